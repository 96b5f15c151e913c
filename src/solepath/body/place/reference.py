"""References to a floor plan: what the wearer does that can be done in few places only, on stairs and in lifts.

Out of activities, rides, flights and the track come three things (Liu et al. 2015, section IV.E): somebody may be on
stairs or in a lift (`Held`), was not after all (`Released`), or has come to another level (`Arrived`), which is more or
less sure. Half a storey is a landing, and a window or two of stairs on level ground are a mistake: neither is likely to
be an arrival.

Latency: a lift's ride with the event that tells it, or two steps or 4 s after an activity which no such event follows;
stairs with the activity that follows them, or up to `WAIT` s or `AWAY` m later when the height fits no storey.
"""

from __future__ import annotations

from collections import deque
from math import hypot, isfinite

from ...events import ActivityChanged, Event, FlightClimbed, LiftRidden, StrideTaken, WearerMoved
from ...floorplan.plan import ConnectorKind, FloorPlan
from ...types import Activity, Foot, Vec3
from ...types.attrs import define, field, frozen
from .landings import HIGH, LOW
from .passage import Passage

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
SOME = 0.35
"""Less than this share is a kerb. What is between is half a storey, or a whole one of which half was told."""
SURE, FAIR, HALF, SURE_RIDE = 0.97, 0.9, 0.1, 0.99
"""How sure an arrival is: when the height fits a storey, when it does not quite, when it is half of one, and a ride."""
RIDE_OVER = 4.0
"""A ride that no event tells is over so long after the activity, s, or with the second step."""
SAME_RIDE = 5.0
"""Rides that end within this of each other are one, told twice, s."""
TRACK = 24
"""Places of the track that are kept."""

UPWARDS = {
    Activity.STAIRS_UP: (ConnectorKind.STAIRS, True),
    Activity.STAIRS_DOWN: (ConnectorKind.STAIRS, False),
    Activity.ELEVATOR_UP: (ConnectorKind.LIFT, True),
    Activity.ELEVATOR_DOWN: (ConnectorKind.LIFT, False),
}
"""What an activity is a reference to, and whether it leads up."""


@frozen
class Held:
    """From `t` on, s, the wearer may be on stairs or in a lift."""

    kind: ConnectorKind
    t: float


@frozen
class Released:
    """It was none."""


@frozen
class Arrived:
    """At `t`, s, the wearer has left stairs or a lift on another level, having set out at `t_start`. `height`: m, None
    when it cannot be told."""

    kind: ConnectorKind
    up: bool
    height: float | None
    t_start: float
    t: float
    doubt: float = 0.0
    """Share of the strides that were told to lead the other way."""
    sure: float = 0.97
    """How likely it is that there were stairs or a lift at all, and that they led to another level; less than 1."""


Reference = Held | Released | Arrived


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

    def hear(self, plan: FloorPlan, events: list[Event], here: WearerMoved) -> list[Reference]:
        """What `events` mean; the wearer is at `here` now."""
        x, y, z = here.position
        self.track.append((here.t, round(x, 3), round(y, 3), round(z, 3)))
        if len(self.track) > TRACK:
            self.track.popleft()
        told: list[Reference] = []
        for event in events:
            if isinstance(event, StrideTaken):
                self._stepped(event.foot)
            elif isinstance(event, ActivityChanged):
                self._changed(event, told)
            elif isinstance(event, FlightClimbed):
                self._climbed(event, told)
            elif isinstance(event, LiftRidden):
                if self.ridden is None or event.t > self.ridden + SAME_RIDE:
                    height = None if event.height is None or not isfinite(event.height) else abs(event.height)
                    t_start = min(event.t_start, event.t)
                    told.append(Arrived(ConnectorKind.LIFT, event.up, height, t_start, event.t, sure=SURE_RIDE))
                    self.ridden = event.t
                if self.passage is not None and self.passage.kind is ConnectorKind.LIFT:
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
        elif passage.kind is ConnectorKind.STAIRS:
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
        if kind is ConnectorKind.LIFT and self.ridden is not None and event.t < self.ridden:
            return
        if passage is not None and passage.kind is kind:
            passage.t_left = passage.end = None
        else:
            if passage is not None:
                told.append(Released())
            passage = self.passage = Passage(kind, event.t, self.at(event.t))
            told.append(Held(kind, event.t))
        if kind is ConnectorKind.LIFT:
            passage.up += 1 if up else -1

    def _climbed(self, event: FlightClimbed, told: list[Reference]) -> None:
        """A flight belongs to the stairs that one is on or has just left; without them, it is one's being there."""
        passage = self.passage
        if passage is not None and passage.kind is not ConnectorKind.STAIRS:
            return
        if passage is None:
            t = min(event.t_start, event.t)
            self.passage = passage = Passage(ConnectorKind.STAIRS, t, self.at(t), t_left=event.t, end=self.at(event.t))
            told.append(Held(ConnectorKind.STAIRS, t))
            passage.up = 1 if event.up else -1
        passage.climbed += event.height if abs(event.height) < 100.0 else 0.0
        if passage.t_left is not None and event.t > passage.t_left:
            passage.t_left, passage.end = event.t, self.at(event.t)

    def _settle(self, passage: Passage, left: float, plan: FloorPlan, here: WearerMoved, told: list[Reference]) -> None:
        """Stairs or a lift were left: for another level, for a landing, or they never were any."""
        up, height = passage.up > 0, passage.height(here.position)
        waited = here.t - left
        if passage.kind is ConnectorKind.LIFT:
            if waited > RIDE_OVER or passage.since >= 2:
                self.passage = None
                self.ridden = left
                told.append(Arrived(passage.kind, up, height, passage.t, left, sure=SURE_RIDE))
            return
        least, most = storeys(plan)
        if height is None or not most > 0.0:
            self.passage = None
            told.append(Released())
            return
        end, measured = passage.end or passage.begin, passage.measured(here.position)
        if not measured and height < LEAST * least <= passage.told_both_ways:
            height = passage.told_both_ways  # half of them told wrong, or up and down again
        real = height >= LEAST * least
        possible = SOME * least <= height <= MOST * most and not passage.leads_away(end)
        fits = (
            plan.heights_known
            and min([abs(height - rise) for rise in rises(plan, ConnectorKind.STAIRS)]) <= FIT * least
        )
        # counted steps are those of landings, too: a flight and a landing are not a storey
        soon = real and possible and fits and (measured or height >= COUNTED * least)
        if waited > WAIT or hypot(here.position[0] - end[0], here.position[1] - end[1]) > AWAY or soon:
            self.passage = None
            good = fits or (real and not plan.heights_known)
            sure = (SURE if good else FAIR if real else HALF) * (1.0 - passage.doubt)
            arrived = Arrived(passage.kind, up, height, passage.t, left, passage.doubt, sure)
            told.append(arrived if possible else Released())


def storeys(plan: FloorPlan) -> tuple[float, float]:
    """The least and the greatest height, m, that stairs of the plan may lead to; 0 where there are none."""
    found = rises(plan, ConnectorKind.STAIRS)
    if not found:
        return (0.0, 0.0)
    if plan.heights_known:
        return (found[0], found[-1])
    ordinals = [level.ordinal for level in plan.levels]
    return (LOW, HIGH * max(max(ordinals) - min(ordinals), 1))


def rises(plan: FloorPlan, kind: ConnectorKind) -> list[float]:
    """Every difference of height, m, over which a connector of a kind leads, least first."""
    found = set()
    for connector in plan.connectors:
        if connector.kind is kind:
            floors = [plan.level(stop.level).elevation for stop in connector.stops]
            found |= {round(abs(b - a), 3) for i, a in enumerate(floors) for b in floors[i + 1 :]}
    return sorted(found - {0.0})
