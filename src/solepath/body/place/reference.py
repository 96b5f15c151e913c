"""References to a floor plan: what the wearer does that can be done in few places only, on stairs and in lifts.

Out of activities, rides, flights and the track come three things (Liu et al. 2015, section IV.E): somebody may be on
stairs or in a lift (`Held`), was not after all (`Released`), or has come to another level (`Arrived`). Half a storey is
a landing, and a window or two of stairs on level ground are a mistake: neither is an arrival.

Latency: a lift's ride with the event that tells it, or two steps or 4 s after an activity which no such event follows;
stairs with the activity that follows them, or up to `WAIT` s or `AWAY` m later when the height fits no storey.
"""

from __future__ import annotations

from collections import deque
from math import hypot, isfinite

from attrs import define, field, frozen

from ...events import ActivityChanged, Event, FlightClimbed, LiftRidden, StepTaken
from ...floorplan.plan import FloorPlan, Kind
from ...types import Activity, Foot, Vec3
from ..position import Position

RISE = 0.165
"""Of one step of a stair, m, where neither track nor plan tells a height."""
WAIT = 8.0
"""s"""
AWAY = 3.5
"""m"""
FIT = 0.24
"""A height fits a storey when it is off by no more than this share of the least storey: a landing half-way does not."""
COUNTED = 0.95
"""Share of the least storey from which on counted steps are taken for one at once."""
LEAST, MOST = 0.6, 2.0
"""Less than this share of the least storey is no arrival, nor more than this one of the highest way up."""
STEEP, LANDING = 2.5, 4.0
"""Stairs lead no further away than so many times their height, and so many m of landings."""
BLIP = 5
"""So many strides up or down are forgotten when the next go the other way."""
RIDE_OVER = 4.0
"""A ride that no event tells is over so long after the activity, s, or with the second step."""
SAME_RIDE = 5.0
"""Rides that end within this of each other are one, told twice, s."""
TRACK = 24
"""Places of the track that are kept."""

UPWARDS = {
    Activity.STAIRS_UP: (Kind.STAIRS, True),
    Activity.STAIRS_DOWN: (Kind.STAIRS, False),
    Activity.ELEVATOR_UP: (Kind.LIFT, True),
    Activity.ELEVATOR_DOWN: (Kind.LIFT, False),
}
"""What an activity is a reference to, and whether it leads up."""


@frozen
class Held:
    """From `t` on, s, the wearer may be on stairs or in a lift."""

    kind: Kind
    t: float


@frozen
class Released:
    """It was none."""


@frozen
class Arrived:
    """At `t`, s, the wearer has left stairs or a lift on another level, having set out at `t_start`. `height`: m, None
    when it cannot be told."""

    kind: Kind
    up: bool
    height: float | None
    t_start: float
    t: float
    doubt: float = 0.0
    """Share of the strides that were told to lead the other way."""


Reference = Held | Released | Arrived


@define
class Passage:
    """Being on stairs or in a lift, as far as is known."""

    kind: Kind
    t: float
    begin: Vec3
    """Of the track, m."""
    up: int = 0
    """Strides (of stairs) or tellings (of lifts) that lead up, less those that lead down."""
    left: int = 0
    right: int = 0
    """Strides of each foot."""
    climbed: float = 0.0
    """Sum of the heights of flights, m."""
    t_left: float | None = None
    end: Vec3 | None = None
    since: int = 0
    """Strides since."""

    def height(self, here: Vec3) -> float | None:
        """By the track where that says anything, else by flights or by counting steps, m, not negative."""
        track = self._track(here)
        if self.kind is Kind.LIFT:
            return track if track > 1.0 else None
        return track if self.measured(here) else max(abs(self.climbed), self._counted)

    def measured(self, here: Vec3) -> bool:
        """Whether the track has a height."""
        track = self._track(here)
        return track > 0.5 * self._counted and track > 0.3

    def _track(self, here: Vec3) -> float:
        return abs((here if self.end is None else self.end)[2] - self.begin[2])

    @property
    def _counted(self) -> float:
        # a stride of a foot is two steps of the stair; of both feet each one is told by its own stride
        # those that were told to lead the other way may have led this way, or may not have been on stairs: half of them
        strides = 0.5 * (self.left + self.right + abs(self.up))
        return RISE * strides * (1.0 if self.left and self.right else 2.0)

    @property
    def doubt(self) -> float:
        """Share of the strides that lead the other way than most."""
        strides = self.left + self.right
        return 0.5 * (1.0 - abs(self.up) / strides) if self.kind is Kind.STAIRS and strides > abs(self.up) else 0.0

    def leads_away(self, here: Vec3) -> bool:
        """Further than stairs of that height do."""
        if self.kind is Kind.LIFT:
            return False
        end = here if self.end is None else self.end
        away = hypot(end[0] - self.begin[0], end[1] - self.begin[1])
        return away > STEEP * (self.height(end) or 0.0) + LANDING


@define
class References:
    """Follows what the wearer does, with the newest places of the track."""

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    passage: Passage | None = field(default=None, init=False)
    track: deque[tuple[float, float, float, float]] = field(factory=deque, init=False)
    """t in s and the place in m."""
    ridden: float | None = field(default=None, init=False)
    """When the last ride was over, s."""

    def forget(self) -> None:
        """Times begin anew."""
        self.passage = self.ridden = None
        self.track.clear()

    def at(self, t: float) -> Vec3:
        """Where the track was, m: between the two nearest places, or the nearest one that is kept."""
        after: tuple[float, float, float, float] | None = None
        for place in reversed(self.track):
            if place[0] <= t:
                if after is None or after[0] <= place[0]:
                    return place[1:]
                k = (t - place[0]) / (after[0] - place[0])
                (_, x, y, z), (_, x1, y1, z1) = place, after
                return (x + k * (x1 - x), y + k * (y1 - y), z + k * (z1 - z))
            after = place
        return (0.0, 0.0, 0.0) if after is None else after[1:]

    def after(self, t: float) -> list[Vec3]:
        """The track from `t` on: the place then, and those that are kept of later."""
        return [self.at(t), *(place[1:] for place in self.track if place[0] > t)]

    def hear(self, plan: FloorPlan, events: list[Event], here: Position) -> list[Reference]:
        """What `events` mean; the wearer is at `here` now."""
        x, y, z = here.position
        self.track.append((here.t, x, y, z))
        if len(self.track) > TRACK:
            self.track.popleft()
        told: list[Reference] = []
        for event in events:
            if isinstance(event, StepTaken):
                self._stepped(event.foot)
            elif isinstance(event, ActivityChanged):
                self._changed(event, told)
            elif isinstance(event, FlightClimbed):
                self._climbed(event, told)
            elif isinstance(event, LiftRidden):
                if self.ridden is None or event.t > self.ridden + SAME_RIDE:
                    height = None if event.height is None or not isfinite(event.height) else abs(event.height)
                    told.append(Arrived(Kind.LIFT, event.up, height, min(event.t_start, event.t), event.t))
                    self.ridden = event.t
                if self.passage is not None and self.passage.kind is Kind.LIFT:
                    self.passage = None
        if self.passage is not None:
            if self.passage.t_left is not None:
                self._settle(self.passage, self.passage.t_left, plan, here, told)
            elif self.passage.leads_away(here.position):
                self.passage = None
                told.append(Released())
        return told

    def _stepped(self, foot: Foot) -> None:
        passage = self.passage
        if passage is None:
            return
        reference = UPWARDS.get(self.activity)
        if passage.t_left is not None or reference is None:
            passage.since += 1
        elif passage.kind is Kind.STAIRS:
            passage.up += 1 if reference[1] else -1
            if foot is Foot.LEFT:
                passage.left += 1
            else:
                passage.right += 1

    def _changed(self, event: ActivityChanged, told: list[Reference]) -> None:
        self.activity = event.activity
        reference, passage = UPWARDS.get(event.activity), self.passage
        if reference is None:
            if passage is not None and passage.t_left is None:
                if event.t <= passage.t:
                    self.passage = None
                    told.append(Released())
                else:
                    passage.t_left, passage.end, passage.since = event.t, self.at(event.t), 0
            return
        kind, up = reference
        if kind is Kind.LIFT and self.ridden is not None and event.t < self.ridden:
            return
        turned = passage is not None and kind is Kind.STAIRS and 0 < (-passage.up if up else passage.up) <= BLIP
        if passage is not None and passage.kind is kind and not turned:
            passage.t_left = passage.end = None
        else:
            if passage is not None:
                told.append(Released())
            passage = self.passage = Passage(kind, event.t, self.at(event.t))
            told.append(Held(kind, event.t))
        if kind is Kind.LIFT:
            passage.up += 1 if up else -1

    def _climbed(self, event: FlightClimbed, told: list[Reference]) -> None:
        """A flight belongs to the stairs that one is on or has just left; without them, it is one's being there."""
        passage = self.passage
        if passage is not None and passage.kind is not Kind.STAIRS:
            return
        if passage is None:
            t = min(event.t_start, event.t)
            self.passage = passage = Passage(Kind.STAIRS, t, self.at(t), t_left=event.t, end=self.at(event.t))
            told.append(Held(Kind.STAIRS, t))
            passage.up = 1 if event.up else -1
        passage.climbed += event.height if abs(event.height) < 100.0 else 0.0
        if passage.t_left is not None and event.t > passage.t_left:
            passage.t_left, passage.end = event.t, self.at(event.t)

    def _settle(self, passage: Passage, left: float, plan: FloorPlan, here: Position, told: list[Reference]) -> None:
        """Stairs or a lift were left: for another level, for a landing, or they never were any."""
        up, height = passage.up > 0, passage.height(here.position)
        arrived = Arrived(passage.kind, up, height, passage.t, left, passage.doubt)
        waited = here.t - left
        if passage.kind is Kind.LIFT:
            if waited > RIDE_OVER or passage.since >= 2:
                self.passage = None
                self.ridden = left
                told.append(arrived)
            return
        storeys = rises(plan, Kind.STAIRS)
        if not storeys or height is None:
            self.passage = None
            told.append(Released())
            return
        least, end = storeys[0], passage.end or passage.begin
        real = LEAST * least <= height <= MOST * storeys[-1] and not passage.leads_away(end)
        fits = min([abs(height - storey) for storey in storeys]) <= FIT * least
        # counted steps are those of landings, too: a flight and a landing are not a storey
        fits = fits and (passage.measured(here.position) or height >= COUNTED * least)
        if waited > WAIT or hypot(here.position[0] - end[0], here.position[1] - end[1]) > AWAY or (real and fits):
            self.passage = None
            told.append(arrived if real else Released())


def rises(plan: FloorPlan, kind: Kind) -> list[float]:
    """Every difference of height, m, over which a connector of a kind leads, least first."""
    found = set()
    for connector in plan.connectors:
        if connector.kind is kind:
            floors = [plan.level(stop.level).elevation for stop in connector.stops]
            found |= {round(abs(b - a), 3) for i, a in enumerate(floors) for b in floors[i + 1 :]}
    return sorted(found - {0.0})
