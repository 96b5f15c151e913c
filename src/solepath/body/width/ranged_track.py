"""The track of one foot as ranges between the feet need it: without the jumps of corrections from outside.

A body part may move and turn a foot's track after a stride (`Shift`). Such a jump is no motion of the foot."""

from __future__ import annotations

from math import cos, hypot, sin

from ...events import StrideTaken
from ...foot.view import FootView
from ...types import Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, ZERO, heading_turned

MAX_POINTS, MIN_SPACING = 80, 0.008
"""Largest number of points of a track that are kept, and least time between two of them, s: at least 0.6 s in all, by
which a range may be ahead of the other foot's samples."""
MAX_JUMP = 0.08
"""Largest displacement of a stride, m, that the velocities of its samples do not explain.

Foot-flat corrects an inertial track by 0 to 4 cm (emulated walks at 100 Hz, recipes that integrate the swing). Recipes
that give each stride a length at its end, as footstep-tracker does, move by 15 to 50 cm: where their foot is amid a
swing is not known."""
MAX_STEP = 0.03
"""Longest time between two samples of a stride, s: slower samples smooth a swing too much.

Widths of an emulated walk are 0.3 cm too large at 100 Hz, 2.0 at 50, 2.4 at 40 and 7.5 at 25 Hz."""
MAX_STRIDES = 3
"""Number of newest strides that are kept."""


@frozen
class RangedStride:
    """One stride on the track of its foot."""

    contact: float
    """Time of the heel-strike, or of the foot-flat of a foot that lands flat, s."""
    t_start: float
    """Foot-flat before the stride, s."""
    t_end: float
    """Foot-flat after the stride, s."""
    start: Vec3
    """Place before the stride, m."""
    end: Vec3
    """Place after the stride, m."""
    turn: float
    """Turn of the foot, rad."""
    usable: bool
    """Flag: a level stride, of which nothing is missing."""


@define
class RangedTrack:
    """The newest points and strides of a foot's track, m; heights are above the newest foot-flat."""

    points: list[tuple[float, Vec3, Vec3]] = field(factory=list, init=False)
    """Times, s, places and velocities, m/s, of the newest samples, oldest first."""
    place: Vec3 = field(default=ZERO, init=False)
    """Newest place on the track, m."""
    velocity: Vec3 = field(default=ZERO, init=False)
    """Newest velocity on the track, m/s."""
    jump: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Horizontal displacement since the newest stride that the velocity does not explain, m."""
    longest_step: float = field(default=0.0, init=False)
    """Longest time between two samples since the newest stride, s."""
    t: float | None = field(default=None, init=False)
    """Time of the newest sample, s; None before any."""
    position: Vec3 = field(default=ZERO, init=False)
    """Position at `t` in the foot's own navigation frame, which corrections move, m."""
    attitude: Quat = field(default=IDENTITY, init=False)
    """Attitude at the newest stride's end."""
    turn: float = field(default=0.0, init=False)
    """Turn from the navigation frame into the frame of the track, rad."""
    moved: bool = field(default=False, init=False)
    """Flag: a stride ended with the newest sample, so that a correction may move the track before the next one."""
    strides: list[RangedStride] = field(factory=list, init=False)
    """Newest strides, oldest first."""
    flat: tuple[float, Vec3] | None = field(default=None, init=False)
    """Time, s, and place of the newest end of a stride; None before any."""

    def add_sample(self, view: FootView) -> None:
        """Add a sample with acc and gyro."""
        if self.t is None:
            self.t, self.position = view.t, view.position
        dt, (x, y, z), (px, py, pz), (qx, qy, qz) = view.t - self.t, view.position, self.position, self.place
        if self.moved:
            self.turn -= heading_turned(self.attitude, view.attitude)
        c, s, (u, v, w), (bu, bv, _) = cos(self.turn), sin(self.turn), view.velocity, self.velocity
        u, v = c * u - s * v, s * u + c * v
        if not self.moved:
            dx, dy, (jx, jy) = c * (x - px) - s * (y - py), s * (x - px) + c * (y - py), self.jump
            self.place = (qx + dx, qy + dy, qz + z - pz)
            self.jump = (jx + dx - 0.5 * dt * (u + bu), jy + dy - 0.5 * dt * (v + bv))
        self.longest_step = max(self.longest_step, dt)
        self.moved, self.t, self.position, self.velocity = False, view.t, view.position, (u, v, w)
        if not self.points or view.t - self.points[-1][0] >= MIN_SPACING:
            self.points = [*self.points[1 - MAX_POINTS :], (view.t, self.place, self.velocity)]

    def add_stride(self, stride: StrideTaken, attitude: Quat, usable: bool) -> RangedStride | None:
        """Add a stride that ends with the newest sample; return it, or None for the first one.

        From now on, heights are above its end."""
        self.moved, self.attitude = True, attitude
        x, y, z = self.place
        self.place = (x, y, 0.0)
        self.points = [(t, (px, py, pz - z), velocity) for t, (px, py, pz), velocity in self.points]
        usable = usable and hypot(*self.jump) < MAX_JUMP and self.longest_step < MAX_STEP
        self.jump, self.longest_step = (0.0, 0.0), 0.0
        before, self.flat = self.flat, (stride.t_end, self.place)
        if before is None or before[0] != stride.t_start:
            return None
        contact = stride.t_end if stride.t_heel_strike is None else stride.t_heel_strike
        taken = RangedStride(
            contact, stride.t_start, stride.t_end, before[1], self.place, stride.heading_change, usable
        )  # fmt: skip
        self.strides = [*self.strides[1 - MAX_STRIDES :], taken]
        return taken

    def at(self, t: float) -> tuple[Vec3, Vec3] | None:
        """Return place and velocity, m/s, at `t`, s, between two samples; None when they are not known."""
        for (t0, p, v), (t1, q, w) in zip(reversed(self.points[:-1]), reversed(self.points[1:]), strict=True):
            if t0 <= t <= t1:
                dt, k = t1 - t0, (t - t0) / (t1 - t0)
                # the cubic curve with these places and velocities at both ends
                ends, start, end = k * k * (3.0 - 2.0 * k), k * (1.0 - k) * (1.0 - k) * dt, k * k * (k - 1.0) * dt
                (x, y, z), (u, v_y, v_z) = (
                    [a + ends * (b - a) + start * c + end * d for a, b, c, d in zip(p, q, v, w, strict=True)],
                    [c + k * (d - c) for c, d in zip(v, w, strict=True)],
                )
                return (x, y, z), (u, v_y, v_z)
        return None
