"""Gong et al. 2023: 40 rectangles of 2.8 m by 4.0 m by touchdown methods I to IV.

Four wearers walk ten rectangles each, with seven attitude sensors and two insoles of 99 cells at 50 Hz. The wearers are
those of table 3 (emulate/wearers/gait.py). They walk from A over B, C and D back to A, turning left without a halt. At
each corner every foot has a step that comes down nearest to it. A deviation is the session's position of these two
touchdowns less the true footprints, averaged over both.

The floor is surveyed, as the paper's was: sessions know the direction of the first side relative to the sensors' common
north. Method IV compensates by the errors of each wearer's own marked walks (section 3.3) on another day: other walks,
with sensors strapped on again."""

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
from .tables import Drawn, Floor, PictureTrack, Reproduction, row_of, statistics
from .walks import run_session

NAME = WALKING_MODES.name
WALKS = 40
RATE = 50.0
"""Sampling rate, Hz (section 3.1)."""
CELLS = 99
STEPS, REPEATS = 50, 3
"""Number of steps of a marked walk, and number of its repeats.

Section 3.3: "50 steps at a time and repeated this three times along each path"."""
METHODS = {"I": TOUCHDOWN_HEIGHT, "II": TOUCHDOWN_ACCELERATION, "III": TOUCHDOWN_PRESSURE, "IV": WALKING_MODES}
PLACES = {"A": (0.0, 0.0), "B": (ALONG, 0.0), "C": (ALONG, ACROSS), "D": (0.0, ACROSS)}
"""Positions of the corners, m; the walk starts and ends at A."""
NEAR = 0.4
"""Largest distance of a touchdown from the true one, s; without one the latest touchdown before gives the place."""


@frozen
class ModesJob:
    """One rectangle of one wearer."""

    subject: int
    seed: int
    calibration: Calibration


@frozen
class MarkedWalks:
    """The marked walks of one wearer: `steps` steps in each mode, `repeats` times."""

    subject: int
    seed: int
    steps: int
    repeats: int


@frozen
class ModesWalked:
    """Results of one rectangle."""

    off: dict[str, dict[str, tuple[float, float]]]
    """Error (x, y) of the wearer's position by method and corner, m."""


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """Return the results of `walks` rectangles, walked by the four wearers in turn."""
    count = WALKS if walks is None else walks
    wearers = list(range(min(count, len(SUBJECTS))))
    learning = [MarkedWalks(subject, 1000 * seed + 500 + 10 * subject, STEPS, REPEATS) for subject in wearers]
    known = list(run_jobs(learn, learning, processes=processes, progress=progress, after=count))
    jobs = [ModesJob(k % len(known), 1000 * seed + k, known[k % len(known)]) for k in range(count)]
    done = list(run_jobs(walk, jobs, processes=processes, progress=progress, before=len(wearers)))
    rows = tuple(
        row_of(published.WALKING_MODES, corner_row(point, method, axis), [one.off[method][point][k] for one in done], 4)
        for point in PLACES
        for method in METHODS
        for k, axis in enumerate("xy")
    )
    return Reproduction(
        name=NAME,
        paper_title=published.WALKING_MODES_TITLE,
        walked=f"{count} rectangles of {ALONG} m by {ACROSS} m by {len(wearers)} wearers at {RATE:g} Hz",
        unit="m",
        rows=rows,
        panels=_panels(done),
        notes=_notes(done),
    )


def _panels(done: Sequence[ModesWalked]) -> tuple[Floor, Floor]:
    corners = [PLACES[point] for point in "ABCDA"]
    absolute = [PictureTrack("rectangle", tuple(corners), Drawn.TRUTH)]
    net = []
    for method in METHODS:
        off = [(point, one.off[method][point]) for one in done for point in PLACES]
        there = tuple((PLACES[point][0] + dx, PLACES[point][1] + dy) for point, (dx, dy) in off)
        absolute.append(PictureTrack(method, there, Drawn.DOTS))
        net.append(PictureTrack(method, tuple(place for _, place in off), Drawn.DOTS))
    marks = tuple((point, x, y) for point, (x, y) in PLACES.items())
    return (
        Floor("where four methods have the corners (fig. 15a)", tuple(absolute), marks),
        Floor("deviations at all corners (fig. 15b)", tuple(net), (("", 0.0, 0.0),)),
    )


def _notes(done: Sequence[ModesWalked]) -> tuple[str, ...]:
    lines = []
    for point in PLACES:
        ours, theirs = [], []
        for method in METHODS:
            lengths = [float(np.hypot(*one.off[method][point])) for one in done]
            ours.append(f"{method} {100.0 * (statistics(lengths).mean or 0.0):.1f}")
            mean, _, _ = published.CORNERS[point][method]
            theirs.append(f"{method} {100.0 * float(np.hypot(*mean)):.1f}")
        lines.append(
            f"{point}: ours is off by {', '.join(ours)} cm on average; the paper's means are off by "
            f"{', '.join(theirs)} cm."
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
    """Return the calibration that a tape measure, scales and the maker of the insoles give."""
    shoe = wearer.shoe
    insoles = {foot: InsoleCalibration(layout=layout(CELLS, foot, shoe.length, shoe.width)) for foot in Foot}
    return Calibration(insoles=insoles, limbs=wearer.limbs, weight=GRAVITY * wearer.mass)


def worn(walker: Walker, known: Calibration, seed: int) -> list[Sample]:
    """Return the samples of the seven sensors and both insoles; `seed` draws their errors and their mounting."""
    layouts = {SITE_OF_FOOT[foot]: one.layout for foot, one in known.insoles.items() if one.layout is not None}
    return limb_samples(walker, RATE, seed=seed, layouts=layouts, cell_part=WORN_RESISTIVE)


def learn(job: MarkedWalks) -> Calibration:
    """Return a wearer's calibration after marked walks in every mode, with sensors strapped on again for each round."""
    wearer = SUBJECTS[job.subject]
    known = known_calibration(wearer)
    errors = []
    for strapped in range(job.seed, job.seed + job.repeats):
        for k, mode in enumerate(MODES):
            walker = Walker(marked(mode, job.steps), wearer, 10 * strapped + k)
            marks = [
                ModeMark(f"mark {n}", mark.foot, mark.x, mark.y, mark.mode, t=mark.t)
                for n, mark in enumerate(marks_of(walker), 1)
                if mark.mode is mode
            ]
            down = touchdowns(DecodedRecording(tuple(worn(walker, known, strapped)), {}), known, heading=0.0)
            errors += step_errors(marks, down)
    return merged(known, Calibration(modes=mean_errors(errors)))


def walk(job: ModesJob) -> ModesWalked:
    """Run all methods on one rectangle."""
    walker = Walker(rectangle(), SUBJECTS[job.subject], job.seed)
    samples = worn(walker, job.calibration, job.seed)
    passed = corners(walker)
    off = {}
    for method, recipe in METHODS.items():
        down = _touchdowns(recipe, samples, job.calibration)
        off[method] = {corner.name: _deviation(walker, corner, down) for corner in passed}
    return ModesWalked(off)


def _touchdowns(recipe: Recipe, samples: Sequence[Sample], calibration: Calibration) -> dict[Foot, list[TouchedDown]]:
    """Return the touchdowns by foot of a session that knows the direction of the rectangle's first side."""
    modes = next(part for part in recipe.parts if isinstance(part, Modes))
    known = evolve(modes, settings=evolve(modes.settings, heading=0.0))
    events = run_session(recipe.exchanged(Modes, known), samples, calibration)
    return {foot: [e for e in events if isinstance(e, TouchedDown) and e.final and e.foot is foot] for foot in Foot}


def _deviation(walker: Walker, corner: LapCorner, down: dict[Foot, list[TouchedDown]]) -> tuple[float, float]:
    """Return the deviation of the middle between the two footprints at a corner, m."""
    dx = dy = 0.0
    for foot in Foot:
        x, y = _place(walker, foot, walker.plan.strides[foot][corner.steps[foot] - 1].heel_strike, down[foot])
        dx += 0.5 * (x - corner.feet[foot][0])
        dy += 0.5 * (y - corner.feet[foot][1])
    return dx, dy


def _place(walker: Walker, foot: Foot, t: float, down: Sequence[TouchedDown]) -> tuple[float, float]:
    """Return the place where the foot came down at `t` s, or where it stood when no touchdown was found."""
    near = [one for one in down if abs(one.t - t) < NEAR]
    if near:
        x, y, _ = min(near, key=lambda one: abs(one.t - t)).position
        return x, y
    before = [one for one in down if one.t < t]
    if before:
        x, y, _ = before[-1].position
        return x, y
    start = walker.plan.starts[foot]
    return start.x, start.y
