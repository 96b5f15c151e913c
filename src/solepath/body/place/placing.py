"""Where on a floor plan the wearer is: what both methods have in common.

The track has a shape, but nobody knows how it lies in the plan. Stairs and lifts tell a place (a known start does,
too); walls tell the rest: of all ways in which the track could lie there, those that lead through walls are wrong (Liu
et al. 2015, section IV.E). Stairs and lifts lead to another level, and where they end is where the plan has it.

The track itself is never bent. Latency: a place is told with the step that leads there, a level as reference.py says.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, isfinite, pi
from typing import ClassVar

from ...events import Event, Placed, PlaceLost, StrideTaken, TurnMade, WearerMoved
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ...types.attrs import NOT_SAVED, define, field
from ..part import MOVEMENTS, PartInput, PartOutput
from .arrivals import fan, nowhere
from .crowd import AGREED, Row, believed, effective, rounded
from .levels import FARTHEST, FEW, ROUGH, Levels
from .readings import ABOUT, looked, mistold
from .reference import Arrived, Held

MORE = 30
"""So many more readings are kept for every other candidate, when it is not faint, than once the place is known."""
OUTSIDE = 6
"""After so many steps outside of everything that the plan has, the wearer has left it."""
LOOK = 4
"""Every so many steps it is looked who has left the plan."""
WIDE = 12
"""Steps until the walls have decided which way an about-turn led."""
APART = 0.5
"""Until then all places together are one candidate only when they differ by no more (rms), m."""
STUCK = 5.0
"""When nobody could go on for so much of the track, m, there is no way."""
CLEAR, FADE, ASIDE = 0.9, 0.88, 3.0
"""Where one place has so much of the belief, the one that is within `ASIDE`, m, of it on another level keeps so much of
its own with each step: floors are often alike, and then no wall ever decides."""


@define
class Placing(Levels):
    """What both methods do alike: they start, change level, end and tell. How they extend the track is their own."""

    needs_position: ClassVar[bool] = True

    plan: IndexedPlan | None = field(default=None, init=False, eq=False, repr=False, metadata=NOT_SAVED)
    """Where the wearer is; whoever makes or restores a session sets it, since it is not saved."""
    waiting: list[Event] = field(factory=list, init=False)
    """What was said since the wearer moved last."""
    start: Start | None = field(default=None, init=False)
    begun: bool = field(default=False, init=False)
    t: float | None = field(default=None, init=False)
    steps: int = field(default=0, init=False)
    outside: int = field(default=0, init=False)
    """Steps since the wearer was last within the plan."""
    wide: int = field(default=0, init=False)
    """Steps for which more readings are kept than belief asks for."""
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

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """What leads somewhere waits until it is known where the wearer is after it."""
        if isinstance(event, MOVEMENTS):
            self.waiting.append(event)
        elif isinstance(event, WearerMoved) and self.plan is not None:
            events, self.waiting = self.waiting, []
            return self.follow(self.plan, events, event)
        return ()

    def follow(self, plan: IndexedPlan, events: list[Event], here: WearerMoved) -> list[Event]:
        """One step, one activity, or what has come together; the wearer is `here` after it. Never raises, whatever the
        track does."""
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
        steps = [event for event in events if isinstance(event, StrideTaken)]
        for step in steps:
            self.pace.stepped(step, here.position)
        if steps:
            self._move(plan, here, steps, known_at, told)
        for event in events:
            if isinstance(event, TurnMade) and abs(event.angle) > ABOUT and self.crowd:
                self._turned(plan, event.t)
        arrived = False
        for reference in self.references.hear(plan.plan, events, here):
            match reference:
                case Held():
                    self.hold(plan.plan, reference)
                case Arrived():
                    self.arrive(plan, reference)
                    arrived = True
                case _:
                    self.release()
        if (steps or arrived) and self.crowd:
            told.append(self._told(plan, here, known_at))
        return told

    def _begin(self, plan: IndexedPlan, here: WearerMoved, known_at: float, told: list[Event]) -> None:
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
        count = self.settings.most if start.heading is None else 2 * FEW
        self.crowd = rounded(fan(self.scattered, plan, level, start.place, start.spread, start.heading, count, 0, 1.0))

    def _move(
        self, plan: IndexedPlan, here: WearerMoved, steps: list[StrideTaken], known_at: float, told: list[Event]
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
        rows = self.crowd
        if not rows:
            return
        move = (move[0] * self.pace.factor, move[1] * self.pace.factor)
        before = self.newest
        came_from = rows
        # each foot turns as the wearer does, and each tells it by its own step
        turned = min(0.5 * sum([abs(step.heading_change) for step in steps]), pi)
        rough = ROUGH if any([step.degraded for step in steps]) else 1.0
        rows = self.stepped(plan, rows, move, rough, turned)
        self.steps = (self.steps + 1) % LOOK
        if self.steps == 0:
            rows = looked(plan, rows)
        stays = _stay(rows, came_from)
        self.stuck = self.stuck + hypot(*move) if stays else 0.0
        self.crowd = rounded(rows) if self.stuck <= STUCK else []
        if not self.crowd:
            where = "" if before is None else f" near ({before.position[0]:.1f}, {before.position[1]:.1f})"
            level = "" if before is None else f" on level {before.level}"
            told.append(
                PlaceLost(t=here.t, known_at=known_at, what=f"the track goes where the plan has no way{where}{level}")
            )
            self._forget()

    def _turned(self, plan: IndexedPlan, t: float) -> None:
        """The wearer has turned about, until `t` s."""
        rows = self.crowd
        self.keep(rows + mistold(plan, rows, self.since(t)))
        self.wide = WIDE

    def _forget(self) -> None:
        self.crowd, self.newest, self.outside, self.stuck = [], None, 0, 0.0

    def _told(self, plan: IndexedPlan, here: WearerMoved, known_at: float) -> Event:
        rows = self.crowd
        known = plan.plan.heights_known
        shown, heights = self.shown(plan.plan, rows, here)
        candidates, spread = believed(
            shown, plan.plan, heights, None if known else here.position[2], AGREED if self.wide == 0 else APART
        )
        first = candidates[0]
        if len(candidates) == 1 and not plan.inside(plan.number(first.level), first.position[0], first.position[1]):
            self.outside += 1
            if self.outside >= OUTSIDE and self.references.passage is None:
                self._forget()
                x, y, _ = first.position
                what = f"the track leaves the plan near ({x:.1f}, {y:.1f}) on level {first.level}"
                return PlaceLost(t=here.t, known_at=known_at, what=what)
        else:
            self.outside = 0
        others = sum([min(1.0, 10.0 * one.weight) for one in candidates[1:]])
        wanted = min(self.settings.most, FEW + int(MORE * others if others else 8.0 * min(spread, 5.0)))
        if self.wide > 0:
            self.wide, wanted = self.wide - 1, self.settings.most
        few = len(rows) <= 1.25 * wanted and (self.wide > 0 or effective(rows) >= 0.5 * wanted)
        if first.weight >= CLEAR and len(candidates) > 1 and self.wide == 0 and not self.either:
            x0, y0 = plan.plan.origin
            x, y, at = first.position[0] - x0, first.position[1] - y0, plan.number(first.level)
            rows = [
                (*row[:4], FADE * row[4], *row[5:])
                if told[5] != at and (row[0] - x) ** 2 + (row[1] - y) ** 2 < ASIDE * ASIDE
                else row
                for row, told in zip(rows, shown, strict=True)
            ]
            self.crowd = rounded(rows)
        if not few:
            self.crowd = rounded(self.thinned(rows, wanted))
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
    """Whether all are where some were before. Most often the first one is not."""
    if rows:
        x, y = rows[0][:2]
        if not any([row[0] == x and row[1] == y for row in before]):
            return False
    places = {row[:2] for row in before}
    return all([row[:2] in places for row in rows])
