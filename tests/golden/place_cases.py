"""More cases of places: pedestrians in an office to whom all happens that can, and floor plans, whole and damaged."""

from __future__ import annotations

import json
import lzma
import re
import zipfile
from collections.abc import Callable, Iterator
from functools import cache, partial
from io import BytesIO
from math import pi, radians
from pathlib import Path
from random import Random
from typing import Any

from attrs import evolve
from corpus import FOLDER, Case
from floors import (
    CORNERS,
    LIFTS,
    STAIRS,
    STOREY,
    FloorEvents,
    Pedestrian,
    activity_changed,
    beside,
    follow,
    office,
    round_to,
)
from plan_files import format_floorplan

from solepath import (
    Activity,
    FlightClimbed,
    FloorPlan,
    IndexedPlan,
    LiftRidden,
    PositionReported,
    Site,
    Start,
    TrackRevised,
    TurnMade,
    read_floorplan,
)
from solepath.body.part import StartGiven
from solepath.floorplan.checks import find_fault
from solepath.floorplan.findings import find_warnings
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.plan import Anchor, Connector, ConnectorKind, ConnectorStop, Door, FloorPlanError, Level, Wall
from solepath.papers.footstep_tracker.snake import PrintedSnake  # as Particles
from solepath.place.placing import Particles  # a track with known errors is given to it, without a session
from solepath.types import checking

Place = tuple[float, float]
PROTOCOL = Path(__file__).resolve().parents[2] / "protocol"
BEARING = 0.6
"""Bearing of the office on the Earth, rad."""
FAR = (-1200.6, 345.3)
"""Where the office lies on the plan of some pedestrians, m."""


# --- pedestrians ------------------------------------------------------------------------------------------------------


def higher(elevations: tuple[float, ...], **changes: Any) -> FloorPlan:
    """Return the office with as many floors as there are elevations, m."""
    plan = office(Anchor(48.0, 11.0, BEARING))
    (*_, top), names = plan.levels, [str(k) for k in range(len(elevations))]
    levels = [
        evolve(plan.levels[k] if k < 2 else top, id=names[k], ordinal=k, elevation=elevations[k])
        for k in range(len(names))
    ]
    connectors = []
    for one in plan.connectors:
        stops = tuple([evolve(one.stops[0], level=name) for name in names])
        stairs = changes if one.kind is ConnectorKind.STAIRS else {}
        connectors.append(evolve(one, stops=stops, **stairs))
    return evolve(plan, levels=tuple(levels), connectors=tuple(connectors))


def moved(plan: FloorPlan, by: Place) -> FloorPlan:
    """Return the plan moved by x and y, m."""

    def at(place: Place) -> Place:
        return place[0] + by[0], place[1] + by[1]

    def line(one: Any) -> Any:
        return evolve(one, start=at(one.start), end=at(one.end))

    levels = [
        evolve(
            level,
            walls=tuple(map(line, level.walls)),
            doors=tuple(map(line, level.doors)),
            rooms=tuple([tuple(map(at, room)) for room in level.rooms]),
        )
        for level in plan.levels
    ]
    connectors = [
        evolve(
            one,
            stops=tuple(
                [evolve(stop, place=at(stop.place), outline=tuple(map(at, stop.outline))) for stop in one.stops]
            ),
        )
        for one in plan.connectors
    ]
    return evolve(plan, levels=tuple(levels), connectors=tuple(connectors))


@cache
def buildings() -> tuple[tuple[IndexedPlan, Place], ...]:
    """Return the plans of the pedestrians, and where the office lies on each, m."""
    north, three = office(Anchor(48.0, 11.0, BEARING)), higher((0.0, STOREY, 2.0 * STOREY))
    unequal = higher((0.0, 2.6, 8.2))
    lifts = [one for one in north.connectors if one.kind is ConnectorKind.LIFT]
    plans = (
        north,
        three,
        moved(three, FAR),
        unequal,
        evolve(unequal, heights_known=False),
        moved(higher((-STOREY, 0.0), flights=None, rise=0.2), FAR),
        higher((0.0, 3.0, 6.0, 9.0), flights=1, rise=None),
        evolve(north, connectors=tuple(lifts)),
        evolve(office(), connectors=()),
    )
    return tuple([(IndexedPlan(plan), FAR if plan in (plans[2], plans[5]) else (0.0, 0.0)) for plan in plans])


class Tale:
    """A walk in which anything may happen, drawn at random; `told` are events and positions in their order."""

    def __init__(self, seed: int, plan: FloorPlan, at: Place) -> None:
        self.random, self.plan, self.at = Random(seed), plan, at
        landings = sorted({**LIFTS, **STAIRS}.values())
        place = self.random.choice([*CORNERS, *map(beside, landings), *LIFTS.values()])
        self.names = [level.id for level in plan.levels]
        self.one = Pedestrian(seed, self.random.choice(self.names), place)
        self.told: list[Any] = self.one.received
        self.start = self.drawn_start()
        self.one.step(0.05, 0.0)

    def on_plan(self, dx: float = 0.0, dy: float = 0.0) -> Place:
        return self.one.place[0] + self.at[0] + dx, self.one.place[1] + self.at[1] + dy

    def drawn_start(self) -> Start | None:
        level, place, heading = self.one.level, self.on_plan(), -self.one.turned
        return self.random.choice(
            [
                None,
                Start(level, place, heading),
                Start(level, place, heading, 2.0),
                Start(level, place, None, 1.0),
                Start(heading=heading + 0.1),
                Start(heading=heading + 0.5 * pi),
                Start(level, self.on_plan(4.0, -3.0), heading, 40.0),
                Start("attic", place),
                Start(level, self.on_plan(500.0)),
            ]
        )

    def other_level(self) -> str:
        k = self.names.index(self.one.level)
        return self.names[min(max(k + self.random.choice([-1, 1]), 0), len(self.names) - 1)]

    def go(self, place: Place) -> None:
        ways = [round_to(beside(self.one.place), beside(place), forwards) for forwards in (True, False)]
        self.one.walk(*min(ways, key=len), place)

    def stroll(self) -> None:
        self.go(self.random.choice(CORNERS))

    def ride(self) -> None:
        """Ride to a floor, to none and perhaps back, or as the activity alone says."""
        self.go(self.random.choice(sorted(LIFTS.values())))
        level, one = self.other_level(), self.one
        rise = STOREY if level > one.level else -STOREY
        by = self.random.choice([rise, rise, rise + 0.5, 0.45 * rise, 3.5 * rise, 2.0 * rise, None])
        if by is None and self.random.random() < 0.5:
            words = (
                (Activity.ELEVATOR_UP, Activity.STANDING) if rise > 0.0 else (Activity.ELEVATOR_DOWN, Activity.WALKING)
            )
            one.emit(activity_changed(one.t + 1.0, one.t + 3.0, words[0]))
            one.t += 12.0
            x, y, z = one.track
            one.track = (x, y, z + self.random.choice([0.0, rise]))
            one.emit(activity_changed(one.t, one.t + 1.0, words[1]))
            if self.random.random() < 0.4:
                self.lift_ridden(rise, None)
        else:
            self.lift_ridden(rise, by)
            if by is not None and abs(by) != STOREY and self.random.random() < 0.7:
                one.step(0.02, 0.0, counts=False)
                self.lift_ridden(*[self.random.choice([-by, rise - by])] * 2)
        one.level = level
        one.walk(beside(one.place))

    def lift_ridden(self, rise: float, height: float | None) -> None:
        one = self.one
        one.t += 12.0
        one.emit(LiftRidden(t=one.t - 1.0, known_at=one.t, t_start=one.t - 9.0, up=rise > 0.0, height=height))

    def climb(self) -> None:
        """Climb two flights, reported as what they are or not, with or without heights, rests and revisions."""
        self.go(self.random.choice(sorted(STAIRS.values())))
        one, random, level = self.one, self.random, self.other_level()
        up, way, t_start = level > one.level, 1.0 if one.place[1] < 15.0 else -1.0, one.t
        rise = random.choice([STOREY, STOREY, 0.0, 2.8, 5.6]) / 20.0 * (1.0 if up else -1.0)
        steps, flights, rest = (
            random.choice([10, 10, 9, 6]),
            random.random() < 0.5,
            random.choice([0.0, 0.0, 2.0, 30.0]),
        )
        said = random.choice([(up, up)] * 4 + [(not up, not up), (up, not up), (not up, up)])
        for flight in (0, 1):
            begun = one.t
            for k in range(steps):
                if k == 3:
                    one.emit(
                        activity_changed(begun, one.t, Activity.STAIRS_UP if said[flight] else Activity.STAIRS_DOWN)
                    )
                one.step(0.0, 0.28 * way * (1.0 if flight == 0 else -1.0), rise, counts=False)
            height = steps * rise
            if flights:
                one.emit(
                    FlightClimbed(t=one.t, known_at=one.t, t_start=begun, up=said[flight], steps=steps, height=height)
                )
            if not flight and random.random() < 0.3:
                one.t -= 40.0
            if rest and not flight:
                one.t += rest
                one.emit(activity_changed(one.t - rest + 0.5, one.t, Activity.STANDING))
                if random.random() < 0.3:
                    break
        one.level, end = level, one.t
        word = random.choice([Activity.WALKING, Activity.WALKING, Activity.STANDING, Activity.RUNNING])
        if random.random() < 0.3:
            other = Activity.STAIRS_DOWN if said[0] else Activity.STAIRS_UP
            one.emit(evolve(activity_changed(t_start, one.t, other), revises=t_start))
        one.late, one.wait = [activity_changed(end, end + 1.5, word)], random.choice([1, 3])
        one.walk(beside(one.place))
        if random.random() < 0.3:
            again = random.choice([Activity.STAIRS_DOWN, Activity.STAIRS_UP])
            one.emit(
                evolve(activity_changed(t_start, one.t, again), revises=t_start),
                activity_changed(end, one.t, Activity.WALKING),
            )

    def stairs_that_are_none(self) -> None:
        one = self.one
        one.emit(activity_changed(one.t, one.t, self.random.choice([Activity.STAIRS_UP, Activity.STAIRS_DOWN])))
        for k in range(self.random.choice([2, 8, 16])):
            one.step(0.25 if k < 8 else -0.25, 0.0)
        one.emit(activity_changed(one.t - self.random.choice([0.0, 20.0]), one.t, Activity.WALKING))
        self.stroll()

    def report(self) -> None:
        """Say where they are: right, or a little or far off, on another floor, or nowhere."""
        dx, dy = self.random.choice([(0.3, -0.4), (0.3, -0.4), (2.5, 0.5), (9.0, 4.0), (1e4, 0.0)])
        level, sigma = (
            self.random.choice([self.one.level] * 3 + [self.names[0], "7"]),
            self.random.choice([0.2, 1.0, 3.0]),
        )
        for _ in range(self.random.choice([1, 1, 2])):
            t = self.one.t
            self.told.append(
                PositionReported(
                    t=t, known_at=t, site=Site.LEFT_FOOT, position=self.on_plan(dx, dy), level=level, sigma=sigma
                )
            )
            if self.random.random() < 0.5:
                self.stroll()

    def revise(self) -> None:
        one, by, turn = self.one, (-9.0, 14.0), self.random.choice([0.0, 0.7, -2.0])
        self.told.append(TrackRevised(t=one.t, known_at=one.t, by=by, turn=turn, nodes=()))
        one.track, one.turned = (one.track[0] + by[0], one.track[1] + by[1], one.track[2]), one.turned + turn

    def turn_about(self) -> None:
        one, wrong, t_start = self.one, self.random.choice([-110.0, 75.0, 165.0]), self.one.t
        one.turned += radians(wrong)
        one.t += 3.0
        for _ in (0, 1):
            one.step(-0.5, 0.0)
        one.emit(
            TurnMade(
                t=t_start + 3.0, known_at=one.t, t_start=t_start, angle=self.random.choice([3.2, -3.2, 1.9]), turn=None
            )
        )

    def leap(self) -> None:
        self.one.t += 6.0
        self.one.step(
            *self.random.choice([(5.0, 0.0), (0.0, -4.5), (9.0, 3.0), (500.0, 0.0), (0.0, 120.0)]), degraded=True
        )

    def go_anywhere(self) -> None:
        """Go through a wall, which nobody can, or out of the house and back."""
        x, y = self.one.place
        self.one.walk(self.random.choice([(x, y + 9.0), (50.0, y), (x - 9.0, y)]), (x, y))

    def set_clock_back(self) -> None:
        self.one.t -= self.random.choice([0.5, 40.0])

    def happen(self) -> None:
        usual = [self.stroll, self.ride, self.climb]
        rare = [
            self.stairs_that_are_none,
            self.report,
            self.revise,
            self.turn_about,
            self.leap,
            self.go_anywhere,
            self.set_clock_back,
        ]
        self.random.choice(usual * 4 + rare)()


def told(numbers: range, method: Callable[[], Particles] = Particles) -> Iterator[Any]:
    """Yield the events of pedestrians of these numbers."""
    for number in numbers:
        plan, at = buildings()[number % len(buildings())]
        tale, part = Tale(number, plan.plan, at), method()
        for _ in range(6):
            tale.happen()
        part.plan = plan
        if tale.start is not None:
            part.feed((StartGiven(tale.start),), None)
        compass = tale.random.choice([None, None, 0.1, 0.2, 0.4])
        off = tale.random.choice([0.0, 0.0, 0.15, 0.5 * pi])
        for count, item in enumerate(tale.told):
            if not isinstance(item, FloorEvents):
                yield from part.feed((item,), None)
                continue
            yield from part.feed(item.events, None)
            north = None if compass is None or count < 20 else (0.5 * pi + BEARING + tale.one.turned + off, compass)
            here = evolve(item.here, north=north, heading_sigma=tale.random.choice([None, 0.002 * count]))
            yield from part.follow(plan, item.events, here)


def stairs_again() -> Iterator[Any]:
    """Yield the events of a wearer whose clock is set back on the stairs, which then begin once more."""
    plan, place = buildings()[0][0], STAIRS["stairs south"]
    part = Particles()
    one = Pedestrian(5, "0", (20.0, 6.2)).known_to(part)
    one.walk(beside(place), place)
    for steps, way, back in ((3, 1.0, 40.0), (7, 1.0, 0.0), (10, -1.0, 0.0)):
        one.emit(activity_changed(one.t, one.t, Activity.STAIRS_UP))
        for _ in range(steps):
            one.step(0.0, 0.28 * way, 0.18)
        one.t -= back
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.walk(beside(place), (30.0, 6.2))
    yield from follow(part, one.received, plan)


def hesitating() -> Iterator[Any]:
    """Yield the events of a wearer who turns round on the stairs again and again."""
    plan, place = buildings()[0][0], STAIRS["stairs south"]
    part = Particles()
    one = Pedestrian(5, "0", (20.0, 6.2)).known_to(part)
    one.walk(beside(place), place)
    for k in range(30):
        one.emit(activity_changed(one.t, one.t, (Activity.STAIRS_UP, Activity.STAIRS_DOWN)[k % 2]))
        for _ in range(1 + k % 3):
            one.step(0.0, 0.28, 0.18 if k % 2 == 0 else -0.18)
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.walk(beside(place), (30.0, 6.2))
    yield from follow(part, one.received, plan)


def reported_again() -> Iterator[Any]:
    """Yield the events of a wearer who reports a wrong place twice, and whose track is revised in between."""
    part = Particles()
    one = Pedestrian(5, "0", (12.0, 6.2)).known_to(part)
    one.walk((20.0, 6.2))
    part.plan = buildings()[0][0]
    yield from follow(part, one.received, part.plan)
    t = one.t
    wrong = PositionReported(t=t, known_at=t, site=Site.LEFT_FOOT, position=(20.0, 23.8), level="0", sigma=1.0)
    for by in ((-9.0, 14.0), (3.0, -5.0)):
        yield from part.feed((wrong,), None)
        yield from part.feed((TrackRevised(t=t, known_at=t, by=by, turn=0.3, nodes=()),), None)


# --- floor plans ------------------------------------------------------------------------------------------------------


def asked(plan: FloorPlan, side: int) -> Iterator[Any]:
    """Yield what a plan says of itself, of a grid of so many points a side, and of ways between these."""
    yield plan, find_warnings(plan, has_start=len(plan.levels) > 1), plan.origin
    index = IndexedPlan(plan)
    for k, level in enumerate(plan.levels):
        ends = [end for wall in level.walls for end in (wall.start, wall.end)] + [
            one for room in level.rooms for one in room
        ]
        (x0, y0), (x1, y1) = [
            [function(axis) for axis in zip(*(ends or [(0.0, 0.0)]), strict=True)] for function in (min, max)
        ]
        points = [
            (x0 - 1.0 + i * (x1 - x0 + 2.0) / side, y0 - 1.0 + j * (y1 - y0 + 2.0) / side)
            for i in range(side + 1)
            for j in range(side + 1)
        ]
        yield [(index.inside(k, *one), index.room(k, *one), index.door(k, *one)) for one in points]
        yield [
            index.crosses(k, *a, *b)
            for step in (1, side + 1, 3 * side)
            for a, b in zip(points, points[step:], strict=False)
        ]


@cache
def files() -> tuple[dict[str, Any], ...]:
    """Return the files of `inputs/plans.jsonl.xz`: drawn by hand or at random, of all three formats."""
    with lzma.open(FOLDER / "inputs" / "plans.jsonl.xz", "rt") as lines:
        return tuple([json.loads(line) for line in lines])


def packed(file: dict[str, Any]) -> bytes:
    """Return the bytes of a file, which is an archive if it has files."""
    if "text" in file:
        return str(file["text"]).encode()
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, text in file["files"].items():
            archive.writestr(f"plan/{name}", text)
    return buffer.getvalue()


def fate(data: bytes, storey: float = 3.0) -> Any:
    """Return the plan in these bytes, or why there is none."""
    try:
        return parse_floorplan(data, storey)
    except FloorPlanError as error:
        return str(error)


def read(kind: str) -> Iterator[Any]:
    """Yield the plans in all files of a kind, what they say, and what is written of them."""
    for file in files():
        if file["name"].startswith(kind):
            plan = fate(packed(file), 3.4)
            yield (file["name"], plan) if isinstance(plan, str) else file["name"]
            if not isinstance(plan, str):
                yield from asked(plan, 7)
                yield format_floorplan(plan)


WRONG = (None, True, -1, 1.5, 48.1501, 1e300, "", "0", "x\n", "Polygon", "Point", [], [[0, 0], [1, 0]], {})
"""What stands in the place of each value of a file."""


def changed(value: Any) -> Iterator[Any]:
    """Yield what JSON becomes when one value, anywhere, is another, is missing or is there twice."""
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            for one in changed(value[key]):
                copy = value.copy()
                copy[key] = one
                yield copy
            copy = value.copy()
            del copy[key]
            yield copy
        if isinstance(value, list):
            yield value + value[:1]
    yield from WRONG


def damaged() -> Iterator[Any]:
    """Yield the fate of small files of all formats in which one value is wrong."""
    for file in files():
        if not file["name"].startswith("damaged"):
            continue
        for name, text in (file.get("files") or {"": file["text"]}).items():
            if text.startswith("<"):
                found = list(re.finditer(r'"([^"]*)"|<[^>]*>', text))
                ways = [
                    text[: one.start(k)] + new + text[one.end(k) :]
                    for one in found
                    for k in (0 if one[1] is None else 1,)
                    for new in ("", "77", "-1e3", "nan", "9" * 400)
                ]
            else:
                ways = [json.dumps(one) for one in changed(json.loads(text))]
            for number, way in enumerate(ways[:: 16 if name else 5]):
                fated = fate(packed({"files": {**file["files"], name: way}} if name else {"text": way}))
                yield number, fated if isinstance(fated, str) else (fated.fingerprint, fated.remarks)


def limits() -> Iterator[Any]:
    """Yield the faults of plans and starts at each limit, beside it and beyond it."""
    house = read_floorplan(PROTOCOL / "floorplans" / "house.geojson")
    ground, *_ = house.levels
    near, nan = (1.0, 1.0), float("nan")

    def on(**changes: Any) -> FloorPlan:
        bare = evolve(ground, room_names=()) if "rooms" in changes else ground
        return evolve(house, levels=(evolve(bare, **changes), *house.levels[1:]))

    def by(*stops: Any, **changes: Any) -> FloorPlan:
        return evolve(house, connectors=(Connector(ConnectorKind.STAIRS, "A", stops, **changes),))

    def wide(width: float) -> FloorPlan:
        return FloorPlan("", (Level("0", "", 0, 0.0, (Wall((0.0, 0.0), (0.2, width)),)),))

    def lifts(count: int, stops: int) -> FloorPlan:
        levels = tuple([Level(str(k), "", k, 3.0 * k, ground.walls) for k in range(stops)])
        return FloorPlan(
            "",
            levels,
            (Connector(ConnectorKind.LIFT, "", tuple([ConnectorStop(str(k), near) for k in range(stops)])),) * count,
        )

    ring = tuple([(0.001 * k, 0.001 * k * k % 3.0) for k in range(1000)])
    long = tuple([Wall((0.0, 0.01 * k), (4000.0, 0.01 * k)) for k in range(126)])
    low, high = ConnectorStop("0", near), ConnectorStop("1", near)
    corners: tuple[Any, ...] = (
        (1e7, 0.0),
        (1.1e7, 0.0),
        (0.0, -1.1e7),
        (nan, 0.0),
        (0.0, nan),
        (1,),
        "ab",
        None,
        (True, 1),
        (10**400, 0),
    )
    odd: tuple[Any, ...] = (
        0,
        1,
        100,
        101,
        0.02,
        0.019,
        0.6,
        0.61,
        50.0,
        53.1,
        -47.0,
        -47.1,
        100_000,
        100_001,
        nan,
        None,
        "x",
        True,
        10**400,
    )
    plans = [
        *[
            evolve(house, anchor=Anchor(*one))
            for one in ((89.0, 180.0, 10.0), (-89.1, 0.0), (0.0, -180.1), (0.0, 0.0, 10.1), (nan, 0.0), ("x", 0.0))
        ],
        *[
            evolve(house, **{key: one})
            for key in ("levels", "connectors", "name", "anchor", "heights_known", "remarks")
            for one in ((), (1,), [], None)
        ],
        *[
            on(**{key: one})
            for key in ("id", "name", "ordinal", "elevation", "walls", "doors", "rooms", "room_names")
            for one in odd
        ],
        *[by(low, high, **{key: one}) for key in ("flights", "rise") for one in odd],
        *[on(walls=(Wall(near, one),)) for one in (*corners, near)],
        *[on(doors=(Door(one, near),)) for one in corners],
        *[on(rooms=((near, (2.0, 1.0), one),)) for one in corners],
        *[by(ConnectorStop("0", one)) for one in corners],
        *[by(ConnectorStop("0", near, ring[:count])) for count in range(4)],
        *[
            by(*stops)
            for stops in (
                (),
                (low,),
                (high, low),
                (low, low),
                (ConnectorStop("2", near),),
                (ConnectorStop(["0"], near),),
            )
        ],
        *[wide(width) for width in (0.99, 1.0, 5000.0, 5001.0)],
        *[lifts(*count) for count in ((1000, 2), (1001, 2), (2001, 1), (2, 1001))],
        *[on(rooms=(ring,) * count) for count in (99, 101)],
        *[on(walls=(Wall(near, (2.0, 2.0)),) * count) for count in (99_900, 100_001)],
        *[
            FloorPlan("", (evolve(ground, walls=long[:count], doors=(), rooms=(), room_names=()),))
            for count in (125, 126)
        ],
        on(room_names=("A",)),
        evolve(house, levels=(ground, ground)),
        evolve(house, levels=house.levels[::-1]),
    ]
    for plan in plans:
        yield find_fault(plan)
    starts = [
        *[Start("0", one) for one in corners],
        *[Start("0", near, one, 0.5) for one in (*odd, 1000.0, -1000.1)],
        *[Start("0", near, 0.0, one) for one in (*odd, 5000.0, 5001.0, -0.1)],
        *[Start("0"), Start(), Start("0", heading=1.0), Start(0, near)],  # type: ignore[arg-type]
    ]
    for start in starts:
        yield str(checking.find_fault(start, Start))


def landmarks() -> Iterator[Any]:
    """Yield the places of stairs and lifts by name, or why there is none."""
    house = read_floorplan(PROTOCOL / "floorplans" / "house.geojson")
    for plan in (
        house,
        evolve(house, connectors=house.connectors[:1] * 2),
        evolve(house, connectors=()),
        evolve(house, levels=()),
    ):
        for name in ("Lift", "Stairs", "", "printer"):
            for level in ("0", "1", "attic"):
                try:
                    yield plan.landmark(name, level)
                except FloorPlanError as error:
                    yield str(error)


def without_rooms() -> Iterator[Any]:
    """Yield what plans without rooms say, closed and open, straight and slanting."""
    house = read_floorplan(PROTOCOL / "floorplans" / "house.geojson")
    for k in range(8):
        turn = complex(0.8, 0.6) ** k

        def at(place: Place, turn: complex = turn) -> Place:
            turned = complex(*place) * turn
            return turned.real, turned.imag

        levels = [
            evolve(
                level,
                rooms=(),
                room_names=(),
                walls=tuple([Wall(at(one.start), at(one.end)) for one in level.walls[k // 2 :]]),
                doors=tuple([Door(at(one.start), at(one.end), one.name) for one in level.doors[k % 3 :]]),
            )
            for level in house.levels
        ]
        yield from asked(evolve(house, levels=tuple(levels), connectors=house.connectors[k % 2 :]), 23)
    yield from asked(office(), 23)


MORE_PLACES: tuple[Case, ...] = (
    *[Case(f"pedestrians from {k} on", partial(told, range(k, k + 5))) for k in (0, 5)],
    Case("pedestrians, the Snake game", partial(told, range(36, 40), PrintedSnake)),
    *[Case(f"floor plans of {kind}", partial(read, kind)) for kind in ("osm", "imdf", "geojson")],
    Case("stairs on a clock set back", stairs_again),
    Case("a person who hesitates on the stairs", hesitating),
    Case("a wrong place twice", reported_again),
    Case("damaged floor plans", damaged),
    Case("the limits of floor plans", limits),
    Case("stairs and lifts by name", landmarks),
    Case("floor plans without rooms", without_rooms),
)
