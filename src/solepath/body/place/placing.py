"""Place of the wearer on a floor plan: the common part of both methods.

The track has a shape, but its placement in the plan is not known. Stairs and lifts give a place (a known start does,
too); walls give the rest: placements of the track that lead through walls are wrong (Liu et al. 2015, section IV.E).
Stairs and lifts lead to another level, and they end where the plan has them.

The track itself is never bent. Latency: a place is reported with the stride that leads there, a level as in
reference.py."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, isfinite, pi
from typing import ClassVar

from ...events import Event, Placed, PlaceLost, StrideTaken, TurnMade, WearerMoved
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ...types.attrs import NOT_SAVED, define, field
from ..part import MOVEMENTS, PartInput, PartOutput
from .arrivals import fan, start_error
from .levels import DEGRADED_FACTOR, KNOWN_ROWS, LONGEST_JUMP, LevelChanges
from .place_hypotheses import ABOUT_TURN, penalise_outside, wrong_turns
from .reference import Arrived, Held
from .rows import ONE_CANDIDATE, Row, candidates_of, effective, rounded

ROWS_PER_CANDIDATE = 30
"""Number of further rows that are kept for every other candidate of some weight."""
MOST_OUTSIDE = 6
"""Number of strides outside of the plan after which the wearer has left it."""
OUTSIDE_INTERVAL = 4
"""Number of strides between two checks for rows outside of the plan."""
WIDE_STRIDES = 12
"""Number of strides until the walls have decided which way an about-turn led."""
WIDE_LIMIT = 0.5
"""Largest deviation (rms) at which all places are one candidate until then, m."""
LONGEST_STUCK = 5.0
"""Length of the track without a possible row after which the place is lost, m."""
CLEAR_WEIGHT, FADE_FACTOR, FADE_RADIUS = 0.9, 0.88, 3.0
"""Weight of a clear candidate, factor of the weight of rows on other levels, and their distance from it, m.

Rows within that distance on another level keep this share of their weight with each stride: floors are often alike, and
then no wall ever decides."""


@define
class Placing(LevelChanges):
    """The common part of both methods: start, change of level, loss and report of the place."""

    needs_position: ClassVar[bool] = True

    plan: IndexedPlan | None = field(default=None, init=False, eq=False, repr=False, metadata=NOT_SAVED)
    """The floor plan; it is not saved, and is set when a session is made or restored."""
    pending: list[Event] = field(factory=list, init=False)
    """Events since the wearer's last move."""
    start: Start | None = field(default=None, init=False)
    started: bool = field(default=False, init=False)
    """Flag: the first position was followed."""
    t: float | None = field(default=None, init=False)
    """Time of the newest position, s."""
    stride_count: int = field(default=0, init=False)
    """Number of strides since the last check for rows outside of the plan."""
    outside: int = field(default=0, init=False)
    """Number of strides since the wearer was last within the plan."""
    wide: int = field(default=0, init=False)
    """Number of strides for which more rows are kept than their weights need."""
    stuck: float = field(default=0.0, init=False)
    """Length of the track since a row could move, m."""
    newest: Placed | None = field(default=None, init=False)
    """The newest place that was reported, None once it is lost."""

    @property
    def place(self) -> Placed | None:
        """Place of the wearer on the plan; None while it is not known."""
        return self.newest

    def set_out(self, start: Start) -> None:
        """Set the start of the wearer, before the first `follow`; raises ValueError for values that are no numbers."""
        numbers = (*start.place, start.spread, 0.0 if start.heading is None else start.heading)
        if not all([isfinite(number) for number in numbers]):
            raise ValueError(f"a start's place, heading and spread are numbers, not {numbers}")
        self.start = start

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Receive an event and hold it back until the wearer's position after it is known."""
        if isinstance(event, MOVEMENTS):
            self.pending.append(event)
        elif isinstance(event, WearerMoved) and self.plan is not None:
            events, self.pending = self.pending, []
            return self.follow(self.plan, events, event)
        return ()

    def follow(self, plan: IndexedPlan, events: list[Event], here: WearerMoved) -> list[Event]:
        """Follow a stride, an activity, or several events, after which the wearer is `here`; never raises."""
        outputs: list[Event] = []
        if not all([isfinite(v) for v in (here.t, *here.position)]):
            return outputs
        known_at = max([here.t, *[event.known_at for event in events]])
        if not self.started:
            self.started = True
            self._start(plan, here, known_at, outputs)
        if self.t is not None and here.t < self.t - 1.0:
            self.references.reset()
            self.arrived_at = None
        self.t = here.t
        strides = [event for event in events if isinstance(event, StrideTaken)]
        for stride in strides:
            self.stride_scale.add_stride(stride, here.position)
        if strides:
            self._move(plan, here, strides, known_at, outputs)
        for event in events:
            if isinstance(event, TurnMade) and abs(event.angle) > ABOUT_TURN and self.rows:
                self._add_about_turn(plan, event.t)
        arrived = False
        for reference in self.references.update(plan.plan, events, here):
            match reference:
                case Held():
                    self.hold(plan.plan, reference)
                case Arrived():
                    self.arrive(plan, reference)
                    arrived = True
                case _:
                    self.release()
        if (strides or arrived) and self.rows:
            outputs.append(self._placed(plan, here, known_at))
        return outputs

    def _start(self, plan: IndexedPlan, here: WearerMoved, known_at: float, outputs: list[Event]) -> None:
        start = self.start
        if start is None:
            what = "no start was given, so the place is not known before the first stairs or lift"
            if not plan.plan.connectors:
                what = "no start was given and the plan has neither stairs nor lifts: the place cannot be known"
            outputs.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self.last_place = here.position
            return
        why_not = start_error(plan, start)
        if why_not is not None:
            outputs.append(PlaceLost(t=here.t, known_at=known_at, what=why_not))
            self.last_place = here.position
            return
        level = plan.number(start.level)
        count = self.settings.most if start.heading is None else 2 * KNOWN_ROWS
        self.rows = rounded(fan(self.scatter, plan, level, start.place, start.spread, start.heading, count, 0, 1.0))

    def _move(
        self, plan: IndexedPlan, here: WearerMoved, strides: list[StrideTaken], known_at: float, outputs: list[Event]
    ) -> None:
        """Move all rows with the track since the last stride."""
        x, y, _ = here.position
        move = (x - self.last_place[0], y - self.last_place[1])
        if not (abs(move[0]) < LONGEST_JUMP and abs(move[1]) < LONGEST_JUMP):
            self.last_place = here.position
            if self.rows:
                what = f"the track leaps by more than {LONGEST_JUMP:.0f} m"
                outputs.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self._lose_place()
            return
        self.last_place = here.position
        rows = self.rows
        if not rows:
            return
        move = (move[0] * self.stride_scale.factor, move[1] * self.stride_scale.factor)
        before = self.newest
        came_from = rows
        # each foot turns as the wearer does, and each stride contains the turn
        turned = min(0.5 * sum([abs(stride.heading_change) for stride in strides]), pi)
        rough = DEGRADED_FACTOR if any([stride.degraded for stride in strides]) else 1.0
        rows = self.move_rows(plan, rows, move, rough, turned)
        self.stride_count = (self.stride_count + 1) % OUTSIDE_INTERVAL
        if self.stride_count == 0:
            rows = penalise_outside(plan, rows)
        stays = _stay(rows, came_from)
        self.stuck = self.stuck + hypot(*move) if stays else 0.0
        self.rows = rounded(rows) if self.stuck <= LONGEST_STUCK else []
        if not self.rows:
            where = "" if before is None else f" near ({before.position[0]:.1f}, {before.position[1]:.1f})"
            level = "" if before is None else f" on level {before.level}"
            outputs.append(
                PlaceLost(t=here.t, known_at=known_at, what=f"the track goes where the plan has no way{where}{level}")
            )
            self._lose_place()

    def _add_about_turn(self, plan: IndexedPlan, t: float) -> None:
        """Add rows for an about-turn of the wearer that ended at `t` s."""
        rows = self.rows
        self.set_rows(rows + wrong_turns(plan, rows, self.displacement_since(t)))
        self.wide = WIDE_STRIDES

    def _lose_place(self) -> None:
        self.rows, self.newest, self.outside, self.stuck = [], None, 0, 0.0

    def _placed(self, plan: IndexedPlan, here: WearerMoved, known_at: float) -> Event:
        rows = self.rows
        known = plan.plan.heights_known
        shown, heights = self.with_levels(plan.plan, rows, here)
        candidates, spread = candidates_of(
            shown,
            plan.plan,
            heights,
            None if known else here.position[2],
            ONE_CANDIDATE if self.wide == 0 else WIDE_LIMIT,
        )
        first = candidates[0]
        if len(candidates) == 1 and not plan.inside(plan.number(first.level), first.position[0], first.position[1]):
            self.outside += 1
            if self.outside >= MOST_OUTSIDE and self.references.passage is None:
                self._lose_place()
                x, y, _ = first.position
                what = f"the track leaves the plan near ({x:.1f}, {y:.1f}) on level {first.level}"
                return PlaceLost(t=here.t, known_at=known_at, what=what)
        else:
            self.outside = 0
        others = sum([min(1.0, 10.0 * one.weight) for one in candidates[1:]])
        count = min(
            self.settings.most, KNOWN_ROWS + int(ROWS_PER_CANDIDATE * others if others else 8.0 * min(spread, 5.0))
        )
        if self.wide > 0:
            self.wide, count = self.wide - 1, self.settings.most
        few = len(rows) <= 1.25 * count and (self.wide > 0 or effective(rows) >= 0.5 * count)
        if first.weight >= CLEAR_WEIGHT and len(candidates) > 1 and self.wide == 0 and not self.level_uncertain:
            x0, y0 = plan.plan.origin
            x, y, at = first.position[0] - x0, first.position[1] - y0, plan.number(first.level)
            rows = [
                (*row[:4], FADE_FACTOR * row[4], *row[5:])
                if shown_row[5] != at and (row[0] - x) ** 2 + (row[1] - y) ** 2 < FADE_RADIUS * FADE_RADIUS
                else row
                for row, shown_row in zip(rows, shown, strict=True)
            ]
            self.rows = rounded(rows)
        if not few:
            self.rows = rounded(self.thin(rows, count))
        self.newest = Placed(
            t=here.t,
            known_at=known_at,
            level=first.level,
            position=first.position,
            spread=spread,
            candidates=candidates,
        )
        return self.newest


def _stay(rows: list[Row], before: list[Row]) -> bool:
    """Return whether all rows are where some were before; most often the first one is not."""
    if rows:
        x, y = rows[0][:2]
        if not any([row[0] == x and row[1] == y for row in before]):
            return False
    places = {row[:2] for row in before}
    return all([row[:2] in places for row in rows])
