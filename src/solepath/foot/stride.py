"""From foot-flat to foot-flat: the record of one step and the uncertainty of the way so far."""

from __future__ import annotations

from math import hypot

from ..events import StrideFeatures, StrideTaken
from ..types import Foot, Quat, Vec3
from ..types.attrs import define, field
from ..types.vector import IDENTITY, SPLIT, ZERO, heading_turned, single, sub
from .world import World

COP_POINTS = 32
PITCHES_KEPT = 32
"""Samples of which the pitch is kept: a toe-off or heel-strike is dated back by less."""


LONGEST_SWING = 3.0
"""A foot that was away for longer did more than a step, s."""
FASTEST = 10.0
"""Nor does anybody run faster than this, m/s."""


@define
class PathCovariance:
    """Covariance of position and heading along a chain of stretches, by dead-reckoning's rule.

    A stretch d (m) of covariance C begins with the heading uncertain by s (rad): its end errs by C and by s times d
    turned by 90 degrees. O(1) memory however long the way.
    """

    position: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """xx, xy, xz, yy, yz, zz in m^2."""
    yaw: float = 0.0
    """rad^2."""
    position_yaw: tuple[float, float] = (0.0, 0.0)
    """Position x, y with yaw, m rad."""

    def extended(self, displacement: Vec3, stretch: tuple[float, ...]) -> PathCovariance:
        """The way with one more stretch (`Corrector.anchor`), both in the same frame."""
        dx, dy, _ = displacement
        px, py = -dy, dx
        sxx, sxy, sxz, syy, syz, szz, yaw = stretch
        xx, xy, xz, y2, yz, zz = self.position
        mx, my = self.position_yaw
        v = self.yaw
        return PathCovariance(
            (
                xx + sxx + 2.0 * mx * px + v * px * px,
                xy + sxy + mx * py + my * px + v * px * py,
                xz + sxz,
                y2 + syy + 2.0 * my * py + v * py * py,
                yz + syz,
                zz + szz,
            ),
            v + yaw,
            (mx + v * px, my + v * py),
        )


SHORTEST_STRIDE, LEAST_TURN = 0.06, 0.35
"""A foot that comes down this near to where it stood, m, has taken no stride, unless it turned by this much, rad."""


@define
class StrideBuilder:
    """Gathers one foot's step while it happens."""

    foot: Foot
    number: int = field(default=0, init=False)
    t_start: float | None = field(default=None, init=False)
    start: Vec3 = field(default=ZERO, init=False)
    attitude: Quat = field(default=IDENTITY, init=False)
    t_toe_off: float | None = field(default=None, init=False)
    t_heel_strike: float | None = field(default=None, init=False)
    degraded: bool = field(default=False, init=False)
    degraded_until: float | None = field(default=None, init=False)
    """Up to then samples were missing or saturated, s; None when nothing is wrong since times began."""
    peak_height: float = field(default=0.0, init=False)
    peak_speed: float = field(default=0.0, init=False)
    pitch: float = field(default=0.0, init=False)
    pitch_low: float = field(default=0.0, init=False)
    pitch_high: float = field(default=0.0, init=False)
    pitches: list[float] = field(factory=lambda: [0.0] * PITCHES_KEPT, init=False)
    """The newest ones, rad, as `single` has them; the next goes to `slot`."""
    slot: int = field(default=0, init=False)
    pitch_at: float = field(default=0.0, init=False)
    """When the newest one was, s."""
    toe_off_pitch: float | None = field(default=None, init=False)
    heel_strike_pitch: float | None = field(default=None, init=False)
    """Toe down positive, rad."""
    load_sum: float = field(default=0.0, init=False)
    load_count: int = field(default=0, init=False)
    cop: list[tuple[float, float]] = field(factory=list, init=False)
    cop_interval: int = field(default=1, init=False)
    cop_skipped: int = field(default=0, init=False)

    def start_stride(self, t: float, position: Vec3, attitude: Quat) -> None:
        """The foot is flat here: a step may start. Position (m) and attitude in the navigation frame."""
        self.t_start = t
        self.start = position
        self.attitude = attitude
        self.t_toe_off = self.t_heel_strike = None
        self.toe_off_pitch = self.heel_strike_pitch = None
        # foot-flat is dated back, into a gap even: what is wrong after it is wrong with the new step
        self.degraded = self.degraded_until is not None and t < self.degraded_until
        self.peak_height = position[2]
        self.peak_speed = self.pitch = self.pitch_low = self.pitch_high = 0.0
        self.load_sum = 0.0
        self.load_count = 0
        self.cop = []
        self.cop_interval = 1
        self.cop_skipped = 0

    def mark_degraded(self, until: float | None) -> None:
        """Samples up to `until`, s, are missing or saturated; None: nobody knows which, and times begin anew."""
        self.degraded = True
        self.degraded_until = until

    def add_motion(self, t: float, dt: float, height: float, speed: float, sagittal: float) -> None:
        """One sample: height in m, speed in m/s, sagittal rate in rad/s, 0 while its axis is not known."""
        if height > self.peak_height:
            self.peak_height = height
        if speed > self.peak_speed:
            self.peak_speed = speed
        pitch = self.pitch = self.pitch + sagittal * dt
        self.pitch_at = t
        high = SPLIT * pitch  # rounded as by `single`
        self.pitches[self.slot] = high - (high - pitch)
        self.slot = (self.slot + 1) % PITCHES_KEPT
        if pitch < self.pitch_low:
            self.pitch_low = pitch
        elif pitch > self.pitch_high:
            self.pitch_high = pitch

    def add_toe_off(self, t: float, interval: float) -> None:
        """The toe left the ground at `t`, s. `interval`: the usual one between samples, s."""
        self.t_toe_off = t
        self.toe_off_pitch = self._pitch_at(t, interval)

    def add_heel_strike(self, t: float, interval: float) -> None:
        """The foot touched the ground at `t`, s."""
        self.t_heel_strike = t
        self.heel_strike_pitch = self._pitch_at(t, interval)

    def _pitch_at(self, t: float, interval: float) -> float | None:
        """Between the two samples around `t`, rad; None when a gap hides them, and before the axis is known: nothing
        has turned."""
        if t > self.pitch_at or self.pitches[self.slot - 2] == 0.0:
            return None
        back = (self.pitch_at - t) / interval if interval > 0.0 else 0.0
        back = min(max(back, 0.0), PITCHES_KEPT - 2.0)
        k = int(back)
        later, earlier = self.pitches[self.slot - 1 - k], self.pitches[self.slot - 2 - k]
        return later + (back - k) * (earlier - later)

    def add_load(self, total: float, cop: tuple[float, float] | None) -> None:
        """One sample of a foot on the ground. Keeps at most COP_POINTS points, evenly spaced, by thinning."""
        self.load_sum += total
        self.load_count += 1
        if cop is None:
            return
        self.cop_skipped += 1
        if self.cop_skipped < self.cop_interval:
            return
        self.cop_skipped = 0
        x, y = cop
        self.cop.append((single(x), single(y)))
        if len(self.cop) > COP_POINTS:
            self.cop = self.cop[::2]
            self.cop_interval *= 2

    def finish(
        self,
        t: float,
        known_at: float,
        position: Vec3,
        attitude: Quat,
        stretch: tuple[float, ...],
        world: World,
        *,
        error_index: float | None = None,
        rise: float | None = None,
    ) -> StrideTaken | None:
        """The foot is flat again: the step, if it was one. `position`, `attitude` and `stretch` as `start_stride` had them."""
        if self.t_start is None or self.t_toe_off is None or max(self.t_start, self.t_toe_off) > t:
            return None  # no step, or one that times beginning anew have cut in two
        displacement = world.vector(sub(position, self.start))
        length, dz = hypot(displacement[0], displacement[1]), displacement[2]
        turn = heading_turned(self.attitude, attitude)
        if hypot(length, dz) < SHORTEST_STRIDE and abs(turn) < LEAST_TURN:
            return None
        self.number += 1
        return StrideTaken(
            t=t,
            known_at=known_at,
            foot=self.foot,
            number=self.number,
            t_start=self.t_start,
            t_end=t,
            displacement=displacement,
            position=world.vector(position),
            length=length,
            heading_change=turn,
            height_change=dz,
            covariance=world.covariance(stretch[:6]),
            t_toe_off=self.t_toe_off,
            t_heel_strike=self.t_heel_strike,
            degraded=self.degraded or t - self.t_toe_off > LONGEST_SWING or length > FASTEST * (t - self.t_start),
            features=StrideFeatures(
                clearance=self.peak_height - max(position[2], self.start[2]),
                peak_speed=self.peak_speed,
                swing_pitch=self.pitch_high - self.pitch_low,
                toe_off_angle=self.toe_off_pitch,
                # the sole that lies flat again is what it is measured against
                heel_strike_angle=None if self.heel_strike_pitch is None else self.pitch - self.heel_strike_pitch,
                contact_load=self.load_sum / self.load_count if self.load_count else None,
                cop=tuple(self.cop),
                error_index=error_index,
                rise=rise,
            ),
        )
