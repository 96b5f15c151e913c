"""Record of one stride from foot-flat to foot-flat."""

from __future__ import annotations

from itertools import chain, islice
from math import acos, hypot, sqrt
from typing import NamedTuple

from ..events import Flaw, StrideFeatures, StrideTaken
from ..events.foot import LONGEST_HARMLESS_GAP, is_harmless
from ..types import Foot, Quat, Vec2, Vec3
from ..types.attrs import ROW_SIZE, define, field
from ..types.doubles import Doubles, doubles, pairs
from ..types.vector import GRAVITY, IDENTITY, SPLIT, UP, ZERO, dot, heading_turned, rotate_back, sub, to_float32
from .navigate.corrector import Corrector
from .rhythm import follow
from .view import FASTEST_RUN
from .world import Covariance3, World

MOST_COP_POINTS = 32
"""Largest number of centre-of-pressure points that are stored of a stride."""
MOST_PITCHES = 32
"""Number of samples whose pitch is stored; a toe-off or heel-strike is dated back by fewer samples."""
LONGEST_SWING = 3.0
"""Longest swing of a single stride, s."""
CONTACT_PER_SWING = 1.5
"""Usual ratio of the time on the ground to the time of the swing before it: 60 to 40 % of a gait cycle (Perry 1992)."""
LONGEST_CONTACT = 3.0
"""Longest time on the ground of a foot that walks, s; a foot that stays longer stands. Chosen by hand."""
FLAT_PITCH_GAIN = 0.25
"""Weight of the newest stance in `StrideBuilder.usual_flat_pitch`, 0 to 1; a mean over about four stances."""
FIRST_MOTION = 0.8
"""Time from heel-off to the next foot-flat, s, that counts as usual before the first stride."""
MERGED_RATIO = 1.8
"""Ratio of that time to the wearer's usual one from which on two strides have merged because a stance was missed.

Two swings and a stance take more than twice that time. On recordings without damage 99 % of the ratios are below 1.6.
"""
MOTION_GAIN, LARGEST_MOTION_RATIO = 0.2, 1.3
"""Weight of the newest time in the usual one, and the limit of its ratio to the usual one in the average."""
GUESSED_SPEED_SIGMA = 1.0
"""Standard deviation of the speed of a foot in a gap longer than `LONGEST_HARMLESS_GAP`, m/s: a longer one that is
harmless at a low rate makes the length less sure, too (`solepath-lab damage losses`)."""
FLAT_SIGMA = 0.01
"""Standard deviation of the place of the sensor, m, when its foot comes to lie flat: a shoe gives way, a foot settles
(strides without losses of the first walks of pyshoe_vicon, `solepath-lab damage losses`)."""
MOST_GAPS = 8
"""Number of the newest gaps that are kept one by one, because a foot-flat may be dated back before them."""
RESTING_RATE, RESTING_SHARE = 0.3**2, 0.15**2
"""Squares of the angular rate below which a foot rests, rad/s, and of its share of the peak rate of the stride.

Both were chosen by hand: 0.3 rad/s is the stance of the slowest walkers, whose peaks are 1.5 to 2."""
SHORTEST_STRIDE, LEAST_STRIDE_TURN = 0.06, 0.35
"""Smallest displacement, m, and smallest turn, rad, of a stride; one of the two is enough."""


class GapSums(NamedTuple):
    """What the gaps of a stride add up to, each as far as it lies in the stride, s."""

    missing: float = 0.0
    """Time for which samples are missing."""
    longest: float = 0.0
    """Longest time from one sample to the next."""
    guessed: float = 0.0
    """Square root of the sum of the squared times of gaps longer than `LONGEST_HARMLESS_GAP`."""

    def with_gap(self, gap: Vec3, t_start: float, t_end: float) -> GapSums:
        """Return the sums with a gap of a stride from `t_start` to `t_end`, s."""
        t_last, t_next, interval = gap
        inside = min(t_next, t_end) - max(t_last, t_start)
        if inside <= 0.0:
            return self
        missing = max(0.0, min(inside, t_next - t_last - interval))
        guessed = inside if t_next - t_last > LONGEST_HARMLESS_GAP else 0.0
        return GapSums(self.missing + missing, max(self.longest, inside), hypot(self.guessed, guessed))


@define
class StrideBuilder:
    """Collects the data of one foot's stride."""

    foot: Foot
    t_start: float | None = None
    """Time of the foot-flat that starts the stride, s; None before any."""
    start: Vec3 = ZERO
    """Position at the start, navigation frame, m."""
    attitude: Quat = IDENTITY
    """Attitude at the start, sensor to navigation frame."""
    t_toe_off: float | None = None
    """Time of toe-off, s; None before it."""
    t_heel_strike: float | None = None
    """Time of heel-strike, s; None before it."""
    flawed_until: dict[Flaw, float] = field(factory=dict)
    """Time up to which samples have each flaw, s."""
    flaws: tuple[Flaw, ...] = ()
    """Flaws of the samples of the stride."""
    clips: bool = False
    """Flag: the range of a sensor is known to be too small for the motion."""
    newest_gaps: tuple[Vec3, ...] = ()
    """Of the newest gaps, the last sample before it, the first one after it, and the usual interval, s."""
    older_gaps: GapSums = GapSums()
    """Sums over gaps of the stride that are no longer among the newest."""
    creep: float = 0.0
    """Square of the horizontal distance, m^2, that a foot at rest has moved since the start.

    A foot at rest does not move: the start was wrong by as much, and what corrects it is part of this stride."""
    peak_height: float = 0.0
    """Largest height of the sensor in the stride, navigation frame, m."""
    peak_speed: float = 0.0
    """Largest speed of the sensor in the stride, m/s."""
    rest: Vec3 = ZERO
    """Duration, s, of the rest under way, in which the foot turns slower than `RESTING_RATE` or `RESTING_SHARE` of its
    peak, and the integrals of the specific force squared, (m/s^2)^2 s, and to the fourth power, (m/s^2)^4 s."""
    longest_rest: Vec3 = ZERO
    """The same of the longest rest of the stride."""
    peak_rate: float = 0.0
    """Square of the largest angular rate of this stride and the one before, (rad/s)^2."""
    stride_rate: float = 0.0
    """Square of the largest angular rate of this stride, (rad/s)^2."""
    least_force: float = GRAVITY * GRAVITY
    """Square of the smallest specific force of the stride, (m/s^2)^2."""
    most_force: float = GRAVITY * GRAVITY
    """Square of the largest specific force of the stride, (m/s^2)^2."""
    t_heel_off: float | None = None
    """Time of heel-off, s; None before it."""
    usual_motion: float = FIRST_MOTION
    """Usual time from heel-off to the next foot-flat of this wearer, s."""
    pitch: float = 0.0
    """Integral of the sagittal rate since the start, toe down positive, rad."""
    pitch_low: float = 0.0
    """Smallest pitch of the stride, rad."""
    pitch_high: float = 0.0
    """Largest pitch of the stride, rad."""
    pitches: Doubles = field(factory=lambda: doubles([0.0] * MOST_PITCHES))
    """Ring buffer of the newest pitches, rad, rounded by `to_float32`."""
    next_pitch: int = 0
    """Index of the oldest pitch in `pitches`, which the next one replaces."""
    t_pitch: float = 0.0
    """Time of the newest pitch, s."""
    toe_off_pitch: float | None = None
    """Pitch at toe-off, toe down positive, rad; None if unknown."""
    heel_strike_pitch: float | None = None
    """Pitch at heel-strike, toe down positive, rad; None if unknown."""
    t_contact: float | None = None
    """Time of the heel-strike before this stance, s; None if the foot stands or has not walked."""
    t_mid_stance: float = 0.0
    """Expected middle of the contact that started at `t_contact`, s."""
    contact_time: float | None = None
    """Duration of the last contact, s; None before any."""
    first_pitch: float = 0.0
    """Pitch at the first foot-flat of this contact, rad."""
    flat_pitch: float = 0.0
    """Pitch of the flat sole, rad: that of the still foot at mid-stance, or the newest one of a foot that stands."""
    usual_flat_pitch: float | None = None
    """Mean of `flat_pitch` relative to the first foot-flat of a contact, rad; None before the first stance."""
    load_sum: float = 0.0
    """Sum of the total load over the samples on the ground."""
    load_count: int = 0
    """Number of samples in `load_sum`."""
    cop: Doubles = field(factory=doubles, metadata={ROW_SIZE: 2})
    """Coordinates x and y in turn of the points of the centre of pressure, foot frame, m."""
    cop_interval: int = 1
    """Number of samples for each stored point of the centre of pressure."""
    cop_skipped: int = 0
    """Number of samples since the last stored point of the centre of pressure."""

    def start_stride(self, t: float, position: Vec3, attitude: Quat) -> None:
        """Start a stride at a foot-flat; position (m) and attitude are in the navigation frame."""
        self.t_start = t
        self.start = position
        self.attitude = attitude
        if self.t_heel_strike is not None and self.t_toe_off is not None:
            self.t_contact = self.t_heel_strike
            expected = self.contact_time or CONTACT_PER_SWING * (self.t_heel_strike - self.t_toe_off)
            self.t_mid_stance = self.t_heel_strike + 0.5 * expected
            self.first_pitch = self.flat_pitch = 0.0
        else:  # another foot-flat of the same contact
            self.first_pitch -= self.pitch
            self.flat_pitch -= self.pitch
        self.t_heel_off = self.t_toe_off = self.t_heel_strike = None
        self.toe_off_pitch = self.heel_strike_pitch = None
        # the foot-flat may be dated back into a gap; the rest of the gap then belongs to the new stride
        self.flaws = tuple([flaw for flaw, until in self.flawed_until.items() if t < until])
        self.newest_gaps = tuple([gap for gap in self.newest_gaps if gap[1] > t])
        self.older_gaps = GapSums()
        self.peak_height = position[2]
        self.creep = self.peak_speed = self.pitch = self.pitch_low = self.pitch_high = 0.0
        self.peak_rate, self.stride_rate = self.stride_rate, 0.0
        self.rest = self.longest_rest = ZERO
        self.least_force = GRAVITY * GRAVITY
        self.most_force = self.least_force
        self.load_sum = 0.0
        self.load_count = 0
        self.cop = doubles()
        self.cop_interval = 1
        self.cop_skipped = 0

    def mark_flawed(self, flaw: Flaw, until: float) -> None:
        """Mark that samples up to `until`, s, have a flaw."""
        if flaw not in self.flaws:
            self.flaws = (*self.flaws, flaw)
        self.flawed_until[flaw] = max(until, self.flawed_until.get(flaw, until))

    def add_gap(self, t_last: float, t: float, interval: float) -> None:
        """Add a gap from the sample at `t_last` to that at `t`, s, of a sensor that measures every `interval` s.

        In an absence, the interval is the gap: none of its samples is missing."""
        if len(self.newest_gaps) == MOST_GAPS and self.t_start is not None:
            self.older_gaps = self.older_gaps.with_gap(self.newest_gaps[0], self.t_start, t_last)
        self.newest_gaps = (*self.newest_gaps[1 - MOST_GAPS :], (t_last, t, interval))
        if interval >= t - t_last or not is_harmless(t - t_last, interval):
            self.mark_flawed(Flaw.GAP, t)

    def cut(self) -> None:
        """Discard the stride, because times restart: its start and its end would be times of two clocks."""
        self.t_start, self.t_contact, self.clips = None, None, False
        self.flawed_until, self.newest_gaps, self.older_gaps = {}, (), GapSums()

    def add_motion(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, position: Vec3, speed: float, sagittal: float, still: bool
    ) -> None:
        """Add one sample: position in m, speed in m/s, sagittal rate in rad/s (0 while its axis is unknown).

        `still` is True when zero-velocity evidence was accepted."""
        x, y, z = acc
        u, v, w = gyro
        force, rate = x * x + y * y + z * z, u * u + v * v + w * w
        if force > self.most_force:
            self.most_force = force
        if force < self.least_force:
            self.least_force = force
        if rate > self.stride_rate:
            self.stride_rate = rate
            if rate > self.peak_rate:
                self.peak_rate = rate
        duration, squares, fourths = self.rest
        if rate < RESTING_RATE or rate < RESTING_SHARE * self.peak_rate:
            self.rest = rest = (duration + dt, squares + force * dt, fourths + force * force * dt)
            if rest > self.longest_rest:
                self.longest_rest = rest
        elif duration:
            self.rest = ZERO
        x, y, z = position
        if z > self.peak_height:
            self.peak_height = z
        if speed > self.peak_speed:
            self.peak_speed = speed
        pitch = self.pitch = self.pitch + sagittal * dt
        self.t_pitch = t
        high = SPLIT * pitch  # rounded as by `to_float32`
        self.pitches[self.next_pitch] = high - (high - pitch)
        self.next_pitch = (self.next_pitch + 1) % MOST_PITCHES
        if pitch < self.pitch_low:
            self.pitch_low = pitch
        elif pitch > self.pitch_high:
            self.pitch_high = pitch
        if still and self.t_toe_off is None:
            u, v, _ = self.start
            self.creep = (x - u) * (x - u) + (y - v) * (y - v)
            t_contact = self.t_contact
            if t_contact is None or t <= self.t_mid_stance or t - t_contact > LONGEST_CONTACT:
                self.flat_pitch = pitch

    @property
    def shaking(self) -> float:
        """Standard deviation of the size of the specific force in the longest rest, m/s^2, by that of its square."""
        duration, squares, fourths = self.longest_rest
        return 0.5 * sqrt(max(0.0, fourths / squares - squares / duration)) if squares > 0.0 else 0.0

    def add_toe_off(self, t: float, interval: float) -> None:
        """Set the toe-off at `t`, s; `interval` is the usual interval between samples, s; zeros before any."""
        self.t_toe_off = t
        self.toe_off_pitch = self._pitch_at(t, interval)
        if self.t_contact is not None and 0.0 < t - self.t_contact < LONGEST_CONTACT and self.toe_off_pitch is not None:
            self.contact_time = t - self.t_contact
            flat_pitch, usual = self.flat_pitch - self.first_pitch, self.usual_flat_pitch
            self.usual_flat_pitch = flat_pitch if usual is None else usual + FLAT_PITCH_GAIN * (flat_pitch - usual)
        self.t_contact = None

    def add_heel_strike(self, t: float, interval: float) -> None:
        """Set the heel-strike at `t`, s; `interval` is the usual interval between samples, s; zeros before any."""
        self.t_heel_strike = t
        self.heel_strike_pitch = self._pitch_at(t, interval)

    def _pitch_at(self, t: float, interval: float) -> float | None:
        """Return the pitch at `t`, interpolated between two samples, rad.

        The result is None if a gap hides these samples, or if the sagittal axis is not yet known."""
        if t > self.t_pitch or self.pitches[self.next_pitch - 2] == 0.0:
            return None
        samples_back = (self.t_pitch - t) / interval if interval > 0.0 else 0.0
        samples_back = min(max(samples_back, 0.0), MOST_PITCHES - 2.0)
        k = int(samples_back)
        later, earlier = self.pitches[self.next_pitch - 1 - k], self.pitches[self.next_pitch - 2 - k]
        return later + (samples_back - k) * (earlier - later)

    def _heel_strike_angle(self) -> float | None:
        """Return the angle at heel-strike against the flat sole, rad, positive toe up; None if unknown.

        A sensor at the ankle or on the laces turns with the shank while the sole lies flat, by 20 degrees in the stance
        of some wearers, so the foot-flat is not enough. The stance that follows is still to come; the earlier ones show
        how far the sensor turns from the foot-flat to mid-stance."""
        if self.heel_strike_pitch is None or self.usual_flat_pitch is None:
            return None
        return self.pitch + self.usual_flat_pitch - self.heel_strike_pitch

    def add_load(self, total: float) -> bool:
        """Add the total load of one sample of a foot on the ground; return whether `add_cop` expects its centre."""
        self.load_sum += total
        self.load_count += 1
        self.cop_skipped += 1
        return self.cop_skipped >= self.cop_interval

    def add_cop(self, cop: Vec2 | None) -> None:
        """Store the centre of pressure, foot frame, m; with None that of the next sample is expected.

        At most MOST_COP_POINTS points are stored, at equal intervals. When there are more, every second one is dropped.
        """
        if cop is None:
            return
        self.cop_skipped = 0
        x, y = cop
        self.cop.extend((to_float32(x), to_float32(y)))
        if len(self.cop) > 2 * MOST_COP_POINTS:
            self.cop = doubles(chain.from_iterable(islice(pairs(self.cop), 0, None, 2)))
            self.cop_interval *= 2

    def finish(self, t: float, known_at: float, corrector: Corrector, world: World, rise: float) -> StrideTaken | None:
        """Return the stride that ends at this foot-flat with the state of `corrector`, without its number, or None.

        `rise` is the change of height, m, before the corrector has corrected it."""
        if self.t_start is None or self.t_toe_off is None or max(self.t_start, self.t_toe_off) > t:
            return None
        displacement = world.rotate_vector(sub(corrector.position, self.start))
        length, dz = hypot(displacement[0], displacement[1]), displacement[2]
        turn = heading_turned(self.attitude, corrector.attitude)
        if hypot(length, dz) < SHORTEST_STRIDE and abs(turn) < LEAST_STRIDE_TURN:
            return None
        flaws, usual = self.flaws, self.usual_motion
        motion = usual if self.t_heel_off is None else t - self.t_heel_off
        if not flaws:  # also of a merged one, so that a wearer who walks ever slower is learnt
            self.usual_motion = follow(usual, motion, MOTION_GAIN, largest=LARGEST_MOTION_RATIO)
        if motion > MERGED_RATIO * usual or t - self.t_toe_off > LONGEST_SWING:
            flaws = (*flaws, Flaw.TWO_STRIDES)
        if length > FASTEST_RUN * (t - self.t_start):
            flaws = (*flaws, Flaw.IMPOSSIBLE)
        if self.clips and corrector.clipped and Flaw.RANGE not in flaws:
            flaws = (*flaws, Flaw.RANGE)
        covariance = world.rotate_covariance(corrector.covariance()[:6])
        gaps = self.older_gaps
        for gap in self.newest_gaps:
            gaps = gaps.with_gap(gap, self.t_start, t)
        return StrideTaken(
            t=t,
            known_at=known_at,
            foot=self.foot,
            number=0,
            t_start=self.t_start,
            t_end=t,
            displacement=displacement,
            position=world.rotate_vector(corrector.position),
            length=length,
            heading_change=turn,
            height_change=dz,
            covariance=covariance,
            t_toe_off=self.t_toe_off,
            t_heel_strike=self.t_heel_strike,
            missing=min(1.0, gaps.missing / (t - self.t_start)) if t > self.t_start else 0.0,
            longest_gap=gaps.longest,
            length_sigma=_length_sigma(displacement, covariance, gaps.guessed, self.creep),
            flaws=flaws,
            features=StrideFeatures(
                clearance=self.peak_height - max(corrector.position[2], self.start[2]),
                peak_speed=self.peak_speed,
                swing_pitch=self.pitch_high - self.pitch_low,
                toe_off_angle=None if self.toe_off_pitch is None else self.toe_off_pitch - self.flat_pitch,
                heel_strike_angle=self._heel_strike_angle(),
                contact_load=self.load_sum / self.load_count if self.load_count else None,
                cop=tuple(pairs(self.cop)),
                error_index=corrector.error_index,
                longest_rest=self.longest_rest[0],
                rest_force=sqrt(self.longest_rest[1] / self.longest_rest[0]) if self.longest_rest[0] > 0.0 else None,
                peak_rate=sqrt(self.peak_rate),
                force_range=sqrt(self.most_force) - sqrt(self.least_force),
                rise=rise,
                tilt=_tilt(self.attitude, corrector.attitude),
            ),
        )


def _tilt(before: Quat, after: Quat) -> float:
    """Return the angle between the directions of up in the sensor in two attitudes, rad."""
    cosine = dot(rotate_back(before, UP), rotate_back(after, UP))
    return acos(max(-1.0, min(1.0, cosine)))


def _length_sigma(displacement: Vec3, covariance: Covariance3, guessed_time: float, creep: float) -> float:
    """Return the standard deviation of the horizontal length of a stride, m.

    To what the corrector knows, if it keeps a covariance, come the creep of the start, m^2, and both ends; to that the
    time that was guessed, s."""
    (x, y, _), (xx, xy, _, yy, _, _) = displacement, covariance
    square = x * x + y * y
    along = (x * x * xx + 2.0 * x * y * xy + y * y * yy) / square if square > 0.0 else 0.5 * (xx + yy)
    known = along + creep + 2.0 * FLAT_SIGMA * FLAT_SIGMA if along > 0.0 else 0.0
    guessed = GUESSED_SPEED_SIGMA * guessed_time
    return sqrt(known + guessed * guessed)
