"""Changes of level on stairs and in elevators, followed on each level that is possible.

Activities are uncertain: level walking may be reported as stairs, and stairs down as stairs up. Therefore, after a
possible change of level, there are rows (hypotheses) for both levels and both directions, each with its probability.
The walls of the plan and later events decide between them."""

from __future__ import annotations

from math import fsum, hypot, isfinite, pi

from ..events import PlanContradicted, TrackRevised, WearerMoved
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import ConnectorKind, FloorPlan, Point
from ..types import Vec3
from ..types.attrs import define, evolve, field
from ..types.vector import ZERO
from .arrivals import (
    EXIT_TIMES,
    START_HEADING_ERROR,
    Arrival,
    Heading,
    arrival_by,
    find_level_changes,
    has_exit,
    reversed_rows,
    rows_at_all_exits,
    rows_at_exits,
)
from .connectors.landings import HEIGHT_ERROR, Landing, find_exits, list_landings
from .connectors.level_changes import FAIR_CERTAINTY, LevelChangePossible, LevelReached
from .connectors.references import References
from .contradictions import CONTRADICTED_CERTAINTY, contradicted_heading, contradicted_height
from .first_arrival import MOST_ROWS, FirstArrival
from .north import HeadingSource, heading_by_north, hold_headings, weigh_headings
from .place_hypotheses import PlaceHypotheses
from .rows.noise import next_random
from .rows.rows import Row, resample_rows, round_rows, turn_rows
from .stride_scale import StrideScale

KNOWN_ROWS = 64
"""Number of rows that are kept when the place is known."""
MAX_JUMP = 100.0
"""Longest move of the track between two positions that is used, m."""
DEGRADED_FACTOR = 1.5
"""Factor of the errors of a degraded stride (mostly a clipped peak, rarely a gap), and of rows that follow a climb."""
SAME_STAIRS_TIME = 10.0
"""Time after an arrival, s, in which further stairs count as the rest of the same stairs."""
MIN_LANDING_SHARE = 0.02
"""Least weight of the rows at exits, as a share of the other rows'; with less, the rows were at wrong places."""
STAYING_SHARE = {ConnectorKind.STAIRS: 0.85, ConnectorKind.LIFT: 0.5}
"""Share of the weight that rows at wrong places keep, because level walking may have been reported as stairs."""
BOTH_LEVELS_LIMITS = (0.3, 0.8)
"""Limits, as shares of the climb to the next landing, between which the wearer may be on either level."""
MIN_CERTAINTY = 0.3
"""Least certainty of an arrival after which the wearer may be at any landing of the plan."""


@define
class LevelChanges(PlaceHypotheses):
    """Changes the level of rows near stairs or an elevator when the wearer is reported to be on them."""

    last_place: Vec3 = field(default=ZERO, init=False)
    """Newest position of the track that was used, m, world frame."""
    references: References = field(factory=References, init=False)
    stride_scale: StrideScale = field(factory=StrideScale, init=False)
    arrival: Arrival | None = field(default=None, init=False)
    """Newest arrival by stairs, whose direction may be revised; None before any."""
    first_arrival: FirstArrival | None = field(default=None, init=False)
    """First arrival while its exits are not decided; None before, afterwards, and with a known heading."""
    level_uncertain: bool = field(default=False, init=False)
    """Flag: the level depends on the reported direction of stairs, which is often wrong."""
    arrived_at: float | None = field(default=None, init=False)
    """Time of the last arrival on another level, s; None before any."""
    unmapped: list[Row] = field(factory=list, init=False)
    """Rows that were in a lift when it went to where the plan has no landing; empty if it did not."""
    unmapped_height: float = field(default=0.0, init=False)
    """Height of all rides since then, m, upwards."""
    known_heading: Heading | None = field(default=None, init=False)
    """Angle of the track's x axis from the plan's, and its largest error, rad; None without a first heading and a
    compass, or if it was wrong."""
    heading_source: HeadingSource = field(default=HeadingSource.NONE, init=False)
    heading_since: float | None = field(default=None, init=False)
    """Time of the first position, s, at which the first heading was known."""

    def start_level_change(self, plan: FloorPlan, change: LevelChangePossible) -> None:
        """Add a row that changes level for each row near stairs or an elevator, and keep the rows that stay."""
        rows = self.rows
        if rows:
            rows = [row for row in rows if not row[7]] or rows
            self.set_rows(rows + find_level_changes(plan, rows, change.kind, self.displacement_since(change.t)))

    def cancel_level_change(self) -> None:
        """Remove the rows that change level, because there was no change."""
        rows = self.rows
        walking = [row for row in rows if not row[7]]
        self.rows = round_rows(
            walking or [(x, y, a, b, w, level, origin, 0) for x, y, a, b, w, level, origin, _ in rows]
        )

    def revise_track(self, event: TrackRevised) -> None:
        """Move and turn what belongs to the track with it; the rows stay where they are on the plan."""
        (x, y, z), (dx, dy) = self.last_place, event.by
        self.last_place = (x + dx, y + dy, z)
        self.references.move(event.by)
        if self.known_heading is not None:
            self.known_heading = (self.known_heading[0] - event.turn, self.known_heading[1])
        self.stride_scale.forget()
        self.rows = round_rows(turn_rows(self.rows, event.turn))
        self.unmapped = round_rows(turn_rows(self.unmapped, event.turn))

    def update_heading(self, plan: FloorPlan, here: WearerMoved) -> None:
        """Allow the first heading the error of the track now; without one, take that by the compass, if there is one.

        Two standard deviations of the track are 95 % of its errors; with pi, any heading is possible. When the compass
        shows the heading for the first time, the rows are weighed by it."""
        sigma = here.heading_sigma
        if self.heading_source is HeadingSource.GIVEN:
            if self.known_heading is not None and sigma is not None and isfinite(sigma):
                self.known_heading = (self.known_heading[0], min(START_HEADING_ERROR + 2.0 * sigma, pi))
        elif self.heading_source is not HeadingSource.CONTRADICTED:
            self.known_heading = heading_by_north(plan, here.north)
            if self.known_heading is not None:
                is_new = self.heading_source is HeadingSource.NONE
                self.heading_source = HeadingSource.COMPASS
                self.rows = round_rows((weigh_headings if is_new else hold_headings)(self.rows, self.known_heading))

    def give_up_heading(self, here: WearerMoved, known_at: float) -> list[PlanContradicted]:
        """Use the known heading no longer if no row has it, and return the event that says so."""
        if self.known_heading is None:
            return []
        since = here.t if self.heading_since is None else self.heading_since
        by_compass = self.heading_source is HeadingSource.COMPASS
        wrong = contradicted_heading(self.rows, self.known_heading, since, here.t, known_at, by_compass)
        if wrong is None:
            return []
        self.known_heading, self.heading_source = None, HeadingSource.CONTRADICTED
        return [wrong]

    def displacement_since(self, t: float) -> Point:
        """Return the displacement of the track since `t`, s, in m."""
        x, y, _ = self.references.position_at(t)
        return (
            (self.last_place[0] - x) * self.stride_scale.factor,
            (self.last_place[1] - y) * self.stride_scale.factor,
        )

    def arrive_by(self, plan: IndexedPlan, arrived: LevelReached, known_at: float) -> list[PlanContradicted]:
        """Arrive on another level, and return an event if the plan has no such ride."""
        if self.unmapped and arrived.kind is ConnectorKind.LIFT and arrived.height is not None:
            height = self.unmapped_height + (arrived.height if arrived.up else -arrived.height)
            whole = evolve(arrived, up=height > 0.0, height=abs(height))
            is_back, levels = abs(height) < HEIGHT_ERROR, sorted({row[5] for row in self.unmapped})
            if is_back or contradicted_height(plan.plan, whole, levels, known_at) is None:
                self._come_back(plan, whole, is_back)
                return []
            self.unmapped_height = height
        wrong = contradicted_height(plan.plan, arrived, sorted({row[5] for row in self.rows}), known_at)
        if wrong is None:
            self.unmapped = []
        else:
            arrived = evolve(arrived, certainty=CONTRADICTED_CERTAINTY)
            if not self.unmapped and arrived.height is not None:
                rows = [row for row in self.rows if row[7]] or find_level_changes(
                    plan.plan, self.rows, arrived.kind, self.displacement_since(arrived.t_start)
                )
                self.unmapped = round_rows(rows if len(rows) <= KNOWN_ROWS else resample_rows(rows, KNOWN_ROWS, 0.5))
                self.unmapped_height = arrived.height if arrived.up else -arrived.height
        self.arrive(plan, arrived)
        return [] if wrong is None else [wrong]

    def _come_back(self, plan: IndexedPlan, whole: LevelReached, is_back: bool) -> None:
        """Continue the rows of a lift that stopped where the plan has no landing, after the rest of its way or back."""
        rows, self.unmapped = self.unmapped, []
        self.random = next_random(self.random)
        found = [(*row[:7], 0) for row in rows] if is_back else rows_at_exits(plan, rows, whole, self.random)
        others = resample_rows([(*row[:7], 0) for row in self.rows], KNOWN_ROWS, 0.5)
        weight, other_weight = fsum([row[4] for row in found]), fsum([row[4] for row in others])
        k = FAIR_CERTAINTY / (1.0 - FAIR_CERTAINTY) * other_weight / weight if weight and other_weight else 1.0
        found = [(x, y, a, b, k * w, level, origin, 0) for x, y, a, b, w, level, origin, _ in found]
        self.arrived_at = whole.t
        self.set_rows(self._move_from_exits(plan, found, whole) + others)

    def arrive(self, plan: IndexedPlan, arrived: LevelReached) -> None:
        """Continue each row that may have changed level from its exits, and keep rows that stayed."""
        if not any([connector.kind is arrived.kind for connector in plan.plan.connectors]):
            return  # the plan has no such connector
        rows = self.rows
        changing = [row for row in rows if row[7]]
        rows = [row for row in rows if not row[7]] or [(*row[:7], 0) for row in rows]
        if rows and not changing:
            changing = find_level_changes(plan.plan, rows, arrived.kind, self.displacement_since(arrived.t_start))
        total = fsum([row[4] for row in rows])
        is_same_climb = self.arrived_at is not None and arrived.t_start < self.arrived_at + SAME_STAIRS_TIME
        if changing and is_same_climb and not has_exit(plan.plan, changing, arrived.up):
            self.cancel_level_change()  # the rest of a climb that already counted as a whole storey
            return
        self.random = next_random(self.random)
        exit_rows = rows_at_exits(plan, changing, arrived, self.random)
        exit_weight = fsum([row[4] for row in exit_rows])
        if exit_weight <= MIN_LANDING_SHARE * total:
            if arrived.certainty <= MIN_CERTAINTY:
                self.arrival = None
                self.cancel_level_change()
                return
            exit_rows = rows_at_all_exits(self.scatter, plan, arrived, self.settings.max_rows, self.known_heading)
            self.first_arrival = FirstArrival(arrived) if self.known_heading is None and not rows else None
            self.level_uncertain = arrived.kind is ConnectorKind.STAIRS
            exit_weight = fsum([row[4] for row in exit_rows])
            landing_share = 1.0 - STAYING_SHARE[arrived.kind]
            has_weights = exit_weight > 0.0 and total > 0.0
            k = total * landing_share / (1.0 - landing_share) / exit_weight if has_weights else 1.0
        else:
            k = arrived.certainty / (1.0 - arrived.certainty)
            self.level_uncertain, self.first_arrival = False, None
        self.arrived_at = arrived.t
        self.arrival = arrival_by(plan.plan, changing, arrived)
        exit_rows = [(x, y, a, b, k * w, level, origin, 0) for x, y, a, b, w, level, origin, _ in exit_rows]
        if len(exit_rows) > self.settings.max_rows:
            exit_rows = self.thin(exit_rows, self.settings.max_rows)
        exit_rows = self._move_from_exits(plan, exit_rows, arrived) + resample_rows(rows, KNOWN_ROWS, 0.5)
        if exit_rows:
            self.set_rows(exit_rows)

    def revise_direction(self) -> None:
        """Exchange the weights of the levels above and below after the newest stairs, as they led the other way."""
        if self.arrival is not None:
            self.rows = round_rows(reversed_rows(self.rows, self.arrival))
            self.arrival = evolve(self.arrival, expected=self.arrival.opposite, opposite=self.arrival.expected)
            if self.first_arrival is not None:
                self.first_arrival.reverse()

    def start_again(self, plan: IndexedPlan) -> None:
        """Start rows from all exits again after a stride, if the first arrival is not decided (first_arrival.py)."""
        first = self.first_arrival
        if first is None:
            return
        is_due, is_lost = first.count_stride(), not (self.rows and self.references.reach_back_to(first.arrived.t))
        if is_lost or first.is_over:
            self.first_arrival = None
        if is_due and not is_lost and not any([row[7] for row in self.rows]):
            rows = rows_at_all_exits(self.scatter, plan, first.arrived, MOST_ROWS, self.known_heading)
            self.set_rows(self._move_from_exits(plan, rows, first.arrived) or self.rows)

    def _move_from_exits(self, plan: IndexedPlan, rows: list[Row], arrived: LevelReached) -> list[Row]:
        """Return rows at exits moved along the track up to now; they left at different times before `arrived.t`."""
        t, n = arrived.t, len(EXIT_TIMES[arrived.kind])
        groups = [self._move_to_now(plan, rows[k::n], t - dt) for k, dt in enumerate(EXIT_TIMES[arrived.kind])]
        return [row for group in groups for row in group]

    def _move_to_now(self, plan: IndexedPlan, rows: list[Row], t: float) -> list[Row]:
        """Return rows of the time `t`, s, moved along the track up to now."""
        path = self.references.path_since(t)
        for (x, y, _), (x1, y1, _) in zip(path, path[1:], strict=False):
            move = ((x1 - x) * self.stride_scale.factor, (y1 - y) * self.stride_scale.factor)
            if rows and move != (0.0, 0.0) and hypot(*move) < MAX_JUMP:
                rows = self.move_rows(plan, rows, move, DEGRADED_FACTOR, 0.0)
        return rows

    def assign_levels(self, plan: FloorPlan, rows: list[Row], here: WearerMoved) -> tuple[list[Row], dict[int, float]]:
        """Return the rows, with a level for those that change level, and the heights of those, m, by landing of entry.

        The level is the nearer one; about half-way, rows alternate between both. Heights end at the next landing."""
        entered = {row[7] for row in rows if row[7]}
        if not entered:
            return rows, {}
        landings = list_landings(plan)
        heights: dict[int, float] = {}
        levels: dict[int, tuple[int, int]] = {}
        for index in sorted(entered):
            landing = landings[index - 1]
            height, above = self._height_gained(plan, landings, landing, here)
            heights[index] = landing.elevation + height
            rise = 0.0 if above is None else abs(above.elevation - landing.elevation)
            is_near_entry = above is None or abs(height) < BOTH_LEVELS_LIMITS[1] * rise
            is_near_next = above is not None and abs(height) > BOTH_LEVELS_LIMITS[0] * rise
            next_level = landing.level if above is None else above.level
            levels[index] = (
                landing.level if is_near_entry else next_level,
                next_level if is_near_next else landing.level,
            )
        rows_with_levels = [
            (*row[:5], levels[row[7]][k % 2], *row[6:]) if row[7] else row for k, row in enumerate(rows)
        ]
        return rows_with_levels, heights

    def _height_gained(
        self, plan: FloorPlan, landings: list[Landing], entered: Landing, here: WearerMoved
    ) -> tuple[float, Landing | None]:
        """Return the wearer's height above the landing `entered`, m, and the next landing; 0 and None if unknown."""
        passage = self.references.passage
        if passage is None:
            return 0.0, None
        up = passage.net_up > 0
        exits = find_exits(plan, landings, entered, up, None) or find_exits(plan, landings, entered, not up, None)
        if not exits:
            return 0.0, None
        above = min([landing for landing, _ in exits], key=lambda landing: abs(landing.elevation - entered.elevation))
        rise = above.elevation - entered.elevation
        height = min(passage.height(here.position) or 0.0, abs(rise))
        return (height if rise > 0.0 else -height), above
