"""Time of the impact with which the ground stops a foot.

The turn of the foot, or the loss of its speed, shows that the foot has landed. The jerk, j = d acc / dt, shows the
time. The ground stops the foot within some hundredths of a second, and heel-strike is the middle of this interval: the
mean time weighted by the squared jerk,

    t_HS = sum t |j|^2 dt / sum |j|^2 dt.

This needs no threshold on the force and works for any mounting and rate. It is not early when the sole turns down well
before it bears weight.

"Shock" is the integral of the squared jerk, m^2/s^5. The numbers were chosen by hand on the recordings of
docs/accuracy.md and not swept."""

from __future__ import annotations

from ...types import Vec3
from ...types.attrs import define, field

LARGEST_SHOCK = 1e12
"""Largest shock that one sample may add, m^2/s^5."""
SHOCK_MEMORY_TIME = 0.02
"""Time constant with which the shock decays before the foot lands, s."""
SHORTEST_LANDING_DELAY = 0.1
"""Shortest time from toe-off to the impact of landing, s; an earlier shock comes from leaving the ground."""


@define
class Impact:
    """The impact that ends one swing. Call `add_sample` for every sample of the swing."""

    swing_start: float | None = field(default=None, init=False)
    """Start of the swing, s; None before any."""
    shock: float = field(default=0.0, init=False)
    """Recent shock, m^2/s^5."""
    mean_time: float = field(default=0.0, init=False)
    """Mean time of `shock`, s."""
    peak_speed: float = field(default=0.0, init=False)
    """Largest speed of the swing so far, m/s."""
    peak_shock: float = field(default=0.0, init=False)
    """Largest shock since the foot had its largest speed, m^2/s^5."""
    peak_shock_time: float = field(default=0.0, init=False)
    """Mean time of `peak_shock`, s."""

    def start_swing(self, t: float) -> None:
        """Start a swing at toe-off at `t`, s."""
        self.swing_start = self.mean_time = t
        self.shock = self.peak_speed = self.peak_shock = 0.0

    def add_sample(self, t: float, dt: float, previous_acc: Vec3, acc: Vec3, speed: float, landing: bool) -> None:
        """Add one sample of the swing.

        `previous_acc` and `acc` are the specific force of the last sample and of this one, m/s^2. `speed` is in m/s.
        While `landing` is True the shock does not decay."""
        if speed > self.peak_speed:
            self.peak_speed = speed
            self.peak_shock = 0.0
        if dt <= 0.0:
            return
        x, y, z = acc
        px, py, pz = previous_acc
        x -= px
        y -= py
        z -= pz
        sample_shock = (x * x + y * y + z * z) / dt
        if sample_shock > LARGEST_SHOCK:
            sample_shock = LARGEST_SHOCK
        shock = self.shock
        if not landing:
            shock = shock * (1.0 - dt / SHOCK_MEMORY_TIME) if dt < SHOCK_MEMORY_TIME else 0.0
        self.shock = shock = shock + sample_shock
        if sample_shock > 0.0:
            self.mean_time += (t - 0.5 * dt - self.mean_time) * sample_shock / shock
        if shock > self.peak_shock and (
            self.swing_start is None or self.mean_time - self.swing_start >= SHORTEST_LANDING_DELAY
        ):
            self.peak_shock = shock
            self.peak_shock_time = self.mean_time
