"""References to a floor plan: activities that are possible in few places only, on stairs and in lifts.

Activities, rides, flights and the track give three references (Liu et al. 2015, section IV.E): the wearer may be on
stairs or in a lift (`Held`), was not after all (`Released`), or has come to another level (`Arrived`), with a
certainty. Half a storey is a landing, and a window or two of stairs on level ground are a mistake: neither is likely to
be an arrival.

Latency: a lift's ride with its event, or two strides or 4 s after an activity without such an event; stairs with the
activity that follows them, or up to `LONGEST_WAIT` s or `WAIT_DISTANCE` m later when the height fits no storey."""

from __future__ import annotations

from collections import deque
from math import hypot, isfinite

from ...events import ActivityChanged, Event, FlightClimbed, LiftRidden, StrideTaken, WearerMoved
from ...floorplan.plan import ConnectorKind, FloorPlan
from ...types import Activity, Foot, Vec3
from ...types.attrs import define, field, frozen
from .landings import HIGH, LOW
from .passage import Passage

LONGEST_WAIT = 8.0
"""Longest wait for the end of stairs whose height fits no storey, s."""
WAIT_DISTANCE = 3.5
"""Distance that ends this wait, m."""
FIT_SHARE = 0.24
"""Largest deviation of a height that fits a storey, as a share of the least storey: a half-way landing does not fit."""
COUNTED_SHARE = 0.95
"""Share of the least storey from which on counted steps are taken for a storey at once."""
LEAST_STOREY, LARGEST_CLIMB = 0.6, 2.0
"""Least height of an arrival as a share of the least storey, and its largest as a multiple of the highest way up."""
KERB_SHARE = 0.35
"""Share of the least storey below which a height is a kerb.

Heights between this and `LEAST_STOREY` are half a storey, or a whole one of which half was detected."""
SURE, FAIR, HALF, SURE_RIDE = 0.97, 0.9, 0.1, 0.99
"""Certainty of an arrival: the height fits a storey, nearly fits one, is half of one; and that of a ride."""
RIDE_OVER = 4.0
"""Time after the activity at which a ride without an event is over, s; the second stride also ends it."""
SAME_RIDE = 5.0
"""Largest time between the ends of two reports of the same ride, s."""
TRACK_PLACES = 24
"""Number of places of the track that are kept."""

REFERENCES = {
    Activity.STAIRS_UP: (ConnectorKind.STAIRS, True),
    Activity.STAIRS_DOWN: (ConnectorKind.STAIRS, False),
    Activity.ELEVATOR_UP: (ConnectorKind.LIFT, True),
    Activity.ELEVATOR_DOWN: (ConnectorKind.LIFT, False),
}
"""Connector of each activity, and whether the activity leads up."""


@frozen
class Held:
    """Reference: from `t` s on the wearer may be on stairs or in a lift."""

    kind: ConnectorKind
    t: float


@frozen
class Released:
    """Reference: the wearer was not on stairs or in a lift after all."""


@frozen
class Arrived:
    """Reference: at `t` s the wearer left stairs or a lift, entered at `t_start`, on another level.

    `height`: m, None when it is not known."""

    kind: ConnectorKind
    up: bool
    height: float | None
    t_start: float
    t: float
    opposite_share: float = 0.0
    """Share of the strides that were reported in the other direction."""
    sure: float = 0.97
    """Probability that there were stairs or a lift and that they led to another level; less than 1."""


Reference = Held | Released | Arrived


@define
class References:
    """Derives references from the wearer's activities and the newest places of the track."""

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    passage: Passage | None = field(default=None, init=False)
    track: deque[tuple[float, float, float, float]] = field(factory=deque, init=False)
    """Newest places of the track: t in s, and x, y, z in m."""
    ridden: float | None = field(default=None, init=False)
    """End of the last ride, s."""

    def reset(self) -> None:
        """Discard the passage, the last ride and the track: times restart."""
        self.passage = self.ridden = None
        self.track.clear()

    def at(self, t: float) -> Vec3:
        """Return the place of the track at `t` s, m: between the two nearest places, or the nearest that is kept."""
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
        """Return the track from `t` s on: the place then, and the later ones that are kept."""
        return [self.at(t), *(place[1:] for place in self.track if place[0] > t)]

    def update(self, plan: FloorPlan, events: list[Event], here: WearerMoved) -> list[Reference]:
        """Return the references in `events`; the wearer is at `here` now."""
        x, y, z = here.position
        self.track.append((here.t, round(x, 3), round(y, 3), round(z, 3)))
        if len(self.track) > TRACK_PLACES:
            self.track.popleft()
        found: list[Reference] = []
        for event in events:
            if isinstance(event, StrideTaken):
                self._add_stride(event.foot)
            elif isinstance(event, ActivityChanged):
                self._change_activity(event, found)
            elif isinstance(event, FlightClimbed):
                self._add_flight(event, found)
            elif isinstance(event, LiftRidden):
                if self.ridden is None or event.t > self.ridden + SAME_RIDE:
                    height = None if event.height is None or not isfinite(event.height) else abs(event.height)
                    t_start = min(event.t_start, event.t)
                    found.append(Arrived(ConnectorKind.LIFT, event.up, height, t_start, event.t, sure=SURE_RIDE))
                    self.ridden = event.t
                if self.passage is not None and self.passage.kind is ConnectorKind.LIFT:
                    self.passage = None
        if self.passage is not None:
            if self.passage.t_left is not None:
                self._leave(self.passage, self.passage.t_left, plan, here, found)
            elif self.passage.leads_away(here.position):
                self.passage = None
                found.append(Released())
        return found

    def _add_stride(self, foot: Foot) -> None:
        passage = self.passage
        if passage is None:
            return
        reference = REFERENCES.get(self.activity)
        if passage.t_left is not None or reference is None:
            passage.strides_since += 1
        elif passage.kind is ConnectorKind.STAIRS:
            passage.up += 1 if reference[1] else -1
            if foot is Foot.LEFT:
                passage.left += 1
            else:
                passage.right += 1

    def _change_activity(self, event: ActivityChanged, found: list[Reference]) -> None:
        self.activity = event.activity
        reference, passage = REFERENCES.get(event.activity), self.passage
        if reference is None:
            if passage is not None and passage.t_left is None:
                if event.t <= passage.t:
                    self.passage = None
                    found.append(Released())
                else:
                    passage.t_left, passage.end, passage.strides_since = event.t, self.at(event.t), 0
            return
        kind, up = reference
        if kind is ConnectorKind.LIFT and self.ridden is not None and event.t < self.ridden:
            return
        if passage is not None and passage.kind is kind:
            passage.t_left = passage.end = None
        else:
            if passage is not None:
                found.append(Released())
            passage = self.passage = Passage(kind, event.t, self.at(event.t))
            found.append(Held(kind, event.t))
        if kind is ConnectorKind.LIFT:
            passage.up += 1 if up else -1

    def _add_flight(self, event: FlightClimbed, found: list[Reference]) -> None:
        """Add a flight to the stairs that the wearer is on or has just left; without them, it starts a passage."""
        passage = self.passage
        if passage is not None and passage.kind is not ConnectorKind.STAIRS:
            return
        if passage is None:
            t = min(event.t_start, event.t)
            self.passage = passage = Passage(ConnectorKind.STAIRS, t, self.at(t), t_left=event.t, end=self.at(event.t))
            found.append(Held(ConnectorKind.STAIRS, t))
            passage.up = 1 if event.up else -1
        passage.flight_height += event.height if abs(event.height) < 100.0 else 0.0
        if passage.t_left is not None and event.t > passage.t_left:
            passage.t_left, passage.end = event.t, self.at(event.t)

    def _leave(self, passage: Passage, left: float, plan: FloorPlan, here: WearerMoved, found: list[Reference]) -> None:
        """Decide on a passage that was left: it led to another level, to a landing, or never was one."""
        up, height = passage.up > 0, passage.height(here.position)
        waited = here.t - left
        if passage.kind is ConnectorKind.LIFT:
            if waited > RIDE_OVER or passage.strides_since >= 2:
                self.passage = None
                self.ridden = left
                found.append(Arrived(passage.kind, up, height, passage.t, left, sure=SURE_RIDE))
            return
        least, most = storeys(plan)
        if height is None or not most > 0.0:
            self.passage = None
            found.append(Released())
            return
        end, measured = passage.end or passage.start, passage.measured(here.position)
        if not measured and height < LEAST_STOREY * least <= passage.height_one_way:
            height = passage.height_one_way  # half of them were reported wrong, or the wearer went up and down again
        real = height >= LEAST_STOREY * least
        possible = KERB_SHARE * least <= height <= LARGEST_CLIMB * most and not passage.leads_away(end)
        fits = (
            plan.heights_known
            and min([abs(height - rise) for rise in rises(plan, ConnectorKind.STAIRS)]) <= FIT_SHARE * least
        )
        # counted steps are those of landings, too: a flight and a landing are not a storey
        soon = real and possible and fits and (measured or height >= COUNTED_SHARE * least)
        if waited > LONGEST_WAIT or hypot(here.position[0] - end[0], here.position[1] - end[1]) > WAIT_DISTANCE or soon:
            self.passage = None
            good = fits or (real and not plan.heights_known)
            sure = (SURE if good else FAIR if real else HALF) * (1.0 - passage.opposite_share)
            arrived = Arrived(passage.kind, up, height, passage.t, left, passage.opposite_share, sure)
            found.append(arrived if possible else Released())


def storeys(plan: FloorPlan) -> tuple[float, float]:
    """Return the least and the greatest height, m, that stairs of the plan may lead to; 0 where there are none."""
    found = rises(plan, ConnectorKind.STAIRS)
    if not found:
        return (0.0, 0.0)
    if plan.heights_known:
        return (found[0], found[-1])
    ordinals = [level.ordinal for level in plan.levels]
    return (LOW, HIGH * max(max(ordinals) - min(ordinals), 1))


def rises(plan: FloorPlan, kind: ConnectorKind) -> list[float]:
    """Return every difference of height, m, over which a connector of a kind leads, least first."""
    found = set()
    for connector in plan.connectors:
        if connector.kind is kind:
            floors = [plan.level(stop.level).elevation for stop in connector.stops]
            found |= {round(abs(b - a), 3) for i, a in enumerate(floors) for b in floors[i + 1 :]}
    return sorted(found - {0.0})
