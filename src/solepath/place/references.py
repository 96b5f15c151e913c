"""References to a floor plan: climbs and rides, which are possible only on its stairs and in its elevators.

Activities, rides, flights and the track give three kinds of references (Liu et al. 2015, section IV.E): the wearer may
be changing level on stairs or in an elevator (`LevelChangePossible`), was not (`LevelChangeCancelled`), or has come to
another level (`LevelReached`), with a certainty. A climb of half a storey leads to a half-way landing, and a short
report of stairs on level ground is a mistake; both have a low certainty or none.

Latency: an elevator ride is known with its event; if there is none, after two strides or `RIDE_END_TIME`. Stairs are
known with the next activity, or up to `MAX_WAIT` s or `WAIT_DISTANCE` m later when the height fits no storey."""

from __future__ import annotations

from collections import deque
from itertools import permutations
from math import dist, exp, fsum, inf, isfinite

from ..events import ActivityChanged, EscalatorRidden, Event, FlightClimbed, LiftRidden, StrideTaken, WearerMoved
from ..events.activity import Ride
from ..floorplan.index import IndexedPlan, Landing
from ..floorplan.plan import ConnectorKind, Point
from ..types import Activity, Floats, Foot, Vec3
from ..types.attrs import define, field, frozen, state, stateful
from ..types.vector import add, sub

# What the plan says about its stairs and elevators.

HEIGHT_ERROR = 0.35
"""Standard deviation of a reported height: constant part, m."""
HEIGHT_ERROR_SHARE = 0.12
"""Standard deviation of a reported height: part that grows with the height, m per m."""
MIN_STOREY_HEIGHT, MAX_STOREY_HEIGHT = 2.4, 5.0
"""Least and largest usual height of a storey, m."""
WRONG_FLIGHT, MIN_FLIGHTS_LIKELIHOOD = 0.2, 0.04
"""Likelihood of one flight too many or too few, as a landing of one stride hides it, and the least of any number
(assumed; of 50 emulated walks the number was right in 48 or more)."""
MIN_EXIT_LIKELIHOOD = 0.02
"""Least likelihood of an exit, as a share of that of the likeliest exit."""
RISER_HEIGHT = 0.165
"""Height of one riser of stairs, m, used when neither the track gives a height nor the plan its risers'."""
MAX_RISERS = 18
"""Largest number of risers of a flight, no unit (DIN 18065: after that there is a landing)."""


def rise_between(plan: IndexedPlan, one: Landing, other: Landing) -> tuple[float, float]:
    """Return the least and the largest height between two landings, m; equal when the plan has heights."""
    if plan.plan.heights_known:
        return (one.distance(other),) * 2
    storeys = max(abs(other.ordinal - one.ordinal), 1)
    return MIN_STOREY_HEIGHT * storeys, MAX_STOREY_HEIGHT * storeys


def find_exits(
    plan: IndexedPlan, entered: Landing, up: bool, height: float | None = None, flights: int | None = None
) -> list[tuple[Landing, float]]:
    """Return the exits after a climb of `height`, m (None: any), from the landing `entered`, with their likelihoods.

    When the plan has no heights, all usual heights of a storey are equally likely. If it has the number of flights of
    the stairs, the number that was climbed counts too, None if it is not known."""
    exits, usual = [], plan.plan.connectors[entered.connector].flights
    for landing in plan.landings:
        rise = landing.elevation - entered.elevation
        if landing.connector == entered.connector and (rise > 0.0 if up else rise < 0.0):
            low, high = rise_between(plan, entered, landing)
            misfit = 0.0 if height is None else max(low - height, height - high, 0.0)
            deviation = misfit / (HEIGHT_ERROR + HEIGHT_ERROR_SHARE * low)
            likelihood = exp(-0.5 * min(deviation * deviation, 1000.0))
            if usual is not None and flights is not None:
                wrong = abs(flights - usual * max(abs(landing.ordinal - entered.ordinal), 1))
                likelihood *= max(WRONG_FLIGHT**wrong, MIN_FLIGHTS_LIKELIHOOD)
            exits.append((landing, likelihood))
    most = max([likelihood for _, likelihood in exits], default=0.0)
    return [(landing, one / most) for landing, one in exits if one >= MIN_EXIT_LIKELIHOOD * most]


@frozen
class Storeys:
    """Storeys of a plan by its stairs from the levels on which the wearer may be."""

    least: float
    """Least climb, m; 0 without stairs."""
    most: float
    """Largest climb, m."""
    rises: Floats
    """Every possible climb, m, the least first; empty when the plan has no heights."""
    flights: int
    """Least number of flights of a storey; 0 if the plan does not know it of every staircase."""


def storeys_of(plan: IndexedPlan, levels: frozenset[int], up: bool | None = None) -> Storeys:
    """Return what the plan says about its stairs from these levels, indices in the plan, or from all if there are none.

    With `up`, only stairs in this direction count. A wearer on a level without such stairs is on another one, so all
    levels and directions count."""
    stairs = [landing for landing in plan.landings if landing.kind is ConnectorKind.STAIRS]
    pairs = [
        (a, b)
        for a, b in permutations(stairs, 2)
        if a.connector == b.connector and (not levels or a.level in levels)
        if up is None or (b.elevation > a.elevation) is up
    ]
    if not pairs:
        return storeys_of(plan, frozenset()) if levels or up is not None else Storeys(0.0, 0.0, (), 0)
    flights = min([plan.plan.connectors[a.connector].flights or 0 for a, _ in pairs])
    if plan.plan.heights_known:
        rises = tuple(sorted({round(a.distance(b), 3) for a, b in pairs}))
        return Storeys(rises[0], rises[-1], rises, flights)
    return Storeys(MIN_STOREY_HEIGHT, max([rise_between(plan, a, b)[1] for a, b in pairs]), (), flights)


def riser_height(plan: IndexedPlan) -> float:
    """Return the height of a riser, m: the mean of the plan's stairs that have one, or the usual one."""
    known = [connector.rise for connector in plan.plan.connectors if connector.rise is not None]
    return fsum(known) / len(known) if known else RISER_HEIGHT


# A passage over stairs or by elevator: its times, height and direction, as far as they are known.

MAX_LENGTH_RATIO, LANDING_LENGTH = 2.5, 4.0
"""Largest horizontal length of stairs as a multiple of their height, and additional length for landings, m."""
MIN_TRACK_SHARE = 0.5
"""Least height by the track that is used on stairs, as a share of the height by counted risers."""
MIN_TRACK_HEIGHT, MIN_RIDE_HEIGHT = 0.3, 1.0
"""Least heights by the track that are used on stairs and after a ride, m."""
MAX_REST, MAX_LANDING_WIDTH = 120.0, 6.0
"""Longest rest on a half-way landing, s, and largest distance between the flights that meet there, m (assumed)."""
MAX_SPANS = 6
"""Largest number of spans that are kept; the oldest two become one, which later reports revise together."""


@define
class StairSpan:
    """The strides of stairs that were reported in one direction, or reports without strides."""

    t: float
    """Time from which the activity was reported, s."""
    net_up: int = 0
    """Number of strides, or of reports without strides, upwards minus the number downwards."""
    strides: int = 0


@define
class Passage:
    """A passage over stairs or by elevator."""

    kind: ConnectorKind
    t: float
    """Start of the passage, s."""
    start: Vec3
    """Position of the track at the start, m."""
    spans: list[StairSpan] = field(factory=list)
    """The stairs and flights that were reported of it, the oldest first."""
    foot: Foot | None = None
    """Foot of the newest stride on the stairs; None before any."""
    both_feet: bool = False
    """Flag: both feet have made strides on the stairs."""
    reported_height: float = 0.0
    """Sum of the heights of the flights, or the height of the ride, m, positive upwards; 0 if it is not known."""
    t_left: float | None = None
    """Time at which the wearer left the stairs or the elevator, s; None before."""
    end: Vec3 | None = None
    """Position of the track at `t_left`, m."""
    strides_since: int = 0
    """Number of strides since `t_left`."""
    riser: float = RISER_HEIGHT
    """Height of one riser of the stairs, m."""
    flights: int = 0
    """Number of flights upwards minus the number downwards."""
    height_before: float = 0.0
    """Height up to the half-way landing at which the passage starts, m, positive upwards; 0 from a level on."""
    decided_height: float | None = None
    """Height by which it was decided, m, not negative; None before, and when it is not known."""
    certainty: float = 0.0
    """Probability that the passage led to another level; 0 while that is not decided, and if it did not."""
    is_half_way: bool = False
    """Flag: the passage ended on a half-way landing, and none has continued it."""

    def contains(self, t_start: float, t: float) -> bool:
        """Return whether more than half of the time from `t_start` to `t`, s, is before the end of the passage."""
        return self.t_left is not None and 0.5 * (t_start + t) <= self.t_left

    def add_flight(self, event: FlightClimbed) -> None:
        """Add a flight."""
        self.reported_height += event.height if abs(event.height) < 100.0 else 0.0
        self.flights += 1 if event.up else -1

    def report(self, t: float, up: bool, revises: float | None) -> None:
        """Count further strides in the direction that is reported from `t`, s, on, and revise those reported before.

        The report replaces every one from `revises`, s, on (None: none), and is repeated whenever one before it is
        revised. So the direction is that of the whole stretch, whatever was reported of it at first."""
        since = t if revises is None else min(t, revises)
        for span in self.spans:
            if span.t >= since:
                span.net_up = span.strides if up else -span.strides
        self.spans = [*[span for span in self.spans if span.strides], StairSpan(t)]
        if len(self.spans) > MAX_SPANS:
            old, one = self.spans[:2]
            self.spans[:2] = [StairSpan(old.t, old.net_up + one.net_up, old.strides + one.strides)]

    def add_direction(self, up: bool, foot: Foot | None = None) -> None:
        """Add a stride of a foot to the newest report, or a report of the direction alone if there is no foot."""
        if not self.spans:
            self.spans.append(StairSpan(self.t))
        self.spans[-1].net_up += 1 if up else -1
        if foot is not None:
            self.spans[-1].strides += 1
            self.both_feet = self.both_feet or self.foot not in (None, foot)
            self.foot = foot

    def move(self, by: Point) -> None:
        """Move with the track by x and y, m."""
        self.start = add(self.start, (*by, 0.0))
        self.end = self.end and add(self.end, (*by, 0.0))

    @property
    def net_up(self) -> int:
        """Number of strides (stairs) or reports (elevator, lone flight) upwards minus the number downwards."""
        return sum([span.net_up for span in self.spans])  # whole numbers

    @property
    def strides(self) -> int:
        """Number of strides of both feet on the stairs."""
        return sum([span.strides for span in self.spans])  # whole numbers

    def _risers(self, strides: float) -> float:
        """Return the height of the risers of this number of strides, m."""
        # a stride of one foot climbs two risers; with both feet there is a stride for each riser
        return self.riser * strides * (1.0 if self.both_feet else 2.0)

    @property
    def _counted_height(self) -> float:
        # only strides in the direction of the majority count: the others may be wrong or not on stairs
        return self._risers(0.5 * (self.strides + abs(self.net_up)))

    @property
    def height_one_way(self) -> float:
        """Height, m, if all strides had the same direction, whatever direction was reported."""
        return abs(self.height_before) + self._risers(self.strides)

    def _rise(self, here: Vec3) -> float:
        """Return the height of the track above the start, m."""
        return (self.end or here)[2] - self.start[2]

    def height(self, here: Vec3) -> float | None:
        """Return the height, m, not negative, by the track or else by flights or counted risers; None when unknown."""
        if self.kind is ConnectorKind.STAIRS:
            return abs(self.height_signed(here))
        track = abs(self._rise(here))
        return track if track > MIN_RIDE_HEIGHT else None

    def height_signed(self, here: Vec3) -> float:
        """Return the height of stairs from the last level on, m, positive upwards."""
        is_measured, counted = self.is_measured(here), max(abs(self.reported_height), self._counted_height)
        own = abs(self._rise(here)) if is_measured else counted
        return self.height_before + (own if self.net_up > 0 else -own)

    def is_measured(self, here: Vec3) -> bool:
        """Return whether the height of the track can be used for stairs."""
        return abs(self._rise(here)) > max(MIN_TRACK_SHARE * self._counted_height, MIN_TRACK_HEIGHT)

    def measured_up(self, here: Vec3) -> bool | None:
        """Return whether stairs lead up by the track and by what was reported; None if one of them does not say so."""
        up = self._rise(here) > 0.0
        return up if self.is_measured(here) and up is (self.net_up > 0) else None

    def is_continued(self, t: float, start: Vec3) -> bool:
        """Return whether stairs that start at `t`, s, and `start`, m, continue this passage from a half-way landing."""
        if self.t_left is None or self.end is None or not 0.0 <= t - self.t_left <= MAX_REST:
            return False
        return _distance(start, self.end) <= MAX_LANDING_WIDTH

    @property
    def opposite_share(self) -> float:
        """Share of the strides whose reported direction differs from that of the majority."""
        strides, net_up = self.strides, abs(self.net_up)
        return 0.5 * (1.0 - net_up / strides) if self.kind is ConnectorKind.STAIRS and strides > net_up else 0.0

    def leads_away(self, here: Vec3) -> bool:
        """Return whether the passage is horizontally longer than stairs of its height can be."""
        end = self.end or here
        most = MAX_LENGTH_RATIO * (self.height(end) or 0.0) + LANDING_LENGTH
        return self.kind is ConnectorKind.STAIRS and _distance(end, self.start) > most


def _distance(one: Vec3, other: Vec3) -> float:
    """Return the horizontal distance, m."""
    return dist(one[:2], other[:2])


# References.

SURE_CERTAINTY, FAIR_CERTAINTY, HALF_CERTAINTY, RIDE_CERTAINTY = 0.97, 0.9, 0.1, 0.99
"""Certainties of an arrival: the height fits a storey; it is large enough; it is about half a storey; it is a ride."""
MAX_WAIT = 8.0
"""Longest wait for the end of stairs whose height fits no storey, s."""
WAIT_DISTANCE = 3.5
"""Distance of the wearer from the end of the stairs at which this wait ends, m."""
FIT_SHARE = 0.24
"""Largest deviation of a height that fits a storey, as a share of the least storey; half a storey does not fit."""
COUNTED_SHARE = 0.95
"""Least height by counted risers that counts as a storey without waiting, as a share of the least storey."""
MIN_STOREY_SHARE, MAX_CLIMB_RATIO = 0.6, 2.0
"""Least height of a storey, as a share of the plan's least, and largest climb, as a multiple of the plan's largest."""
KERB_SHARE = 0.35
"""Share of the least storey below which a height is a kerb.

Heights between this and `MIN_STOREY_SHARE` are half a storey, or a storey of which only half was detected."""
RIDE_END_TIME = 4.0
"""Time after the end of an elevator activity at which a ride without an event has ended, s; two strides also end it."""
MAX_TRACK_POSITIONS = 24
"""Number of positions of the track that are kept."""

CONNECTOR_OF_ACTIVITY = {
    Activity.STAIRS_UP: (ConnectorKind.STAIRS, True),
    Activity.STAIRS_DOWN: (ConnectorKind.STAIRS, False),
    Activity.ELEVATOR_UP: (ConnectorKind.LIFT, True),
    Activity.ELEVATOR_DOWN: (ConnectorKind.LIFT, False),
}
"""Kind of connector for each activity, and a flag: the activity leads up."""


@frozen
class LevelChangePossible:
    """The reference that the wearer may be on stairs or in an elevator from `t_start`, s, on."""

    kind: ConnectorKind
    t_start: float


@frozen
class LevelChangeCancelled:
    """The reference that a possible change of level did not happen."""


@frozen
class LevelReached:
    """The reference that the wearer left stairs or an elevator on another level at `t`, s."""

    kind: ConnectorKind
    up: bool
    height: float | None
    """Height of the climb, m, not negative; None when it is not known."""
    t_start: float
    """Time at which the stairs or the elevator were entered, s."""
    t: float
    certainty: float
    """Probability that the wearer is on another level now; less than 1."""
    opposite_share: float = 0.0
    """Share of the strides that were reported in the other direction."""
    flights: int | None = None
    """Number of flights that were climbed; None when none was reported."""
    is_revision: bool = False
    """Flag: it is the newest arrival again, of which more is known now."""


Reference = LevelChangePossible | LevelChangeCancelled | LevelReached


@stateful
class References:
    """Derives references from the wearer's activities and the newest positions of the track."""

    activity: Activity = Activity.UNKNOWN
    passage: Passage | None = None
    """Passage under way, or left and not decided; None otherwise."""
    track: deque[tuple[float, Vec3]] = state(factory=deque)
    """Newest positions of the track: t, s, and position, m."""
    newest: Passage | None = None
    """Newest passage that was decided: it led to another level, or to a half-way landing; None before any.

    What is reported of its time afterwards belongs to it, and begins no other passage."""

    def reset(self) -> None:
        """Discard the passages and the track, because the clock restarts."""
        self.passage = self.newest = None
        self.track.clear()

    def position_at(self, t: float) -> Vec3:
        """Return the position of the track at `t`, s, in m, by interpolation, or the nearest position that is kept."""
        t1, after = inf, (0.0, 0.0, 0.0)
        for t0, before in reversed(self.track):
            if t0 <= t:
                return add(before, sub(after, before), (t - t0) / (t1 - t0)) if t0 < t1 < inf else before
            t1, after = t0, before
        return after

    def move(self, by: Point) -> None:
        """Move all positions that are kept by x and y, m, because the track was revised."""
        self.track = deque([(t, add(position, (*by, 0.0))) for t, position in self.track])
        for passage in (self.passage, self.newest):
            if passage is not None:
                passage.move(by)

    def reach_back_to(self, t: float) -> bool:
        """Return whether no position since `t`, s, was discarded."""
        return len(self.track) < MAX_TRACK_POSITIONS or self.track[0][0] <= t

    def path_since(self, t: float) -> list[Vec3]:
        """Return the position of the track at `t`, s, and all later positions that are kept, m."""
        return [self.position_at(t), *(position for t_then, position in self.track if t_then > t)]

    def update(
        self, plan: IndexedPlan, events: list[Event], here: WearerMoved, levels: frozenset[int] = frozenset()
    ) -> list[Reference]:
        """Return the references that follow from `events`; the wearer is at `here` now.

        `levels` are those on which the wearer may be, as indices in the plan; none if that is not known."""
        x, y, z = here.position
        self.track.append((here.t, (round(x, 3), round(y, 3), round(z, 3))))
        if len(self.track) > MAX_TRACK_POSITIONS:
            self.track.popleft()
        references: list[Reference] = []
        last = [event for event in events if isinstance(event, ActivityChanged)][-1:]
        for event in events:
            match event:
                case StrideTaken():
                    self._add_stride(event.foot)
                case ActivityChanged():
                    references += self._change_activity(plan, event, levels, here, event in last)
                case FlightClimbed():
                    references += self._add_flight(plan, event)
                case LiftRidden() | EscalatorRidden():
                    references += self._add_ride(event)
        passage = self.passage
        if passage is not None and passage.t_left is not None:
            references += self._decide(passage, plan, levels, here, here.t - passage.t_left)
        elif passage is not None and passage.leads_away(here.position):
            references += self._cancel()
        return references

    def _cancel(self) -> list[Reference]:
        """Forget the passage, which was none."""
        self.passage = None
        return [LevelChangeCancelled()]

    def _newest_of(self, kind: ConnectorKind, t_start: float, t: float) -> Passage | None:
        """Return the newest passage if it is of this kind and what is reported from `t_start` to `t`, s, belongs to it.

        This is the one rule by which evidence that comes late is not counted twice."""
        newest = self.newest
        return newest if newest is not None and newest.kind is kind and newest.contains(t_start, t) else None

    def _reached(self, passage: Passage, is_revision: bool = False) -> list[Reference]:
        """Return the arrival by a passage that is decided, as far as it led to another level."""
        t_left, opposite = passage.t_left, passage.opposite_share
        if t_left is None or not passage.certainty:
            return []
        height, certainty = passage.decided_height, passage.certainty * (1.0 - opposite)
        up, flights = passage.net_up > 0, abs(passage.flights) or None
        return [LevelReached(passage.kind, up, height, passage.t, t_left, certainty, opposite, flights, is_revision)]

    def _add_stride(self, foot: Foot) -> None:
        passage, connector = self.passage, CONNECTOR_OF_ACTIVITY.get(self.activity)
        if passage is None:
            return
        if passage.t_left is not None or connector is None:
            passage.strides_since += 1
        elif passage.kind is ConnectorKind.STAIRS:
            passage.add_direction(connector[1], foot)

    def _add_ride(self, event: Ride) -> list[Reference]:
        """Add a ride to the newest passage, of which it may tell the height; otherwise it is a passage."""
        kind = ConnectorKind.LIFT if isinstance(event, LiftRidden) else ConnectorKind.STAIRS
        if self.passage is not None and self.passage.kind is kind:
            self.passage = None
        t_start = min(event.t_start, event.t)
        ridden = self._newest_of(kind, t_start, event.t)
        passage = ridden or Passage(kind, t_start, self.position_at(t_start), certainty=RIDE_CERTAINTY)
        if passage.reported_height:
            return []
        passage.spans = [StairSpan(t_start, 1 if event.up else -1)]
        known = event.height is not None and isfinite(event.height)
        passage.reported_height = abs(event.height or 0.0) if known else 0.0
        passage.decided_height = passage.reported_height or passage.decided_height
        self.newest = passage
        if ridden is None:
            passage.t_left, passage.end = event.t, passage.start
        return self._reached(passage, ridden is not None)

    def _change_activity(
        self, plan: IndexedPlan, event: ActivityChanged, levels: frozenset[int], here: WearerMoved, is_last: bool
    ) -> list[Reference]:
        """Follow a report of an activity; `is_last` says that none after it is known yet."""
        self.activity = event.activity
        connector, passage = CONNECTOR_OF_ACTIVITY.get(event.activity), self.passage
        if connector is None:
            if passage is not None and passage.t_left is None:
                if event.t <= passage.t:
                    return self._cancel()
                passage.t_left, passage.end, passage.strides_since = event.t, self.position_at(event.t), 0
            return []
        kind, up = connector
        t, references = event.t, list[Reference]()
        newest = None if passage is not None else self._newest_of(kind, t, t)
        if newest is not None and kind is ConnectorKind.LIFT:
            return []
        if newest is not None and newest.t_left is not None:
            was_up = newest.net_up > 0
            newest.report(t, up, event.revises)
            references += self._reached(newest, True) if (newest.net_up > 0) is not was_up else []
            if not is_last:
                return references
            t = newest.t_left  # the stairs go on
        if passage is not None and passage.kind is kind:
            passage.t_left = passage.end = None
        else:
            if passage is not None:  # another one begins: the wait is over
                is_over = passage.t_left is not None and passage.t_left <= t
                references += self._decide(passage, plan, levels, here, inf) if is_over else self._cancel()
            passage = self._enter(plan, kind, t, references)
        if kind is ConnectorKind.LIFT:
            passage.add_direction(up)
        else:
            passage.report(t, up, event.revises)
        return references

    def _add_flight(self, plan: IndexedPlan, event: FlightClimbed) -> list[Reference]:
        """Add a flight to the passage over stairs that it belongs to; without one, the flight starts a passage."""
        passage, references, t_start = self.passage, list[Reference](), min(event.t_start, event.t)
        newest = self._newest_of(ConnectorKind.STAIRS, t_start, event.t)
        if newest is not None and not (passage is not None and passage.height_before):
            newest.add_flight(event)
            return self._reached(newest, True)
        if passage is None:
            passage = self._enter(plan, ConnectorKind.STAIRS, t_start, references)
            passage.t_left = -inf
            passage.add_direction(event.up)
        elif passage.kind is ConnectorKind.LIFT:
            return []
        passage.add_flight(event)
        if passage.t_left is not None and event.t > passage.t_left:
            passage.t_left, passage.end = event.t, self.position_at(event.t)
        return references

    def _enter(self, plan: IndexedPlan, kind: ConnectorKind, t: float, references: list[Reference]) -> Passage:
        """Begin a passage at `t`, s; from a half-way landing it continues the one that ended there."""
        references.append(LevelChangePossible(kind, t))
        start, newest = self.position_at(t), self.newest
        passage = self.passage = Passage(kind, t, start, riser=riser_height(plan))
        if newest is not None:
            if newest.is_half_way and kind is ConnectorKind.STAIRS and newest.is_continued(t, start):
                passage.height_before, passage.flights = newest.height_signed(start), newest.flights
            newest.is_half_way = False
        return passage

    def _decide(
        self, passage: Passage, plan: IndexedPlan, levels: frozenset[int], here: WearerMoved, waiting_time: float
    ) -> list[Reference]:
        """Decide whether a passage that was left led to another level, when that is certain or the wait is over."""
        height = passage.height(here.position)
        if passage.kind is ConnectorKind.LIFT:
            if waiting_time <= RIDE_END_TIME and passage.strides_since < 2:
                return []
            self.passage, self.newest = None, passage
            passage.decided_height, passage.certainty = height, RIDE_CERTAINTY
            return self._reached(passage)
        # only the height of the track shows the direction beyond doubt
        storeys = storeys_of(plan, levels, passage.measured_up(here.position))
        least, rises = storeys.least, storeys.rises
        if height is None or not storeys.most > 0.0:
            return self._cancel()
        end, measured = passage.end or passage.start, passage.is_measured(here.position)
        if not measured and height < MIN_STOREY_SHARE * least <= passage.height_one_way:
            height = passage.height_one_way  # half of the directions are wrong, or the wearer went up and down again
        fits = min([abs(height - rise) for rise in rises], default=inf) <= FIT_SHARE * least
        flights = abs(passage.flights)
        # a higher one is two flights, taken for one
        is_partial = not fits and 0 < flights < storeys.flights and height <= flights * MAX_RISERS * passage.riser
        is_storey = height >= MIN_STOREY_SHARE * least and not is_partial
        leads_away = passage.leads_away(end)
        is_possible = KERB_SHARE * least <= height <= MAX_CLIMB_RATIO * storeys.most and not leads_away
        # counted risers include steps on landings, so a flight and a landing must not count as a storey
        is_settled = is_storey and is_possible and fits and (measured or height >= COUNTED_SHARE * least)
        if not (is_settled or waiting_time > MAX_WAIT or _distance(here.position, end) > WAIT_DISTANCE):
            return []
        passage.is_half_way = (is_possible or (flights > 0 and not leads_away)) and not is_storey
        if is_possible or passage.is_half_way:
            self.newest = passage
        if not is_possible:
            return self._cancel()
        self.passage, passage.decided_height = None, height
        passage.certainty = HALF_CERTAINTY if not is_storey else SURE_CERTAINTY if fits or not rises else FAIR_CERTAINTY
        return self._reached(passage)
