"""Walking state by the angle per metre of each stride: its inclination divided by half its horizontal length.

Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1. The angle and its
thresholds are in steepness.py. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...body.activity.flights import Flights, is_stair_rise
from ...body.part import ActivityPart, PartInput, PartOutput
from ...events import ActivityChanged, Event, Limitation, StrideTaken
from ...foot.view import FootView
from ...types import Activity, Foot, Phase, Site
from ...types.attrs import define, field
from ...types.vector import TIME_EPSILON
from .steepness import steepness

STANDING_DELAY = 1.2
"""Time without motion after which the wearer is STANDING, s; longer than a stance of a slow walker."""
UNKNOWN_DELAY = 5.0
"""Time of motion without a stride after which the activity is UNKNOWN, s."""
LARGEST_CLOCK_DIFFERENCE, LONGEST_SILENCE = 5.0, 10.0
"""Difference of times above which the feet's clocks are not comparable, s; time after which a foot is silent, s."""
_ACTIVITY_OF = {0: Activity.WALKING, 1: Activity.STAIRS_UP, -1: Activity.STAIRS_DOWN}
"""Activity by the direction of a stride (`steepness`)."""


@define
class AnglePerMetre(ActivityPart):
    """Classifies each stride as level, upstairs or downstairs by its angle per metre, and detects flights of stairs.

    The paper has three states: level, up and down. Walking and jogging are one state, so a level stride is WALKING at
    any speed. Two states are added: feet that stand for `STANDING_DELAY` are STANDING from the start of that stance,
    and feet that move without a stride for `UNKNOWN_DELAY` are UNKNOWN. Every event is final and has no probability.
    Latency: a state that starts with a toe-off is known at the end of that stride; standing, after `STANDING_DELAY`.

    A stride with a larger height change than stairs have (`is_stair_rise`) is an error of the track; its angle is not
    used. The activity of a wearer who walked or climbed stays; STANDING becomes UNKNOWN. When the clock of foot A
    restarts, events have times of foot B's clock. Samples of A are ignored while its time differs from B's by more than
    `LARGEST_CLOCK_DIFFERENCE`. This ends when (1) the difference is smaller, (2) B's clock restarts too, or (3) B has
    sent no samples for `LONGEST_SILENCE`."""

    needs_samples: ClassVar[bool] = True

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """Activity of the last event."""
    limitation_reported: bool = field(default=False, init=False)
    """Flag: what these activities cannot tell was reported."""
    flights: Flights = field(factory=Flights, init=False)
    reported_t: float | None = field(default=None, init=False)
    """Time `t` of the last event, s; None when that event is on a clock that is no longer used."""
    clocks: dict[Foot, float] = field(factory=dict, init=False)
    """Newest time of each foot whose clock is used for the times of events, s."""
    waiting_since: dict[Foot, float | None] = field(factory=dict, init=False)
    """Feet that are not used since their clocks restarted, each with the time of its own clock, s, since which the
    other foot has been silent; None if the other foot is not silent."""
    moved_at: float | None = field(default=None, init=False)
    """Last time at which the phase of a foot was not STATIONARY, s; at first, the time of the first sample."""
    stride_t: float | None = field(default=None, init=False)
    """End of the last stride, or last time of standing, s; at first, the time of the first sample."""

    def reset(self, site: Site) -> None:
        foot = site.foot
        if foot is None:
            return
        self.flights.reset()
        self.clocks.pop(foot, None)
        self.waiting_since[foot] = None

    def finish(self, now: float) -> Sequence[PartOutput]:
        return self.flights.finish(now)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        if view is None or view.moved_at != view.t or not view.levelled:
            return ()  # no sample, one without acc or gyro, or a foot not yet tracked
        t = view.t
        if self.waiting_since and not self._use_clock(view.foot, t):
            return ()
        self.clocks[view.foot] = t
        if self.moved_at is None or self.stride_t is None:
            self.moved_at = self.stride_t = t
        known_at = view.known_at
        outputs: list[Event] = []
        if not self.limitation_reported:
            self.limitation_reported = True
            what = "activities as printed: running counts as walking, and rides in lifts as standing"
            outputs.append(Limitation(t=t, known_at=known_at, site=None, what=what))
        for event in events:
            if isinstance(event, StrideTaken):
                t_start = event.t_start if event.t_toe_off is None else max(event.t_start, event.t_toe_off)
                self.stride_t = max(self.stride_t, event.t)
                direction = None
                if is_stair_rise(event.height_change, event.degraded):
                    direction = steepness(event.length, event.height_change)
                    self._report(_ACTIVITY_OF[direction], t_start, known_at, outputs)
                elif self.activity is Activity.STANDING:
                    self._report(Activity.UNKNOWN, t_start, known_at, outputs)
                outputs += self.flights.add_stride(event, direction)
        if view.phase is not Phase.STATIONARY:
            if t > self.moved_at:
                self.moved_at = t
            if t - self.stride_t > UNKNOWN_DELAY and self.activity is not Activity.UNKNOWN:
                self._report(Activity.UNKNOWN, self.stride_t, known_at, outputs)
        elif t - self.moved_at >= STANDING_DELAY - TIME_EPSILON:
            self.stride_t = max(self.stride_t, t)
            self._report(Activity.STANDING, self.moved_at, known_at, outputs)
        if self.flights.direction != 0:
            outputs += self.flights.advance(t, known_at)
        return outputs

    def _use_clock(self, foot: Foot, t: float) -> bool:
        """Decide whether samples of `foot`, at `t` s, are used, and change to its clock if it must be used."""
        waiting_since, clocks = self.waiting_since, self.clocks
        if foot not in waiting_since and clocks:
            for other in waiting_since:
                waiting_since[other] = None  # `foot` is not silent
            return True
        if clocks and abs(t - max(clocks.values())) > LARGEST_CLOCK_DIFFERENCE:
            wait_start = waiting_since[foot]
            if wait_start is None:
                waiting_since[foot] = wait_start = t
            if t - wait_start <= LONGEST_SILENCE:
                return False
            for other in clocks:
                waiting_since[other] = None
            clocks.clear()
            self.flights.reset()
        if not clocks:
            self.moved_at = self.stride_t = self.reported_t = None
        waiting_since.pop(foot, None)
        return True

    def _report(self, activity: Activity, t_start: float, known_at: float, events: list[Event]) -> None:
        """Add an ActivityChanged to `events` if the activity changes, or if none is on a clock still in use."""
        if activity is self.activity and self.reported_t is not None:
            return
        t_start = t_start if self.reported_t is None else max(t_start, self.reported_t)
        self.activity, self.reported_t = activity, t_start
        events.append(ActivityChanged(t=t_start, known_at=max(known_at, t_start), activity=activity, probability=None))
