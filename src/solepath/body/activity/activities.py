"""Activities of the wearer: standing, walking, running, stairs and elevators, for any recipe.

The samples of each foot are cut into blocks of half a second (features.py), and every block gives a likelihood of each
motion (motion.py). Three kinds of evidence feed a Markov chain of sixteen states (chain.py): the motion likelihoods of
both feet, the force that an elevator adds on a standing foot (ride.py), and the slope of the air pressure when there is
a barometer (pressure_height.py). Viterbi's algorithm finds the likeliest sequence of activities (hypotheses.py).

Latency: a block is judged when two more blocks have come, 1 to 1.5 s after it. The likeliest sequence is reported at
once as not final. The segments on which all likely sequences agree are reported again as final, mostly seconds later.
Standing may turn out to be a ride whose start was not detected, so it becomes final after up to a minute; the end of a
ride becomes final after 12 s."""

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
from .features import BLOCK_DURATION, WINDOW_REACH
from .flights import Flights
from .foot_blocks import MAX_STRIDE_TIME, FootBlocks
from .hypotheses import ActivitySegment, BlockEvidence, Hypotheses
from .motion import MotionModel, load_released_model
from .pressure_height import BLOCKS_BEFORE, NO_EVIDENCE, PressureHeight
from .votes import block_force, motion_votes

LEFT: Final = Foot.LEFT
"""The left foot, looked up once: access to an enum member costs as much as five multiplications."""

SILENT_BLOCKS = 3
"""Number of blocks without samples after which a foot is no longer waited for."""
MAX_EMPTY_BLOCKS = 60
"""Largest number of consecutive empty blocks that are judged; the rest of a longer gap is skipped."""
START_TOLERANCE = 1.0
"""Largest change in the start of a provisional activity that is not reported as a revision, s."""
MAX_WAITING_STRIDES = 8
"""Largest number of strides whose activity is not known yet; older ones are discarded."""
NO_FEATURES = StrideFeatures(0.0, 0.0, 0.0)
NO_COVARIANCE = (0.0,) * 6
"""Placeholders in `Activities.strides`: only the times and heights of these strides are used."""
STAIR_DIRECTIONS = {Activity.STAIRS_UP: 1, Activity.STAIRS_DOWN: -1}
ELEVATOR_GOES_UP = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}
"""Flag for each elevator activity: the ride goes up."""


@frozen
class ActivitiesSettings:
    """The settings of `Activities`."""

    model: MotionModel | None = None
    """Motion model; None: the model of this release."""


@define
class Activities(ActivityPart):
    """Reports the wearer's activity, flights of stairs and elevator rides."""

    needs_samples: ClassVar[bool] = True

    settings: ActivitiesSettings = ActivitiesSettings()
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """The newest activity that was reported, final or not."""
    origin: float | None = field(default=None, init=False)
    """Start of block 0, s."""
    next_block: int = field(default=0, init=False)
    """Number of the block that is judged next."""
    left: FootBlocks = field(factory=FootBlocks, init=False)
    right: FootBlocks = field(factory=FootBlocks, init=False)
    pressure_height: PressureHeight = field(factory=PressureHeight, init=False)
    hypotheses: Hypotheses = field(factory=Hypotheses, init=False)
    provisional: list[ActivitySegment] = field(factory=list, init=False)
    """Segments that were reported and are not final, oldest first."""
    withdrawn_at: float | None = field(default=None, init=False)
    """Time `t` of the newest report, s, if it is not final and withdrew an activity without a successor; else None."""
    flights: Flights = field(factory=Flights, init=False)
    strides: deque[StrideTaken] = field(factory=deque, init=False)
    """Strides whose activity is not known yet, without their features."""

    def ready(self) -> None:
        """Read the motion model of this release, unless the settings have one."""
        if self.settings.model is None:
            load_released_model()

    def reset(self, site: Site) -> None:
        """Discard the blocks of a foot whose clock restarts, the waiting strides and the flight under way."""
        if site.foot is None:
            return
        (self.left if site.foot is LEFT else self.right).restart()
        self.flights.reset()
        self.strides.clear()
        if self.left.index is None and self.right.index is None:
            self._restart()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add a sample of a foot with its air pressure and events; return activities, flights and rides."""
        sample = view.sample
        acc, t, origin = sample.acc, sample.t, self.origin
        side = self.left if view.foot is LEFT else self.right
        if origin is None:
            if acc is None:
                return ()
            self.origin = origin = t
        block_number = (t - origin + TIE) / BLOCK_DURATION
        events: Sequence[PartOutput] = ()
        if sample.air_pressure is not None and side.index is not None:
            self.pressure_height.add(view.foot, floor(block_number), sample.air_pressure)
        if acc is not None:
            if side.index is None or block_number >= side.index + 1:
                side.close()
                side.start_block(floor(block_number), view.gyro_bias, view.acc_grain)
                events = self._judge(t, view.known_at)
            side.add(acc, sample.gyro, view if view.levelled else None)
        if view.events:
            side.add_events(view.events, view.position[2])
            for event in view.events:
                if isinstance(event, StrideTaken):
                    self.strides.append(_reduce(event, event.known_at))
                    if len(self.strides) > MAX_WAITING_STRIDES:
                        self.strides.popleft()
        return events

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the final activities, including the last second, because no more samples come."""
        events: list[Event] = []
        sides = [side for side in (self.left, self.right) if side.index is not None]
        last = max([side.index for side in sides if side.index is not None], default=-1)
        for side in sides:
            side.close()
        while self.next_block <= last and last - self.next_block < MAX_EMPTY_BLOCKS:
            self._judge_block(self.next_block)
            self.next_block += 1
        self._report(now, events, True)
        return events

    def _judge(self, t: float, known_at: float) -> list[Event]:
        """Judge the blocks that are complete in all feet that give samples."""
        open_blocks = [side.index for side in (self.left, self.right) if side.index is not None]
        newest = max(open_blocks)
        complete = min([index for index in open_blocks if newest - index < SILENT_BLOCKS]) - 1 - WINDOW_REACH
        if complete < self.next_block:
            return []
        events: list[Event] = []
        empty_blocks = 0
        while self.next_block <= complete:
            empty_blocks = 0 if self._judge_block(self.next_block) else empty_blocks + 1
            self.next_block += 1
            if empty_blocks > MAX_EMPTY_BLOCKS:
                self.next_block = max(self.next_block, complete - WINDOW_REACH)
        self._report(known_at, events)
        self._count_flights(t, known_at, events)
        return events

    def _judge_block(self, index: int) -> bool:
        """Judge one block and return whether it has samples."""
        t = self._time(index)
        model = self.settings.model or load_released_model()
        sides = (self.left, self.right)
        features = [side.features(index, t + 0.5 * BLOCK_DURATION) for side in sides]
        pressure_height = self.pressure_height
        pressure_scores = pressure_height.score_slope(index, BLOCK_DURATION) if pressure_height.blocks else NO_EVIDENCE
        self.hypotheses.update(
            BlockEvidence(
                t=t,
                motion_scores=motion_votes(model, features),
                forces=tuple([block_force(side.block(index), side.resolution) for side in sides]),
                pressure_scores=pressure_scores,
                before=pressure_height.height(index - BLOCKS_BEFORE, index - 1),
                after=pressure_height.height(index, index + WINDOW_REACH),
            ),
            model.chain,
        )
        return any([foot_features is not None for foot_features in features])

    def _time(self, index: int) -> float:
        return (0.0 if self.origin is None else self.origin) + index * BLOCK_DURATION

    def _restart(self) -> None:
        self.origin = None
        self.next_block = 0
        self.pressure_height = PressureHeight()
        self.hypotheses = Hypotheses()
        self.provisional, self.withdrawn_at = [], None

    def _report(self, known_at: float, events: list[Event], ending: bool = False) -> None:
        """Report the changes of the likeliest sequence; `ending` settles all of it."""
        hypotheses = self.hypotheses
        for settled, ended, probability in hypotheses.settle(self._time(self.next_block) + (1e6 if ending else 0.0)):
            if ended is not None and ended.activity in ELEVATOR_GOES_UP:
                events.append(_ride_event(ended, settled.t, known_at))
            events.append(
                self._activity_event(
                    settled,
                    known_at,
                    True,
                    self.provisional[0].t if self.provisional else self.withdrawn_at,
                    probability,
                )
            )
            self.provisional, self.withdrawn_at = [], None
        best = hypotheses.best
        if best is None:
            return
        open_segments = best.path if hypotheses.settled is None else best.path[1:]
        unchanged = 0
        for old, new in zip(self.provisional, open_segments, strict=False):
            if old.activity is not new.activity or abs(old.t - new.t) > START_TOLERANCE:
                break
            unchanged += 1
        withdrawn, new_segments = self.provisional[unchanged:], list(open_segments[unchanged:])
        revised = withdrawn[0].t if withdrawn else self.withdrawn_at
        if withdrawn and not new_segments:
            # no new activity takes the place of the withdrawn one: the activity before it continues
            self._withdraw(unchanged, withdrawn[0].t, known_at, False, events)
        for segment in new_segments:
            events.append(self._activity_event(segment, known_at, False, revised, hypotheses.probability(segment)))
            revised = self.withdrawn_at = None
        self.provisional = [*self.provisional[:unchanged], *new_segments]
        if ending and self.withdrawn_at is not None:
            self._withdraw(unchanged, self.withdrawn_at, known_at, True, events)

    def _withdraw(self, unchanged: int, t: float, known_at: float, final: bool, events: list[Event]) -> None:
        """Report that the activity of time `t`, s, is withdrawn and the activity before it continues.

        `unchanged` is the number of provisional segments that stay."""
        settled = Activity.UNKNOWN if self.hypotheses.settled is None else self.hypotheses.settled
        continued = ActivitySegment(t, self.provisional[unchanged - 1].activity if unchanged else settled)
        events.append(self._activity_event(continued, known_at, final, t, self.hypotheses.probability(continued)))
        self.withdrawn_at = None if final else t

    def _activity_event(
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
        """Pass the strides up to the newest judged block to `flights`, with the activity at the middle of each."""
        t_judged = self._time(self.next_block)
        best = self.hypotheses.best
        path: Sequence[ActivitySegment] = () if best is None else best.path
        while self.strides and 0.5 * (self.strides[0].t_start + self.strides[0].t_end) < t_judged:
            stride = self.strides.popleft()
            middle = 0.5 * (max(stride.t_start, stride.t_end - MAX_STRIDE_TIME) + stride.t_end)
            activity = Activity.UNKNOWN
            for segment in path:
                if segment.t <= middle:
                    activity = segment.activity
            reduced = _reduce(stride, max(known_at, stride.known_at))
            events += self.flights.add_stride(reduced, STAIR_DIRECTIONS.get(activity, 0))
        events += self.flights.advance(t, known_at)


def _reduce(stride: StrideTaken, known_at: float) -> StrideTaken:
    """Return a copy of the stride with only the times and heights that flights need."""
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


def _ride_event(ride: ActivitySegment, t_end: float, known_at: float) -> LiftRidden:
    start = ride.t if ride.detected_at is None else ride.detected_at
    end = max(start, t_end if ride.ended_at is None else ride.ended_at)
    return LiftRidden(
        t=end, known_at=max(known_at, end), t_start=start, up=ELEVATOR_GOES_UP[ride.activity], height=ride.height
    )
