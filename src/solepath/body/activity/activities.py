"""Activities of the wearer: standing, walking, running, stairs and lifts, for any recipe.

The samples of each foot are cut into blocks of half a second (features.py), and every block gives a likelihood of each
motion (motion.py). The votes of the feet, the force that a lift adds on a standing foot (ride.py) and the slope of the
air pressure, where there is a barometer (pressure_height.py), are the evidence of a chain of sixteen states that is
followed by Viterbi's algorithm (hypotheses.py).

Latency: a block is judged when two more have come, 1 to 1.5 s after it. The likeliest course is reported at once, not
final. The part on which all likely courses agree is reported again as final, mostly seconds later. Standing that may
still turn out to be a ride whose start was not detected stays open for up to a minute, a ride's end for 12 s."""

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
from .features import BLOCK, REACH
from .flights import Flights
from .foot_blocks import FootBlocks
from .hypotheses import ActivitySegment, BlockEvidence, Hypotheses
from .motion import MotionModel, shipped
from .pressure_height import NO_EVIDENCE, PressureHeight
from .votes import block_force, motion_votes

LEFT: Final = Foot.LEFT
"""The left foot, looked up once: access to an enum member costs as much as five multiplications."""

SILENT_BLOCKS = 3
"""Number of blocks after which a silent foot is not waited for."""
MOST_EMPTY_BLOCKS = 60
"""Largest number of consecutive empty blocks that are judged one by one."""
TIME_TOLERANCE = 1.0
"""Largest change in the start of a provisional activity that is not reported again, s."""
MOST_WAITING = 8
"""Largest number of strides that wait for their activity."""
NO_FEATURES = StrideFeatures(0.0, 0.0, 0.0)
NO_COVARIANCE = (0.0,) * 6
"""Covariance of strides that wait: only their times and heights are used."""
STAIR_DIRECTIONS = {Activity.STAIRS_UP: 1, Activity.STAIRS_DOWN: -1}
RIDES_UP = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}


@frozen
class ActivitiesSettings:
    """The settings of `Activities`."""

    model: MotionModel | None = None
    """Motion model; None: the one of this release."""


@define
class Activities(ActivityPart):
    """Reports the wearer's activity, flights of stairs and lift rides."""

    needs_samples: ClassVar[bool] = True

    settings: ActivitiesSettings = ActivitiesSettings()
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """The newest activity that was reported, final or not."""
    origin: float | None = field(default=None, init=False)
    """Start of block 0, s."""
    next: int = field(default=0, init=False)
    """Number of the block that is judged next."""
    left: FootBlocks = field(factory=FootBlocks, init=False)
    right: FootBlocks = field(factory=FootBlocks, init=False)
    air: PressureHeight = field(factory=PressureHeight, init=False)
    hypotheses: Hypotheses = field(factory=Hypotheses, init=False)
    provisional: list[ActivitySegment] = field(factory=list, init=False)
    """Segments that were reported and are not final, in the order of time."""
    withdrawn_at: float | None = field(default=None, init=False)
    """Time `t` of a newer provisional report that withdrew the activity reported then, s."""
    flights: Flights = field(factory=Flights, init=False)
    strides: deque[StrideTaken] = field(factory=deque, init=False)
    """Strides whose activity is not known yet, without their features."""

    def ready(self) -> None:
        """Read the motion model of this release, unless the settings have one."""
        if self.settings.model is None:
            shipped()

    def reset(self, site: Site) -> None:
        """Reset a foot whose clock restarts: what is under way there is discarded."""
        if site.foot is None:
            return
        (self.left if site.foot is LEFT else self.right).restart()
        self.flights.reset()
        self.strides.clear()
        if self.left.index is None and self.right.index is None:
            self._restart()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add a sample of a foot, also of its barometer, with its events; return activities, flights and rides."""
        sample = view.sample
        acc, t, origin = sample.acc, sample.t, self.origin
        side = self.left if view.foot is LEFT else self.right
        if origin is None:
            if acc is None:
                return ()
            self.origin = origin = t
        since = (t - origin + TIE) / BLOCK
        events: Sequence[PartOutput] = ()
        if sample.air_pressure is not None and side.index is not None:
            self.air.add(view.foot, floor(since), sample.air_pressure)
        if acc is not None:
            if side.index is None or since >= side.index + 1:
                side.close()
                side.start_block(floor(since), view.gyro_bias, view.acc_grain)
                events = self._judge(t, view.known_at)
            side.add(acc, sample.gyro, view if view.levelled else None)
        if view.events:
            side.add_events(view.events, view.position[2])
            for event in view.events:
                if isinstance(event, StrideTaken):
                    self.strides.append(_reduced(event, event.known_at))
                    if len(self.strides) > MOST_WAITING:
                        self.strides.popleft()
        return events

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the final activities, also those of the last second: no more samples come."""
        events: list[Event] = []
        sides = [side for side in (self.left, self.right) if side.index is not None]
        last = max([side.index for side in sides if side.index is not None], default=-1)
        for side in sides:
            side.close()
        while self.next <= last and last - self.next < MOST_EMPTY_BLOCKS:
            self._judge_block(self.next)
            self.next += 1
        self._report(now, events, True)
        return events

    def _judge(self, t: float, known_at: float) -> list[Event]:
        """Judge the blocks that are complete in all feet that give samples."""
        newest_blocks = [side.index for side in (self.left, self.right) if side.index is not None]
        newest = max(newest_blocks)
        complete = min([index for index in newest_blocks if newest - index < SILENT_BLOCKS]) - 1 - REACH
        if complete < self.next:
            return []
        events: list[Event] = []
        empty_blocks = 0
        while self.next <= complete:
            empty_blocks = 0 if self._judge_block(self.next) else empty_blocks + 1
            self.next += 1
            if empty_blocks > MOST_EMPTY_BLOCKS:
                self.next = max(self.next, complete - REACH)
        self._report(known_at, events)
        self._count_flights(t, known_at, events)
        return events

    def _judge_block(self, index: int) -> bool:
        """Judge one block and return whether it has samples."""
        t = self._time(index)
        model = self.settings.model or shipped()
        sides = (self.left, self.right)
        features = [side.features(index, t + 0.5 * BLOCK) for side in sides]
        air = self.air
        climbs = air.climbs(index, BLOCK) if air.blocks else NO_EVIDENCE
        self.hypotheses.update(
            BlockEvidence(
                t=t,
                motions=motion_votes(model, features),
                forces=tuple([block_force(side.block(index), side.resolution) for side in sides]),
                climbs=climbs,
                before=air.height(index - 3, index - 1),
                after=air.height(index, index + REACH),
            ),
            model.chain,
        )
        return any([one is not None for one in features])

    def _time(self, index: int) -> float:
        return (0.0 if self.origin is None else self.origin) + index * BLOCK

    def _restart(self) -> None:
        self.origin = None
        self.next = 0
        self.air = PressureHeight()
        self.hypotheses = Hypotheses()
        self.provisional, self.withdrawn_at = [], None

    def _report(self, known_at: float, events: list[Event], ending: bool = False) -> None:
        """Report the changes of the likeliest course; `ending`: all of it is settled."""
        hypotheses = self.hypotheses
        for settled, before, likely in hypotheses.settle(self._time(self.next) + (1e6 if ending else 0.0)):
            if before is not None and before.activity in RIDES_UP:
                events.append(_lift_event(before, settled.t, known_at))
            events.append(
                self._changed(
                    settled, known_at, True, self.provisional[0].t if self.provisional else self.withdrawn_at, likely
                )
            )
            self.provisional, self.withdrawn_at = [], None
        best = hypotheses.best
        if best is None:
            return
        open_ = best.path if hypotheses.settled is None else best.path[1:]
        same = 0
        for old, new in zip(self.provisional, open_, strict=False):
            if old.activity is not new.activity or abs(old.t - new.t) > TIME_TOLERANCE:
                break
            same += 1
        dropped, fresh = self.provisional[same:], list(open_[same:])
        revised = dropped[0].t if dropped else self.withdrawn_at
        if dropped and not fresh:
            # only the activity before it takes its place
            self._withdraw(same, dropped[0].t, known_at, False, events)
        for segment in fresh:
            events.append(self._changed(segment, known_at, False, revised, hypotheses.probability(segment)))
            revised = self.withdrawn_at = None
        self.provisional = [*self.provisional[:same], *fresh]
        if ending and self.withdrawn_at is not None:
            self._withdraw(same, self.withdrawn_at, known_at, True, events)

    def _withdraw(self, same: int, t: float, known_at: float, final: bool, events: list[Event]) -> None:
        """Report that the activity reported at `t`, s, is withdrawn, and that the one before it continues."""
        settled = Activity.UNKNOWN if self.hypotheses.settled is None else self.hypotheses.settled
        on = ActivitySegment(t, self.provisional[same - 1].activity if same else settled)
        events.append(self._changed(on, known_at, final, t, self.hypotheses.probability(on)))
        self.withdrawn_at = None if final else t

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
        """Pass the strides up to the newest judged block to the flights, each with the activity in its middle."""
        until = self._time(self.next)
        best = self.hypotheses.best
        path: Sequence[ActivitySegment] = () if best is None else best.path
        while self.strides and 0.5 * (self.strides[0].t_start + self.strides[0].t_end) < until:
            stride = self.strides.popleft()
            middle = 0.5 * (max(stride.t_start, stride.t_end - 1.6) + stride.t_end)
            activity = Activity.UNKNOWN
            for segment in path:
                if segment.t <= middle:
                    activity = segment.activity
            known = _reduced(stride, max(known_at, stride.known_at))
            events += self.flights.add_stride(known, STAIR_DIRECTIONS.get(activity, 0))
        events += self.flights.advance(t, known_at)


def _reduced(stride: StrideTaken, known_at: float) -> StrideTaken:
    """Return the stride with only the times and heights that flights need."""
    return StrideTaken(
        t=stride.t,
        known_at=known_at,
        final=stride.final,
        foot=stride.foot,
        number=stride.number,
        t_start=stride.t_start,
        t_end=stride.t_end,
        displacement=ZERO,
        position=ZERO,
        length=stride.length,
        heading_change=stride.heading_change,
        height_change=stride.height_change,
        covariance=NO_COVARIANCE,
        t_toe_off=stride.t_toe_off,
        t_heel_strike=stride.t_heel_strike,
        degraded=stride.degraded,
        features=NO_FEATURES,
    )


def _lift_event(ride: ActivitySegment, t_end: float, known_at: float) -> LiftRidden:
    start = ride.t if ride.from_ is None else ride.from_
    end = max(start, t_end if ride.to is None else ride.to)
    return LiftRidden(t=end, known_at=max(known_at, end), t_start=start, up=RIDES_UP[ride.activity], height=ride.height)
