"""Where on a floor plan the wearer is: what a session asks of the part, and what both methods have in common.

The track has a shape, but nobody knows how it lies in the plan. Stairs and lifts tell a place (a known start does,
too); walls tell the rest: of all ways in which the track could lie there, those that lead through walls are wrong (Liu
et al. 2015, section IV.E). Stairs and lifts lead to another level, and where they end is where the plan has it.

The track itself is never bent. Latency: a place is told with the step that leads there, a level as reference.py says.
"""

from __future__ import annotations

from math import hypot, isfinite, pi
from typing import Protocol

from attrs import define, field

from ...events import Event, Placed, PlaceLost, StepTaken
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import FloorPlan, Kind, Point, Start
from ...types import Vec3
from ...vector import ZERO
from ..position import Position
from .arrivals import anew, changing, fan, nowhere, out
from .crowd import Row, believed, effective, origin_of, packed, resampled, unpacked
from .landings import landings, ways_out
from .noise import NOISE, ROWS, following
from .pace import Pace
from .reference import Arrived, Held, References


class PlacePart(Protocol):
    """The track and what the wearer does in, the place on the plan out. A plain record, as every machine is."""

    def set_out(self, start: Start) -> None:
        """The wearer sets out there. To be told before the first `follow`. ValueError for what is no number."""

    def follow(self, plan: IndexedPlan, events: list[Event], here: Position) -> list[Event]:
        """`events`: what has just become known, of steps and of what the wearer does; `here`: where the track leads
        now, world frame. Always with the same plan. Returns Placed or PlaceLost, or nothing."""

    @property
    def place(self) -> Placed | None:
        """Where the wearer is on the plan; None while it is of no use."""


FEW = 64
"""So many readings of the track are kept once the place is known ..."""
MORE = 40
"""... so many more for every other candidate ..."""
JUMP = 4.0
"""A move of more than this between two steps is across a gap, m: which way it went is not known."""
FARTHEST = 100.0
"""A track that leaps by more is of no use, m."""
OUTSIDE = 6
"""After so many steps outside of everything that the plan has, the wearer has left it."""
ROUGH = 1.5
"""A degraded step errs by so many times as much: few have lost samples, most but a peak that the sensor cannot show."""
LOOK, OUT = 4, 0.25
"""Every so many steps it is looked who has left the plan, and such a one counts so much less than those within."""
STUCK = 5.0
"""When nobody could go on for so much of the track, m, there is no way."""
SOON = 10.0
"""Stairs that are entered so soon after others, s, are the same ones."""
ELSEWHERE = 0.02
"""With less belief than this near any landing, the wearer was not where the plan had him."""
DOUBT = {Kind.STAIRS: 0.85, Kind.LIFT: 0.5}
"""What a belief is worth then, against the landings: level steps may be taken for stairs."""


@define
class Placing:
    """What both methods do alike: they start, change level, end and tell. How they extend the track is their own."""

    most: int = 300
    """More readings of the track than this are never kept."""
    # state
    start: Start | None = field(default=None, init=False)
    begun: bool = field(default=False, init=False)
    crowd: bytes = field(default=b"", init=False)
    last: Vec3 = field(default=ZERO, init=False)
    """Up to where the track has been followed, m."""
    t: float | None = field(default=None, init=False)
    references: References = field(factory=References, init=False)
    pace: Pace = field(factory=Pace, init=False)
    random: int = field(default=1, init=False)
    arrived: float | None = field(default=None, init=False)
    """When the wearer was last said to be on another level, s."""
    steps: int = field(default=0, init=False)
    outside: int = field(default=0, init=False)
    """Steps since the wearer was last within the plan."""
    stuck: float = field(default=0.0, init=False)
    """Track, m, since anybody could go on."""
    newest: Placed | None = field(default=None, init=False)

    @property
    def place(self) -> Placed | None:
        """Where the wearer is on the plan; None while it is of no use."""
        return self.newest

    def set_out(self, start: Start) -> None:
        """The wearer sets out there. To be told before the first `follow`. ValueError for what is no number."""
        numbers = (*start.place, start.spread, 0.0 if start.heading is None else start.heading)
        if not all([isfinite(number) for number in numbers]):
            raise ValueError(f"a start's place, heading and spread are numbers, not {numbers}")
        self.start = start

    def follow(self, plan: IndexedPlan, events: list[Event], here: Position) -> list[Event]:
        """One step, one activity, or what has come together. Never raises, whatever the track does."""
        told: list[Event] = []
        if not all([isfinite(v) for v in (here.t, *here.position)]):
            return told
        known_at = max([here.t, *[event.known_at for event in events]])
        if not self.begun:
            self.begun = True
            self._begin(plan, here, known_at, told)
        if self.t is not None and here.t < self.t - 1.0:
            self.references.forget()
            self.arrived = None
        self.t = here.t
        steps = [event for event in events if isinstance(event, StepTaken)]
        for step in steps:
            self.pace.stepped(step, here.position)
        if steps:
            self._move(plan, here, steps, known_at, told)
        for reference in self.references.hear(plan.plan, events, here):
            match reference:
                case Held():
                    self._hold(plan.plan, reference)
                case Arrived():
                    self._arrive(plan, reference)
                case _:
                    self._release()
        if steps and self.crowd:
            told.append(self._told(plan, here, known_at))
        return told

    # --- how a method differs ---

    def extended(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The rows a move (m, track) further; without those that cannot go there. `rough`: how much worse than usual
        the track is. `turned`: by how much the wearer has turned with it, rad, not negative."""
        raise NotImplementedError

    def scattered(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        raise NotImplementedError

    def thinned(self, rows: list[Row], wanted: int) -> list[Row]:
        """About so many rows that stand for all."""
        raise NotImplementedError

    # --- the flow ---

    def _begin(self, plan: IndexedPlan, here: Position, known_at: float, told: list[Event]) -> None:
        start = self.start
        if start is None:
            what = "no start was given, so the place is not known before the first stairs or lift"
            if not plan.plan.connectors:
                what = "no start was given and the plan has neither stairs nor lifts: the place cannot be known"
            told.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self.last = here.position
            return
        why_not = nowhere(plan, start)
        if why_not is not None:
            told.append(PlaceLost(t=here.t, known_at=known_at, what=why_not))
            self.last = here.position
            return
        level = plan.number(start.level)
        count = self.most if start.heading is None else 2 * FEW
        self.crowd = packed(fan(self.scattered, plan, level, start.place, start.spread, start.heading, count, 0, 1.0))

    def _move(
        self, plan: IndexedPlan, here: Position, steps: list[StepTaken], known_at: float, told: list[Event]
    ) -> None:
        """The track since the last step, for all rows."""
        x, y, _ = here.position
        move = (x - self.last[0], y - self.last[1])
        if not (abs(move[0]) < FARTHEST and abs(move[1]) < FARTHEST):
            self.last = here.position
            if self.crowd:
                what = f"the track leaps by more than {FARTHEST:.0f} m"
                told.append(PlaceLost(t=here.t, known_at=known_at, what=what))
            self._forget()
            return
        self.last = here.position
        rows = unpacked(self.crowd)
        if not rows:
            return
        move = (move[0] * self.pace.factor, move[1] * self.pace.factor)
        before = self.newest
        places = {row[:2] for row in rows}
        # each foot turns as the wearer does, and each tells it by its own step
        turned = min(0.5 * sum([abs(step.heading_change) for step in steps]), pi)
        rough = ROUGH if any([step.degraded for step in steps]) else 1.0
        rows = self._stepped(plan, rows, move, rough, turned)
        self.steps = (self.steps + 1) % LOOK
        if self.steps == 0:
            rows = self._looked(plan, rows)
        stays = all(row[:2] in places for row in rows)
        self.stuck = self.stuck + hypot(*move) if stays else 0.0
        self.crowd = packed(rows) if self.stuck <= STUCK else b""
        if not self.crowd:
            where = "" if before is None else f" near ({before.position[0]:.1f}, {before.position[1]:.1f})"
            level = "" if before is None else f" on level {before.level}"
            told.append(
                PlaceLost(t=here.t, known_at=known_at, what=f"the track goes where the plan has no way{where}{level}")
            )
            self._forget()

    def _looked(self, plan: IndexedPlan, rows: list[Row]) -> list[Row]:
        """Who is where nobody can be counts less."""
        x0, y0 = origin_of(plan.plan)
        looked: list[Row] = []
        for row in rows:
            x, y, a, b, w, level, came, held = row
            there = held or plan.inside(level, x0 + x, y0 + y)
            looked.append(row if there else (x, y, a, b, OUT * w, level, came, held))
        return looked

    def _stepped(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        dx, dy = move
        changing = [row for row in rows if row[7]]
        walking = [row for row in rows if not row[7]] if changing else rows
        if hypot(dx, dy) > JUMP:
            walking = self._jumped(plan, walking, move)
        elif walking:
            walking = self.extended(plan, walking, move, rough, turned)
        # on stairs one goes as the track says: the walls around them are those of one level or the other
        carried = [
            (x + a * dx - b * dy, y + b * dx + a * dy, a, b, w, level, origin, held)
            for x, y, a, b, w, level, origin, held in changing
        ]
        return carried + walking

    def _jumped(self, plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
        """Across a gap: walls on the straight way say nothing, but the end must be somewhere."""
        dx, dy = move
        off = 0.3 * hypot(dx, dy)
        x0, y0 = origin_of(plan.plan)
        self.random = following(self.random)
        kept: list[Row] = []
        for k, (x, y, a, b, w, level, origin, held) in enumerate(rows):
            for j in (0, 1):
                ex, ey, _, _ = NOISE[(self.random + 2 * k + j) % ROWS]
                nx, ny = x + a * dx - b * dy + off * ex, y + b * dx + a * dy + off * ey
                if plan.inside(level, nx + x0, ny + y0):
                    kept.append((nx, ny, a, b, w, level, origin, held))
        return kept if len(kept) <= self.most else resampled(kept, self.most, 0.5)

    def _forget(self) -> None:
        self.crowd, self.newest, self.outside, self.stuck = b"", None, 0, 0.0

    # --- levels ---

    def _hold(self, plan: FloorPlan, held: Held) -> None:
        """Who is near stairs or a lift may be changing level from now on, or may not: both are followed."""
        rows = unpacked(self.crowd)
        if rows:
            self.crowd = packed(rows + changing(plan, rows, held.kind, self._since(held.t)))

    def _release(self) -> None:
        """Nobody was changing level."""
        rows = unpacked(self.crowd)
        walking = [row for row in rows if not row[7]]
        self.crowd = packed(walking or [(x, y, a, b, w, level, came, 0) for x, y, a, b, w, level, came, _ in rows])

    def _since(self, t: float) -> Point:
        """The way since then, m, track."""
        x, y, _ = self.references.at(t)
        return ((self.last[0] - x) * self.pace.factor, (self.last[1] - y) * self.pace.factor)

    def _arrive(self, plan: IndexedPlan, arrived: Arrived) -> None:
        """The wearer is on another level: every reading that could be there goes on from the landing."""
        rows = unpacked(self.crowd)
        if not any([connector.kind is arrived.kind for connector in plan.plan.connectors]):
            return  # the plan does not have them all
        held = [row for row in rows if row[7]]
        rows = [row for row in rows if not row[7]] or rows
        if rows and not held:
            held = changing(plan.plan, rows, arrived.kind, self._since(arrived.t_start))
        total = sum([row[4] for row in rows])
        self.random = following(self.random)
        there = out(plan, held, arrived, arrived.up, self.random)
        again = self.arrived is not None and arrived.t_start < self.arrived + SOON
        if not there and held and again:
            self._release()  # the rest of a way that was taken for the whole
            return
        if not there:
            # to a foot, stairs up and down look much alike: from where there is no way up, one has gone down
            there = out(plan, held, arrived, not arrived.up, self.random)
        self.arrived = arrived.t
        if sum([row[4] for row in there]) <= ELSEWHERE * total:
            there = anew(self.scattered, plan, arrived, self.most)
            weight = sum([row[4] for row in there])
            if rows and weight > 0.0 and total > 0.0:
                doubt = DOUBT[arrived.kind]
                each = weight * doubt / (1.0 - doubt) / FEW
                kept = resampled(rows, FEW, 0.5)
                stayed = [(x, y, a, b, each, level, came, 0) for x, y, a, b, _, level, came, _ in kept]
                there = self._caught_up(plan, there, arrived.t) + stayed
                self.crowd = packed(self.thinned(there, self.most) if len(there) > self.most else there)
                return
        if len(there) > self.most:
            there = self.thinned(there, self.most)
        there = self._caught_up(plan, there, arrived.t)
        if there:
            self.outside = 0
            self.crowd = packed(there)

    def _caught_up(self, plan: IndexedPlan, rows: list[Row], t: float) -> list[Row]:
        """Rows that stand where the wearer was at `t`, s, led on to where the track is now."""
        way = [place for place in self.references.after(t)]
        for (x, y, _), (x1, y1, _) in zip(way, way[1:], strict=False):
            move = ((x1 - x) * self.pace.factor, (y1 - y) * self.pace.factor)
            if rows and move != (0.0, 0.0) and abs(move[0]) < FARTHEST and abs(move[1]) < FARTHEST:
                rows = self._stepped(plan, rows, move, ROUGH, 0.0)
        return rows

    # --- what is told ---

    def _told(self, plan: IndexedPlan, here: Position, known_at: float) -> Event:
        rows = unpacked(self.crowd)
        origin = origin_of(plan.plan)
        candidates, spread = believed(rows, plan.plan, origin, self._climbed(plan.plan, rows, here))
        first = candidates[0]
        if len(candidates) == 1 and not plan.inside(
            plan.number(first.level), first.position[0], first.position[1]
        ):
            self.outside += 1
            if self.outside >= OUTSIDE and self.references.passage is None:
                self._forget()
                x, y, _ = first.position
                what = f"the track leaves the plan near ({x:.1f}, {y:.1f}) on level {first.level}"
                return PlaceLost(t=here.t, known_at=known_at, what=what)
        else:
            self.outside = 0
        wanted = min(self.most, FEW + MORE * (len(candidates) - 1) + int(8.0 * min(spread, 5.0)))
        if len(rows) > 1.25 * wanted or effective(rows) < 0.5 * wanted:
            self.crowd = packed(self.thinned(rows, wanted))
        self.newest = Placed(
            t=here.t,
            known_at=known_at,
            level=first.level,
            position=first.position,
            spread=spread,
            candidates=candidates,
        )
        return self.newest

    def _climbed(self, plan: FloorPlan, rows: list[Row], here: Position) -> float:
        """How far above where they entered those are who change level, m: no further than the next landing."""
        passage = self.references.passage
        held = next((row[7] for row in rows if row[7]), 0)
        if passage is None or not held:
            return 0.0
        stops = landings(plan)
        ways = ways_out(stops, stops[held - 1], passage.up > 0, None)
        rises = [way.elevation - stops[held - 1].elevation for way, _ in ways]
        most = min([abs(rise) for rise in rises if (rise > 0.0) is (passage.up > 0)], default=0.0)
        height = min(passage.height(here.position) or 0.0, most)
        return height if passage.up > 0 else -height
