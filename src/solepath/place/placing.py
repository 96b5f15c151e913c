"""Place of the wearer on a floor plan: the common part of the particle filter and the Snake game.

The shape of the track is known, but its position and heading in the plan are not. Stairs, elevators and a known start
give a position. Walls do the rest: a placement of the track that leads through walls is wrong (Liu et al. 2015, section
IV.E). Stairs and elevators lead to another level and end where the plan has them.

The track itself is not changed. Latency: a place is reported with the stride that leads there;
connectors/references.py has the latency of a level."""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum, hypot, isfinite, pi
from typing import ClassVar

from ..body.fuse.position_covariance import LEAST_WAY
from ..body.part import MOVEMENTS, PartInput, PartOutput, StartGiven
from ..events import Event, Placed, PlaceLost, PositionReported, StrideTaken, TrackRevised, TurnMade, WearerMoved
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import Point, Start
from ..foot.view import FootView
from ..types.attrs import NOT_SAVED, define, field
from .arrivals import START_HEADING_ERROR, spread_rows, start_error
from .connectors.level_changes import DirectionRevised, LevelChangePossible, LevelReached
from .levels import DEGRADED_FACTOR, KNOWN_ROWS, MAX_JUMP, LevelChanges
from .north import HeadingSource
from .place_hypotheses import ABOUT_TURN_ANGLE, penalise_outside, rows_after_wrong_turn
from .reported import use_report
from .rows.alike_levels import hold_alike_levels
from .rows.rows import ONE_CANDIDATE_SPREAD, candidates_of, effective_count, have_not_moved, round_rows

ROWS_PER_CANDIDATE = 30
"""Number of additional rows that are kept for each candidate but the heaviest; fewer for a weight below 0.1.

Without a start, three of 25 emulated walks with insoles lose the true place with 20, none with 30; 60 gain nothing."""
MAX_STRIDES_OUTSIDE = 6
"""Number of strides outside of the plan after which the place is lost."""
OUTSIDE_INTERVAL = 4
"""Number of strides between two checks for rows outside of the plan."""
ABOUT_TURN_STRIDES = 12
"""Number of strides after an about-turn in which all rows are kept, until the walls have decided its angle."""
ABOUT_TURN_SPREAD = 0.5
"""Largest rms deviation of the places that form one candidate during `ABOUT_TURN_STRIDES`, m."""
MAX_STUCK_DISTANCE = 5.0
"""Length of track that no row could follow after which the place is lost, m."""
MIN_CLEAR_WEIGHT, FADE_FACTOR, FADE_RADIUS = 0.9, 0.88, 3.0
"""Least weight of a clear candidate; factor of the weight of rows on other levels; their largest distance from it, m.

When a candidate is clear, each stride reduces the weight of rows at the same place on other levels: walls do not remove
them where floors are equal, and `hold_alike_levels` keeps their share of the weight in each move."""


@define
class Placing(LevelChanges):
    """The common part of all placing methods: start, change of level, loss and report of the place."""

    needs_position: ClassVar[bool] = True

    plan: IndexedPlan | None = field(default=None, init=False, eq=False, repr=False, metadata=NOT_SAVED)
    """The floor plan; it is not saved, and is set when a session is made or restored."""
    pending_events: list[Event] = field(factory=list, init=False)
    """Events since the wearer's last position."""
    start: Start | None = field(default=None, init=False)
    started: bool = field(default=False, init=False)
    """Flag: the first position was received."""
    t: float | None = field(default=None, init=False)
    """Time of the newest position, s."""
    stride_count: int = field(default=0, init=False)
    """Number of strides since the last check for rows outside of the plan."""
    strides_outside: int = field(default=0, init=False)
    """Number of strides since the place was last within the plan."""
    wide_strides: int = field(default=0, init=False)
    """Number of further strides in which all rows are kept."""
    stuck_distance: float = field(default=0.0, init=False)
    """Length of track since a row could move, m."""
    rejected: tuple[Point, Point] | None = field(default=None, init=False)
    """Newest rejected place of a report, plan frame, and where the track was, world frame, m; None after one fitted."""
    newest_placed: Placed | None = field(default=None, init=False)
    """Newest place that was reported; None when it is lost."""

    @property
    def place(self) -> Placed | None:
        """Place of the wearer on the plan; None while it is not known."""
        return self.newest_placed

    def _set_start(self, start: Start) -> None:
        self.start = start
        if start.heading is not None:
            self.known_heading = (start.heading, START_HEADING_ERROR)
            self.heading_source = HeadingSource.GIVEN

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Hold events back until the wearer's position after them is known, and return the place then."""
        return [output for event in events for output in self._receive(event)]

    def _receive(self, event: PartInput) -> Sequence[PartOutput]:
        if isinstance(event, MOVEMENTS):
            self.pending_events.append(event)
        elif isinstance(event, WearerMoved) and self.plan is not None:
            events, self.pending_events = self.pending_events, []
            return self.follow(self.plan, events, event)
        elif isinstance(event, PositionReported) and event.position is not None and event.level and self.plan:
            return self._use_report(self.plan, event, event.position)
        elif isinstance(event, StartGiven):
            self._set_start(event.start)
        elif isinstance(event, TrackRevised):
            self.revise_track(event)
            if self.rejected is not None:
                place, (x, y) = self.rejected
                self.rejected = (place, (x + event.by[0], y + event.by[1]))
        return ()

    def _use_report(self, plan: IndexedPlan, event: PositionReported, place: Point) -> list[Event]:
        """Weigh the rows by a place that a person reports, m; before the first position, the app's start counts."""
        if not self.started and self.start is not None and self.start.place is not None:
            return []
        (x, y, _), other = self.last_place, None
        if self.rejected is not None:
            before, (at_x, at_y) = self.rejected
            other = before if hypot(x - at_x, y - at_y) < LEAST_WAY else None
        rows, rejected = use_report(
            plan, self.rows, event, place, other, self.scatter, self.settings.max_rows, self.known_heading
        )
        self.set_rows(rows)
        self.rejected = None if rejected is None else (place, (x, y))
        if rejected is None:
            self.unmapped, self.first_arrival = [], None
        return [] if rejected is None else [rejected]

    def follow(self, plan: IndexedPlan, events: list[Event], here: WearerMoved) -> list[Event]:
        """Update the rows with events after which the wearer is at `here`, and return the place; never raises."""
        outputs: list[Event] = []
        if not all([isfinite(v) for v in (here.t, *here.position)]):
            return outputs
        known_at = max([here.t, *[event.known_at for event in events]])
        if not self.started:
            self.started, self.heading_since = True, here.t
            self._start(plan, here, known_at, outputs)
        if self.t is not None and here.t < self.t - 1.0:
            self.references.reset()
            self.arrived_at, self.heading_since, self.unmapped, self.first_arrival = None, here.t, [], None
        self.t = here.t
        self.update_heading(plan.plan, here)
        strides = [event for event in events if isinstance(event, StrideTaken)]
        for stride in strides:
            self.stride_scale.add_stride(stride, here.position)
        if strides:
            self._move(plan, here, strides, known_at, outputs)
            self.start_again(plan)
        for event in events:
            if isinstance(event, TurnMade) and abs(event.angle) > ABOUT_TURN_ANGLE and self.rows:
                self._add_about_turn(plan, event.t)
        arrived = False
        levels = frozenset([row[5] for row in self.rows])
        for reference in self.references.update(plan.plan, events, here, levels):
            match reference:
                case LevelChangePossible():
                    self.start_level_change(plan.plan, reference)
                case LevelReached():
                    outputs += self.arrive_by(plan, reference, known_at)
                    arrived = True
                case DirectionRevised():
                    self.revise_direction()
                case _:
                    self.cancel_level_change()
        if (strides or arrived) and self.rows:
            outputs += self.give_up_heading(here, known_at)
            outputs.append(self._report_place(plan, here, known_at))
        return outputs

    def _start(self, plan: IndexedPlan, here: WearerMoved, known_at: float, outputs: list[Event]) -> None:
        start = self.start
        if self.rows:
            self.last_place = here.position
            return  # a person has said where the wearer is
        if start is None or start.place is None:
            given = "start" if start is None else "place of the start"
            what = f"no {given} was given, so the place is not known before the first stairs or lift"
            if not plan.plan.connectors:
                what = f"no {given} was given and the plan has neither stairs nor lifts: the place cannot be known"
            outputs.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self.last_place = here.position
            return
        reason = start_error(plan, start)
        if reason is not None:
            outputs.append(PlaceLost(t=here.t, known_at=known_at, what=reason))
            self.last_place = here.position
            return
        level = plan.number(start.level)
        count = self.settings.max_rows if start.heading is None else 2 * KNOWN_ROWS
        self.rows = round_rows(
            spread_rows(self.scatter, plan, level, start.place, start.spread, self.known_heading, count, 0, 1.0)
        )

    def _move(
        self, plan: IndexedPlan, here: WearerMoved, strides: list[StrideTaken], known_at: float, outputs: list[Event]
    ) -> None:
        """Move all rows with the track since the last stride."""
        x, y, _ = here.position
        move = (x - self.last_place[0], y - self.last_place[1])
        if not (abs(move[0]) < MAX_JUMP and abs(move[1]) < MAX_JUMP):
            self.last_place = here.position
            if self.rows:
                what = f"the track leaps by more than {MAX_JUMP:.0f} m"
                outputs.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self._lose_place()
            return
        self.last_place = here.position
        previous, rows = self.newest_placed, self.rows
        if not rows:
            return
        move = (move[0] * self.stride_scale.factor, move[1] * self.stride_scale.factor)
        # both feet make a turn of the wearer: half of each stride's turn counts
        turned = min(0.5 * fsum([abs(stride.heading_change) for stride in strides]), pi)
        error_factor = DEGRADED_FACTOR if any([stride.degraded for stride in strides]) else 1.0
        rows = self.move_rows(plan, rows, move, error_factor, turned)
        if previous is not None:
            rows = hold_alike_levels(plan, self.rows, rows, move, previous)
        self.stride_count = (self.stride_count + 1) % OUTSIDE_INTERVAL
        if self.stride_count == 0:
            rows = penalise_outside(plan, rows)
        not_moved = have_not_moved(rows, self.rows)
        self.stuck_distance = self.stuck_distance + hypot(*move) if not_moved else 0.0
        self.rows = round_rows(rows) if self.stuck_distance <= MAX_STUCK_DISTANCE else []
        if not self.rows:
            where = "" if previous is None else f" near ({previous.position[0]:.1f}, {previous.position[1]:.1f})"
            level = "" if previous is None else f" on level {previous.level}"
            outputs.append(
                PlaceLost(t=here.t, known_at=known_at, what=f"the track goes where the plan has no way{where}{level}")
            )
            self._lose_place()

    def _add_about_turn(self, plan: IndexedPlan, t: float) -> None:
        """Add rows for an about-turn of the wearer that ended at `t`, s."""
        rows = self.rows
        self.set_rows(rows + rows_after_wrong_turn(plan, rows, self.displacement_since(t)))
        self.wide_strides, self.first_arrival = ABOUT_TURN_STRIDES, None

    def _lose_place(self) -> None:
        self.rows, self.unmapped, self.newest_placed, self.strides_outside, self.stuck_distance = [], [], None, 0, 0.0

    def _report_place(self, plan: IndexedPlan, here: WearerMoved, known_at: float) -> Event:
        rows = self.rows
        known = plan.plan.heights_known
        rows_with_levels, heights = self.assign_levels(plan.plan, rows, here)
        candidates, spread = candidates_of(
            rows_with_levels,
            plan.plan,
            heights,
            None if known else here.position[2],
            ONE_CANDIDATE_SPREAD if self.wide_strides == 0 else ABOUT_TURN_SPREAD,
        )
        heaviest = candidates[0]
        if len(candidates) == 1 and not plan.inside(
            plan.number(heaviest.level), heaviest.position[0], heaviest.position[1]
        ):
            self.strides_outside += 1
            if self.strides_outside >= MAX_STRIDES_OUTSIDE and self.references.passage is None:
                self._lose_place()
                x, y, _ = heaviest.position
                what = f"the track leaves the plan near ({x:.1f}, {y:.1f}) on level {heaviest.level}"
                return PlaceLost(t=here.t, known_at=known_at, what=what)
        else:
            self.strides_outside = 0
        # one candidate: 8 more rows for each metre of spread
        others = fsum([min(1.0, 10.0 * candidate.weight) for candidate in candidates[1:]])
        count = min(
            self.settings.max_rows, KNOWN_ROWS + int(ROWS_PER_CANDIDATE * others if others else 8.0 * min(spread, 5.0))
        )
        if self.wide_strides > 0:
            self.wide_strides, count = self.wide_strides - 1, self.settings.max_rows
        is_small = len(rows) <= 1.25 * count and (self.wide_strides > 0 or effective_count(rows) >= 0.5 * count)
        if (
            heaviest.weight >= MIN_CLEAR_WEIGHT
            and len(candidates) > 1
            and self.wide_strides == 0
            and not self.level_uncertain
        ):
            x0, y0 = plan.plan.origin
            x, y, heaviest_level = heaviest.position[0] - x0, heaviest.position[1] - y0, plan.number(heaviest.level)
            rows = [
                (*row[:4], FADE_FACTOR * row[4], *row[5:])
                if row_with_level[5] != heaviest_level
                and (row[0] - x) ** 2 + (row[1] - y) ** 2 < FADE_RADIUS * FADE_RADIUS
                else row
                for row, row_with_level in zip(rows, rows_with_levels, strict=True)
            ]
            self.rows = round_rows(rows)
        if not is_small:
            self.rows = round_rows(self.thin(rows, count))
        number = plan.number(heaviest.level)
        self.newest_placed = Placed(
            t=here.t,
            known_at=known_at,
            level=heaviest.level,
            position=heaviest.position,
            room=plan.room(number, *heaviest.position[:2]),
            door=plan.door(number, *heaviest.position[:2]),
            spread=spread,
            candidates=candidates,
        )
        return self.newest_placed
