"""Emulated walks of Gong et al. 2023: over marks on the floor, around a rectangle, and along bends by two load laws.

What the methods know of a wearer is not what the emulator has. The lengths of the limbs are measured from outside, with
errors (`measured_limbs`). The sensors sit on skin that moves (emulated/limb_samples.py). The load in bends moves
by the law of the literature and by chance, not by that of the rules of table 2."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot
from operator import attrgetter

import numpy as np
from attrs import astuple, evolve, frozen

from solepath.calibration import Calibration, InsoleCalibration, Limbs
from solepath.calibration.records import merged
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import CRE_CC02, WORN_RESISTIVE
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.gait import LoadLaw, Wearer
from solepath.emulate.wearers.walker import Walker
from solepath.events import TouchedDown
from solepath.papers.walking_modes.calibrate import MODES, ModeMark, StepError, mean_errors, step_errors, touchdowns
from solepath.papers.walking_modes.recipe import WALKING_MODES, WALKING_MODES_PRINTED
from solepath.recipes import Recipe
from solepath.recording.decoded import DecodedRecording
from solepath.types import SITE_OF_FOOT, Foot, Sample
from solepath.types.vector import GRAVITY
from solepath.validate.alignment import Floats

from ...emulated.laps import LapCorner, corners, marked, rectangle
from ...emulated.laps import marks as marks_of
from ...emulated.limb_samples import limb_samples
from ...emulated.wearers import SUBJECTS
from ..tables import Values, WalkResults, mean, pooled
from ..walks import run_session

RATE = 50.0
"""Sampling rate, Hz (section 3.1)."""
CELL_COUNT = 99
LOAD_VARIATION = 0.004
"""Standard deviation of the load's lateral position under a foot between steps, m (assumed)."""
LENGTH_ERRORS = (0.010, 0.010, 0.010, 0.005, 0.005)
"""Standard deviations of measured `Limbs`, m: distance of the hip joints, thigh, shank, foot and ankle's height.

A joint found by regression is 12.3 mm off in space, with images as the truth (Mantovani et al. 2016, Gait & Posture
44): 7 mm on one axis, and 10 mm for the distance of two. The others are assumed for a tape over the skin."""
RULES = {"by turn": WALKING_MODES, "table 2": WALKING_MODES_PRINTED}
"""Recipes by the rule by which they recognise the mode."""
MAX_TIME_DIFFERENCE = 0.4
"""Largest time between a reported touchdown and the true one that it matches, s."""


@frozen
class Conditions:
    """The conditions of a walk that a method does not know."""

    hips: float = 0.0
    """Error of the measured distance of the hip joints in addition to that of `measured_limbs`, m."""
    tissue: float = 1.0
    """Motion of soft tissue, as a multiple of that of limb_samples.py."""
    law: LoadLaw = LoadLaw.HEEL_OUT_FOREFOOT_IN
    """Law by which the load moves in a bend."""
    variation: float = LOAD_VARIATION
    """Variation of the load's lateral position, m."""
    contact: GroundContact = RIGID
    """Contact of the soles with the ground."""
    tilt: float = 0.0
    """Tilt that stays about either horizontal axis of each sensor's world, rad (`AttitudeErrors.steady_tilt`)."""

    def wearer(self, subject: int) -> Wearer:
        """Return the wearer of this index in SUBJECTS."""
        wearer = SUBJECTS[subject]
        shoe = evolve(wearer.shoe, contact=self.contact)
        return evolve(wearer, shoe=shoe, load_law=self.law, load_variation=self.variation)

    def calibration(self, subject: int) -> Calibration:
        """Return the calibration that needs no walk: lengths of the limbs, weight, and layouts of the insoles."""
        wearer = self.wearer(subject)
        shoe, limbs = wearer.shoe, measured_limbs(wearer)
        insoles = {foot: InsoleCalibration(layout=layout(CELL_COUNT, foot, shoe.length, shoe.width)) for foot in Foot}
        limbs = evolve(limbs, hip_width=limbs.hip_width + self.hips)
        return Calibration(insoles=insoles, limbs=limbs, weight=GRAVITY * wearer.mass)

    def samples(self, walker: Walker, calibration: Calibration, seed: int) -> list[Sample]:
        """Return the samples of the seven sensors and both insoles, whose errors and mounting are drawn from `seed`."""
        layouts = {
            SITE_OF_FOOT[foot]: one.layout for foot, one in calibration.insoles.items() if one.layout is not None
        }
        return limb_samples(
            walker,
            RATE,
            seed=seed,
            attitude=evolve(CRE_CC02, steady_tilt=self.tilt),
            layouts=layouts,
            cell_part=WORN_RESISTIVE,
            tissue=self.tissue,
            limb_attitudes_only=True,
        )


USUAL = Conditions()


def measured_limbs(wearer: Wearer) -> Limbs:
    """Return the lengths of the wearer's limbs as somebody measures them from outside, m: not as the joints have them.

    Errors are normal, the same in every walk, and drawn from the wearer's number."""
    drawn = np.random.default_rng([wearer.number, 10]).standard_normal(len(LENGTH_ERRORS)).tolist()
    off = zip(astuple(wearer.limbs), LENGTH_ERRORS, drawn, strict=True)
    return Limbs(*[length + sigma * value for length, sigma, value in off])


@frozen
class MarkedWalks:
    """The walks of one wearer over marks on the floor: `steps` steps in each mode, `repeats` times.

    Before each repeat the sensors are attached anew."""

    subject: int
    seed: int
    steps: int
    repeats: int
    conditions: Conditions = USUAL


@frozen
class LearntModes:
    """A wearer's calibration, and its compensation as table 1 has it: x to the right, y ahead, m."""

    calibration: Calibration
    results: WalkResults


def learn(job: MarkedWalks) -> LearntModes:
    """Return what walks over marks in every mode tell of a wearer."""
    wearer, measured = job.conditions.wearer(job.subject), job.conditions.calibration(job.subject)
    errors: list[StepError] = []
    for round_seed in range(job.seed, job.seed + job.repeats):
        for k, mode in enumerate(MODES):
            walker = Walker(marked(mode, job.steps), wearer, 10 * round_seed + k)
            marks = [
                ModeMark(f"mark {n}", mark.foot, mark.x, mark.y, mark.mode, t=mark.t)
                for n, mark in enumerate(marks_of(walker), 1)
                if mark.mode is mode
            ]
            recording = DecodedRecording(tuple(job.conditions.samples(walker, measured, round_seed)), {})
            errors += step_errors(marks, touchdowns(recording, measured, heading=0.0), turn=0.0)
    means = mean_errors(errors)
    table: Values = {
        f"{foot.value} {mode.value} {axis}": (value,)
        for foot, row in means.items()
        for mode, (forward, left) in row.items()
        for axis, value in (("x", -left), ("y", forward))
    }
    return LearntModes(merged(measured, Calibration(modes=means)), WalkResults(table))


@frozen
class ModesJob:
    """One rectangle, walked by the wearer of index `subject` in SUBJECTS, by several methods.

    A method is a recipe and the calibration that it gets, by name."""

    subject: int
    seed: int
    methods: dict[str, tuple[Recipe, Calibration]]
    conditions: Conditions = USUAL


def walk(job: ModesJob) -> WalkResults:
    """Emulate one rectangle and return the deviations at its corners by method, m, as `corner_row` names them.

    "POINT METHOD m" is the length of one, `corners_row` the mean of the lengths."""
    conditions = job.conditions
    walker = Walker(rectangle(), conditions.wearer(job.subject), job.seed)
    samples = conditions.samples(walker, conditions.calibration(job.subject), job.seed)
    values = Values()
    for method, (recipe, calibration) in job.methods.items():
        touchdown_events = _touchdowns(recipe, samples, calibration)
        passes = sorted(corners(walker), key=attrgetter("name"))
        off = {corner.name: _deviation(walker, corner, touchdown_events) for corner in passes}
        lengths = {point: hypot(*of) for point, of in off.items()}
        values |= {
            corner_row(point, method, axis): (of[k],) for point, of in off.items() for k, axis in enumerate("xy")
        }
        values |= {corner_row(point, method, "m"): (length,) for point, length in lengths.items()}
        values[corners_row(method)] = (mean(list(lengths.values())),)
    return WalkResults(values)


def corner_row(point: str, method: str, axis: str) -> str:
    """Return the name of the row of a corner, a touchdown method and an axis ("x" or "y")."""
    return f"{point} {method} {axis}"


def corners_row(method: str) -> str:
    """Return the name of the row of the mean length of the deviations at all corners."""
    return f"corners, {method} m"


def deviations(walks: Iterable[Values], point: str, method: str) -> Floats:
    """Return the deviations (n, 2), m, of a method at a corner."""
    return np.array([pooled(walks, corner_row(point, method, axis)) for axis in "xy"]).T


def _touchdowns(recipe: Recipe, samples: Sequence[Sample], calibration: Calibration) -> dict[Foot, list[TouchedDown]]:
    """Return the final touchdowns by foot of a session that knows the direction of the rectangle's first side."""
    events = run_session(recipe.with_heading(0.0), samples, calibration)
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
    before = [one for one in touchdown_events if one.t < t]
    if not near and not before:
        return walker.plan.starts[foot].x, walker.plan.starts[foot].y
    x, y, _ = (min(near, key=lambda one: abs(one.t - t)) if near else before[-1]).position
    return x, y


@frozen
class BendsJob:
    """Walks of one wearer straight on and along the paper's bends, `steps` steps each."""

    subject: int
    seed: int
    steps: int
    conditions: Conditions


def recognise(job: BendsJob) -> WalkResults:
    """Return the share of touchdowns, in percent, with the right mode in each of the five walks, by rule."""
    conditions = job.conditions
    calibration = conditions.calibration(job.subject)
    shares: Values = {f"modes {rule} %": () for rule in RULES}
    for k, mode in enumerate(MODES):
        walker = Walker(marked(mode, job.steps), conditions.wearer(job.subject), 10 * job.seed + k)
        samples = conditions.samples(walker, calibration, job.seed)
        true = [mark for mark in marks_of(walker) if mark.mode is mode]
        for rule, recipe in RULES.items():
            found = _touchdowns(recipe, samples, calibration)
            right = sum(
                any(down.mode is mode and abs(down.t - mark.t) < MAX_TIME_DIFFERENCE for down in found[mark.foot])
                for mark in true
            )
            shares[f"modes {rule} %"] += (100.0 * right / len(true),)
    return WalkResults(shares)
