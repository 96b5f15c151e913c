"""Walking state by the angle per metre of each stride: its inclination divided by half its horizontal length.

Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1. The angle and its
thresholds are in steepness.py. Numbers without a source were chosen by hand."""

from __future__ import annotations

from typing import ClassVar

from ...body.activity.flights import Flights, FlightStride, is_stair_rise
from ...body.part import ActivityPart, Inputs, Outputs
from ...events import ActivityChanged, Event, Limitation, StrideTaken
from ...foot.view import FootView
from ...types import Activity, Foot, Phase, Site
from ...types.attrs import define, state, stateful
from ...types.vector import TIME_EPSILON
from .steepness import steepness

STANDING_DELAY = 1.2
"""Time without motion after which the wearer is STANDING, s; longer than a stance of a slow walker."""
UNKNOWN_DELAY = 5.0
"""Time of motion without a stride after which the activity is UNKNOWN, s."""
_ACTIVITY_OF = {0: Activity.WALKING, 1: Activity.STAIRS_UP, -1: Activity.STAIRS_DOWN}
"""Activity by the direction of a stride (`steepness`)."""


@define
class FootTimes:
    """What one foot did last, by its own clock."""

    moved_at: float
    """Last time at which its phase was not STATIONARY, s; at first, the time of the first sample."""
    stride_t: float
    """End of its last stride, s; at first, the time of the first sample."""
    stands: bool = False
    """Flag: it has stood for `STANDING_DELAY`."""
    idle: bool = False
    """Flag: it has moved without a stride for `UNKNOWN_DELAY`."""


@stateful
class AnglePerMetre(ActivityPart):
    """Classifies each stride as level, upstairs or downstairs by its angle per metre, and detects flights of stairs.

    The paper has three states: level, up and down. Walking and jogging are one state, so a level stride is WALKING at
    any speed. Two states are added: feet that stand for `STANDING_DELAY` are STANDING from the start of that stance,
    and feet that move without a stride for `UNKNOWN_DELAY` are UNKNOWN. Every event is final and has no probability.
    Latency: a state that starts with a toe-off is known at the end of that stride; standing, after `STANDING_DELAY`.

    A stride with a larger height change than stairs have (`is_stair_rise`) is an error of the track; its angle is not
    used. The activity of a wearer who walked or climbed stays; STANDING becomes UNKNOWN. Times are those of the foot
    that shows a state; each foot is compared with its own clock only."""

    needs_samples: ClassVar[bool] = True

    activity: Activity = Activity.UNKNOWN
    """Activity of the last event."""
    limitation_reported: bool = False
    """Flag: what these activities cannot tell was reported."""
    flights: Flights = state(factory=Flights)
    reported_t: float | None = None
    """Time `t` of the last event, s; None when that event is on a clock that is no longer used."""
    feet: dict[Foot, FootTimes] = state(factory=dict)
    """Times of each foot with samples."""

    def reset(self, site: Site) -> None:
        if site.foot is not None:
            self.flights.reset()
            self.feet.pop(site.foot, None)
            self.reported_t = None

    def finish(self, now: float) -> Outputs:
        return self.flights.finish(now)

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        if view is None or view.moved_at != view.t or not view.levelled:
            return ()  # no sample, one without acc or gyro, or a foot not yet tracked
        t, known_at = view.t, view.known_at
        times = self.feet.setdefault(view.foot, FootTimes(t, t))
        outputs: list[Event] = []
        if not self.limitation_reported:
            self.limitation_reported = True
            what = "activities as printed: running counts as walking, and rides in lifts as standing"
            outputs.append(Limitation(t=t, known_at=known_at, site=None, what=what))
        for event in events:
            if isinstance(event, StrideTaken):
                t_start = event.t_start if event.t_toe_off is None else max(event.t_start, event.t_toe_off)
                times.stride_t = max(times.stride_t, event.t)
                direction = None
                if is_stair_rise(event.height_change, event.degraded):
                    direction = steepness(event.length, event.height_change)
                    self._report(_ACTIVITY_OF[direction], t_start, known_at, outputs)
                elif self.activity is Activity.STANDING:
                    self._report(Activity.UNKNOWN, t_start, known_at, outputs)
                outputs += self.flights.add_stride(FlightStride.of(event), direction, event.known_at)
        if view.phase is not Phase.STATIONARY:
            times.moved_at = t
        times.stands = t - times.moved_at >= STANDING_DELAY - TIME_EPSILON
        if times.stands:
            times.stride_t = t
        times.idle = t - times.stride_t > UNKNOWN_DELAY
        feet = self.feet.values()
        if all([one.stands for one in feet]):
            self._report(Activity.STANDING, times.moved_at, known_at, outputs)
        elif times.idle and all([one.idle or one.stands for one in feet]) and self.activity is not Activity.UNKNOWN:
            self._report(Activity.UNKNOWN, times.stride_t, known_at, outputs)
        if self.flights.direction != 0:
            outputs += self.flights.advance(t, known_at)
        return outputs

    def _report(self, activity: Activity, t_start: float, known_at: float, events: list[Event]) -> None:
        """Add an ActivityChanged to `events` if the activity changes, or if none is on a clock still in use."""
        if activity is self.activity and self.reported_t is not None:
            return
        t_start = t_start if self.reported_t is None else max(t_start, self.reported_t)
        self.activity, self.reported_t = activity, t_start
        events.append(ActivityChanged(t=t_start, known_at=max(known_at, t_start), activity=activity, probability=None))
