"""The walks of Li et al. 2016, one emulated walk a job: there and back, stairs, a rectangle, ramps, five minutes.

One MPU-6050 sits on the laces of the right shoe and samples at 100 Hz, without radio losses. Every walk has other
sensor errors and other strides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import hypot, radians

import numpy as np
from attrs import frozen

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import Shoe
from solepath.emulate.wearers.truth import Truth
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, StrideTaken
from solepath.types import Sample
from solepath.validate.alignment import Floats, path_length

from ..tables import DrawStyle, PictureTrack, Plot, Values, WalkResults, pooled
from ..walks import align_track, final_strides, run_session
from .figures import extraction_curves, posture_curves, window_curves
from .scores import Scores, score_legs, score_strides
from .variants import (
    BEFORE,
    BY_ANGLE,
    DEFAULT_ROW,
    FOOT,
    MAIN,
    OURS,
    PRINTED,
    RECIPES,
    SHORT,
    STAIRS,
    STATES,
    TABLE,
    ShoeSetup,
)

WALKING_SPEED, JOGGING_SPEED = 1.0, 2.1
"""Walking and jogging speed, m/s: assumed, so that strides are about as long as the paper's 1.20 m and 1.60 m."""
LEG = 19.2
"""Length of the straight line, m (section 4.2.1)."""
ROUNDS = 2
"""Number of rounds "back and forth", and on the stairs up and down, of each wearer."""
STANDING_TIME = 6.0
"""Time for which the wearer stands before the first step, s."""
SIDES = (6.0, 7.0)
"""Sides of the rectangle, m (section 4.2.4, fig. 25b)."""
RISERS = 11
"""Number of stairs in a flight (assumed). Each is 0.16 m high and 0.30 m deep, as in the paper."""
LAPS = 2
"""Number of laps of the corridors of each storey, so that the walk takes five minutes."""
SLOPES = (0.02, 0.05)
"""Slopes of the ramps, m/m: of a floor that is not quite level, and of a ramp for wheelchairs."""
RAMP, KERB = 20.0, 0.10
"""Length of a ramp and height of a single step, m."""
HALF_TURN, QUARTER_TURN = radians(180), radians(90)
LAST_STRIDES = 9
"""Number of strides at the end of a walk whose directions give the heading error."""
MAX_POINTS = 400
"""Largest number of points of a track in the figure."""


def line_route(rounds: int = ROUNDS, jogs: bool = False) -> Route:
    """Return the line there and back, at a walk or at a jog, with a turn on the spot at either end."""
    route = Route().stand(STANDING_TIME)
    for _ in range(2 * rounds):
        route = route.jog(LEG, JOGGING_SPEED) if jogs else route.walk(LEG, WALKING_SPEED)
        route = route.turn(HALF_TURN).stand(1.0)
    return route


def stairs_route(rounds: int = ROUNDS) -> Route:
    """Return a flight up and down, with a few metres and a turn on the spot at either end."""
    route = Route().stand(STANDING_TIME)
    for up in (True, False) * rounds:
        route = route.walk(2.5, 1.2).stairs(RISERS, up=up).walk(2.5).turn(HALF_TURN).stand(1.0)
    return route


def short_route() -> Route:
    """Return one round of each: walking, jogging, stairs."""
    parts = (line_route(1), line_route(1, True), stairs_route(1))
    return Route(tuple([action for k, part in enumerate(parts) for action in part.actions[1 if k else 0 :]]))


def rectangle_route() -> Route:
    """Return the rectangle of fig. 25b, with a turn on the spot at each corner."""
    route = Route().stand(STANDING_TIME)
    for side in SIDES * 2:
        route = route.walk(side, WALKING_SPEED).turn(QUARTER_TURN).stand(1.0)
    return route


def ramps_route() -> Route:
    """Return 20 m on the level, ramps up and down of either slope, and a kerb up and down, all straight on."""
    route = Route().stand(STANDING_TIME).walk(20.0, WALKING_SPEED)
    for slope in SLOPES:
        for signed in (slope, -slope):
            route = route.walk(RAMP, slope=signed).walk(5.0)
    for up in (True, False):
        route = route.stairs(1, up=up, rise=KERB).walk(5.0)
    return route.stop(2.0)


def tour_route() -> Route:
    """Return the route of fig. 35: corridors of two storeys and the stairs between them, for five minutes."""
    route = Route().stand(STANDING_TIME)
    for up in (True, False):
        for _ in range(2 * LAPS):
            route = route.walk(LEG, 1.2).turn(QUARTER_TURN, 1.0).walk(9.0).turn(QUARTER_TURN, 1.0)
        route = route.walk(4.0)
        route = route.stairs(RISERS, up=up).turn(HALF_TURN, 0.7).stairs(RISERS, up=up).walk(4.0)
    return route.stop(3.0)


ROUTES: dict[str, Callable[[], Route]] = {
    "walking": line_route,
    "jogging": partial(line_route, jogs=True),
    "stairs": stairs_route,
    "short": short_route,
    "setup": short_route,
    "rectangle": rectangle_route,
    "ramps": ramps_route,
    "five minutes": tour_route,
}
"""Functions that return the route of each walk."""
SHORT_WALKS = ("short", "setup")
"""Walks in all states, with the setup of the table and with any."""
TITLES = {
    "walking": "there and back (fig. 25a)", "rectangle": "rectangle (fig. 25b)", "stairs": "stairs (fig. 28)",
    "five minutes": "five minutes (fig. 35)",
}  # fmt: skip
"""Titles of the walks whose tracks are drawn, in the order of the figures."""
WALK_RECIPES: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("walking", "jogging", "stairs"), tuple(MAIN)),
    "short": tuple(SHORT),
    "setup": (OURS, PRINTED),
    "rectangle": (OURS, PRINTED),
    "ramps": (OURS, PRINTED, BY_ANGLE, DEFAULT_ROW),
    "five minutes": (OURS, PRINTED, DEFAULT_ROW),
}
"""Names of the recipes that walk each walk."""


@frozen
class ShoeJob:
    """One walk to emulate."""

    seed: int
    walk: str
    """Name of the walk in ROUTES."""
    setup: ShoeSetup = TABLE
    drawn: bool = False
    """True for the walks of which curves are drawn."""


def walk(job: ShoeJob) -> WalkResults:
    """Emulate one walk and run its recipes on it.

    Values are "RECIPE, NAME" with the names of `Scores`. Panels of a walk that is drawn are figs. 3, 7 and 20, or its
    tracks in space."""
    samples, truth = sample_walk(ROUTES[job.walk](), job.seed, job.setup)
    sessions = {name: run_session(RECIPES[name], samples) for name in WALK_RECIPES[job.walk]}
    panels: tuple[Plot, ...] = ()
    if job.drawn and job.walk == "short":
        panels = (window_curves(samples, truth), posture_curves(samples), *extraction_curves(samples, truth))
    elif job.drawn:
        panels = (Plot(TITLES.get(job.walk, ""), _tracks(sessions, truth)),)
    values = Values()
    for recipe, events in sessions.items():
        values |= {f"{recipe}, {name}": of for name, of in _score(job.walk, recipe, events, truth).items()}
    return WalkResults(values, panels)


def sample_walk(route: Route, seed: int, setup: ShoeSetup = TABLE) -> tuple[list[Sample], Truth]:
    """Return the samples of the sensor on a walk along `route`, and the truth."""
    walker = Walker(route, Wearer(shoe=Shoe(contact=setup.contact)), seed=seed)
    samples = walker.samples(FOOT, setup.rate, setup.chip, mounting=setup.mounting)
    return samples, walker.truth({FOOT: setup.mounting})


def _score(walk: str, recipe: str, events: Sequence[Event], truth: Truth) -> Scores:
    """Return what is shown of a walk.

    That are figures of strides and of legs, of ramps and kerbs, or of the whole track; of the short walk the figures of
    all states in one."""
    strides = final_strides(events, FOOT)
    if walk == "ramps":
        return _rises(strides, truth)
    if walk == "five minutes":
        return _score_track(strides, truth)
    legs = Scores() if walk in ("stairs", *SHORT_WALKS) else score_legs(strides, truth, FOOT)
    if walk == "rectangle":
        return legs | {"end m": _score_track(strides, truth)["end m"]}
    scores = score_strides(strides, truth, FOOT)
    if walk in SHORT_WALKS:
        lengths, heights = (
            pooled([scores], *[f"{state}, {name} m" for state in of])
            for name, of in (("length", STATES), ("height", STAIRS))
        )
        found = {name: of for name, of in scores.items() if name.endswith("steps %")}
        height = _score_track(strides, truth)["end height m"]
        return found | {"length m": tuple(lengths), "stair height m": tuple(heights), "end height m": height}
    if recipe in BEFORE.values():
        return {name: of for name, of in scores.items() if name.endswith(("height m", "angle deg/m"))}
    return scores | legs


def _score_track(strides: Sequence[StrideTaken], truth: Truth) -> Scores:
    """Return the figures of the whole track.

    "end m" and "end %": horizontal distance from the true end, and its share of the way; "end height m": error of its
    height; "end heading deg": median error of the direction of the last strides."""
    path = path_length(truth.pose(FOOT, np.arange(0.0, truth.duration, 0.1)).position[:, :2])
    if len(strides) < 2:
        x, y, z = truth.pose(FOOT, truth.duration).position[0]
        off, height, heading = hypot(x, y), z, np.zeros(1)
    else:
        ours, true = _positions(strides, truth)
        off, height = hypot(*(ours[-1, :2] - true[-1, :2])), ours[-1, 2] - true[-1, 2]
        directions = [np.arctan2(d[:, 1], d[:, 0]) for d in (np.diff(ours, axis=0), np.diff(true, axis=0))]
        turned = directions[0] - directions[1]
        heading = np.degrees(np.arctan2(np.sin(turned), np.cos(turned)))
    return {
        "end m": (float(off),),
        "end %": (100.0 * float(off) / path,),
        "end height m": (abs(float(height)),),
        "end heading deg": (abs(float(np.median(heading[-LAST_STRIDES:]))),),
    }


def _positions(strides: Sequence[StrideTaken], truth: Truth) -> tuple[Floats, Floats]:
    """Return the estimated and the true position at the start and at the end of each stride, (n, 3), m.

    The estimated ones are laid on the true ones over the first two metres."""
    ours = np.array([(0.0, 0.0, 0.0), *(stride.position for stride in strides)])
    true = truth.pose(FOOT, np.array([0.0, *(stride.t_end for stride in strides)])).position
    true = true - true[0]
    ours[:, :2] = align_track(ours[:, :2], true[:, :2])
    return ours, true


def _rises(strides: Sequence[StrideTaken], truth: Truth) -> Scores:
    """Return the size of the error of the height between the levels before and after each ramp and kerb, m."""
    ramps = [(f"slope {100.0 * slope:g} %", slope * RAMP, RAMP) for slope in SLOPES]
    true_strides, x, found = truth.strides(FOOT), 20.0, Scores()
    places = np.cumsum([0.0, *(stride.displacement[0] for stride in true_strides)])
    times = [0.0, *(stride.t_end for stride in true_strides)]
    for name, rise, length in (*ramps, (f"kerb {KERB:g} m", KERB, 0.3)):
        for true_rise in (rise, -rise):
            # the middle of the level metres before and after; a foot that stands astride an edge is in neither
            before, after = (float(np.interp(place, places, times)) for place in (x - 2.0, x + length + 2.5))
            z = [next((one.position[2] for one in reversed(strides) if one.t_end <= t), 0.0) for t in (before, after)]
            row = f"{name}, height m"
            found[row] = (*found.get(row, ()), abs(z[1] - z[0] - true_rise))
            x += length + 5.0
    return found


def _tracks(sessions: Mapping[str, Sequence[Event]], truth: Truth) -> list[PictureTrack]:
    t = np.array([0.0, *(stride.t_end for stride in truth.strides(FOOT)[-MAX_POINTS:])])
    position = truth.pose(FOOT, t).position
    tracks = [PictureTrack("true path", _points(position - position[0]), DrawStyle.TRUTH)]
    for name in (OURS, PRINTED):
        strides = final_strides(sessions[name], FOOT)
        if len(strides) > 1:
            tracks.append(PictureTrack(name, _points(_positions(strides, truth)[0][-MAX_POINTS:])))
    return tracks


def _points(positions: Floats) -> tuple[tuple[float, float, float], ...]:
    return tuple([(float(x), float(y), float(z)) for x, y, z in positions])
