"""Walks of one wearer of the footstep-tracker experiments: corridor, activities, turns, a path through the building.

A CC2541 in each insole samples at 20 Hz (section IV, "System Deployment"). Every wearer has another pair."""

from __future__ import annotations

from math import degrees, hypot, pi, radians, remainder

import numpy as np
from attrs import frozen

from ...calibration import Calibration, CalibrationError
from ...emulate.routes.building import BUILDING
from ...emulate.routes.route import Route
from ...emulate.routes.ways import BuildingWalk, case_study, corridor, wandering
from ...emulate.sensors.sensortags import CC2541
from ...emulate.walk import EmulatedWalk, emulate
from ...emulate.wearers.gait import Wearer, random_wearer
from ...emulate.wearers.shoe import IN_SOLE
from ...events import StrideTaken, TurnMade
from ...papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from ...papers.footstep_tracker.toe_out import toe_out, toe_out_calibration
from ...session import Session
from ...types import SITE_OF_FOOT, Foot, Turn
from ..emulated import activity as emulated_activity
from ..emulated import place as emulated_place
from ..emulated.place import PlaceScore
from ..measures.confusion import ActivityScore
from .walks import run_session

RATE = 20.0
"""Sampling rate, Hz."""
CALIBRATION_LENGTH = 20.0
"""Length of the walk from which the toe-out angle is calibrated, m (fig. 10)."""
CORRIDOR_LENGTH = 63.0
"""Length of the corridor, m."""
STEP_LENGTH_SHARE = 0.413
"""Step length as a share of stature.

The common method of fig. 13 (b) multiplies the number of steps by "a step length estimated by the user's height". The
paper does not give the rule. This is the factor that pedometers use for a woman; that for a man is 0.415."""
TURN_ANGLES = tuple(radians(angle) for angle in range(-180, 181, 30) if angle)
"""Turn angles of fig. 13 (d), rad, positive to the left."""
CLASS_ANGLES = {Turn.LEFT: (0.5 * pi,), Turn.RIGHT: (-0.5 * pi,), Turn.ABOUT: (pi, -pi)}
"""Turn angles of each class, rad."""


@frozen
class WearerData:
    """A wearer, and the wearer's stature, m."""

    wearer: Wearer
    stature: float


@frozen
class FootstepResults:
    """The results of all experiments with one wearer."""

    one_foot_error: float
    """Error of the corridor's length as the sum of the right foot's strides, m."""
    stature_error: float
    """Error of the corridor's length by the wearer's stature, m."""
    two_feet_error: float
    """Error of the corridor's length as the distance between first and last position of the wearer, m."""
    one_foot_stride_errors: tuple[float, ...]
    """Error of each stride length, measured minus true, m."""
    two_feet_stride_errors: tuple[float, ...]
    """Mean of the length errors of each stride and of the other foot's last stride before it, m."""
    windows: ActivityScore
    """Score of two-second windows on another walk of another wearer, with stairs and elevators."""
    printed_windows: ActivityScore
    """The same by the paper's tree and hidden Markov model."""
    turn_errors: dict[float, float]
    """Error of the turn angle, degrees, by true angle, degrees."""
    classes: dict[Turn, tuple[int, int]]
    """Number of turns classified right and number of all, by class."""
    places: tuple[PlaceScore, ...]
    """Scores of the positions on the floor plan, on the path of the paper's case study and on another path."""


def score_wearer(seed: int) -> FootstepResults:
    """Return the results of all walks of one wearer."""
    wearer_data = WearerData(*random_wearer(np.random.default_rng([seed, 17])))
    calibration = _calibrate(wearer_data, seed)
    windows, printed_windows = [
        emulated_activity.score(recipe, seed).windows for recipe in (FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED)
    ]
    turn_errors, classes = _score_turns(wearer_data, calibration, seed)
    places = tuple(_score_place(wearer_data, calibration, way, seed) for way in (case_study(), wandering(seed)))
    corridor_errors = _score_corridor(wearer_data, calibration, seed)
    return FootstepResults(*corridor_errors, windows, printed_windows, turn_errors, classes, places)


def _emulate_walk(wearer_data: WearerData, route: Route, seed: int) -> EmulatedWalk:
    tags = {site: CC2541(rate=RATE, mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    return emulate(route, wearer=wearer_data.wearer, devices=tags, seed=seed)


def _calibrate(wearer_data: WearerData, seed: int) -> Calibration:
    """Return a calibration with the toe-out of both feet from a walk of known length (fig. 10).

    The calibration is empty when the walk gives no toe-out."""
    walk = _emulate_walk(wearer_data, Route().stand(3.0).walk(CALIBRATION_LENGTH, 1.2).stop(2.0), seed + 500)
    try:
        return toe_out_calibration(toe_out(walk.packets))
    except CalibrationError:
        return Calibration()


def _score_corridor(
    wearer_data: WearerData, calibration: Calibration, seed: int
) -> tuple[float, float, float, tuple[float, ...], tuple[float, ...]]:
    walk = _emulate_walk(wearer_data, corridor().route, seed)
    session = Session(FOOTSTEP_TRACKER, calibration=calibration)
    events = session.feed(walk.packets) + session.finish()
    final_position = session.position
    two_feet = 0.0 if final_position is None else hypot(final_position.position[0], final_position.position[1])
    strides = [event for event in events if isinstance(event, StrideTaken)]
    one_foot = sum([stride.length for stride in strides if stride.foot is Foot.RIGHT])
    by_stature = len(strides) * STEP_LENGTH_SHARE * wearer_data.stature
    one_foot_errors, two_feet_errors = [], []
    last_errors: dict[Foot, float] = {}
    for stride in strides:
        true = _true_length(walk, stride)
        if true is None:
            continue
        error = stride.length - true
        one_foot_errors.append(error)
        other = last_errors.get(Foot.LEFT if stride.foot is Foot.RIGHT else Foot.RIGHT)
        if other is not None:
            two_feet_errors.append(0.5 * (error + other))
        last_errors[stride.foot] = error
    length = corridor().route.length
    return (
        abs(one_foot - length), abs(by_stature - length), abs(two_feet - length),
        tuple(one_foot_errors), tuple(two_feet_errors),
    )  # fmt: skip


def _true_length(walk: EmulatedWalk, stride: StrideTaken) -> float | None:
    """Return the length, m, of the true stride that contains the middle of this stride's swing; None without one."""
    if stride.t_toe_off is None or stride.t_heel_strike is None:
        return None
    middle = 0.5 * (stride.t_toe_off + stride.t_heel_strike)
    for true in walk.truth.strides(stride.foot):
        if true.t_start <= middle <= true.t_end:
            return hypot(true.displacement[0], true.displacement[1])
    return None


def _score_turns(
    wearer_data: WearerData, calibration: Calibration, seed: int
) -> tuple[dict[float, float], dict[Turn, tuple[int, int]]]:
    rng = np.random.default_rng([seed, 18])
    turn_errors: dict[float, float] = {}
    for angle in TURN_ANGLES:
        reported_turns = _report_turns(wearer_data, calibration, angle, rng, seed)
        off = sum([one.angle for one in reported_turns]) - angle
        # a turn by 180 degrees to the left ends in the same direction as one to the right
        turn_errors[round(degrees(angle))] = abs(degrees(remainder(off, 2.0 * pi)))
    classes = {}
    for turn, angles in CLASS_ANGLES.items():
        n_right = 0
        for k in range(TURNS_PER_CLASS):
            angle = angles[k % len(angles)] + float(rng.normal(0.0, TURN_SPREAD))
            reported_turns = _report_turns(wearer_data, calibration, angle, rng, seed + k)
            n_right += [one.turn for one in reported_turns if one.turn is not None] == [turn]
        classes[turn] = (n_right, TURNS_PER_CLASS)
    return turn_errors, classes


TURNS_PER_CLASS = 10
"""Number of turns of each class for each wearer; the paper has 30 for training and five other wearers for the test."""
TURN_SPREAD = radians(15.0)
"""Standard deviation of the turn angle, rad, because nobody turns by exactly 90 degrees.

The classifier was trained with the same value (lab/train/turns.py)."""


def _report_turns(
    wearer_data: WearerData, calibration: Calibration, angle: float, rng: np.random.Generator, seed: int
) -> list[TurnMade]:
    """Return the turns that are reported while the wearer walks 6 m, turns by `angle` rad and walks 6 m."""
    radius = float(rng.uniform(0.0, 1.2))
    route = Route(speed=float(rng.uniform(0.9, 1.3))).stand(2.5).walk(6.0).turn(angle, radius if radius > 0.4 else 0.0)
    walk = _emulate_walk(wearer_data, route.walk(6.0).stop(3.0), seed)
    return [event for event in run_session(FOOTSTEP_TRACKER, walk.packets, calibration) if isinstance(event, TurnMade)]


def _score_place(wearer_data: WearerData, calibration: Calibration, way: BuildingWalk, seed: int) -> PlaceScore:
    walk = _emulate_walk(wearer_data, way.route, seed)
    events = run_session(FOOTSTEP_TRACKER, walk.packets, calibration, BUILDING)
    return emulated_place.score(way, walk.walker, walk.truth, events)
