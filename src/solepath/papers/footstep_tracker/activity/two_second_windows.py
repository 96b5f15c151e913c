"""Activities of windows of two seconds, by a tree and a hidden Markov model.

After Liu et al. 2015, "Track Your Foot Step: Anchor-free Indoor Localization based on Sensing Users' Foot Steps",
section IV.A, fig. 5: a threshold on the variance of a_z parts {standing, hypergravity, weightlessness} from {walking,
stairs up, stairs down}; thresholds on its mean part the first three; a hidden Markov model parts the others. "If we
estimate the user's activity as EHG, then we wait for an EWL, and we say the user is under EA. If the user is under EWL,
we wait for an EHG, and we say the user is under ED."

Open in the paper, and settled here:

- Observations of the hidden Markov model. Features of the window (window_model.FEATURES: log variance and skewness of
  a_z, the mean force, the log energies across a_z and of the turning; section V.C has "accelerometer and gyroscope
  data") under a mixture of Gaussians for each state, as Mannini and Sabatini 2010 (Sensors 10, 1154) classify
  activities by a continuous-emission model of window features. Windows that slide by a quarter contain each instant
  four times, so a window's log-likelihood counts a quarter.
- The mean of standing. A threshold on the mean itself needs sensors without offset, but offsets are as large as a
  lift's pulse. So the mean counts against that of the foot's own standing (`StandingForce`).
- In fig. 4 a_z is about -9.8 at rest, so its "smaller" in hypergravity is larger downwards. Here specific force counts
  upwards: hypergravity is above.
- The wait for the other pulse ends when the wearer walks off, and after `LONGEST_RIDE`; then there was no ride.
- Two feet. Both give the same window: the mean of their variances and of their means counts, and their log-likelihoods
  add up.
- Running is none of the paper's activities. It comes out as WALKING.

Time of a change. A window moves if any part of it does: so movement started in the newest half-second of the first
window that moves, and ended at the start of the first one that does not; the same holds for a lift's pulses. Between
walking and stairs the middle of the window counts. The first windows of a movement hold some standing too, which looks
like stairs: the hidden Markov model starts with the first that holds none, and a movement is reported when one more
window has moved, so a foot that is put elsewhere within half a second has not walked. So a label is known within
0.5 s after the start of a pulse, 2.5 s of movement, 2 s of standing, 1.5 s of stairs after walking. A lift that has
set off is reported as not final until its second pulse."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ....body.part import ActivityPart, PartOutput
from ....events import ActivityChanged, Event, LiftRidden
from ....foot.view import FootView
from ....types import Activity, Foot, Site
from ....types.attrs import define, field, frozen
from .hmm import bayes_update, forward, scaled_likelihoods
from .window_model import WindowModel, shipped
from .windows import BLOCKS, HOP, WINDOW, FootWindow, FootWindows

MOVING = (Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN)
"""States of the hidden Markov model."""
LIFT = {True: Activity.ELEVATOR_UP, False: Activity.ELEVATOR_DOWN}
"""Activity of a lift by its direction, True for up."""
UNIFORM = (1.0 / 3.0,) * 3
"""Belief before the first window of a movement."""
SILENT_HOPS = 4
"""Number of half-seconds behind the other foot after which a foot is not waited for."""
LOST_HOPS = 8
"""Number of half-seconds without a window after which the activity is unknown."""
QUICK_SHARE, SLOW_SHARE = 0.5, 0.05
"""Share of a window in the mean of standing: the second after a movement, and in the long run."""
LONGEST_PULSE = 10
"""Longest pulse of a lift, half-seconds: after a longer one the foot stands otherwise than before."""
LONGEST_RIDE = 120
"""Longest time from the first pulse of a ride to the second, half-seconds."""
FIRST_WHOLE_WINDOW = BLOCKS
"""Number of the first window of a movement in which nothing stands still."""
FEWEST_WINDOWS = FIRST_WHOLE_WINDOW + 1
"""Number of windows that make a movement: fewer are a foot that was put elsewhere."""


@define
class StandingForce:
    """The mean specific force of a foot that stands, m/s^2."""

    mean: float | None = None
    share: float = 1.0
    """Share that the next window of standing will have in the mean."""
    windows: int = 0

    def add_window(self, mean: float) -> None:
        """Add another window of standing."""
        self.windows += 1
        self.mean = mean if self.mean is None else self.mean + self.share * (mean - self.mean)
        self.share = max(SLOW_SHARE, self.share / (1.0 + self.share))

    def moved(self) -> None:
        """Let the next window count more, because the foot may stand otherwise after a movement."""
        self.share = max(self.share, QUICK_SHARE)


@define
class LiftPulses:
    """The pulses of a lift so far, one or both."""

    t_start: float
    """Start of the ride, s."""
    index: int
    up: bool
    braking: bool = False
    """Flag: the second pulse has come."""
    newest: int = 0
    """Number of the last window with a pulse."""
    first_pulse: int = 1
    """Number of windows of the first pulse."""


@frozen
class TwoSecondSettings:
    """Settings of `TwoSecondWindows`."""

    model: WindowModel | None = None
    """Learnt model; None is the one that comes with this release."""


@define
class TwoSecondWindows(ActivityPart):
    """Classifies activities by windows of two seconds (footstep-tracker)."""

    needs_samples: ClassVar[bool] = True

    settings: TwoSecondSettings = TwoSecondSettings()
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """Newest reported activity."""
    origin: float | None = field(default=None, init=False)
    """Start of all windows, s."""
    feet: dict[Foot, FootWindows] = field(factory=dict, init=False)
    standing: dict[Foot, StandingForce] = field(factory=dict, init=False)
    decided: int | None = field(default=None, init=False)
    """Number of the newest window that was decided."""
    belief: tuple[float, ...] | None = field(default=None, init=False)
    """Belief of the hidden Markov model; None while the wearer stands."""
    ride: LiftPulses | None = field(default=None, init=False)
    moved: int = field(default=0, init=False)
    """Number of windows of movement since the last without."""
    reported_t: float | None = field(default=None, init=False)
    """Time `t` of the newest event, s."""

    def ready(self) -> None:
        """Read the learnt model from its file."""
        if self.settings.model is None:
            shipped()

    def reset(self, site: Site) -> None:
        """Discard all windows when the clock of a foot's samples restarts."""
        if site.foot is not None:
            self.origin = self.decided = self.belief = self.ride = self.reported_t = None
            self.activity = Activity.UNKNOWN
            self.feet, self.standing = {}, {}

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        acc, t = view.sample.acc, view.t
        if acc is None:
            return ()
        if self.origin is None:
            self.origin = t
        if view.foot not in self.feet:
            feet = {**self.feet, view.foot: FootWindows()}
            self.feet = {one: feet[one] for one in Foot if one in feet}
            self.standing.setdefault(view.foot, StandingForce())
        if not self.feet[view.foot].update(t - self.origin, acc, view.sample.gyro):
            return ()
        return self._decide_ready(view.known_at)

    def _decide_ready(self, known_at: float) -> list[Event]:
        """Decide about every window that no foot will add to, after a half-second of one foot."""
        events: list[Event] = []
        while waiting := [w.ready[0].index for w in self.feet.values() if w.ready]:
            index = min(waiting)
            newest = [w.newest for w in self.feet.values() if w.newest is not None]
            if any(index >= one >= max(newest) - SILENT_HOPS for one in newest):
                break
            ready = [(foot, w.ready) for foot, w in self.feet.items() if w.ready and w.ready[0].index == index]
            windows = {foot: queue.popleft() for foot, queue in ready}
            if self.decided is None or index > self.decided:
                events += self._decide(index, windows, known_at)
        return events

    def _decide(self, index: int, windows: dict[Foot, FootWindow], known_at: float) -> list[Event]:
        events: list[Event] = []
        if self.decided is not None and index - self.decided > LOST_HOPS:
            events = [] if self.ride is None else self._withdraw_ride(self.ride, known_at)
            self.belief = None
            events += self._change(self._newest(self.decided) + HOP, Activity.UNKNOWN, known_at)
        self.decided = index
        model = self.settings.model or shipped()
        if sum([w.variance for w in windows.values()]) > model.moving * len(windows):
            self.moved += 1
            for foot in windows:
                self.standing[foot].moved()
            if self.moved < FIRST_WHOLE_WINDOW:
                return events
            state = self._state(model, windows)
            return events if self.moved < FEWEST_WINDOWS else events + self._add_moving_window(index, state, known_at)
        self.moved, self.belief = 0, None
        off = 0.0
        for foot, window in windows.items():
            mean = self.standing[foot].mean
            off += 0.0 if mean is None else window.mean - mean
        off /= len(windows)
        pulse = 0 if abs(off) < model.pulse else 1 if off > 0.0 else -1
        if pulse == 0:
            for foot, window in windows.items():
                self.standing[foot].add_window(window.mean)
        return events + self._add_standing_window(index, pulse, windows, known_at)

    def _state(self, model: WindowModel, windows: dict[Foot, FootWindow]) -> Activity:
        """Return the likeliest movement by the hidden Markov model, with this window."""
        feet = [model.log_likelihoods(window) for window in windows.values()]
        share = 1.0 / BLOCKS
        likely = scaled_likelihoods([share * sum(values) for values in zip(*feet, strict=True)])
        before = self.belief
        self.belief = bayes_update(UNIFORM, likely) if before is None else forward(before, model.transitions, likely)
        return MOVING[self.belief.index(max(self.belief))]

    def _add_moving_window(self, index: int, state: Activity, known_at: float) -> list[Event]:
        t_start = self._newest(index - self.moved + 1)
        events: list[Event] = []
        if self.ride is not None:
            ride = self.ride
            events = self._end_ride(ride, t_start, known_at) if ride.braking else self._withdraw_ride(ride, known_at)
        if self.activity in MOVING:
            t_start = self._newest(index) + 0.5 * (HOP - WINDOW)  # the half-second in the window's middle
        return events + self._change(t_start, state, known_at)

    def _add_standing_window(
        self, index: int, pulse: int, windows: dict[Foot, FootWindow], known_at: float
    ) -> list[Event]:
        ride, events = self.ride, list[Event]()
        if ride is not None:
            direction = 1 if ride.up else -1
            if pulse == -direction:
                if not ride.braking:
                    events += self._change(ride.t_start, self.activity, known_at, revises=ride.t_start)
                ride.braking, ride.newest = True, index
                if index - ride.index < LONGEST_RIDE + LONGEST_PULSE:
                    return events
                pulse = 0
            if ride.braking:
                events += self._end_ride(ride, self._start(index), known_at)
                pulse = 0  # a lift that brakes hard swings back
            elif pulse == direction and index - ride.newest <= BLOCKS:
                ride.newest, ride.first_pulse = index, ride.first_pulse + 1
                if ride.first_pulse <= LONGEST_PULSE:
                    return events
                first = all(self.standing[foot].windows <= LONGEST_PULSE for foot in windows)
                for foot, window in windows.items():
                    self.standing[foot] = StandingForce(window.mean, QUICK_SHARE, LONGEST_PULSE)
                if first:  # the very first standing was the pulse, and this is standing
                    ride.up, ride.first_pulse = not ride.up, 1
                    return events + self._change(
                        ride.t_start, LIFT[ride.up], known_at, final=False, revises=ride.t_start
                    )
                pulse = 0
                events += self._withdraw_ride(ride, known_at)
            elif pulse == direction or index - ride.index > LONGEST_RIDE:
                events += self._withdraw_ride(ride, known_at)  # its other pulse never came
            else:
                return events
        if pulse == 0:
            return events + self._change(self._start(index), Activity.STANDING, known_at)
        t_start = self._not_before_reported(self._newest(index))
        self.ride = LiftPulses(t_start, index, pulse > 0, newest=index)
        return events + self._change(t_start, LIFT[pulse > 0], known_at, final=False)

    def _end_ride(self, ride: LiftPulses, t: float, known_at: float) -> list[Event]:
        self.ride = None
        t = self._not_before_reported(t)
        ridden = LiftRidden(t=t, known_at=known_at, t_start=ride.t_start, up=ride.up, height=None)
        return [ridden, *self._change(t, Activity.STANDING, known_at)]

    def _withdraw_ride(self, ride: LiftPulses, known_at: float) -> list[Event]:
        self.ride = None
        return self._change(ride.t_start, Activity.STANDING, known_at, revises=ride.t_start)

    def _change(
        self, t: float, activity: Activity, known_at: float, *, final: bool = True, revises: float | None = None
    ) -> list[Event]:
        """Return the event of this activity, if it is another one or a revision."""
        if activity is self.activity and revises is None:
            return []
        if revises is None:
            t = self._not_before_reported(t)
        if self.reported_t is None and self.origin is not None:
            t = self.origin  # the first window includes the half-second of levelling
        self.activity, self.reported_t = activity, t
        return [
            ActivityChanged(t=t, known_at=known_at, final=final, activity=activity, probability=None, revises=revises)
        ]

    def _not_before_reported(self, t: float) -> float:
        """Return `t`, or the time of the newest event if that is later."""
        return t if self.reported_t is None else max(t, self.reported_t)

    def _start(self, index: int) -> float:
        """Return the start of window `index`, s."""
        return self._newest(index) + HOP - WINDOW

    def _newest(self, index: int) -> float:
        """Return the start of the newest half-second of window `index`, s."""
        return (0.0 if self.origin is None else self.origin) + index * HOP
