"""The corridor of 63 m (fig. 13 b and c): strides, zones and lengths by one foot, by both and by the stature."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from math import degrees, hypot

from solepath.calibration import Calibration, CalibrationError
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import EmulatedWalk
from solepath.events import Event, StrideTaken
from solepath.foot.stance.stance import Load, Stance
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.papers.footstep_tracker.static_zones import TIME_TOLERANCE, StaticZones
from solepath.papers.footstep_tracker.toe_out import ToeOut, printed_angle, toe_out, toe_out_calibration
from solepath.recipes import Recipe
from solepath.recording.decoded import decode_recording
from solepath.session import Session
from solepath.types import OTHER, SITE_OF_FOOT, Foot, Packet, Quat, Vec3
from solepath.types.attrs import define, evolve, field
from solepath.types.vector import GRAVITY, IDENTITY

from ...emulated.buildings import corridor
from ..tables import PictureTrack, Plot, WalkResults
from ..walks import final_strides
from .wearers import LENGTH_RECIPES, ONE_METRE_RULE, WearerJob

CALIBRATION_LENGTH = 20.0
"""Length of the walk from which the toe-out angle is calibrated, m (fig. 10)."""
CORRIDOR_LENGTH = 63.0
"""Length of the corridor, m."""
STEP_LENGTH_SHARE = 0.413
"""Step length as a share of stature.

The common method of fig. 13 (b) multiplies the number of steps by "a step length estimated by the user's height". The
paper does not give the rule. This is the factor that pedometers use for a woman; that for a man is 0.415."""
REST_TOLERANCE, REST_SAMPLES = 0.5, 6
"""Largest difference from (0, 0, 1 g), m/s^2, and number of samples of a static zone as printed (section IV.B)."""


@define
class WatchedZones(StaticZones):
    """Detector that counts its zones; it is for figures only."""

    zones: int = field(default=0, init=False)
    """Number of zones."""
    strict_zones: int = field(default=0, init=False)
    """Number of zones in which six samples were at rest sooner or later."""
    is_strict: bool = field(default=False, init=False)
    """Flag: six samples were at rest in the present zone."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        was_static = self.static
        stance = StaticZones.update(self, t, dt, acc, gyro, load, attitude)
        if self.static:
            if not was_static:
                self.zones, self.is_strict = self.zones + 1, False
            if not self.is_strict and self.strict.duration(t) >= self.settings.length - TIME_TOLERANCE:
                self.strict_zones, self.is_strict = self.strict_zones + 1, True
        return stance


def score_corridor(job: WearerJob) -> WalkResults:
    """Return the results of one wearer; only STANDARD has all variants and the toe-out.

    "one foot: VARIANT" are the errors of the sum of each foot's strides, m; "ours" is with the toe-out. "two feet" is
    their mean, "by height" the error of the length by the stature. "end: VARIANT" are errors of the distance from first
    to last position, m; "step: one foot" errors of single stride lengths, m, and "step: two feet" of means with the
    other foot's last one. The other values are rows."""
    found = _calibrate(job) if job.is_standard else []
    calibration = toe_out_calibration(found)
    walk, length = job.walk(corridor().route), corridor().route.length
    events, session = _run(evolve(FOOTSTEP_TRACKER, detector=WatchedZones()), walk.packets, calibration)
    n_true = sum([len(walk.truth.strides(foot)) for foot in Foot])
    strides = final_strides(events)
    values = {"one foot: ours": _off(strides, length), "end: two feet": (_end(session) - length,)}
    values["two feet"] = (0.5 * sum(values["one foot: ours"]),)
    values["by height"] = (len(strides) * STEP_LENGTH_SHARE * job.stature - length,)
    if job.is_standard:
        for name, recipe in LENGTH_RECIPES.items():
            variant = final_strides(_run(recipe, walk.packets)[0])
            values[f"one foot: {name}"] = _off(variant, length)
            values[f"strides, {name} %"] = (100.0 * len(variant) / n_true,)
        packets = [[packet for packet in walk.packets if packet.site is SITE_OF_FOOT[foot]] for foot in Foot]
        values["end: one foot"] = tuple(
            [_end(_run(FOOTSTEP_TRACKER, of_foot, calibration)[1]) - length for of_foot in packets]
        )
        values["end: one-metre rule"] = (_end(_run(ONE_METRE_RULE, walk.packets, calibration)[1]) - length,)
    zones = [tracker.detector for tracker in session.feet.values() if isinstance(tracker.detector, WatchedZones)]
    n_zones = sum([one.zones for one in zones])
    loose = n_zones - sum([one.strict_zones for one in zones])
    printed = [printed_angle(one.along, CALIBRATION_LENGTH) for one in found]
    toe_out = job.wearer.toe_out
    values |= _stride_errors(walk, strides) | {
        "zones by the loose rule %": (100.0 * loose / max(1, n_zones),),
        "zones within 0, 0, g %": (_literal_share(walk),),
        "toe-out deg": tuple([degrees(one.angle - toe_out) for one in found if one.is_known]),
        "toe-out, printed deg": tuple([degrees(one[0] - toe_out) for one in printed if one is not None]),
    }
    return WalkResults(values, (_curves(walk, strides, job.stature),) if job.is_standard else ())


def _calibrate(job: WearerJob) -> list[ToeOut]:
    """Return the toe-out of both feet from a walk of known length (fig. 10); nothing when it cannot be measured."""
    walk = job.walk(Route().stand(3.0).walk(CALIBRATION_LENGTH, 1.2).stop(2.0), more=500)
    try:
        return toe_out(walk.packets, CALIBRATION_LENGTH)
    except CalibrationError:
        return []


def _run(
    recipe: Recipe, packets: Sequence[Packet], calibration: Calibration | None = None
) -> tuple[list[Event], Session]:
    session = Session(recipe, calibration=Calibration() if calibration is None else calibration)
    return session.feed(packets) + session.finish(), session


def _off(strides: list[StrideTaken], length: float) -> tuple[float, ...]:
    """Return the error of the sum of each foot's strides, m."""
    return tuple([sum([one.length for one in strides if one.foot is foot]) - length for foot in Foot])


def _end(session: Session) -> float:
    """Return the distance of the last position from the first, m."""
    here = session.position
    return 0.0 if here is None else hypot(here.position[0], here.position[1])


def _true_length(walk: EmulatedWalk, stride: StrideTaken) -> float | None:
    """Return the length, m, of the true stride that contains the middle of this stride's swing; None without one."""
    if stride.t_toe_off is None or stride.t_heel_strike is None:
        return None
    middle = 0.5 * (stride.t_toe_off + stride.t_heel_strike)
    for true in walk.truth.strides(stride.foot):
        if true.t_start <= middle <= true.t_end:
            return hypot(true.displacement[0], true.displacement[1])
    return None


def _stride_errors(walk: EmulatedWalk, strides: list[StrideTaken]) -> dict[str, tuple[float, ...]]:
    one_foot, two_feet = [], []
    last_errors: dict[Foot, float] = {}
    for stride in strides:
        true = _true_length(walk, stride)
        if true is None:
            continue
        error = stride.length - true
        one_foot.append(error)
        other = last_errors.get(OTHER[stride.foot])
        if other is not None:
            two_feet.append(0.5 * (error + other))
        last_errors[stride.foot] = error
    return {"step: one foot": tuple(one_foot), "step: two feet": tuple(two_feet)}


def _curves(walk: EmulatedWalk, strides: list[StrideTaken], stature: float) -> Plot:
    """Return the errors along the corridor: of the right foot, of the mean of both feet, and by the stature."""
    walked: dict[Foot, list[tuple[float, float]]] = {}
    for foot in Foot:
        pairs = [(one.length, true) for one in strides if one.foot is foot and (true := _true_length(walk, one))]
        walked[foot] = list(zip(*(accumulate(values) for values in zip(*pairs, strict=True)), strict=True))
    right = walked[Foot.RIGHT]
    both = list(zip(walked[Foot.LEFT], right, strict=False))
    step = STEP_LENGTH_SHARE * stature
    curves = {
        "one foot": [(true, abs(ours - true)) for ours, true in right],
        "double feet": [(0.5 * (b + d), abs(0.5 * (a + c - b - d))) for (a, b), (c, d) in both],
        "common method": [(true, abs((2.0 * k + 2.0) * step - true)) for k, (_, true) in enumerate(right)],
    }
    tracks = [PictureTrack(name, points) for name, points in curves.items()]
    return Plot(f"{CORRIDOR_LENGTH:g} m of corridor (b)", tracks, "distance, m", "error, m")


def _literal_share(walk: EmulatedWalk) -> float:
    """Return the share of the stances that have six samples within 0.5 m/s^2 of (0, 0, 1 g), %.

    The sensors lie in the foot's axes, as in fig. 3; the samples are as they come, with the offset of the chip."""
    samples = decode_recording(walk.packets).samples
    found = count = 0
    for foot in Foot:
        times = [
            (one.t, max(abs(one.acc[0]), abs(one.acc[1]), abs(one.acc[2] - GRAVITY)) <= REST_TOLERANCE)
            for one in samples
            if one.site is SITE_OF_FOOT[foot] and one.acc is not None
        ]
        strides = walk.truth.strides(foot)
        for before, after in pairwise(strides):
            longest = run = 0
            for t, at_rest in times:
                if before.t_end <= t <= after.t_heel_off:
                    run = run + 1 if at_rest else 0
                    longest = max(longest, run)
            found, count = found + (longest >= REST_SAMPLES), count + 1
    return 100.0 * found / max(1, count)
