"""What the wearer does: standing, walking, running, stairs and lifts, for any recipe.

Each foot is looked at in blocks of half a second (features.py) and says of every block how likely each way of moving is
(motion.py). The feet's votes, what a lift adds to the force on a standing foot (ride.py) and the slope of the air
pressure, where there is a barometer (air.py), are the evidence of a chain of sixteen states that is followed by
Viterbi's algorithm (hypotheses.py).

When what is known: a block is judged when two more have come, 1 to 1.5 s after it. The likeliest course is told at
once, not final; what all courses that are still likely agree on is told again as final, mostly seconds later. Standing
that may still turn out to be a ride whose beginning nobody felt stays open for up to a minute, a ride's end for 12 s.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import floor
from typing import ClassVar, Final

from ...events import ActivityChanged, Event, LiftRidden, StrideFeatures, StrideTaken
from ...foot.view import FootView
from ...types import Activity, Foot, Site
from ...types.attrs import define, field, frozen
from ...types.vector import TIE, ZERO
from ..part import ActivityPart, PartOutput
from .air import NOTHING, PressureHeight
from .features import BLOCK, REACH
from .flights import Flights
from .foot_blocks import FootBlocks
from .hypotheses import ActivitySegment, BlockEvidence, Hypotheses
from .motion import MotionModel, shipped
from .votes import felt, motions

LEFT: Final = Foot.LEFT
"""Looked up once: a word of an enum costs as much as five multiplications."""

SILENT = 3
"""Blocks after which a foot is not waited for."""
PATIENT = 60
"""Blocks of silence that are gone through one by one."""
WOBBLE = 1.0
"""What is not final is not told again because it began this little earlier or later, s."""
WAITING = 8
"""Steps that may wait for their activity."""
NO_MORE = StrideFeatures(0.0, 0.0, 0.0)
NOWHERE = (0.0,) * 6
"""Of those that wait nobody asks for more than their times and heights."""
AFOOT = {Activity.STAIRS_UP: 1, Activity.STAIRS_DOWN: -1}
RIDDEN = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}


@frozen
class ActivitiesSettings:
    """What `Activities` is set to."""

    model: MotionModel | None = None
    """What was learnt of moving feet; None: what comes with this release."""


@define
class Activities(ActivityPart):
    """Says what the wearer does, and tells flights of stairs and rides in a lift."""

    needs_samples: ClassVar[bool] = True

    settings: ActivitiesSettings = ActivitiesSettings()
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """The newest that was told, final or not."""
    origin: float | None = field(default=None, init=False)
    """When block 0 began, s."""
    next: int = field(default=0, init=False)
    """The block that is judged next."""
    left: FootBlocks = field(factory=FootBlocks, init=False)
    right: FootBlocks = field(factory=FootBlocks, init=False)
    air: PressureHeight = field(factory=PressureHeight, init=False)
    courses: Hypotheses = field(factory=Hypotheses, init=False)
    told: list[ActivitySegment] = field(factory=list, init=False)
    """What was told and is not final, in the order of time."""
    instead: float | None = field(default=None, init=False)
    """`t` of what was told after that, not final either: that what was told of then was wrong, s."""
    flights: Flights = field(factory=Flights, init=False)
    steps: deque[StrideTaken] = field(factory=deque, init=False)
    """Steps whose activity is not known yet, without their features."""

    def ready(self) -> None:
        """What was learnt is read."""
        if self.settings.model is None:
            shipped()

    def reset(self, site: Site) -> None:
        """The clock of the samples of a site restarts: what is under way there is forgotten."""
        if site.foot is None:
            return
        (self.left if site.foot is LEFT else self.right).restart()
        self.flights.reset()
        self.steps.clear()
        if self.left.index is None and self.right.index is None:
            self._restart()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A sample of a foot, a barometer's too, and what came of it."""
        sample = view.sample
        acc, t, origin = sample.acc, sample.t, self.origin
        side = self.left if view.foot is LEFT else self.right
        if origin is None:
            if acc is None:
                return ()
            self.origin = origin = t
        since = (t - origin + TIE) / BLOCK
        told: Sequence[PartOutput] = ()
        if sample.air_pressure is not None and side.index is not None:
            self.air.add(view.foot, floor(since), sample.air_pressure)
        if acc is not None:
            if side.index is None or since >= side.index + 1:
                side.close()
                side.begin(floor(since), view.gyro_bias, view.acc_grain)
                told = self._judge(t, view.known_at)
            side.add(acc, sample.gyro, view if view.levelled else None)
        if view.events:
            side.heard(view.events, view.position[2])
            for event in view.events:
                if isinstance(event, StrideTaken):
                    self.steps.append(_slimmed(event, event.known_at))
                    if len(self.steps) > WAITING:
                        self.steps.popleft()
        return told

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Nothing more comes: what was told so far is final, and so is what is said of the last second."""
        told: list[Event] = []
        sides = [side for side in (self.left, self.right) if side.index is not None]
        last = max([side.index for side in sides if side.index is not None], default=-1)
        for side in sides:
            side.close()
        while self.next <= last and last - self.next < PATIENT:
            self._judge_block(self.next)
            self.next += 1
        self._tell(now, told, True)
        return told

    def _judge(self, t: float, known_at: float) -> list[Event]:
        """Judge the blocks that are complete in all feet that are heard."""
        heard = [side.index for side in (self.left, self.right) if side.index is not None]
        newest = max(heard)
        complete = min([index for index in heard if newest - index < SILENT]) - 1 - REACH
        if complete < self.next:
            return []
        told: list[Event] = []
        quiet = 0
        while self.next <= complete:
            quiet = 0 if self._judge_block(self.next) else quiet + 1
            self.next += 1
            if quiet > PATIENT:
                self.next = max(self.next, complete - REACH)
        self._tell(known_at, told)
        self._count_flights(t, known_at, told)
        return told

    def _judge_block(self, index: int) -> bool:
        """Whether anything was heard in it."""
        t = self._time(index)
        model = self.settings.model or shipped()
        sides = (self.left, self.right)
        said = [side.features(index, t + 0.5 * BLOCK) for side in sides]
        air = self.air
        climbs = air.climbs(index, BLOCK) if air.blocks else NOTHING
        self.courses.update(
            BlockEvidence(
                t=t,
                motions=motions(model, said),
                felt=tuple([felt(side.block(index), side.grain) for side in sides]),
                climbs=climbs,
                before=air.height(index - 3, index - 1),
                after=air.height(index, index + REACH),
            ),
            model.chain,
        )
        return any([features is not None for features in said])

    def _time(self, index: int) -> float:
        return (0.0 if self.origin is None else self.origin) + index * BLOCK

    def _restart(self) -> None:
        self.origin = None
        self.next = 0
        self.air = PressureHeight()
        self.courses = Hypotheses()
        self.told, self.instead = [], None

    def _tell(self, known_at: float, events: list[Event], at_last: bool = False) -> None:
        """What is new of the likeliest course; `at_last`: all of it is settled."""
        courses = self.courses
        for begun, before, likely in courses.settle(self._time(self.next) + (1e6 if at_last else 0.0)):
            if before is not None and before.activity in RIDDEN:
                events.append(_ridden(before, begun.t, known_at))
            events.append(self._changed(begun, known_at, True, self.told[0].t if self.told else self.instead, likely))
            self.told, self.instead = [], None
        best = courses.best
        if best is None:
            return
        open_ = best.path if courses.settled is None else best.path[1:]
        same = 0
        for old, new in zip(self.told, open_, strict=False):
            if old.activity is not new.activity or abs(old.t - new.t) > WOBBLE:
                break
            same += 1
        dropped, fresh = self.told[same:], list(open_[same:])
        revised = dropped[0].t if dropped else self.instead
        if dropped and not fresh:
            # nothing takes its place but what went before it
            self._go_on(same, dropped[0].t, known_at, False, events)
        for segment in fresh:
            events.append(self._changed(segment, known_at, False, revised, courses.probability(segment)))
            revised = self.instead = None
        self.told = [*self.told[:same], *fresh]
        if at_last and self.instead is not None:
            self._go_on(same, self.instead, known_at, True, events)

    def _go_on(self, same: int, t: float, known_at: float, final: bool, events: list[Event]) -> None:
        """What was told of `t`, s, was wrong, and what went before it goes on."""
        settled = Activity.UNKNOWN if self.courses.settled is None else self.courses.settled
        on = ActivitySegment(t, self.told[same - 1].activity if same else settled)
        events.append(self._changed(on, known_at, final, t, self.courses.probability(on)))
        self.instead = None if final else t

    def _changed(
        self, segment: ActivitySegment, known_at: float, final: bool, revises: float | None, probability: float
    ) -> ActivityChanged:
        self.activity = segment.activity
        return ActivityChanged(
            t=segment.t,
            known_at=max(known_at, segment.t),
            final=final,
            activity=segment.activity,
            probability=probability,
            revises=revises,
        )

    def _count_flights(self, t: float, known_at: float, events: list[Event]) -> None:
        """The steps up to the block that was judged last, each with what the wearer did in its middle."""
        until = self._time(self.next)
        best = self.courses.best
        path: Sequence[ActivitySegment] = () if best is None else best.path
        while self.steps and 0.5 * (self.steps[0].t_start + self.steps[0].t_end) < until:
            step = self.steps.popleft()
            middle = 0.5 * (max(step.t_start, step.t_end - 1.6) + step.t_end)
            doing = Activity.UNKNOWN
            for segment in path:
                if segment.t <= middle:
                    doing = segment.activity
            known = _slimmed(step, max(known_at, step.known_at))
            events += self.flights.stepped(known, AFOOT.get(doing, 0))
        events += self.flights.waited(t, known_at)


def _slimmed(step: StrideTaken, known_at: float) -> StrideTaken:
    """What flights ask for: times and heights."""
    return StrideTaken(
        t=step.t,
        known_at=known_at,
        final=step.final,
        foot=step.foot,
        number=step.number,
        t_start=step.t_start,
        t_end=step.t_end,
        displacement=ZERO,
        position=ZERO,
        length=step.length,
        heading_change=step.heading_change,
        height_change=step.height_change,
        covariance=NOWHERE,
        t_toe_off=step.t_toe_off,
        t_heel_strike=step.t_heel_strike,
        degraded=step.degraded,
        features=NO_MORE,
    )


def _ridden(ride: ActivitySegment, over: float, known_at: float) -> LiftRidden:
    start = ride.t if ride.from_ is None else ride.from_
    end = max(start, over if ride.to is None else ride.to)
    return LiftRidden(t=end, known_at=max(known_at, end), t_start=start, up=RIDDEN[ride.activity], height=ride.height)
