"""Activities of windows of two seconds, by a tree and a hidden Markov model.

After Liu et al. 2015, "Track Your Foot Step: Anchor-free Indoor Localization based on Sensing Users' Foot Steps",
section IV.A, fig. 5: a threshold on the variance of a_z parts {standing, hypergravity, weightlessness} from {walking,
stairs up, stairs down}; thresholds on its mean part the first three; a hidden Markov model parts the others. "If we
estimate the user's activity as EHG, then we wait for an EWL, and we say the user is under EA. If the user is under EWL,
we wait for an EHG, and we say the user is under ED."

What the paper leaves open, and what is taken here:

- What the hidden Markov model observes. Features of the window (window_model.FEATURES: log variance and skewness of
  a_z, the mean force, the log energies across a_z and of the turning; section V.C has "accelerometer and gyroscope
  data") under a mixture of Gaussians for each state, as Mannini and Sabatini 2010 (Sensors 10, 1154) classify
  activities by a continuous-emission model of window features. Windows that slide by a quarter see each instant four
  times, so a window's log-likelihood counts a quarter.
- The mean of standing. A threshold on the mean itself needs sensors without offset, but offsets are as large as a
  lift's pulse. So the mean counts against that of the foot's own standing (`Standing`).
- In fig. 4 a_z is about -9.8 at rest, so its "smaller" in hypergravity is larger downwards. Here specific force counts
  upwards: hypergravity is above.
- Waiting for the other pulse ends when the wearer walks off, and after `LONGEST_RIDE`; then there was no ride.
- Two feet. Both are asked about the same window: the mean of their variances and of their means counts, and their
  log-likelihoods add up.
- Running is none of the paper's activities. It comes out as WALKING.

When a change was. A window moves if any part of it does: so movement began in the newest half-second of the first
window that moves, and ended at the beginning of the first one that does not; the same holds of a lift's pulses. Between
walking and stairs it is the middle of the window that counts. The first windows of a movement hold some standing too,
which looks like stairs: the hidden Markov model begins with the first that holds none, and a movement is told when a
window more has moved, so a foot that is put elsewhere within half a second has not walked. So a label is known within
0.5 s after the beginning of a pulse, 2.5 s of movement, 2 s of standing, 1.5 s of stairs after walking. A lift that has
set off is told as not final until its second pulse.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ....body.part import ActivityPart, PartOutput
from ....events import ActivityChanged, Event, LiftRidden
from ....foot.view import FootView
from ....types import Activity, Foot, Site
from ....types.attrs import define, field, frozen
from .hmm import forward, spread, weighed
from .window_model import WindowModel, shipped
from .windows import BLOCKS, HOP, WINDOW, FootWindow, FootWindows

MOVING = (Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN)
"""The states of the hidden Markov model."""
LIFT = {True: Activity.ELEVATOR_UP, False: Activity.ELEVATOR_DOWN}
UNIFORM = (1.0 / 3.0,) * 3
SILENT = 4
"""A foot this many half-seconds behind the other is not waited for."""
LOST = 8
"""After this many half-seconds without a window nobody knows what the wearer does."""
QUICK, SLOW = 0.5, 0.05
"""Share that a window has in the mean of standing: the second after a movement, and in the long run."""
LONGEST_PULSE = 10
"""Half-seconds. A mean that is off for longer is no lift's pulse: the foot stands otherwise than before."""
LONGEST_RIDE = 120
"""Half-seconds from the first pulse to the second."""
WHOLE = BLOCKS
"""The first window of a movement in which nothing stands still."""
SURE = WHOLE + 1
"""The one that makes it a movement: fewer are a foot that was put elsewhere."""


@define
class Standing:
    """The mean specific force of a foot that stands, m/s^2."""

    mean: float | None = None
    share: float = 1.0
    """That the next window of standing will have in it."""
    windows: int = 0

    def learn(self, mean: float) -> None:
        """Another window of standing."""
        self.windows += 1
        self.mean = mean if self.mean is None else self.mean + self.share * (mean - self.mean)
        self.share = max(SLOW, self.share / (1.0 + self.share))

    def moved(self) -> None:
        """The foot may stand otherwise from now on."""
        self.share = max(self.share, QUICK)


@define
class LiftPulses:
    """One pulse of a lift was felt, or both."""

    began: float
    """s."""
    index: int
    up: bool
    braking: bool = False
    """The second pulse has come."""
    newest: int = 0
    """The last window with a pulse."""
    first_pulse: int = 1
    """Windows of it."""


@frozen
class TwoSecondSettings:
    """What `TwoSecondWindows` is set to."""

    model: WindowModel | None = None
    """What it was taught; None is what comes with this release."""


@define
class TwoSecondWindows(ActivityPart):
    """The activity part of footstep-tracker."""

    needs_samples: ClassVar[bool] = True

    settings: TwoSecondSettings = TwoSecondSettings()
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """The newest that it told."""
    origin: float | None = field(default=None, init=False)
    """The beginning of all windows, s."""
    feet: dict[Foot, FootWindows] = field(factory=dict, init=False)
    standing: dict[Foot, Standing] = field(factory=dict, init=False)
    decided: int | None = field(default=None, init=False)
    """The newest window that was."""
    belief: tuple[float, ...] | None = field(default=None, init=False)
    """Of the hidden Markov model; None while the wearer stands."""
    ride: LiftPulses | None = field(default=None, init=False)
    moved: int = field(default=0, init=False)
    """Windows of movement since the last without."""
    told: float | None = field(default=None, init=False)
    """`t` of the newest event."""

    def ready(self) -> None:
        """What was learnt is read."""
        if self.settings.model is None:
            shipped()

    def reset(self, site: Site) -> None:
        """The clock of the samples of a site restarts: so do all windows."""
        if site.foot is not None:
            self.origin = self.decided = self.belief = self.ride = self.told = None
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
            self.standing.setdefault(view.foot, Standing())
        if not self.feet[view.foot].update(t - self.origin, acc, view.sample.gyro):
            return ()
        return self._full(view.known_at)

    def _full(self, known_at: float) -> list[Event]:
        """A half-second of one foot is over: decide about every window that no foot will add to."""
        events: list[Event] = []
        while waiting := [w.ready[0].index for w in self.feet.values() if w.ready]:
            index = min(waiting)
            newest = [w.newest for w in self.feet.values() if w.newest is not None]
            if any(index >= one >= max(newest) - SILENT for one in newest):
                break
            ready = [(foot, w.ready) for foot, w in self.feet.items() if w.ready and w.ready[0].index == index]
            seen = {foot: windows.popleft() for foot, windows in ready}
            if self.decided is None or index > self.decided:
                events += self._decide(index, seen, known_at)
        return events

    def _decide(self, index: int, seen: dict[Foot, FootWindow], known_at: float) -> list[Event]:
        events: list[Event] = []
        if self.decided is not None and index - self.decided > LOST:
            events = [] if self.ride is None else self._no_ride(self.ride, known_at)
            self.belief = None
            events += self._change(self._newest(self.decided) + HOP, Activity.UNKNOWN, known_at)
        self.decided = index
        model = self.settings.model or shipped()
        if sum([w.variance for w in seen.values()]) > model.moving * len(seen):
            self.moved += 1
            for foot in seen:
                self.standing[foot].moved()
            if self.moved < WHOLE:
                return events
            state = self._state(model, seen)
            return events if self.moved < SURE else events + self._moves(index, state, known_at)
        self.moved, self.belief = 0, None
        off = 0.0
        for foot, window in seen.items():
            mean = self.standing[foot].mean
            off += 0.0 if mean is None else window.mean - mean
        off /= len(seen)
        pulse = 0 if abs(off) < model.pulse else 1 if off > 0.0 else -1
        if pulse == 0:
            for foot, window in seen.items():
                self.standing[foot].learn(window.mean)
        return events + self._stands(index, pulse, seen, known_at)

    def _state(self, model: WindowModel, seen: dict[Foot, FootWindow]) -> Activity:
        """What kind of movement the hidden Markov model believes in, with this window."""
        feet = [model.log_likelihoods(window) for window in seen.values()]
        share = 1.0 / BLOCKS
        likely = spread([share * sum(values) for values in zip(*feet, strict=True)])
        before = self.belief
        self.belief = weighed(UNIFORM, likely) if before is None else forward(before, model.transitions, likely)
        return MOVING[self.belief.index(max(self.belief))]

    def _moves(self, index: int, state: Activity, known_at: float) -> list[Event]:
        began = self._newest(index - self.moved + 1)
        events: list[Event] = []
        if self.ride is not None:
            ride = self.ride
            events = self._arrive(ride, began, known_at) if ride.braking else self._no_ride(ride, known_at)
        if self.activity in MOVING:
            began = self._newest(index) + 0.5 * (HOP - WINDOW)  # the half-second in the window's middle
        return events + self._change(began, state, known_at)

    def _stands(self, index: int, pulse: int, seen: dict[Foot, FootWindow], known_at: float) -> list[Event]:
        ride, events = self.ride, list[Event]()
        if ride is not None:
            forth = 1 if ride.up else -1
            if pulse == -forth:
                if not ride.braking:
                    events += self._change(ride.began, self.activity, known_at, revises=ride.began)
                ride.braking, ride.newest = True, index
                if index - ride.index < LONGEST_RIDE + LONGEST_PULSE:
                    return events
                pulse = 0
            if ride.braking:
                events += self._arrive(ride, self._start(index), known_at)
                pulse = 0  # a lift that brakes hard swings back
            elif pulse == forth and index - ride.newest <= BLOCKS:
                ride.newest, ride.first_pulse = index, ride.first_pulse + 1
                if ride.first_pulse <= LONGEST_PULSE:
                    return events
                first = all(self.standing[foot].windows <= LONGEST_PULSE for foot in seen)
                for foot, window in seen.items():
                    self.standing[foot] = Standing(window.mean, QUICK, LONGEST_PULSE)
                if first:  # what seemed to be standing at the very first was the pulse, and what lasts is standing
                    ride.up, ride.first_pulse = not ride.up, 1
                    return events + self._change(ride.began, LIFT[ride.up], known_at, final=False, revises=ride.began)
                pulse = 0
                events += self._no_ride(ride, known_at)
            elif pulse == forth or index - ride.index > LONGEST_RIDE:
                events += self._no_ride(ride, known_at)  # the other pulse of that one never came
            else:
                return events
        if pulse == 0:
            return events + self._change(self._start(index), Activity.STANDING, known_at)
        began = self._after(self._newest(index))
        self.ride = LiftPulses(began, index, pulse > 0, newest=index)
        return events + self._change(began, LIFT[pulse > 0], known_at, final=False)

    def _arrive(self, ride: LiftPulses, t: float, known_at: float) -> list[Event]:
        self.ride = None
        t = self._after(t)
        ridden = LiftRidden(t=t, known_at=known_at, t_start=ride.began, up=ride.up, height=None)
        return [ridden, *self._change(t, Activity.STANDING, known_at)]

    def _no_ride(self, ride: LiftPulses, known_at: float) -> list[Event]:
        self.ride = None
        return self._change(ride.began, Activity.STANDING, known_at, revises=ride.began)

    def _change(
        self, t: float, activity: Activity, known_at: float, *, final: bool = True, revises: float | None = None
    ) -> list[Event]:
        """The event of this activity, where that is another or a revision."""
        if activity is self.activity and revises is None:
            return []
        if revises is None:
            t = self._after(t)
        if self.told is None and self.origin is not None:
            t = self.origin  # the first window speaks for the half-second that it was levelled in
        self.activity, self.told = activity, t
        return [
            ActivityChanged(t=t, known_at=known_at, final=final, activity=activity, probability=None, revises=revises)
        ]

    def _after(self, t: float) -> float:
        """`t`, but not before what was told already."""
        return t if self.told is None else max(t, self.told)

    def _start(self, index: int) -> float:
        """When window `index` begins, s."""
        return self._newest(index) + HOP - WINDOW

    def _newest(self, index: int) -> float:
        """When its newest half-second begins."""
        return (0.0 if self.origin is None else self.origin) + index * HOP
