"""One foot, one sample at a time: evidence, navigation, phases and steps.

Order within a sample: gap, calibration, prediction, evidence, correction, cues, phase, step. Everything that happens
is an event; the live position is read from `position` after each sample.
"""

from __future__ import annotations

from math import inf, isfinite, sqrt

from attrs import define, evolve, field

from ..events import Event, FootMoved, Limitation, SampleGap, ScaleSuspect
from ..types import SITE_OF_FOOT, Foot, Layout, Phase, Quat, Sample, Vec3
from ..vector import GRAVITY, ZERO, sub
from .attitude import Levelling, Rest
from .cues import InertialCues, PressureCues, Seen
from .cycle import Cycle
from .dedrift import LinearDedrift
from .eskf import ErrorStateFilter
from .habit import Habit, Leap
from .navigate import LONGEST_BRIDGE
from .phase import BEGINS, PHASES, Cue
from .pressure import Insole
from .pressure_stance import MaximumPressure, TwoArea
from .refusal import refusal, rejected
from .rhythm import Rhythm
from .stance import AngularRate, Graph, Load, MovingVariance, Shoe
from .step import StepBuilder, Way
from .turn import heading_turned
from .world import Covariance3, World

AnyDetector = Cycle | Shoe | AngularRate | MovingVariance | Graph | TwoArea | MaximumPressure
AnyCorrector = ErrorStateFilter | LinearDedrift

STILL = 0.35
"""A foot that is faster than this after the correction is not flat, however much noise the evidence has, m/s."""

WITHOUT = 1.0
"""For this long samples may lack acc or gyro before the foot is said to have none, s."""


@define
class FootTracker:
    """Feed it the samples of one foot in the order of their time."""

    foot: Foot
    detector: AnyDetector
    corrector: AnyCorrector
    poses: bool = False
    """Emit FootMoved for every navigated sample."""
    # state
    t: float | None = field(default=None, init=False)
    """The newest sample, s."""
    moved_at: float | None = field(default=None, init=False)
    """The newest sample with both acc and gyro, s."""
    pressed_at: float | None = field(default=None, init=False)
    """The newest sample that lacked one of them, s."""
    lacking_since: float | None = field(default=None, init=False)
    """Since when no sample has had both, s."""
    load: Load | None = field(default=None, init=False)
    """The newest load, when a sample without acc or gyro brought it."""
    rhythm: Rhythm = field(factory=Rhythm, init=False)
    phase: Phase = field(default=Phase.STATIONARY, init=False)
    phase_began: float | None = field(default=None, init=False)
    levelling: Levelling = field(factory=Levelling, init=False)
    levelled: bool = field(default=False, init=False)
    rest: Rest = field(factory=Rest, init=False)
    insole: Insole = field(factory=Insole, init=False)
    inertial_cues: InertialCues = field(factory=InertialCues, init=False)
    pressure_cues: PressureCues = field(factory=PressureCues, init=False)
    habit: Habit = field(factory=Habit, init=False)
    step: StepBuilder = field(init=False)
    way: Way = field(factory=Way, init=False)
    """In the navigation frame, up to `anchored`."""
    anchored: Vec3 = field(default=ZERO, init=False)
    """Position of the last anchor, navigation frame, m."""
    world: World = field(factory=World, init=False)
    headed: bool = field(default=False, init=False)
    """The world's heading is settled."""
    said: list[str] = field(factory=list, init=False)
    scale_suspected: bool = field(default=False, init=False)

    def __attrs_post_init__(self) -> None:
        self.step = StepBuilder(self.foot)

    # --- what it knows ---

    @property
    def position(self) -> Vec3:
        """Live position of the sensor, world frame, m; where it was first seen is the origin."""
        return self.world.vector(self.corrector.position)

    @property
    def velocity(self) -> Vec3:
        """Live velocity of the sensor, world frame, m/s."""
        return self.world.vector(self.corrector.velocity)

    @property
    def attitude(self) -> Quat:
        """Sensor to world."""
        return self.world.attitude(self.corrector.attitude)

    @property
    def covariance(self) -> Covariance3:
        """Of `position`, m^2."""
        way = self.way.extended(sub(self.corrector.position, self.anchored), self.corrector.covariance())
        return self.world.covariance(way.position)

    # --- samples ---

    def wear(self, layout: Layout) -> None:
        """The device said where its pressure cells are."""
        self.insole.wear(layout)

    def interrupt(self) -> None:
        """The clock of the samples begins anew, before or after the old one; what the foot did between is unknown."""
        if self.t is not None and self.levelled:
            self.corrector.bridge(inf)
        self.t = self.moved_at = self.pressed_at = self.lacking_since = self.phase_began = self.load = None
        self.step.degraded = True
        # Windows over the old times would wait for the new ones to catch up. What was learnt stays.
        axis = self.inertial_cues.axis
        self.detector = evolve(self.detector)
        self.inertial_cues = evolve(self.inertial_cues)
        self.inertial_cues.axis = axis
        self.pressure_cues = evolve(self.pressure_cues)
        self.levelling = evolve(self.levelling)
        self.insole.interrupt()
        self.habit.interrupt()
        self.rest.interrupt()

    def feed(self, sample: Sample) -> list[Event]:
        """One sample of this foot. A sample that cannot be used changes nothing and is named in an event."""
        t = sample.t
        whole = sample.acc is not None and sample.gyro is not None
        last = self.moved_at if whole else self.pressed_at
        why_not = refusal(sample, last)
        if why_not is not None:
            return [rejected(sample, why_not, last)]
        known_at = t if sample.known_at is None else max(t, sample.known_at)
        if sample.acc is None and sample.gyro is None and not sample.pressure:
            return []  # a barometer's or magnetometer's: not a matter of the foot
        events: list[Event] = []
        self.t = t if self.t is None else max(self.t, t)
        if sample.saturated:
            self.step.degraded = True
        load: Load | None = None
        if sample.pressure:
            load = self.insole.update(t, sample.pressure)
            if self.phase is not Phase.SWING and load is not None and self.step.t_toe_off is None:
                self.step.loaded(sum(sample.pressure), self.insole.centre_of_pressure(sample.pressure))
        if sample.acc is not None and sample.gyro is not None:
            dt = 0.0 if last is None else self._watch_for_gaps(last, t, known_at, sample, events)
            self.moved_at = t
            self.lacking_since = None
            if load is None:
                load, self.load = self.load, None
            self._inertial(t, dt, known_at, sample.acc, sample.gyro, sample.saturated, load, events)
            return events
        self.pressed_at = t
        if self.moved_at is not None and t - self.moved_at < WITHOUT:
            self.load = load  # cells and inertial sensor come apart; the next inertial sample takes the load along
        else:
            dt = 0.0 if last is None else self._watch_for_gaps(last, t, known_at, sample, events)
            self._pressure_alone(t, dt, known_at, sample, load, events)
        return events

    def _watch_for_gaps(self, last: float, t: float, known_at: float, sample: Sample, events: list[Event]) -> float:
        """Name a gap between two samples; returns the time to integrate over, s."""
        dt = t - last
        if self.rhythm.update(dt) or dt > LONGEST_BRIDGE:
            events.append(SampleGap(t=last, known_at=known_at, site=SITE_OF_FOOT[self.foot], duration=dt))
            self.step.degraded = True
            if self.levelled:
                dt = self._over_gap(last, t, dt, known_at, sample, events)
        return dt

    def _over_gap(
        self, last: float, t: float, dt: float, known_at: float, sample: Sample, events: list[Event]
    ) -> float:
        corrector, habit = self.corrector, self.habit
        if dt <= habit.shortest or sample.acc is None or sample.gyro is None:
            return corrector.bridge(dt)
        k = self.rest.scale
        x, y, z = sample.acc
        acc, gyro = (x * k, y * k, z * k), sub(sample.gyro, self.rest.bias)
        for again in (False, True):  # within a second a foot may land, stand, and leave again
            leap = habit.leap(
                last, t, acc, gyro, corrector.rate, corrector.attitude, corrector.velocity, corrector.position
            )
            if leap is None:
                if again:
                    return 0.0
                if dt > LONGEST_BRIDGE:
                    habit.interrupt()
                return corrector.bridge(dt)
            if isinstance(leap, str):
                return 0.0
            corrector.leap(t - last, leap.attitude, leap.velocity, leap.position)
            self._went_through(leap, known_at, events)
            if leap.landed is None:
                return 0.0
            last = leap.landed
        return 0.0

    def _went_through(self, leap: Leap, known_at: float, events: list[Event]) -> None:
        """The phases that a gap has hidden."""
        habit = self.habit
        if self.phase is Phase.STATIONARY:
            guessed, due = habit.guessed, habit.due
            self._see(Seen(Cue.LIFT, leap.lifted), known_at, events)
            habit.guessed, habit.due = guessed, due
        if leap.cleared is not None and self.phase is not Phase.SWING and self.step.t_toe_off is None:
            self._see(self.inertial_cues.cleared(leap.cleared), known_at, events)
        if leap.struck is not None and self.phase is Phase.SWING:
            self._see(Seen(Cue.CONTACT, leap.struck), known_at, events)
        if leap.landed is not None:
            self._see(Seen(Cue.FLAT, leap.landed), known_at, events)

    def _inertial(
        self,
        t: float,
        dt: float,
        known_at: float,
        acc: Vec3,
        gyro: Vec3,
        saturated: bool,
        load: Load | None,
        events: list[Event],
    ) -> None:
        rest = self.rest
        if rest.update(t, acc, gyro):
            self._check_scale(t, known_at, events)
        k = rest.scale
        x, y, z = acc
        acc = (x * k, y * k, z * k)
        x, y, z = gyro
        bx, by, bz = rest.bias
        gyro = (x - bx, y - by, z - bz)
        corrector = self.corrector
        stance = self.detector.update(t, dt, acc, gyro, load)
        if not self.levelled:
            first = self.levelling.update(t, acc, gyro)
            if first is not None:
                corrector.start(*first)
                self.levelled = True
                self.step.begin(t, ZERO, corrector.attitude)
            self._say_where(t, known_at, events)
            return
        corrector.predict(dt, acc, gyro, saturated)
        believed = corrector.correct(t, stance)
        vx, vy, vz = corrector.velocity
        speed = sqrt(vx * vx + vy * vy + vz * vz)
        still = believed and speed < STILL
        cues = self.inertial_cues
        seen = cues.update(t, dt, gyro, still, speed, self.phase)
        if load is not None:
            seen = self._with_pressure(t, dt, load, seen)
        if self.habit.lifted is not None and t >= self.habit.due:
            self.habit.keep(t, corrector.attitude, corrector.velocity, corrector.position, acc, gyro)
        self.step.moved(dt, corrector.position[2], speed, cues.sagittal if cues.axis is not None else 0.0)
        if seen is not None:
            self._see(seen, known_at, events)
        elif self.world.north is None:
            self.world.find(corrector.position)
        self._say_where(t, known_at, events)

    def _say_where(self, t: float, known_at: float, events: list[Event]) -> None:
        if self.poses:
            here, velocity = self.position, self.velocity
            events.append(
                FootMoved(t=t, known_at=known_at, foot=self.foot, position=here, velocity=velocity, phase=self.phase)
            )

    def _with_pressure(self, t: float, dt: float, load: Load, seen: Seen | None) -> Seen | None:
        """Contact and clear are the pressure's to say, flat and lift the inertial sensor's; the heel dates the lift."""
        pressed = self.pressure_cues.update(t, dt, load, self.phase)
        if pressed is not None:
            return pressed
        if seen is None or seen.cue is Cue.FLAT:
            return seen
        return self.pressure_cues.dated(seen) if seen.cue is Cue.LIFT else None

    def _pressure_alone(
        self, t: float, dt: float, known_at: float, sample: Sample, load: Load | None, events: list[Event]
    ) -> None:
        if self.lacking_since is None:
            self.lacking_since = t
        lacking = "accelerometer" if sample.acc is None else "gyroscope"
        if t - self.lacking_since >= WITHOUT and lacking not in self.said:
            self.said.append(lacking)
            what = f"no {lacking} on the {self.foot.value} foot: no steps and no track from it"
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], what=what))
        if load is None:
            return
        seen = self.pressure_cues.update(t, dt, load, self.phase) or self.pressure_cues.areas(t, load, self.phase)
        if seen is not None:
            self._see(seen, known_at, events)

    # --- phases and steps ---

    def _see(self, seen: Seen, known_at: float, events: list[Event]) -> None:
        phase = PHASES[self.phase][seen.cue]
        if phase is self.phase:
            return
        self.phase = phase
        # cues look back by different spans; phases follow each other all the same
        t = seen.t if self.phase_began is None else max(seen.t, self.phase_began)
        self.phase_began = t
        events.append(BEGINS[phase](t=t, known_at=max(known_at, t), foot=self.foot))
        if phase is Phase.SWING:
            self.step.t_toe_off = t
        elif phase is Phase.LOADING:
            self.step.t_heel_strike = t
        elif phase is Phase.PUSH_OFF and self.levelled:
            self.habit.lift(t)
            self._anchor()
        elif phase is Phase.STATIONARY and self.levelled:
            self._flat(t, known_at, events)

    def _flat(self, t: float, known_at: float, events: list[Event]) -> None:
        corrector, habit = self.corrector, self.habit
        step = self.step
        turn = heading_turned(step.attitude, corrector.attitude)
        way = sub(corrector.position, step.start)
        mended = habit.flat(t, step.t_toe_off, step.t_heel_strike, turn, way, self.rhythm.usual or 0.0)
        if mended is not None:
            (x, y, z), (dx, dy, dz) = step.start, mended.way
            corrector.mend(mended.turn, (x + dx, y + dy, z + dz))
        position, attitude = corrector.position, corrector.attitude
        if not self.headed and self.step.t_toe_off is not None:
            # the first step fixes the heading; until then it was the direction in which the foot set out
            self.headed = self.world.find(position, self.step.shortest)
        taken = self.step.finish(t, known_at, position, attitude, corrector.covariance(), self.world)
        if taken is not None:
            events.append(taken)
            # a final step is never seen from another frame again, even when it was too short to give a direction
            self.headed = True
            self.world.settle()
        self.step.begin(t, position, attitude)

    def _anchor(self) -> None:
        position = self.corrector.position
        stretch = self.corrector.anchor()
        self.way = self.way.extended(sub(position, self.anchored), stretch)
        self.anchored = position

    def _check_scale(self, t: float, known_at: float, events: list[Event]) -> None:
        magnitude = self.rest.magnitude
        if magnitude is None or self.scale_suspected or 0.85 < magnitude / GRAVITY < 1.15:
            return
        self.scale_suspected = True
        ratio = GRAVITY / magnitude if magnitude > 0.0 else inf
        suggestion = f"multiply acc by {ratio:.3g}" if isfinite(ratio) else "acc reads nothing at all"
        events.append(
            ScaleSuspect(
                t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], magnitude=magnitude, suggestion=suggestion
            )
        )
