"""A small office of two floors, and a pedestrian who walks to given places and emits events and positions.

The errors of the track are those of recorded tracks: 2 % of every length, 5 degrees a minute, 3 % of every stride. Its
heading in the plan is unknown.
"""

from __future__ import annotations

from functools import cache
from math import cos, hypot, pi, radians, sin
from random import Random

from attrs import define, field
from views import told

from solepath import (
    Activity,
    ActivityChanged,
    Event,
    Flaw,
    FlightClimbed,
    Foot,
    LiftRidden,
    Placed,
    PlaceLost,
    StrideFeatures,
    StrideTaken,
    Vec3,
)
from solepath.body.part import Position, StartGiven
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    FloorPlan,
    Level,
    Point,
    Start,
    Wall,
)
from solepath.place.placing import Particles

STOREY = 3.6
WIDE, DEEP = 40.0, 30.0
"""Width (x) and depth (y) of the office, m: a ring corridor, rooms outside it, and stairs and elevators inside it."""
LEFT, RIGHT, LOW, HIGH = 6.2, 33.8, 6.2, 23.8
"""Coordinates of the middle of the corridor, m; the corridor is 2.4 m wide."""
LIFTS: dict[str, Point] = {"lift west": (8.2, 18.0), "lift south": (14.0, 8.2), "lift east": (31.8, 12.0)}
STAIRS: dict[str, Point] = {"stairs north": (25.0, 21.8), "stairs south": (26.0, 8.2)}
CABINS = {
    "lift west": (7.4, 16.8, 9.4, 19.2),
    "lift south": (12.8, 7.4, 15.2, 9.4),
    "lift east": (30.6, 10.8, 32.6, 13.2),
}
WELLS = {"stairs north": (23.5, 17.0, 26.5, 22.6), "stairs south": (24.5, 7.4, 27.5, 13.0)}


def wall(walls: list[Wall], start: Point, end: Point, *gaps: tuple[float, float]) -> None:
    """Add a wall with gaps (start, end), distances along it, m."""
    length = hypot(end[0] - start[0], end[1] - start[1])
    ux, uy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    s = 0.0
    for a, b in [*sorted(gaps), (length, length)]:
        if a > s:
            walls.append(Wall((start[0] + ux * s, start[1] + uy * s), (start[0] + ux * a, start[1] + uy * a)))
        s = b


def _walls(exit_door: bool) -> tuple[Wall, ...]:
    walls: list[Wall] = []
    west, east, south, north = LEFT - 1.2, RIGHT + 1.2, LOW - 1.2, HIGH + 1.2
    wall(walls, (0.0, 0.0), (WIDE, 0.0))
    wall(walls, (WIDE, 0.0), (WIDE, DEEP), *([(LOW - 0.6, LOW + 0.6)] if exit_door else []))
    wall(walls, (WIDE, DEEP), (0.0, DEEP))
    wall(walls, (0.0, DEEP), (0.0, 0.0))
    doors = [(1.5 + 5.0 * k, 2.5 + 5.0 * k) for k in range(6)]
    wall(walls, (west, south), (east, south), *doors)
    wall(walls, (west, north), (east, north), *doors)
    wall(walls, (west, south), (west, north), *doors[:4])
    wall(walls, (east, south), (east, north), (0.6, 1.8), *doors[1:4])
    for k in range(1, 7):
        wall(walls, (west + 5.0 * k - 1.0, 0.0), (west + 5.0 * k - 1.0, south))
        wall(walls, (west + 5.0 * k - 1.0, north), (west + 5.0 * k - 1.0, DEEP))
    for k in range(1, 4):
        wall(walls, (0.0, south + 5.0 * k), (west, south + 5.0 * k))
        wall(walls, (east, south + 5.0 * k), (WIDE, south + 5.0 * k))
    west, east, south, north = LEFT + 1.2, RIGHT - 1.2, LOW + 1.2, HIGH - 1.2
    wall(walls, (west, south), (east, south), (6.0, 7.2), (17.5, 19.7))
    wall(walls, (west, north), (east, north), (16.5, 18.7))
    wall(walls, (west, south), (west, north), (10.0, 11.2))
    wall(walls, (east, south), (east, north), (4.0, 5.2))
    for x0, y0, x1, y1 in (*CABINS.values(), *WELLS.values()):
        for start, end in (((x0, y0), (x0, y1)), ((x1, y0), (x1, y1)), ((x0, y0), (x1, y0)), ((x0, y1), (x1, y1))):
            on_side = abs(start[0] - end[0]) < 0.01 and min(abs(start[0] - west), abs(start[0] - east)) < 0.01
            on_end = abs(start[1] - end[1]) < 0.01 and min(abs(start[1] - south), abs(start[1] - north)) < 0.01
            if not on_side and not on_end:
                wall(walls, start, end)
    # the rest of the block: rooms that nobody enters
    wall(walls, (west + 10.0, south), (west + 10.0, north))
    return tuple(walls)


def office(anchor: Anchor | None = None) -> FloorPlan:
    levels = tuple(
        Level(name, f"floor {name}", k, STOREY * k, _walls(exit_door=k == 0)) for k, name in enumerate(("0", "1"))
    )
    connectors = []
    for kind, places, outlines in ((ConnectorKind.LIFT, LIFTS, CABINS), (ConnectorKind.STAIRS, STAIRS, WELLS)):
        for name, place in places.items():
            x0, y0, x1, y1 = outlines[name]
            ring = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
            stops = tuple(ConnectorStop(level.id, place, ring) for level in levels)
            connectors.append(Connector(kind, name, stops, 2 if kind is ConnectorKind.STAIRS else None))
    return FloorPlan("office", levels, tuple(connectors), anchor)


@cache
def indexed_office() -> IndexedPlan:
    return IndexedPlan(office())


METHODS = (Particles,)
Method = Particles
"""A part that estimates the place of a wearer on a plan."""


@define
class FloorEvents:
    """Simultaneous events of a wearer, and the true level and place, m (None if they are not compared)."""

    events: list[Event]
    here: Position
    level: str | None = None
    place: Point | None = None


@define
class Pedestrian:
    """A pedestrian who walks, rides and climbs; `received` holds the resulting events."""

    seed: int
    level: str = "0"
    place: Point = (0.0, 0.0)
    stride: float = 0.62
    received: list[FloorEvents] = field(factory=list)
    t: float = 0.0
    track: Vec3 = (0.0, 0.0, 0.0)
    random: Random = field(init=False)
    scale: float = field(init=False)
    drift: float = field(init=False)
    turned: float = field(init=False)
    count: int = 0
    late: list[Event] = field(factory=list)
    """Events that are emitted after `wait` more calls of `step`."""
    wait: int = 0

    def __attrs_post_init__(self) -> None:
        self.random = Random(self.seed)
        self.scale = 1.0 + 0.02 * self.random.choice([-1.0, 1.0])
        self.drift = radians(5.0) / 60.0 * self.random.choice([-1.0, 1.0])
        self.turned = self.random.uniform(-pi, pi)

    def known_to(self, part: Method) -> Pedestrian:
        """Set the place of the start and the heading of the track in the part."""
        told(part, StartGiven(Start(self.level, self.place, -self.turned)))
        return self

    def here(self) -> Position:
        return Position(self.t, self.track, (0.01, 0.0, 0.0, 0.01, 0.0, 0.01))

    def emit(self, *events: Event) -> None:
        self.received.append(FloorEvents(list(events), self.here()))

    def step(self, dx: float, dy: float, dz: float = 0.0, counts: bool = True, degraded: bool = False) -> None:
        """Move the wearer by (dx, dy, dz), m, plan frame, with one stride event."""
        self.t += 0.55
        self.turned += self.drift * 0.55
        noise = 0.03 * hypot(dx, dy)
        ex, ey = dx * self.scale + self.random.gauss(0.0, noise), dy * self.scale + self.random.gauss(0.0, noise)
        c, s = cos(self.turned), sin(self.turned)
        x, y, z = self.track
        self.track = (x + c * ex - s * ey, y + s * ex + c * ey, z + dz)
        self.place = (self.place[0] + dx, self.place[1] + dy)
        self.count += 1
        events: list[Event] = []
        if self.late:
            self.wait -= 1
            if self.wait <= 0:
                events, self.late = self.late, []
        foot, stride = (Foot.LEFT, Foot.RIGHT)[self.count % 2], 2.0 * hypot(ex, ey)
        events.append(stepped(self.t, foot, self.count, self.track, degraded, stride))
        counts_here = counts and not self.late
        self.received.append(
            FloorEvents(events, self.here(), self.level if counts_here else None, self.place if counts_here else None)
        )

    def walk(self, *ways: Point) -> None:
        for x1, y1 in ways:
            x0, y0 = self.place
            count = max(1, round(hypot(x1 - x0, y1 - y0) / self.stride))
            for k in range(1, count + 1):
                offset = (0.0, 0.0) if k == count else (self.random.gauss(0.0, 0.05), self.random.gauss(0.0, 0.05))
                x, y = x0 + (x1 - x0) * k / count + offset[0], y0 + (y1 - y0) * k / count + offset[1]
                self.step(x - self.place[0], y - self.place[1])

    def ride(self, level: str, height: float | None = None) -> None:
        """Ride to the other level; the event comes 1 s after the end of the ride."""
        up = level > self.level
        start = self.t + 3.0
        self.t += 12.0
        x, y, z = self.track
        self.track, self.level = (x, y, z + (STOREY if up else -STOREY)), level
        self.emit(LiftRidden(t=self.t - 1.0, known_at=self.t, t_start=start, up=up, height=height))

    def climb(self, level: str, name: str, flights: bool = True) -> None:
        """Climb ten treads, a landing and ten treads back; the activity and its end are reported four steps late."""
        up = level > self.level
        direction, rise = (1.0 if STAIRS[name][1] < 15.0 else -1.0), (STOREY if up else -STOREY) / 20.0
        t_start = self.t
        for k in range(20):
            if k == 4:
                self.emit(activity_changed(t_start, self.t, Activity.STAIRS_UP if up else Activity.STAIRS_DOWN))
            self.step(0.0, 0.28 * direction * (1.0 if k < 10 else -1.0), rise, counts=False)
            if flights and k in (9, 19):
                height = 10.0 * rise
                self.emit(
                    FlightClimbed(t=self.t, known_at=self.t, t_start=self.t - 5.0, up=up, steps=10, height=height)
                )
        self.level, self.late, self.wait = level, [activity_changed(self.t, self.t + 1.5, Activity.WALKING)], 3


def stepped(
    t: float, foot: Foot, number: int, position: Vec3, degraded: bool = False, stride: float = 1.2
) -> StrideTaken:
    return StrideTaken(
        t=t, known_at=t + 0.04, foot=foot, number=number, t_start=t - 1.0, t_end=t, displacement=(stride, 0.0, 0.0),
        position=position, length=stride, heading_change=0.0, height_change=0.0,
        covariance=(1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4), t_toe_off=t - 0.6, t_heel_strike=t - 0.1,
        flaws=(Flaw.GAP,) * degraded,
        features=StrideFeatures(0.1, 3.0, 1.0, None, (), None),
    )  # fmt: skip


def activity_changed(t: float, known_at: float, activity: Activity) -> ActivityChanged:
    return ActivityChanged(t=t, known_at=max(t, known_at), activity=activity, probability=None)


def follow(part: Method, received: list[FloorEvents], plan: IndexedPlan | None = None) -> list[Event]:
    """Return all events of the part."""
    return [event for step in received for event in part.follow(plan or indexed_office(), step.events, step.here)]


def placed(events: list[Event]) -> list[Placed]:
    return [event for event in events if isinstance(event, Placed)]


def lost(events: list[Event]) -> list[str]:
    """Return the reason of every PlaceLost."""
    return [event.what for event in events if isinstance(event, PlaceLost)]


CORNERS = ((LEFT, LOW), (RIGHT, LOW), (RIGHT, HIGH), (LEFT, HIGH))


def beside(place: Point) -> Point:
    """Return the place in the middle of the corridor in front of a landing, m."""
    x, y = place
    if x < 10.0 or x > 30.0:
        return (LEFT if x < 10.0 else RIGHT, y)
    return (x, LOW if y < 15.0 else HIGH)


def round_to(start: Point, end: Point, forwards: bool) -> list[Point]:
    """Return the places along the corridor from start to end, with the corners; counter-clockwise if `forwards`."""
    start_along, end_along = _along(start), _along(end)
    perimeter = 2.0 * (RIGHT - LEFT + HIGH - LOW)
    distance = (end_along - start_along) % perimeter if forwards else (start_along - end_along) % perimeter
    corners = [
        ((_along(c) - start_along) % perimeter if forwards else (start_along - _along(c)) % perimeter, c)
        for c in CORNERS
    ]
    return [start, *[corner for along, corner in sorted(corners) if 0.0 < along < distance], end]


def _along(place: Point) -> float:
    x, y = place
    if abs(y - LOW) < 0.01:
        return x - LEFT
    if abs(x - RIGHT) < 0.01:
        return RIGHT - LEFT + y - LOW
    if abs(y - HIGH) < 0.01:
        return RIGHT - LEFT + HIGH - LOW + RIGHT - x
    return 2.0 * (RIGHT - LEFT) + HIGH - LOW + HIGH - y


def tour(seed: int) -> Pedestrian:
    """Return a pedestrian who rode an elevator, walked to stairs, climbed and walked to an elevator, all at random."""
    random = Random(seed * 7919)
    lift, stairs, last = random.choice(sorted(LIFTS)), random.choice(sorted(STAIRS)), random.choice(sorted(LIFTS))
    pedestrian = Pedestrian(seed, "1", LIFTS[lift])
    pedestrian.ride("0", -STOREY if random.random() < 0.5 else None)
    pedestrian.walk(*round_to(beside(LIFTS[lift]), beside(STAIRS[stairs]), random.random() < 0.5), STAIRS[stairs])
    pedestrian.climb("1", stairs, flights=random.random() < 0.5)
    pedestrian.walk(*round_to(beside(STAIRS[stairs]), beside(LIFTS[last]), random.random() < 0.5), LIFTS[last])
    return pedestrian
