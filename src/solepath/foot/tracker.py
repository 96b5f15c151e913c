"""Tracker of one foot: stance evidence, navigation and cues, one sample at a time.

The order within a sample is: gap, calibration, prediction, evidence, correction, cues, phases and strides (gait.py).
The results are events; `position` is the live position after each sample."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING, Any

from ..events import Defect, DefectFound, Event, Flaw, FootMoved, HeelStrike, SampleGap
from ..types import SITE_OF_FOOT, Foot, Layout, Phase, Quat, Sample, Vec3
from ..types.attrs import MADE_AGAIN, evolve, field, state, stateful
from ..types.records import MAX_TIME
from ..types.vector import ZERO
from .attitude import Levelling, Rest, WalkScale
from .bearing import KNOWN
from .cues.cues import Cues, TimedCue
from .gait import FLAT_SPEED, Gait
from .gap import SHORTEST_FILLED_GAP, NoInfill, find_infill
from .limitations import Limitations
from .navigate.corrector import LONGEST_BRIDGE, Corrector
from .phase import SWING
from .rejection import rejected, rejection_reason
from .rhythm import Rhythm
from .settings import FootSettings
from .stance.stance import Detector, Load, Stance
from .stuck import Stuck
from .view import AfterEvents, FootPose, FootView, PressedCells
from .world import Covariance3

if TYPE_CHECKING:
    from .pressure.insole import Sole


@stateful
class FootTracker:
    """Tracks one foot from its samples, which must be in order of time."""

    foot: Foot = field()
    detector: Detector = field()
    corrector: Corrector = field()
    cues: Cues = field()
    settings: FootSettings = field(default=FootSettings())
    sole: Sole | None = state(default=None, metadata=MADE_AGAIN)
    """Pressure cells of the foot; None until there are any."""
    t: float | None = None
    """Time of the newest sample, s; None before any."""
    moved_at: float | None = None
    """Time of the newest sample with both acc and gyro, s; None before any."""
    partial_at: float | None = None
    """Time of the newest sample without acc or gyro, s; None before any."""
    viewed_at: float | None = None
    """Time of the newest sample whose view the parts of the body received, s; None before any."""
    load: Load | None = None
    """Newest load that came without acc or gyro and waits for the next inertial sample; None otherwise."""
    counts_losses: bool = True
    """Flag: samples are fed without a link, which counts losses itself."""
    gap_end: float = -MAX_TIME
    """Time of the end of the newest gap that was reported, s."""
    stuck: Stuck = state(factory=Stuck)
    rhythm: Rhythm = state(factory=Rhythm)
    levelling: Levelling = state(factory=Levelling)
    levelled: bool = False
    """The first attitude is known."""
    rest: Rest = state(factory=Rest)
    walk_scale: WalkScale = state(factory=WalkScale)
    gait: Gait = field(init=False)
    limitations: Limitations = field(init=False)

    def __attrs_post_init__(self) -> None:
        self.gait = Gait(self.foot, self.settings.heading, self.settings.every_stride)
        self.limitations = Limitations(self.foot)

    def make_sole(self) -> Sole:
        """Make the sole of a foot whose sensor has pressure cells, if it has none yet; return it."""
        from .pressure.insole import Sole  # many sensors have no cells

        sole = self.sole = self.sole or Sole(self.foot, self.settings)
        return sole

    @property
    def phase(self) -> Phase:
        """Phase of the foot."""
        return self.gait.phase

    @property
    def position(self) -> Vec3:
        """Live position of the sensor, world frame, m; the origin is its first position."""
        return self.gait.world.rotate_vector(self.corrector.position)

    @property
    def velocity(self) -> Vec3:
        """Live velocity of the sensor, world frame, m/s."""
        return self.gait.world.rotate_vector(self.corrector.velocity)

    @property
    def attitude(self) -> Quat:
        """Live attitude, sensor to world frame."""
        return self.gait.world.rotate_attitude(self.corrector.attitude)

    @property
    def covariance(self) -> Covariance3:
        """Covariance of the live position, world frame, m^2."""
        return self.gait.covariance(self.corrector)

    @property
    def pose(self) -> FootPose | None:
        """Position of the foot with its covariance; None before any sample."""
        return None if self.t is None else FootPose(self.foot, self.t, self.moved_at, self.position, self.covariance)

    def view(
        self, sample: Sample, known_at: float, happened: bool, with_covariance: bool, other_t: float | None
    ) -> FootView:
        """Return the view after `sample`; if events `happened`, `other_t` is `viewed_at` of the other foot, s."""
        corrector, gait, rest = self.corrector, self.gait, self.rest
        insole = None if self.sole is None else self.sole.insole
        after, pressed = None, None
        if happened:
            layout = None if insole is None else insole.layout
            error = gait.world.rotate_vector(corrector.velocity_error)
            takes_shifts = with_covariance and hasattr(corrector, "shift")
            covariance = gait.covariance(corrector) if with_covariance else None
            attitude, bias = gait.stride.attitude, rest.bias_filter.bias
            nobody = gait.bearing.evidence <= -KNOWN
            after = AfterEvents(attitude, layout, other_t, takes_shifts, covariance, bias, error, nobody)
        if insole is not None and insole.cells:
            cells, layout = insole.cells, insole.layout
            newtons = insole.settings.newtons is not None or (layout is not None and layout.scale is not None)
            without_inertial = self.moved_at is None and sample.gyro is None
            centre = insole.centre_of_pressure(cells) if without_inertial else None
            pressed = PressedCells(cells, layout, newtons, centre)
        return FootView(
            self.foot, sample, sample.t, known_at, self.moved_at, self.levelled, gait.phase,
            corrector.position, corrector.velocity, corrector.attitude, gait.world.north,
            rest.bias, rest.grain if rest.count else 0.0, pressed, after,
        )  # fmt: skip

    def take_impact(self, t: float, known_at: float) -> HeelStrike | None:
        """Return the heel-strike that the sample of `t`, s, shows, if not final yet; None for a foot with cells."""
        impact_at, gait, sole = self.cues.impact_at, self.gait, self.sole
        is_new = impact_at is not None and gait.impact_at is None and gait.phase is SWING
        if impact_at is None or not is_new or (sole is not None and sole.had_cells):
            return None
        return gait.add_impact(impact_at, t, known_at)

    def mark_defect(self, defect: Defect) -> None:
        """Mark strides as flawed from now until `reset`: all, or if a range is too small those with cut-off peaks."""
        if defect is Defect.CLIPPED:
            self.gait.stride.clips = True
        else:
            self.gait.stride.mark_flawed(Flaw.DEFECT, MAX_TIME)

    def shift(self, yaw: float, by: Vec3) -> None:
        """Turn the foot by `yaw` rad and move it by `by` m, world frame, from now on.

        The live track and the next strides change. Reported strides stay, and no stride gets longer. Call it between a
        foot-flat and the next sample. A corrector without a method `shift` is not changed."""
        apply_shift = getattr(self.corrector, "shift", None)
        if apply_shift is not None:
            apply_shift(yaw, self.gait.shift(yaw, by))

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells that the device has sent."""
        sole = self.make_sole()
        sole.set_layout(layout, self.limitations)
        self._set_layouts(sole, layout)

    def _set_layouts(self, sole: Sole, layout: Layout) -> None:
        sole.layout_changed = False
        self.detector.set_layout(layout)
        self.cues.set_layout(layout)
        self.limitations.queue(self.detector.lacking)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, because times restart, earlier or later, after unknown motion."""
        if self.t is not None and self.levelled:
            self.corrector.bridge(inf)
        self.t = self.moved_at = self.partial_at = self.viewed_at = self.limitations.lacking_since = self.load = None
        self.limitations.mismatch_since = None
        self.gap_end = -MAX_TIME
        self.gait.reset()
        # Windows that hold old times would wait until the new times reach them. What was learnt stays.
        detector: Any = self.detector
        self.detector = evolve(detector)
        self.cues.restart()
        if self.sole is not None:
            if self.sole.insole.layout is not None:
                self._set_layouts(self.sole, self.sole.insole.layout)
            self.sole.reset()
        self.levelling = Levelling()
        self.rest.reset()
        self.walk_scale.reset()
        self.stuck = Stuck()

    def feed(self, sample: Sample) -> list[Event]:
        """Return the events of one sample of this foot; one that cannot be used is reported and changes no state."""
        t: float = sample.t
        acc: Vec3 | None = sample.acc  # declared, because the fields of a compiled Sample have any type
        gyro: Vec3 | None = sample.gyro
        t_last = self.moved_at if (has_inertial := acc is not None and gyro is not None) else self.partial_at
        if (rejection := rejection_reason(sample, t_last)) is not None:
            return [rejected(sample, rejection, t_last)]
        known_at = sample.known_at if sample.known_at > t else t
        if acc is None and gyro is None and not sample.pressure:
            return []  # from a barometer or magnetometer, which a foot does not use
        events: list[Event] = []
        if acc is not None and gyro is not None:
            what = self.stuck.update(t, acc, gyro)
            if what is not None:
                events.append(self._stuck_sensor(what, t, known_at))
            if self.stuck.held:
                return events
        if self.limitations.pending:
            self.limitations.flush(t, known_at, events)
        if self.t is None or t > self.t:
            self.t = t
        if sample.saturated:
            self.gait.stride.mark_flawed(Flaw.RANGE, t)
        sole, load = self.sole, None
        if sample.pressure or (sole is not None and sole.had_cells):
            sole = sole or self.make_sole()
            load = self._add_cells(sole, sample, known_at, events)
        if not has_inertial:
            if t_last is not None and t - t_last > self.rhythm.longest_loss:
                self.limitations.lacking_since = None  # an absence shows nothing of what the sensor lacks
            self.partial_at = t
            if self.moved_at is not None and not self.limitations.is_lacking(t):
                self.load = load  # cells and inertial sensor send separately: the next inertial sample uses this load
                return events
        dt = 0.0 if t_last is None else t - t_last
        is_gap = t_last is not None and self.rhythm.update(dt)
        if t_last is not None and (is_gap or dt > LONGEST_BRIDGE):
            if is_gap or (self.counts_losses and len(self.rhythm.first) == 1):
                self._report_gap(t_last, t, known_at, events)
            dt = self._cross_gap(t_last, t, known_at, sample, events)
        if load is None and self.settings.needs_pressure and (sole is None or not sole.had_cells):
            self.moved_at = t if has_inertial else self.moved_at
            text = f"no pressure cells on the {self.foot.value} foot: this recipe has nothing to say of it"
            self.limitations.report_lacking(text, t, known_at, events)
            return events
        if acc is None or gyro is None:
            text = f"no {'accelerometer' if acc is None else 'gyroscope'} on the {self.foot.value} foot"
            has_contacts = sole is not None and sole.had_cells
            lacking = "its pressure cells show contacts, and no strides and no track" if has_contacts else ""
            text = f"{text}: {lacking or 'no steps and no track from it'}"
            self.limitations.report_lacking(text, t, known_at, events)
            if load is not None:
                for timed_cue in self.cues.alone(t, dt, load, self.phase):
                    self._apply_cue(timed_cue, t, known_at, events)
            return events
        self.moved_at = t
        self.limitations.lacking_since = None
        if load is None and self.load is not None:
            load, self.load = self.load, None
        rest, corrector, gait = self.rest, self.corrector, self.gait
        if sample.quat is not None:
            corrector.use_attitude(sample.quat)
        if rest.update(t, acc, gyro):
            self.detector.scaled(rest.scale)
            corrector.scaled(rest.scale)
        if not rest.count:
            self.walk_scale.add_sample(t, acc, gyro)
        k, (bx, by, bz) = rest.scale, rest.bias
        x, y, z = acc
        u, v, w = gyro
        acc, gyro = (x * k, y * k, z * k), (u - bx, v - by, w - bz)
        if self.levelled or self.levelling.found:
            corrector.predict(dt, acc, gyro, sample.saturated)
        stance = self.detector.update(t, dt, acc, gyro, load, corrector.attitude)
        if not self.levelled:
            self._level(t, acc, gyro, stance)
            if self.settings.poses:
                self._report_motion(t, known_at, events)
            return events
        drift = corrector.velocity[2]
        accepted = corrector.correct(t, stance)
        vx, vy, vz = corrector.velocity
        if accepted and not rest.count:
            rest.scale = self.walk_scale.add_evidence(t, drift - vz, k)
        speed = sqrt(vx * vx + vy * vy + vz * vz)
        cues, still = self.cues, accepted and speed < FLAT_SPEED
        timed_cues = cues.update(t, dt, acc, gyro, still, speed, gait.phase, load, stance)
        if cues.mark is not None:
            corrector.mark(t, cues.mark)
        template, position = gait.template, corrector.position
        if template.t_heel_off is not None and t >= template.t_next_moment:
            template.add_moment(t, corrector.attitude, corrector.velocity, position, acc, gyro)
        gait.stride.add_motion(t, dt, acc, gyro, position, speed, cues.sagittal, still)
        if timed_cues:
            for timed_cue in timed_cues:
                self._apply_cue(timed_cue, t, known_at, events)
        elif not gait.heading_settled:
            gait.follow_heading(position, corrector.attitude)
        if self.settings.poses:
            self._report_motion(t, known_at, events)
        return events

    def _stuck_sensor(self, what: str, t: float, known_at: float) -> DefectFound:
        """Return the event of a stuck sensor, whose samples are not used."""
        self.mark_defect(Defect.REPEATED)
        site = SITE_OF_FOOT[self.foot]
        return DefectFound(t=t, known_at=known_at, site=site, defect=Defect.REPEATED, what=what)

    def _add_cells(self, sole: Sole, sample: Sample, known_at: float, events: list[Event]) -> Load | None:
        """Add the pressure cells of a sample; return the load, or None while it is not known."""
        gait = self.gait
        with_centre = self.cues.uses_centre or self.detector.uses_centre
        load = sole.add_sample(sample, known_at, gait.phase, with_centre, self.limitations, events)
        if sole.layout_changed and sole.insole.layout is not None:
            self._set_layouts(sole, sole.insole.layout)
        if load is None or gait.phase is SWING or gait.stride.t_toe_off is not None:
            return load
        if gait.stride.add_load(sole.insole.sum):
            is_known = load.airborne or with_centre
            gait.stride.add_cop(load.centre if is_known else sole.insole.centre_of_pressure(load.cells))
        return load

    def _report_gap(self, t_last: float, t: float, known_at: float, events: list[Event]) -> None:
        """Report what no earlier event covers of a gap: a loss where no link counts them, or an absence."""
        start = max(t_last, self.gap_end)
        count, is_absence = self.rhythm.count_missing(t - start), t - start > self.rhythm.longest_loss
        if is_absence or (count > 0 and self.counts_losses):
            self.gap_end, site = t, SITE_OF_FOOT[self.foot]
            events.append(SampleGap(t=start, known_at=known_at, site=site, duration=t - start, count=count))

    def _cross_gap(self, t_last: float, t: float, known_at: float, sample: Sample, events: list[Event]) -> float:
        """Return the time to integrate over between two samples that are far apart, s.

        If there is a stride template (gap.py), the gap is filled and the phases that it hid are appended to `events`;
        else it is crossed by a straight line."""
        duration = t - t_last
        corrector, gait = self.corrector, self.gait
        template = gait.template
        gait.stride.add_gap(
            t_last, t, self.rhythm.usual_interval or 0.0 if duration <= self.rhythm.longest_loss else duration
        )
        if duration > self.rhythm.longest_loss:
            gait.stride.t_start = None  # nothing is known of an absence, so no stride lasts through it
        if duration > LONGEST_BRIDGE:
            self.rest.end_rest()
            self.levelling = Levelling()
        if not self.levelled:
            return duration
        if duration <= SHORTEST_FILLED_GAP or sample.acc is None or sample.gyro is None:
            return corrector.bridge(duration)
        acc, gyro = self.rest.calibrate(sample.acc, sample.gyro)
        infill = find_infill(template, corrector, t_last, t, acc, gyro)
        if infill is NoInfill.UNKNOWN:
            template.bridged = True
            if duration > LONGEST_BRIDGE:
                template.reset()
            return corrector.bridge(duration)
        for _ in range(2):  # within a second a foot may land, stand and leave again
            if isinstance(infill, NoInfill):
                break
            self.cues.reset()
            corrector.infill(t - t_last, infill.attitude, infill.velocity, infill.position)
            events += gait.apply_infill(infill, self.cues, t, known_at, corrector, self.rhythm.usual_interval or 0.0)
            if infill.t_foot_flat is None:
                break
            t_last = infill.t_foot_flat
            infill = find_infill(template, corrector, t_last, t, acc, gyro)
        return 0.0

    def _level(self, t: float, acc: Vec3, gyro: Vec3, stance: Stance) -> None:
        """Look for the first attitude, and start navigation with each better one."""
        if (first_attitude := self.levelling.update(t, acc, gyro)) is not None:
            self.corrector.start(*first_attitude)
            self.gait.stride.start_stride(t, ZERO, self.corrector.attitude)
        if self.levelling.final:
            self.levelled = True
            if self.levelling.walks:
                self.gait.start_walking(self.corrector.correct(t, stance))

    def _report_motion(self, t: float, known_at: float, events: list[Event]) -> None:
        p, v = self.position, self.velocity
        events.append(FootMoved(t=t, known_at=known_at, foot=self.foot, position=p, velocity=v, phase=self.phase))

    def _apply_cue(self, timed_cue: TimedCue, t: float, known_at: float, events: list[Event]) -> None:
        corrector = self.corrector if self.levelled else None
        events += self.gait.apply_cue(timed_cue, t, known_at, corrector, self.rhythm.usual_interval or 0.0)
