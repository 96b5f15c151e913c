"""References to a floor plan: climbs and rides, which are possible only on its stairs and in its elevators.

Activities, rides, flights and the track give three kinds of references (Liu et al. 2015, section IV.E): the wearer may
be changing level on stairs or in an elevator (`LevelChangePossible`), was not (`LevelChangeCancelled`), or has come to
another level (`LevelReached`), with a certainty. A climb of half a storey leads to a half-way landing, and a short
report of stairs on level ground is a mistake; both have a low certainty or none.

Latency: an elevator ride is known with its event; if there is none, after two strides or `RIDE_END_TIME`. Stairs are
known with the next activity, or up to `MAX_WAIT` s or `WAIT_DISTANCE` m later when the height fits no storey."""

from __future__ import annotations

from collections import deque
from math import hypot, inf, isfinite

from ...events import ActivityChanged, Event, FlightClimbed, LiftRidden, StrideTaken, WearerMoved
from ...floorplan.plan import ConnectorKind, FloorPlan
from ...types import Activity, Foot, Vec3
from ...types.attrs import define, field
from .level_changes import (
    FAIR_CERTAINTY,
    HALF_CERTAINTY,
    RIDE_CERTAINTY,
    SURE_CERTAINTY,
    DirectionRevised,
    LevelChangeCancelled,
    LevelChangePossible,
    LevelReached,
    Reference,
)
from .passage import Passage
from .storeys import MAX_RISERS, riser_height, storeys_of

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
SAME_RIDE_TIME = 5.0
"""Largest time between the ends of two reports of the same ride, s."""
MAX_TRACK_POSITIONS = 24
"""Number of positions of the track that are kept."""

CONNECTOR_OF_ACTIVITY = {
    Activity.STAIRS_UP: (ConnectorKind.STAIRS, True),
    Activity.STAIRS_DOWN: (ConnectorKind.STAIRS, False),
    Activity.ELEVATOR_UP: (ConnectorKind.LIFT, True),
    Activity.ELEVATOR_DOWN: (ConnectorKind.LIFT, False),
}
"""Kind of connector for each activity, and a flag: the activity leads up."""


@define
class References:
    """Derives references from the wearer's activities and the newest positions of the track."""

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    passage: Passage | None = field(default=None, init=False)
    """Passage under way, or left and not decided; None otherwise."""
    track: deque[tuple[float, float, float, float]] = field(factory=deque, init=False)
    """Newest positions of the track: t, s, and x, y, z, m."""
    ride_end: float | None = field(default=None, init=False)
    """End of the last ride, s."""
    decided: tuple[float, bool] | None = field(default=None, init=False)
    """End of the newest stairs that led to another level, s, and a flag: they led up; None before any."""
    partial: Passage | None = field(default=None, init=False)
    """Newest passage that ended on a half-way landing; None otherwise."""

    def reset(self) -> None:
        """Discard the passages, the last ride and the track, because the clock restarts."""
        self.passage = self.ride_end = self.partial = self.decided = None
        self.track.clear()

    def position_at(self, t: float) -> Vec3:
        """Return the position of the track at `t`, s, in m, by interpolation, or the nearest position that is kept."""
        after: tuple[float, float, float, float] | None = None
        for before in reversed(self.track):
            if before[0] <= t:
                if after is None or after[0] <= before[0]:
                    return before[1:]
                k = (t - before[0]) / (after[0] - before[0])
                (_, x, y, z), (_, x1, y1, z1) = before, after
                return (x + k * (x1 - x), y + k * (y1 - y), z + k * (z1 - z))
            after = before
        return (0.0, 0.0, 0.0) if after is None else after[1:]

    def move(self, by: tuple[float, float]) -> None:
        """Move all positions that are kept by x and y, m, because the track was revised."""
        dx, dy = by
        self.track = deque([(t, x + dx, y + dy, z) for t, x, y, z in self.track])
        if self.passage is not None:
            x, y, z = self.passage.start
            self.passage.start = (x + dx, y + dy, z)
            if self.passage.end is not None:
                x, y, z = self.passage.end
                self.passage.end = (x + dx, y + dy, z)

    def reach_back_to(self, t: float) -> bool:
        """Return whether no position since `t`, s, was discarded."""
        return len(self.track) < MAX_TRACK_POSITIONS or self.track[0][0] <= t

    def path_since(self, t: float) -> list[Vec3]:
        """Return the position of the track at `t`, s, and all later positions that are kept, m."""
        return [self.position_at(t), *(position[1:] for position in self.track if position[0] > t)]

    def update(
        self, plan: FloorPlan, events: list[Event], here: WearerMoved, levels: frozenset[int] = frozenset()
    ) -> list[Reference]:
        """Return the references that follow from `events`; the wearer is at `here` now.

        `levels` are those on which the wearer may be, as indices in the plan; none if that is not known."""
        x, y, z = here.position
        self.track.append((here.t, round(x, 3), round(y, 3), round(z, 3)))
        if len(self.track) > MAX_TRACK_POSITIONS:
            self.track.popleft()
        references: list[Reference] = []
        for event in events:
            if isinstance(event, StrideTaken):
                self._add_stride(event.foot)
            elif isinstance(event, ActivityChanged):
                self._change_activity(plan, event, references)
            elif isinstance(event, FlightClimbed):
                self._add_flight(plan, event, references)
            elif isinstance(event, LiftRidden):
                if self.ride_end is None or event.t > self.ride_end + SAME_RIDE_TIME:
                    height = None if event.height is None or not isfinite(event.height) else abs(event.height)
                    t_start = min(event.t_start, event.t)
                    references.append(
                        LevelReached(ConnectorKind.LIFT, event.up, height, t_start, event.t, certainty=RIDE_CERTAINTY)
                    )
                    self.ride_end = event.t
                if self.passage is not None and self.passage.kind is ConnectorKind.LIFT:
                    self.passage = None
        if self.passage is not None:
            if self.passage.t_left is not None:
                self._decide(self.passage, self.passage.t_left, plan, levels, here, references)
            elif self.passage.leads_away(here.position):
                self.passage = None
                references.append(LevelChangeCancelled())
        return references

    def _add_stride(self, foot: Foot) -> None:
        passage = self.passage
        if passage is None:
            return
        connector = CONNECTOR_OF_ACTIVITY.get(self.activity)
        if passage.t_left is not None or connector is None:
            passage.strides_since += 1
        elif passage.kind is ConnectorKind.STAIRS:
            passage.add_direction(connector[1], foot)

    def _change_activity(self, plan: FloorPlan, event: ActivityChanged, references: list[Reference]) -> None:
        self.activity = event.activity
        connector, passage = CONNECTOR_OF_ACTIVITY.get(event.activity), self.passage
        if connector is None:
            if passage is not None and passage.t_left is None:
                if event.t <= passage.t:
                    self.passage = None
                    references.append(LevelChangeCancelled())
                else:
                    passage.t_left, passage.end, passage.strides_since = event.t, self.position_at(event.t), 0
            return
        kind, up = connector
        if kind is ConnectorKind.LIFT and self.ride_end is not None and event.t < self.ride_end:
            return
        if passage is None and self._revises_decided(event, kind, up, references):
            return
        if passage is not None and passage.kind is kind:
            passage.t_left = passage.end = None
        else:
            if passage is not None:
                references.append(LevelChangeCancelled())
            passage = self.passage = self._enter(plan, kind, event.t)
            references.append(LevelChangePossible(kind, event.t))
        if kind is ConnectorKind.LIFT:
            passage.add_direction(up)
        else:
            passage.report(event.t, up, event.revises)

    def _revises_decided(
        self, event: ActivityChanged, kind: ConnectorKind, up: bool, references: list[Reference]
    ) -> bool:
        """Return whether an activity is a later report of the newest stairs, which were left already."""
        if self.decided is None or kind is not ConnectorKind.STAIRS or event.revises is None:
            return False
        t_left, was_up = self.decided
        if event.t >= t_left:
            return False
        if up is not was_up:
            self.decided = (t_left, up)
            references.append(DirectionRevised())
        return True

    def _add_flight(self, plan: FloorPlan, event: FlightClimbed, references: list[Reference]) -> None:
        """Add a flight to the passage over stairs; without one, the flight starts a passage."""
        passage = self.passage
        if passage is not None and passage.kind is not ConnectorKind.STAIRS:
            return
        if passage is None:
            t = min(event.t_start, event.t)
            self.passage = passage = self._enter(plan, ConnectorKind.STAIRS, t)
            passage.t_left, passage.end = event.t, self.position_at(event.t)
            references.append(LevelChangePossible(ConnectorKind.STAIRS, t))
            passage.add_direction(event.up)
        passage.flight_height += event.height if abs(event.height) < 100.0 else 0.0
        passage.flights += 1 if event.up else -1
        if passage.t_left is not None and event.t > passage.t_left:
            passage.t_left, passage.end = event.t, self.position_at(event.t)

    def _enter(self, plan: FloorPlan, kind: ConnectorKind, t: float) -> Passage:
        """Return a new passage from `t`, s, on; from a half-way landing it continues the one that ended there."""
        start, partial = self.position_at(t), self.partial
        passage, self.partial = Passage(kind, t, start, riser=riser_height(plan)), None
        if partial is not None and kind is ConnectorKind.STAIRS and partial.is_continued(t, start):
            passage.height_before, passage.flights = partial.height_signed(start), partial.flights
        return passage

    def _decide(
        self,
        passage: Passage,
        t_left: float,
        plan: FloorPlan,
        levels: frozenset[int],
        here: WearerMoved,
        references: list[Reference],
    ) -> None:
        """Decide whether a passage that was left led to another level, when that is certain or the wait is over."""
        up, height = passage.net_up > 0, passage.height(here.position)
        waiting_time = here.t - t_left
        if passage.kind is ConnectorKind.LIFT:
            if waiting_time > RIDE_END_TIME or passage.strides_since >= 2:
                self.passage = None
                self.ride_end = t_left
                references.append(LevelReached(passage.kind, up, height, passage.t, t_left, certainty=RIDE_CERTAINTY))
            return
        # only the height of the track shows the direction beyond doubt
        storeys = storeys_of(plan, levels, passage.measured_up(here.position))
        least, most = storeys.heights
        if height is None or not most > 0.0:
            self.passage = None
            references.append(LevelChangeCancelled())
            return
        end, measured = passage.end or passage.start, passage.is_measured(here.position)
        if not measured and height < MIN_STOREY_SHARE * least <= passage.height_one_way:
            height = passage.height_one_way  # half of the directions are wrong, or the wearer went up and down again
        fits = min([abs(height - rise) for rise in storeys.rises], default=inf) <= FIT_SHARE * least
        flights = abs(passage.flights) or None
        is_partial = (
            not fits
            and storeys.flights is not None
            and flights is not None
            and flights < storeys.flights
            and height <= flights * MAX_RISERS * passage.riser  # a higher one is two flights, taken for one
        )
        is_storey = height >= MIN_STOREY_SHARE * least and not is_partial
        is_possible = KERB_SHARE * least <= height <= MAX_CLIMB_RATIO * most and not passage.leads_away(end)
        # counted risers include steps on landings, so a flight and a landing must not count as a storey
        is_settled = is_storey and is_possible and fits and (measured or height >= COUNTED_SHARE * least)
        if (
            waiting_time > MAX_WAIT
            or hypot(here.position[0] - end[0], here.position[1] - end[1]) > WAIT_DISTANCE
            or is_settled
        ):
            self.passage = None
            fits_plan = (fits or not storeys.rises) and is_storey
            certainty = (SURE_CERTAINTY if fits_plan else FAIR_CERTAINTY if is_storey else HALF_CERTAINTY) * (
                1.0 - passage.opposite_share
            )
            arrived = LevelReached(
                passage.kind, up, height, passage.t, t_left, passage.opposite_share, certainty, flights
            )
            references.append(arrived if is_possible else LevelChangeCancelled())
            if is_possible:
                self.decided = (t_left, up)
            is_climb = is_possible or (passage.flights != 0 and not passage.leads_away(end))
            self.partial = passage if is_climb and not is_storey else None
