"""Changes of level: every row is followed on each level that it may be on.

Activities are evidence, not facts: level walking is taken for stairs, and stairs down for stairs up. Therefore a wearer
who may have changed level is followed on either level, and in either direction, each with its probability; the walls
and later events decide."""

from __future__ import annotations

from math import hypot

from ...events import WearerMoved
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import ConnectorKind, FloorPlan, Point
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO
from .arrivals import all_exits, changing_level, exits
from .landings import Landing, landings, ways_out
from .noise import next_random
from .place_hypotheses import PlaceHypotheses
from .reference import Arrived, Held, References
from .rows import Row, resampled, rounded
from .stride_scale import StrideScale

KNOWN_ROWS = 64
"""Number of rows that are kept once the place is known."""
LONGEST_JUMP = 100.0
"""Longest move of the track that is used, m."""
DEGRADED_FACTOR = 1.5
"""Factor of the errors of a degraded stride: few lack samples, most only a peak beyond the sensor's range."""
SAME_STAIRS_TIME = 10.0
"""Time after an arrival in which stairs are taken for the same ones, s."""
LEAST_SHARE = 0.02
"""Least share of the weight near any landing; with less, the wearer was not where the plan had him."""
OLD_SHARE = {ConnectorKind.STAIRS: 0.85, ConnectorKind.LIFT: 0.5}
"""Share of the weight that the old places then keep, against the landings: level steps may be taken for stairs."""
BOTH_LEVELS = (0.3, 0.8)
"""Limits, as shares of the climb to the next landing, between which the wearer may be on either level.

The height is that of counted steps."""
LEAST_SURE = 0.3
"""Least certainty of an arrival for which the wearer is searched elsewhere."""


@define
class LevelChanges(PlaceHypotheses):
    """Changes the level of the rows near stairs or a lift when the wearer is reported to be on them."""

    last_place: Vec3 = field(default=ZERO, init=False)
    """Place up to which the track has been followed, m."""
    references: References = field(factory=References, init=False)
    stride_scale: StrideScale = field(factory=StrideScale, init=False)
    level_uncertain: bool = field(default=False, init=False)
    """Flag: the level follows only from the reported direction of stairs, which is easily wrong."""
    arrived_at: float | None = field(default=None, init=False)
    """Time of the last arrival on another level, s."""

    def hold(self, plan: FloorPlan, held: Held) -> None:
        """Follow the rows near stairs or a lift both as changing level and as staying."""
        rows = self.rows
        if rows:
            rows = [row for row in rows if not row[7]] or rows
            self.set_rows(rows + changing_level(plan, rows, held.kind, self.displacement_since(held.t)))

    def release(self) -> None:
        """Stop following changes of level: there was none."""
        rows = self.rows
        walking = [row for row in rows if not row[7]]
        self.rows = rounded(walking or [(x, y, a, b, w, level, came, 0) for x, y, a, b, w, level, came, _ in rows])

    def displacement_since(self, t: float) -> Point:
        """Return the displacement of the track since `t` s, m."""
        x, y, _ = self.references.at(t)
        return (
            (self.last_place[0] - x) * self.stride_scale.factor,
            (self.last_place[1] - y) * self.stride_scale.factor,
        )

    def arrive(self, plan: IndexedPlan, arrived: Arrived) -> None:
        """Continue each row that could be on another level from its landing, and all rows if the arrival is unsure."""
        if not any([connector.kind is arrived.kind for connector in plan.plan.connectors]):
            return  # the plan has no such connector
        rows = self.rows
        held = [row for row in rows if row[7]]
        rows = [row for row in rows if not row[7]] or [(*row[:7], 0) for row in rows]
        if rows and not held:
            held = changing_level(plan.plan, rows, arrived.kind, self.displacement_since(arrived.t_start))
        total = sum([row[4] for row in rows])
        again = self.arrived_at is not None and arrived.t_start < self.arrived_at + SAME_STAIRS_TIME
        if held and again and not leads_on(plan.plan, held, arrived.up):
            self.release()  # the rest of a climb that was already taken for the whole
            return
        self.random = next_random(self.random)
        there = exits(plan, held, arrived, self.random)
        found = sum([row[4] for row in there])
        if found <= LEAST_SHARE * total:
            if arrived.sure <= LEAST_SURE:
                self.release()
                return
            there = all_exits(self.scatter, plan, arrived, self.settings.most)
            self.level_uncertain = arrived.kind is ConnectorKind.STAIRS
            found = sum([row[4] for row in there])
            sure = 1.0 - OLD_SHARE[arrived.kind]
            k = total * sure / (1.0 - sure) / found if found > 0.0 and total > 0.0 else 1.0
        else:
            k = arrived.sure / (1.0 - arrived.sure)
            self.level_uncertain = False
        self.arrived_at = arrived.t
        there = [(x, y, a, b, k * w, level, came, 0) for x, y, a, b, w, level, came, _ in there]
        if len(there) > self.settings.most:
            there = self.thin(there, self.settings.most)
        there = self._move_to_now(plan, there, arrived.t) + resampled(rows, KNOWN_ROWS, 0.5)
        if there:
            self.set_rows(there)

    def _move_to_now(self, plan: IndexedPlan, rows: list[Row], t: float) -> list[Row]:
        """Return rows that stand where the wearer was at `t` s, moved to where the track is now."""
        way = self.references.after(t)
        for (x, y, _), (x1, y1, _) in zip(way, way[1:], strict=False):
            move = ((x1 - x) * self.stride_scale.factor, (y1 - y) * self.stride_scale.factor)
            if rows and move != (0.0, 0.0) and hypot(*move) < LONGEST_JUMP:
                rows = self.move_rows(plan, rows, move, DEGRADED_FACTOR, 0.0)
        return rows

    def with_levels(self, plan: FloorPlan, rows: list[Row], here: WearerMoved) -> tuple[list[Row], dict[int, float]]:
        """Return the rows with the level that each is nearer to, and the height of the wearer by landing of entry, m.

        About half-way a row is on either level. The height is no further than the next landing."""
        entered = {row[7] for row in rows if row[7]}
        if not entered:
            return rows, {}
        stops = landings(plan)
        heights: dict[int, float] = {}
        levels: dict[int, tuple[int, int]] = {}
        for index in sorted(entered):
            stop = stops[index - 1]
            height, above = self._height_gained(plan, stops, stop, here)
            heights[index] = stop.elevation + height
            rise = 0.0 if above is None else abs(above.elevation - stop.elevation)
            here_still = above is None or abs(height) < BOTH_LEVELS[1] * rise
            there = above is not None and abs(height) > BOTH_LEVELS[0] * rise
            next_level = stop.level if above is None else above.level
            levels[index] = (stop.level if here_still else next_level, next_level if there else stop.level)
        shown = [(*row[:5], levels[row[7]][k % 2], *row[6:]) if row[7] else row for k, row in enumerate(rows)]
        return shown, heights

    def _height_gained(
        self, plan: FloorPlan, stops: list[Landing], entered: Landing, here: WearerMoved
    ) -> tuple[float, Landing | None]:
        """Return the height of the rows that change level above their landing, m, and the next landing on their way."""
        passage = self.references.passage
        if passage is None:
            return 0.0, None
        up = passage.up > 0
        ways = ways_out(plan, stops, entered, up, None) or ways_out(plan, stops, entered, not up, None)
        if not ways:
            return 0.0, None
        above = min([way for way, _ in ways], key=lambda way: abs(way.elevation - entered.elevation))
        rise = above.elevation - entered.elevation
        height = min(passage.height(here.position) or 0.0, abs(rise))
        return (height if rise > 0.0 else -height), above


def leads_on(plan: FloorPlan, held: list[Row], up: bool) -> bool:
    """Return whether any of the landings that were entered has a way in this direction."""
    stops: list[Landing] = landings(plan)
    return any([ways_out(plan, stops, stops[index - 1], up, None) for index in {row[7] for row in held}])
