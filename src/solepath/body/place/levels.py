"""How readings of the track change level. What the wearer is said to do is evidence and no fact.

Activities err: level walking is taken for stairs, and stairs down for stairs up. So who may have changed level is
followed on either level, and in either direction, each as far as it is likely; the walls and what comes next decide.
"""

from __future__ import annotations

from math import hypot

from ...events import WearerMoved
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import ConnectorKind, FloorPlan, Point
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO
from .arrivals import anew, changing, out
from .crowd import Row, resampled, rounded
from .landings import Landing, landings, ways_out
from .noise import following
from .pace import StrideScale
from .readings import Readings
from .reference import Arrived, Held, References

FEW = 64
"""So many readings of the track are kept once the place is known."""
FARTHEST = 100.0
"""A track that leaps by more is of no use, m."""
ROUGH = 1.5
"""A degraded step errs by so many times as much: few have lost samples, most but a peak that the sensor cannot show."""
SOON = 10.0
"""Stairs that are entered so soon after others, s, are the same ones."""
ELSEWHERE = 0.02
"""With less belief than this near any landing, the wearer was not where the plan had him."""
DOUBT = {ConnectorKind.STAIRS: 0.85, ConnectorKind.LIFT: 0.5}
"""What a belief is worth then, against the landings: level steps may be taken for stairs."""
EITHER = (0.3, 0.8)
"""Who has come so far to the next landing, as shares of the way, may be nearer to either: steps are counted."""
LIKELY = 0.3
"""An arrival that is less sure is no reason to look for the wearer elsewhere."""


@define
class Levels(Readings):
    """Who is near stairs or a lift when they are told of changes level, or does not."""

    last: Vec3 = field(default=ZERO, init=False)
    """Up to where the track has been followed, m."""
    references: References = field(factory=References, init=False)
    pace: StrideScale = field(factory=StrideScale, init=False)
    either: bool = field(default=False, init=False)
    """Only the direction in which stairs were told to lead says which level it is, and that is easily wrong."""
    arrived: float | None = field(default=None, init=False)
    """When the wearer was last said to be on another level, s."""

    def hold(self, plan: FloorPlan, held: Held) -> None:
        """Who is near stairs or a lift may be changing level from now on, or may not: both are followed."""
        rows = self.crowd
        if rows:
            rows = [row for row in rows if not row[7]] or rows
            self.keep(rows + changing(plan, rows, held.kind, self.since(held.t)))

    def release(self) -> None:
        """Nobody was changing level."""
        rows = self.crowd
        walking = [row for row in rows if not row[7]]
        self.crowd = rounded(walking or [(x, y, a, b, w, level, came, 0) for x, y, a, b, w, level, came, _ in rows])

    def since(self, t: float) -> Point:
        """The way since then, m, track."""
        x, y, _ = self.references.at(t)
        return ((self.last[0] - x) * self.pace.factor, (self.last[1] - y) * self.pace.factor)

    def arrive(self, plan: IndexedPlan, arrived: Arrived) -> None:
        """The wearer may be on another level: every reading that could be there goes on from the landing, and all go on
        where they are as far as the arrival is not sure."""
        if not any([connector.kind is arrived.kind for connector in plan.plan.connectors]):
            return  # the plan does not have them all
        rows = self.crowd
        held = [row for row in rows if row[7]]
        rows = [row for row in rows if not row[7]] or [(*row[:7], 0) for row in rows]
        if rows and not held:
            held = changing(plan.plan, rows, arrived.kind, self.since(arrived.t_start))
        total = sum([row[4] for row in rows])
        again = self.arrived is not None and arrived.t_start < self.arrived + SOON
        if held and again and not leads_on(plan.plan, held, arrived.up):
            self.release()  # the rest of a way that was taken for the whole
            return
        self.random = following(self.random)
        there = out(plan, held, arrived, self.random)
        found = sum([row[4] for row in there])
        if found <= ELSEWHERE * total:
            if arrived.sure <= LIKELY:
                self.release()
                return
            there = anew(self.scattered, plan, arrived, self.settings.most)
            self.either = arrived.kind is ConnectorKind.STAIRS
            found = sum([row[4] for row in there])
            sure = 1.0 - DOUBT[arrived.kind]
            k = total * sure / (1.0 - sure) / found if found > 0.0 and total > 0.0 else 1.0
        else:
            k = arrived.sure / (1.0 - arrived.sure)
            self.either = False
        self.arrived = arrived.t
        there = [(x, y, a, b, k * w, level, came, 0) for x, y, a, b, w, level, came, _ in there]
        if len(there) > self.settings.most:
            there = self.thinned(there, self.settings.most)
        there = self._caught_up(plan, there, arrived.t) + resampled(rows, FEW, 0.5)
        if there:
            self.keep(there)

    def _caught_up(self, plan: IndexedPlan, rows: list[Row], t: float) -> list[Row]:
        """Rows that stand where the wearer was at `t`, s, led on to where the track is now."""
        way = self.references.after(t)
        for (x, y, _), (x1, y1, _) in zip(way, way[1:], strict=False):
            move = ((x1 - x) * self.pace.factor, (y1 - y) * self.pace.factor)
            if rows and move != (0.0, 0.0) and hypot(*move) < FARTHEST:
                rows = self.stepped(plan, rows, move, ROUGH, 0.0)
        return rows

    def shown(self, plan: FloorPlan, rows: list[Row], here: WearerMoved) -> tuple[list[Row], dict[int, float]]:
        """Who changes level is on the one that is nearer, and about half-way on either. The rows so, and for every
        landing at which one of them entered the height that they have come to, m, no further than the next landing."""
        entered = {row[7] for row in rows if row[7]}
        if not entered:
            return rows, {}
        stops = landings(plan)
        heights: dict[int, float] = {}
        levels: dict[int, tuple[int, int]] = {}
        for index in sorted(entered):
            stop = stops[index - 1]
            height, above = self._climbed(plan, stops, stop, here)
            heights[index] = stop.elevation + height
            rise = 0.0 if above is None else abs(above.elevation - stop.elevation)
            here_still = above is None or abs(height) < EITHER[1] * rise
            there = above is not None and abs(height) > EITHER[0] * rise
            next_level = stop.level if above is None else above.level
            levels[index] = (stop.level if here_still else next_level, next_level if there else stop.level)
        told = [(*row[:5], levels[row[7]][k % 2], *row[6:]) if row[7] else row for k, row in enumerate(rows)]
        return told, heights

    def _climbed(
        self, plan: FloorPlan, stops: list[Landing], entered: Landing, here: WearerMoved
    ) -> tuple[float, Landing | None]:
        """How far above where they entered those are who change level, m, and the next landing on their way."""
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
    """Whether there is a way up, or down, from where anybody has entered."""
    stops: list[Landing] = landings(plan)
    return any([ways_out(plan, stops, stops[index - 1], up, None) for index in {row[7] for row in held}])
