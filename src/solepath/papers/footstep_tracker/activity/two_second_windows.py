"""Activities of windows of two seconds, by a decision tree and a hidden Markov model.

After Liu et al. 2015, "Track Your Foot Step: Anchor-free Indoor Localization based on Sensing Users' Foot Steps",
section IV.A, fig. 5. A threshold on the variance of a_z separates {standing, hypergravity, weightlessness} from
{walking, stairs up, stairs down}; thresholds on its mean separate the first three, a hidden Markov model the others.
"If we estimate the user's activity as EHG [hypergravity], then we wait for an EWL [weightlessness], and we say the user
is under EA [elevator ascending]. If the user is under EWL, we wait for an EHG, and we say the user is under ED
[descending]." Hypergravity and weightlessness last for one pulse each, when an elevator speeds up and when it brakes.

The paper leaves these points open:

- Observations of the hidden Markov model are window features (window_model.FEATURES: log variance and skewness of a_z,
  the mean force, the log energies across a_z and of the rotation; section V.C has "accelerometer and gyroscope data").
  Each state has a mixture of Gaussians, as in the continuous-emission model of window features of Mannini and Sabatini
  2010 (Sensors 10, 1154). Windows overlap so that each instant is in four, so a log-likelihood counts a quarter.
- A threshold on the mean itself needs sensors without offset, but offsets are as large as the pulses of an elevator.
  So the mean is compared with the mean while the same foot stood (`StandingForce`).
- In fig. 4 a_z is about -9.8 at rest, so "smaller" in hypergravity means more negative. Here specific force is positive
  upwards, so it is larger in hypergravity.
- The wait for the second pulse ends when the wearer walks away, and after `LONGEST_RIDE`. Then there was no ride. With
  the second pulse the ride is reported, from the first one on.
- The windows of both feet at one time are combined: variances and means are averaged, log-likelihoods are added.
- Running is none of the paper's activities. It is reported as WALKING.

Time of a change: A window counts as moving if any part of it moves. So movement started in the newest half-second of
the first moving window, and ended at the start of the first window that does not move. The same holds for the pulses of
an elevator. A change between walking and stairs is in the middle of the window. The first windows of a movement also
contain standing, which makes them look like stairs. So the hidden Markov model starts with the first window without
standing. A movement is reported after one more moving window: a foot that is only put elsewhere within half a second
has not walked. So an activity is known this long after its start: a pulse, 0.5 s; movement, 2.5 s; standing, 2 s;
stairs after walking, 1.5 s; a ride in an elevator, with its second pulse.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import fsum
from typing import ClassVar

from ....body.part import ActivityPart, Inputs, Outputs
from ....events import ActivityChanged, Event, LiftRidden, Limitation
from ....foot.view import FootView
from ....types import Activity, Floats, Foot, Site
from ....types.attrs import define, field, frozen, state, stateful
from .hmm import bayes_update, forward, scaled_likelihoods
from .window_model import WindowModel, shipped
from .windows import BLOCKS, HOP, QUICK_SHARE, WINDOW, FootWindow, FootWindows, StandingForce

MOVING_ACTIVITIES = (Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN)
"""States of the hidden Markov model."""
ELEVATOR_ACTIVITY = {True: Activity.ELEVATOR_UP, False: Activity.ELEVATOR_DOWN}
"""Activity in an elevator by its direction; True for up."""
UNIFORM_BELIEF = (1.0 / 3.0,) * 3
"""Probabilities of the states before the first window of a movement."""
LONGEST_SILENCE = 4
"""Number of half-seconds by which a foot may lag behind the other before its windows are no longer awaited."""
LONGEST_GAP = 8
"""Number of half-seconds without a window after which the activity is unknown."""
LONGEST_PULSE = 10
"""Longest pulse of an elevator, half-seconds. A longer one means that the foot now stands in another posture."""
LONGEST_RIDE = 120
"""Longest time from the first pulse of a ride to the second, half-seconds."""
FIRST_WHOLE_WINDOW = BLOCKS
"""Number, from 1, of the first window of a movement that contains no standing."""
FEWEST_WINDOWS = FIRST_WHOLE_WINDOW + 1
"""Least number of windows of a movement; with fewer, a foot was only put elsewhere."""


@define
class ElevatorPulses:
    """The one or two pulses of an elevator so far."""

    t_start: float
    """Start of the ride, s."""
    index: int
    """Number of the first window with a pulse."""
    up: bool
    """Flag: the elevator goes up."""
    newest: int
    """Number of the last window of the first pulse."""
    braking: bool = False
    """Flag: the second pulse has started."""


@frozen
class TwoSecondSettings:
    """Settings of `TwoSecondWindows`."""

    model: WindowModel | None = None
    """Learnt model; None is the one that comes with this release."""


@stateful
class TwoSecondWindows(ActivityPart):
    """Classifies activities by windows of two seconds (footstep-tracker)."""

    needs_samples: ClassVar[bool] = True

    settings: TwoSecondSettings = field(default=TwoSecondSettings())
    activity: Activity = Activity.UNKNOWN
    """Newest reported activity."""
    origin: float | None = None
    """Time of the first sample, from which windows are numbered, s."""
    feet: dict[Foot, FootWindows] = state(factory=dict)
    """Windows by foot."""
    standing: dict[Foot, StandingForce] = state(factory=dict)
    """Force of standing by foot."""
    newest_decided: int | None = None
    """Number of the newest window that was classified."""
    belief: Floats | None = None
    """Probabilities of the states of the hidden Markov model; None while the wearer stands."""
    ride: ElevatorPulses | None = None
    """Pulses of the present elevator ride; None without one."""
    moving_windows: int = 0
    """Number of consecutive moving windows up to now."""
    limitation_reported: bool = False
    """Flag: what these activities cannot tell was reported."""
    reported_t: float | None = None
    """Time `t` of the newest event, s."""

    def ready(self) -> None:
        """Read the learnt model from its file."""
        if self.settings.model is None:
            shipped()

    def reset(self, site: Site) -> None:
        """Discard all windows when the clock of a foot's samples restarts."""
        if site.foot is not None:
            self.origin = self.newest_decided = self.belief = self.ride = self.reported_t = None
            self.activity = Activity.UNKNOWN
            self.feet, self.standing = {}, {}

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        if view is None or view.sample.acc is None:
            return ()
        acc, t = view.sample.acc, view.t
        if self.origin is None:
            self.origin = t
        if view.foot not in self.feet:
            feet = {**self.feet, view.foot: FootWindows()}
            self.feet = {one: feet[one] for one in Foot if one in feet}
            self.standing[view.foot] = StandingForce()
        outputs: list[Event] = []
        if not self.limitation_reported:
            self.limitation_reported = True
            what = "activities as printed: running counts as walking, and rides in lifts have no height"
            outputs.append(Limitation(t=t, known_at=view.known_at, site=None, what=what))
        if self.feet[view.foot].update(t - self.origin, acc, view.sample.gyro):
            outputs += self._decide_ready(view.known_at)
        return outputs

    def _decide_ready(self, known_at: float) -> list[Event]:
        """Classify every window that is complete for all feet that still send samples."""
        events: list[Event] = []
        while waiting := [w.ready[0].index for w in self.feet.values() if w.ready]:
            index = min(waiting)
            newest = [w.newest for w in self.feet.values() if w.newest is not None]
            if any(index >= newest_index >= max(newest) - LONGEST_SILENCE for newest_index in newest):
                break
            ready = [(foot, w.ready) for foot, w in self.feet.items() if w.ready and w.ready[0].index == index]
            windows = {foot: queue.popleft() for foot, queue in ready}
            if self.newest_decided is None or index > self.newest_decided:
                events += self._decide(index, windows, known_at)
        return events

    def _decide(self, index: int, windows: dict[Foot, FootWindow], known_at: float) -> list[Event]:
        events: list[Event] = []
        if self.newest_decided is not None and index - self.newest_decided > LONGEST_GAP:
            self.belief = self.ride = None
            events += self._change(self._block_start(self.newest_decided) + HOP, Activity.UNKNOWN, known_at)
        self.newest_decided = index
        model = self.settings.model or shipped()
        if fsum([w.variance for w in windows.values()]) > model.moving * len(windows):
            self.moving_windows += 1
            for foot in windows:
                self.standing[foot].add_movement()
            if self.moving_windows >= FIRST_WHOLE_WINDOW:
                state = self._state(model, windows)
                if self.moving_windows >= FEWEST_WINDOWS:
                    events += self._add_moving_window(index, state, known_at)
            return events
        self.moving_windows, self.belief = 0, None
        means = [(self.standing[foot].mean, window.mean) for foot, window in windows.items()]
        difference = fsum([now - usual for usual, now in means if usual is not None]) / len(windows)
        pulse = 0 if abs(difference) < model.pulse else 1 if difference > 0.0 else -1
        if pulse == 0:
            for foot, window in windows.items():
                self.standing[foot].add_window(window.mean)
        return events + self._add_standing_window(index, pulse, windows, known_at)

    def _state(self, model: WindowModel, windows: dict[Foot, FootWindow]) -> Activity:
        """Return the likeliest movement after this window, by the hidden Markov model."""
        feet = [model.log_likelihoods(window) for window in windows.values()]
        share = 1.0 / BLOCKS
        likelihoods = scaled_likelihoods([share * fsum(values) for values in zip(*feet, strict=True)])
        belief = self.belief
        self.belief = (
            bayes_update(UNIFORM_BELIEF, likelihoods)
            if belief is None
            else forward(belief, model.transitions, likelihoods)
        )
        return MOVING_ACTIVITIES[self.belief.index(max(self.belief))]

    def _add_moving_window(self, index: int, state: Activity, known_at: float) -> list[Event]:
        t_start = self._block_start(index - self.moving_windows + 1)
        events = self._end_ride(t_start, known_at)
        if self.activity in MOVING_ACTIVITIES:
            t_start = self._block_start(index) + 0.5 * (HOP - WINDOW)  # the middle of the window
        return events + self._change(t_start, state, known_at)

    def _add_standing_window(
        self, index: int, pulse: int, windows: dict[Foot, FootWindow], known_at: float
    ) -> list[Event]:
        ride = self.ride
        if ride is not None:
            direction = 1 if ride.up else -1
            if pulse == -direction and index - ride.index <= LONGEST_RIDE + LONGEST_PULSE:
                ride.braking = True
                return self._change(ride.t_start, ELEVATOR_ACTIVITY[ride.up], known_at)
            if pulse == direction and not ride.braking and index - ride.newest <= BLOCKS:
                ride.newest = index
                if index - ride.index <= LONGEST_PULSE:
                    return []
                self.standing |= {foot: StandingForce(window.mean, QUICK_SHARE) for foot, window in windows.items()}
                if ride.index <= LONGEST_PULSE:  # the first standing was the pulse of a lift, and this is standing
                    ride.up, ride.index = not ride.up, index
                    return []
                pulse = 0
            elif pulse == 0 and not ride.braking and index - ride.index <= LONGEST_RIDE:
                return []
            elif ride.braking:
                pulse = 0  # an elevator that brakes hard rebounds, which looks like a pulse
        events = self._end_ride(self._start(index), known_at)
        if pulse != 0:
            self.ride = ElevatorPulses(self._not_before_reported(self._block_start(index)), index, pulse > 0, index)
            return events
        return events + self._change(self._start(index), Activity.STANDING, known_at)

    def _end_ride(self, t: float, known_at: float) -> list[Event]:
        """Return the events at the end of a ride; nothing if there is none, or if its second pulse never came."""
        ride, self.ride = self.ride, None
        if ride is None or not ride.braking:
            return []
        t = self._not_before_reported(t)
        ridden = LiftRidden(t=t, known_at=max(known_at, t), t_start=ride.t_start, up=ride.up, height=None)
        return [ridden, *self._change(t, Activity.STANDING, known_at)]

    def _change(self, t: float, activity: Activity, known_at: float) -> list[Event]:
        """Return the event of this activity if the activity changes, otherwise nothing."""
        if activity is self.activity:
            return []
        t = self._not_before_reported(t)
        if self.reported_t is None and self.origin is not None:
            t = self.origin  # the first window also stands for the half-second before it, used for levelling
        self.activity, self.reported_t = activity, t
        known_at = max(known_at, t)  # feet whose clocks are far apart have windows of the future
        return [ActivityChanged(t=t, known_at=known_at, activity=activity, probability=None)]

    def _not_before_reported(self, t: float) -> float:
        """Return `t`, or the time of the newest event if that is later."""
        return t if self.reported_t is None else max(t, self.reported_t)

    def _start(self, index: int) -> float:
        """Return the start of window `index`, s."""
        return self._block_start(index) + HOP - WINDOW

    def _block_start(self, index: int) -> float:
        """Return the start of the newest half-second of window `index`, s."""
        return (0.0 if self.origin is None else self.origin) + index * HOP
