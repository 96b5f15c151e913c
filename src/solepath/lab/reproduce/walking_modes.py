"""Gong et al. 2023: 40 rectangles of 2.8 m by 4.0 m by touchdown methods I to IV.

Four wearers walk ten rectangles each, with seven attitude sensors and two insoles of 99 cells at 50 Hz. The wearers are
those of table 3 (emulate/wearers/gait.py). They walk from A over B, C and D back to A, turning left without a halt. Of
each foot one touchdown is nearest to a corner. The deviation at a corner is the error of the session's positions of
these two touchdowns, averaged over both feet: estimated minus true footprint.

The floor is surveyed, as in the paper: sessions know the direction of the first side relative to the sensors' common
north. Method IV compensates with the errors of the same wearer's marked walks (section 3.3). These are other walks, for
which the sensors were strapped on again. The four touchdown methods are those of papers/walking_modes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration, InsoleCalibration, merged
from ...emulate.routes.laps import ACROSS, ALONG, LapCorner, corners, marked, rectangle
from ...emulate.routes.laps import marks as marks_of
from ...emulate.sensors.insoles import layout
from ...emulate.sensors.parts import WORN_RESISTIVE
from ...emulate.sensors.suit import limb_samples
from ...emulate.wearers.gait import SUBJECTS, Wearer
from ...emulate.wearers.walker import Walker
from ...events import TouchedDown
from ...papers.walking_modes.calibrate import MODES, ModeMark, mean_errors, step_errors, touchdowns
from ...papers.walking_modes.modes import Modes
from ...papers.walking_modes.recipe import TOUCHDOWN_ACCELERATION, TOUCHDOWN_HEIGHT, TOUCHDOWN_PRESSURE, WALKING_MODES
from ...recipes import Recipe
from ...recording.decoded import DecodedRecording
from ...types import SITE_OF_FOOT, Foot, Sample
from ...types.vector import GRAVITY
from ..processes import Progress, run_jobs
from . import published
from .published import corner_row
from .tables import DrawStyle, FloorPanel, PictureTrack, Reproduction, row_of, statistics
from .walks import run_session

NAME = WALKING_MODES.name
WALKS = 40
RATE = 50.0
"""Sampling rate, Hz (section 3.1)."""
CELL_COUNT = 99
MARKED_STEPS, MARKED_REPEATS = 50, 3
"""Number of steps of a marked walk, and number of its repetitions.

Section 3.3: "50 steps at a time and repeated this three times along each path"."""
METHODS = {"I": TOUCHDOWN_HEIGHT, "II": TOUCHDOWN_ACCELERATION, "III": TOUCHDOWN_PRESSURE, "IV": WALKING_MODES}
CORNER_POSITIONS = {"A": (0.0, 0.0), "B": (ALONG, 0.0), "C": (ALONG, ACROSS), "D": (0.0, ACROSS)}
"""Positions (x, y) of the corners, m; x along the first side, y to the left. The walk starts and ends at A."""
MAX_TIME_DIFFERENCE = 0.4
"""Largest time between a reported touchdown and the true one that it matches, s."""


@frozen
class ModesJob:
    """One rectangle to emulate, with the wearer's number in SUBJECTS and calibration."""

    subject: int
    seed: int
    calibration: Calibration


@frozen
class MarkedWalks:
    """The marked walks of one wearer to emulate: `steps` steps in each mode, `repeats` times."""

    subject: int
    seed: int
    steps: int
    repeats: int


@frozen
class ModesResults:
    """The results of one rectangle."""

    deviations: dict[str, dict[str, tuple[float, float]]]
    """Deviation (x, y) by method and corner, m."""


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """Return the results of `walks` rectangles, walked by the four wearers in turn."""
    count = WALKS if walks is None else walks
    wearers = list(range(min(count, len(SUBJECTS))))
    marked_walks = [
        MarkedWalks(subject, 1000 * seed + 500 + 10 * subject, MARKED_STEPS, MARKED_REPEATS) for subject in wearers
    ]
    known = list(run_jobs(learn, marked_walks, processes=processes, progress=progress, after=count))
    jobs = [ModesJob(k % len(known), 1000 * seed + k, known[k % len(known)]) for k in range(count)]
    results = list(run_jobs(walk, jobs, processes=processes, progress=progress, before=len(wearers)))
    rows = tuple(
        row_of(
            published.WALKING_MODES,
            corner_row(point, method, axis),
            [one.deviations[method][point][k] for one in results],
            4,
        )
        for point in CORNER_POSITIONS
        for method in METHODS
        for k, axis in enumerate("xy")
    )
    return Reproduction(
        name=NAME,
        paper_title=published.WALKING_MODES_TITLE,
        emulation=f"{count} rectangles of {ALONG} m by {ACROSS} m by {len(wearers)} wearers at {RATE:g} Hz",
        unit="m",
        rows=rows,
        panels=_panels(results),
        notes=_notes(results),
    )


def _panels(results: Sequence[ModesResults]) -> tuple[FloorPanel, FloorPanel]:
    closed_path = tuple(CORNER_POSITIONS[point] for point in "ABCDA")
    tracks = [PictureTrack("rectangle", closed_path, DrawStyle.TRUTH)]
    deviation_tracks = []
    for method in METHODS:
        deviations = [(point, one.deviations[method][point]) for one in results for point in CORNER_POSITIONS]
        estimated_positions = tuple(
            (CORNER_POSITIONS[point][0] + dx, CORNER_POSITIONS[point][1] + dy) for point, (dx, dy) in deviations
        )
        tracks.append(PictureTrack(method, estimated_positions, DrawStyle.DOTS))
        deviation_tracks.append(PictureTrack(method, tuple(place for _, place in deviations), DrawStyle.DOTS))
    marks = tuple((point, x, y) for point, (x, y) in CORNER_POSITIONS.items())
    return (
        FloorPanel("where four methods have the corners (fig. 15a)", tuple(tracks), marks),
        FloorPanel("deviations at all corners (fig. 15b)", tuple(deviation_tracks), (("", 0.0, 0.0),)),
    )


def _notes(results: Sequence[ModesResults]) -> tuple[str, ...]:
    lines = []
    for point in CORNER_POSITIONS:
        our_texts, paper_texts = [], []
        for method in METHODS:
            lengths = [float(np.hypot(*one.deviations[method][point])) for one in results]
            our_texts.append(f"{method} {100.0 * (statistics(lengths).mean or 0.0):.1f}")
            mean, _, _ = published.CORNERS[point][method]
            paper_texts.append(f"{method} {100.0 * float(np.hypot(*mean)):.1f}")
        lines.append(
            f"{point}: ours is off by {', '.join(our_texts)} cm on average; the paper's means are off by "
            f"{', '.join(paper_texts)} cm."
        )
    lines.append(
        "IV compensates each wearer by what the wearer's own marked walks showed; the table that the recipe ships, the "
        "paper's table 1, does worse on these wearers."
    )
    lines.append(
        "How the first side lies to the sensors' common north is given to all four methods, not found by them."
    )
    lines.append("The paper heads its table mm; its figures are taken for m, and so are ours. It has no quartiles.")
    return tuple(lines)


def known_calibration(wearer: Wearer) -> Calibration:
    """Return the calibration that is known from a tape measure, scales and the data of the insoles."""
    shoe = wearer.shoe
    insoles = {foot: InsoleCalibration(layout=layout(CELL_COUNT, foot, shoe.length, shoe.width)) for foot in Foot}
    return Calibration(insoles=insoles, limbs=wearer.limbs, weight=GRAVITY * wearer.mass)


def sample_wearer(walker: Walker, known: Calibration, seed: int) -> list[Sample]:
    """Return the samples of the seven sensors and both insoles, whose errors and mounting are drawn from `seed`."""
    layouts = {SITE_OF_FOOT[foot]: one.layout for foot, one in known.insoles.items() if one.layout is not None}
    return limb_samples(walker, RATE, seed=seed, layouts=layouts, cell_part=WORN_RESISTIVE)


def learn(job: MarkedWalks) -> Calibration:
    """Return a wearer's calibration after marked walks in every mode; each repetition has the sensors mounted again."""
    wearer = SUBJECTS[job.subject]
    known = known_calibration(wearer)
    errors = []
    for round_seed in range(job.seed, job.seed + job.repeats):
        for k, mode in enumerate(MODES):
            walker = Walker(marked(mode, job.steps), wearer, 10 * round_seed + k)
            marks = [
                ModeMark(f"mark {n}", mark.foot, mark.x, mark.y, mark.mode, t=mark.t)
                for n, mark in enumerate(marks_of(walker), 1)
                if mark.mode is mode
            ]
            recording = DecodedRecording(tuple(sample_wearer(walker, known, round_seed)), {})
            touchdown_events = touchdowns(recording, known, heading=0.0)
            errors += step_errors(marks, touchdown_events)
    return merged(known, Calibration(modes=mean_errors(errors)))


def walk(job: ModesJob) -> ModesResults:
    """Emulate one rectangle and run all methods on it."""
    walker = Walker(rectangle(), SUBJECTS[job.subject], job.seed)
    samples = sample_wearer(walker, job.calibration, job.seed)
    corner_passes = corners(walker)
    deviations = {}
    for method, recipe in METHODS.items():
        touchdown_events = _touchdowns(recipe, samples, job.calibration)
        deviations[method] = {corner.name: _deviation(walker, corner, touchdown_events) for corner in corner_passes}
    return ModesResults(deviations)


def _touchdowns(recipe: Recipe, samples: Sequence[Sample], calibration: Calibration) -> dict[Foot, list[TouchedDown]]:
    """Return the final touchdowns by foot of a session that knows the direction of the rectangle's first side."""
    modes = next(part for part in recipe.parts if isinstance(part, Modes))
    known = evolve(modes, settings=evolve(modes.settings, heading=0.0))
    events = run_session(recipe.exchanged(Modes, known), samples, calibration)
    return {foot: [e for e in events if isinstance(e, TouchedDown) and e.final and e.foot is foot] for foot in Foot}


def _deviation(
    walker: Walker, corner: LapCorner, touchdown_events: dict[Foot, list[TouchedDown]]
) -> tuple[float, float]:
    """Return the deviation (x, y) at a corner, m."""
    dx = dy = 0.0
    for foot in Foot:
        x, y = _place(
            walker, foot, walker.plan.strides[foot][corner.steps[foot] - 1].heel_strike, touchdown_events[foot]
        )
        dx += 0.5 * (x - corner.feet[foot][0])
        dy += 0.5 * (y - corner.feet[foot][1])
    return dx, dy


def _place(walker: Walker, foot: Foot, t: float, touchdown_events: Sequence[TouchedDown]) -> tuple[float, float]:
    """Return the position (x, y), m, of the touchdown near `t` s, else of the last one before, else of the start."""
    near = [one for one in touchdown_events if abs(one.t - t) < MAX_TIME_DIFFERENCE]
    if near:
        x, y, _ = min(near, key=lambda one: abs(one.t - t)).position
        return x, y
    before = [one for one in touchdown_events if one.t < t]
    if before:
        x, y, _ = before[-1].position
        return x, y
    start = walker.plan.starts[foot]
    return start.x, start.y
