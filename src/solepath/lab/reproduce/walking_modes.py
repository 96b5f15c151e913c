"""Gong et al. 2023: positions at the corners of 40 rectangles of 2.8 m by 4.0 m, by touchdown methods I to IV.

Four wearers walk ten rectangles each, with seven attitude sensors and two insoles of 99 cells at 50 Hz. The wearers are
those of table 3 (emulate/wearers/gait.py). They walk from A over B, C and D back to A, turning left without a halt. For
each corner and foot, one stride counts: that whose foot-flat is nearest to the time when the pelvis passes the corner.
The deviation at a corner is the session's touchdown minus the true footprint of these strides, averaged over both feet.

The floor is surveyed, as in the paper: sessions know the direction of the first side relative to the sensors' common
north. A touchdown is the moment at which a foot comes down. Methods I, II and III of papers/walking_modes detect it by
height, net acceleration and pressure. IV also uses pressure, and compensates with the errors of the same wearer's walks
over marks on the floor (section 3.3). These are other walks, for which the sensors were attached anew."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration, InsoleCalibration, Limbs, merged
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
"""Number of steps of a walk over marks, and number of its repetitions.

Section 3.3: "50 steps at a time and repeated this three times along each path"."""
METHODS = {"I": TOUCHDOWN_HEIGHT, "II": TOUCHDOWN_ACCELERATION, "III": TOUCHDOWN_PRESSURE, "IV": WALKING_MODES}
CORNER_POSITIONS = {"A": (0.0, 0.0), "B": (ALONG, 0.0), "C": (ALONG, ACROSS), "D": (0.0, ACROSS)}
"""Positions (x, y) of the corners, m; x along the first side, y to the left. The walk starts and ends at A."""
HIP_ERROR, BONE_ERROR, FOOT_ERROR = 0.010, 0.010, 0.005
"""Standard deviations of measured lengths, m: distance of the hip joints, thigh and shank, foot and ankle's height.

Where a joint is by regression is 12.3 mm off in space, with images as the truth (Mantovani et al. 2016, Gait & Posture
44): 7 mm on one axis, and 10 mm for the distance of two. The others are assumed for a tape over the skin."""
MAX_TIME_DIFFERENCE = 0.4
"""Largest time between a reported touchdown and the true one that it matches, s."""


@frozen
class ModesJob:
    """One rectangle to emulate, walked by the wearer of index `subject` in SUBJECTS, who has this calibration."""

    subject: int
    seed: int
    calibration: Calibration


@frozen
class MarkedWalks:
    """The walks of one wearer over marks on the floor to emulate: `steps` steps in each mode, `repeats` times."""

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
    calibrations = list(run_jobs(learn, marked_walks, processes=processes, progress=progress, jobs_after=count))
    jobs = [ModesJob(k % len(wearers), 1000 * seed + k, calibrations[k % len(wearers)]) for k in range(count)]
    results = list(run_jobs(walk, jobs, processes=processes, progress=progress, jobs_before=len(wearers)))
    rows = tuple(
        row_of(
            published.WALKING_MODES,
            corner_row(point, method, axis),
            [one.deviations[method][point][k] for one in results],
            digits=4,
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
        deviation_tracks.append(PictureTrack(method, tuple(deviation for _, deviation in deviations), DrawStyle.DOTS))
    marks = tuple((point, x, y) for point, (x, y) in CORNER_POSITIONS.items())
    return (
        FloorPanel("corners as estimated by the four methods (fig. 15a)", tuple(tracks), marks),
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
            f"{point}: the mean length of our deviations is {', '.join(our_texts)} cm; the length of the paper's mean "
            f"deviation is {', '.join(paper_texts)} cm."
        )
    lines.append(
        "IV compensates each wearer by the mean errors of the wearer's own walks over marks. The recipe's own "
        "compensation, the paper's table 1, is worse for these wearers."
    )
    lines.append("All four methods are given the direction of the first side relative to the sensors' common north.")
    lines.append("The heading of the paper's table says mm, but its numbers are read as m. It has no quartiles.")
    return tuple(lines)


def measured_limbs(wearer: Wearer) -> Limbs:
    """Return the lengths of the wearer's limbs as somebody measures them from outside, m: not as the joints have them.

    Errors are normal, the same in every walk, and drawn from the wearer's number."""
    limbs, rng = wearer.limbs, np.random.default_rng([wearer.number, 10])
    hips, thigh, shank, foot, ankle = (float(value) for value in rng.standard_normal(5))
    return Limbs(
        hip_width=limbs.hip_width + HIP_ERROR * hips,
        thigh=limbs.thigh + BONE_ERROR * thigh,
        shank=limbs.shank + BONE_ERROR * shank,
        foot=limbs.foot + FOOT_ERROR * foot,
        ankle_height=limbs.ankle_height + FOOT_ERROR * ankle,
    )


def measured_calibration(wearer: Wearer) -> Calibration:
    """Return the calibration that needs no walk: lengths of the limbs, weight, and layouts of the insoles."""
    shoe = wearer.shoe
    insoles = {foot: InsoleCalibration(layout=layout(CELL_COUNT, foot, shoe.length, shoe.width)) for foot in Foot}
    return Calibration(insoles=insoles, limbs=measured_limbs(wearer), weight=GRAVITY * wearer.mass)


def sample_wearer(walker: Walker, calibration: Calibration, seed: int) -> list[Sample]:
    """Return the samples of the seven sensors and both insoles, whose errors and mounting are drawn from `seed`."""
    layouts = {SITE_OF_FOOT[foot]: one.layout for foot, one in calibration.insoles.items() if one.layout is not None}
    return limb_samples(walker, RATE, seed=seed, layouts=layouts, cell_part=WORN_RESISTIVE)


def learn(job: MarkedWalks) -> Calibration:
    """Return a wearer's calibration from walks over marks in every mode; sensors are attached anew for each repeat."""
    wearer = SUBJECTS[job.subject]
    measured = measured_calibration(wearer)
    errors = []
    for round_seed in range(job.seed, job.seed + job.repeats):
        for k, mode in enumerate(MODES):
            walker = Walker(marked(mode, job.steps), wearer, 10 * round_seed + k)
            marks = [
                ModeMark(f"mark {n}", mark.foot, mark.x, mark.y, mark.mode, t=mark.t)
                for n, mark in enumerate(marks_of(walker), 1)
                if mark.mode is mode
            ]
            recording = DecodedRecording(tuple(sample_wearer(walker, measured, round_seed)), {})
            touchdown_events = touchdowns(recording, measured, heading=0.0)
            errors += step_errors(marks, touchdown_events)
    return merged(measured, Calibration(modes=mean_errors(errors)))


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
    with_heading = evolve(modes, settings=evolve(modes.settings, heading=0.0))
    events = run_session(recipe.exchanged(Modes, with_heading), samples, calibration)
    return {foot: [e for e in events if isinstance(e, TouchedDown) and e.final and e.foot is foot] for foot in Foot}


def _deviation(
    walker: Walker, corner: LapCorner, touchdown_events: dict[Foot, list[TouchedDown]]
) -> tuple[float, float]:
    """Return the deviation (x, y) at a corner, m."""
    dx = dy = 0.0
    for foot in Foot:
        stride = walker.plan.strides[foot][corner.stride_numbers[foot] - 1]
        x, y = _place(walker, foot, stride.heel_strike, touchdown_events[foot])
        dx += 0.5 * (x - corner.footprints[foot][0])
        dy += 0.5 * (y - corner.footprints[foot][1])
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
