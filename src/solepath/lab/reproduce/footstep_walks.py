"""Walks of one wearer of the footstep-tracker experiments: corridor, activities, turns, a way through the building.

There are two CC2541 in the insoles at 20 Hz (section IV, "System Deployment"), another pair for every wearer."""

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
from ...papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
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
KNOWN_WAY = 20.0
"""Length of the walk from which the toe-out angle is calibrated, m (fig. 10)."""
CORRIDOR = 63.0
"""Length of the corridor, m."""
BY_HEIGHT = 0.413
"""Step length over stature.

The common method of fig. 13 (b) multiplies the steps by "a step length estimated by the user's height". The paper does
not give the rule; this is the factor that pedometers use for a woman (0.415 for a man)."""
INCREMENTS = tuple(radians(angle) for angle in range(-180, 181, 30) if angle)
"""Turn angles of fig. 13 (d), rad."""
CLASSES = {Turn.LEFT: (0.5 * pi,), Turn.RIGHT: (-0.5 * pi,), Turn.ABOUT: (pi, -pi)}
"""Turn angles of each class, rad."""


@frozen
class WearerData:
    """A wearer, with toes more or less out, and the wearer's stature, m."""

    who: Wearer
    stature: float


@frozen
class FootstepWalked:
    """Results of one wearer; lengths in m, angles in degrees, shares as fractions of one."""

    one_foot: float
    """Error at the end of the corridor by one foot, m."""
    by_height: float
    """Error at the end of the corridor by stature, m."""
    two_feet: float
    """Error at the end of the corridor by both feet, m."""
    step_one: tuple[float, ...]
    """Signed error of the length of each stride by one foot, m."""
    step_two: tuple[float, ...]
    """Signed error of the mean of a stride and the other foot's stride before it, m."""
    windows: ActivityScore
    """Score of two-second windows on another walk of another wearer, with stairs and lifts."""
    turned: dict[float, float]
    """Error of the turn angle, degrees, by true angle, degrees."""
    classes: dict[Turn, tuple[int, int]]
    """Number of turns classified right and number of all, by class."""
    places: tuple[PlaceScore, ...]
    """Scores of the place along the way of the paper's case study, and along another way."""


def walked(seed: int) -> FootstepWalked:
    """Return the results of all walks of one wearer."""
    known = WearerData(*random_wearer(np.random.default_rng([seed, 17])))
    calibration = _calibrated(known, seed)
    windows = emulated_activity.score(FOOTSTEP_TRACKER, seed).windows
    turned, classes = _turns(known, calibration, seed)
    places = tuple(_placed(known, calibration, way, seed) for way in (case_study(), wandering(seed)))
    return FootstepWalked(*_corridor(known, calibration, seed), windows, turned, classes, places)


def _worn(known: WearerData, route: Route, seed: int) -> EmulatedWalk:
    tags = {site: CC2541(rate=RATE, mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    return emulate(route, wearer=known.who, devices=tags, seed=seed)


def _calibrated(known: WearerData, seed: int) -> Calibration:
    """Return the toe-out of both feet from a walk of known length (fig. 10); none where that gives no angle."""
    walk = _worn(known, Route().stand(3.0).walk(KNOWN_WAY, 1.2).stop(2.0), seed + 500)
    try:
        return toe_out_calibration(toe_out(walk.packets, KNOWN_WAY))
    except CalibrationError:
        return Calibration()


def _corridor(
    known: WearerData, calibration: Calibration, seed: int
) -> tuple[float, float, float, tuple[float, ...], tuple[float, ...]]:
    walk = _worn(known, corridor().route, seed)
    session = Session(FOOTSTEP_TRACKER, calibration=calibration)
    events = session.feed(walk.packets) + session.finish()
    here = session.position
    two_feet = 0.0 if here is None else hypot(here.position[0], here.position[1])
    steps = [event for event in events if isinstance(event, StrideTaken)]
    one_foot = sum([step.length for step in steps if step.foot is Foot.RIGHT])
    by_height = len(steps) * BY_HEIGHT * known.stature
    off_one, off_two = [], []
    before: dict[Foot, float] = {}
    for step in steps:
        true = _true_length(walk, step)
        if true is None:
            continue
        off = step.length - true
        off_one.append(off)
        other = before.get(Foot.LEFT if step.foot is Foot.RIGHT else Foot.RIGHT)
        if other is not None:
            off_two.append(0.5 * (off + other))
        before[step.foot] = off
    length = corridor().route.length
    return (
        abs(one_foot - length), abs(by_height - length), abs(two_feet - length), tuple(off_one), tuple(off_two)
    )  # fmt: skip


def _true_length(walk: EmulatedWalk, step: StrideTaken) -> float | None:
    """Return the length of the true stride with the same swing as this one, m."""
    if step.t_toe_off is None or step.t_heel_strike is None:
        return None
    middle = 0.5 * (step.t_toe_off + step.t_heel_strike)
    for true in walk.truth.steps(step.foot):
        if true.t_start <= middle <= true.t_end:
            return hypot(true.displacement[0], true.displacement[1])
    return None


def _turns(
    known: WearerData, calibration: Calibration, seed: int
) -> tuple[dict[float, float], dict[Turn, tuple[int, int]]]:
    rng = np.random.default_rng([seed, 18])
    turned: dict[float, float] = {}
    for angle in INCREMENTS:
        made = _turn(known, calibration, angle, rng, seed)
        off = sum([one.angle for one in made]) - angle
        # a turn about to the left equals one to the right
        turned[round(degrees(angle))] = abs(degrees(remainder(off, 2.0 * pi)))
    classes = {}
    for turn, angles in CLASSES.items():
        right = 0
        for k in range(PER_CLASS):
            angle = angles[k % len(angles)] + float(rng.normal(0.0, TURN_SPREAD))
            made = _turn(known, calibration, angle, rng, seed + k)
            right += [one.turn for one in made if one.turn is not None] == [turn]
        classes[turn] = (right, PER_CLASS)
    return turned, classes


PER_CLASS = 10
"""Turns of each class and wearer; the paper has 30 of three wearers for training, and five new ones."""
TURN_SPREAD = radians(15.0)
"""Standard deviation of the turn angle, rad, because nobody turns by exactly 90 degrees.

The classifier was trained with the same value (lab/train/turns.py)."""


def _turn(
    known: WearerData, calibration: Calibration, angle: float, rng: np.random.Generator, seed: int
) -> list[TurnMade]:
    """Return the turns reported while the wearer walks, turns and walks."""
    radius = float(rng.uniform(0.0, 1.2))
    route = Route(speed=float(rng.uniform(0.9, 1.3))).stand(2.5).walk(6.0).turn(angle, radius if radius > 0.4 else 0.0)
    walk = _worn(known, route.walk(6.0).stop(3.0), seed)
    return [event for event in run_session(FOOTSTEP_TRACKER, walk.packets, calibration) if isinstance(event, TurnMade)]


def _placed(known: WearerData, calibration: Calibration, way: BuildingWalk, seed: int) -> PlaceScore:
    walk = _worn(known, way.route, seed)
    events = run_session(FOOTSTEP_TRACKER, walk.packets, calibration, BUILDING)
    return emulated_place.score(way, walk.walker, walk.truth, events)
