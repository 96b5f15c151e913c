"""The corridor of 63 m (fig. 13 b and c): strides and lengths by one foot, by both and by the stature."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from math import degrees, hypot

from solepath.emulate.routes.route import Route
from solepath.emulate.walk import EmulatedWalk
from solepath.events import StrideTaken
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from solepath.papers.footstep_tracker.stride_length import printed_toe_out
from solepath.recipes import Recipe
from solepath.session import Session
from solepath.types import OTHER, SITE_OF_FOOT, Foot, Packet

from ...emulated.buildings import corridor
from ..tables import PictureTrack, Plot, Values, WalkResults
from ..walks import final_strides, run_session
from .wearers import LENGTH_RECIPES, ONE_METRE_RULE, WearerJob

CALIBRATION_LENGTH = 20.0
"""Length of the walk from which the printed toe-out angle is calibrated, m (fig. 10)."""
STEP_LENGTH_SHARE = 0.413
"""Step length as a share of stature.

The common method of fig. 13 (b) multiplies the number of steps by "a step length estimated by the user's height". The
paper does not give the rule. This is the factor that pedometers use for a woman; that for a man is 0.415."""


def score_corridor(job: WearerJob) -> WalkResults:
    """Return the rows of one wearer: sizes of errors as shares of the length, %, those of strides in m.

    "one foot" are the sums of each foot's strides, "two feet" their mean, "corridor's end" the distance from the first
    to the last position. Only STANDARD has the additions one after the other, the ends and strides."""
    way = corridor().route
    walk = job.walk(way)
    n_true = sum([len(walk.truth.strides(foot)) for foot in Foot])
    recipes = LENGTH_RECIPES if job.is_standard else {"printed": FOOTSTEP_TRACKER_PRINTED, "one foot": FOOTSTEP_TRACKER}
    values, strides = Values(), list[StrideTaken]()

    def share(length: float) -> float:
        return 100.0 * (length / way.length - 1.0)

    for name, recipe in recipes.items():
        strides = final_strides(run_session(recipe, walk.packets))
        of_feet = [share(sum([one.length for one in strides if one.foot is foot])) for foot in Foot]
        values[f"corridor, {name} %"] = tuple(map(abs, of_feet))
        values[f"strides, {name} %"] = (100.0 * len(strides) / n_true,)
    values["corridor, two feet %"] = (abs(sum(of_feet)) / len(of_feet),)
    values["common to both feet %"] = (sum(of_feet) / len(of_feet),)
    if not job.is_standard:
        return WalkResults(values)
    values["corridor, by height %"] = (abs(share(len(strides) * STEP_LENGTH_SHARE * job.stature)),)
    alone = [[packet for packet in walk.packets if packet.site is SITE_OF_FOOT[foot]] for foot in Foot]
    ends = {
        "one foot": [_end(FOOTSTEP_TRACKER, of_foot) for of_foot in alone],
        "one-metre rule": [_end(ONE_METRE_RULE, walk.packets)],
        "two feet": [_end(FOOTSTEP_TRACKER, walk.packets)],
    }
    values |= {f"corridor's end, {name} %": tuple([abs(share(end)) for end in of]) for name, of in ends.items()}
    angles = _printed_toe_out(job)
    values |= _stride_errors(walk, strides) | {
        "toe-out, printed deg": angles,
        "feet with a printed toe-out %": (100.0 * len(angles) / len(Foot),),
    }
    return WalkResults(values, (_curves(walk, strides, job.stature),))


def _printed_toe_out(job: WearerJob) -> tuple[float, ...]:
    """Return the errors of the printed toe-out, degrees, of the feet that have one after a walk of known length."""
    walk = job.walk(Route().stand(3.0).walk(CALIBRATION_LENGTH, 1.2).stop(2.0), more=500)
    strides = final_strides(run_session(FOOTSTEP_TRACKER, walk.packets))
    sums = [sum([one.length for one in strides if one.foot is foot]) for foot in Foot]
    angles = [printed_toe_out(along, CALIBRATION_LENGTH) for along in sums]
    return tuple([degrees(abs(angle - job.wearer.toe_out)) for angle in angles if angle is not None])


def _end(recipe: Recipe, packets: Sequence[Packet]) -> float:
    """Return the distance of the last position from the first, m."""
    session = Session(recipe)
    session.feed(packets)
    session.finish()
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


def _stride_errors(walk: EmulatedWalk, strides: list[StrideTaken]) -> Values:
    """Return the sizes of the errors of single lengths, m, and of their means with the other foot's last one."""
    one_foot, two_feet = [], []
    last_errors: dict[Foot, float] = {}
    for stride in strides:
        true = _true_length(walk, stride)
        if true is not None:
            error = last_errors[stride.foot] = stride.length - true
            one_foot.append(abs(error))
            if (other := last_errors.get(OTHER[stride.foot])) is not None:
                two_feet.append(abs(0.5 * (error + other)))
    return {"step, one foot m": tuple(one_foot), "step, two feet m": tuple(two_feet)}


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
    return Plot("63 m of corridor (b)", tracks, "distance, m", "error, m")
