"""Time of the impact with which the ground stops a foot.

The turn of the foot, or the loss of its speed, shows that it has landed. The jerk shows when. The ground stops the foot
within some hundredths of a second, and heel-strike is the middle of this time: the mean time weighted by the squared
jerk, j = d acc / dt,

    t_HS = sum t |j|^2 dt / sum |j|^2 dt.

This needs no threshold on the force, works for any mounting and rate, and does not come early if the sole turns down
well before it bears weight."""

from __future__ import annotations

from ...types import Vec3
from ...types.attrs import define, field

LARGEST_SHOCK = 1e12
"""Largest squared jerk times interval of one sample, m^2/s^5."""
SHOCK_MEMORY_TIME = 0.02
"""Duration of the memory of the shock, s."""
SHORTEST_LANDING_DELAY = 0.1
"""Shortest time from toe-off to an impact of landing, s; an earlier one is that of leaving the ground."""


@define
class Impact:
    """The impact that ends one swing. Call `add_sample` for every sample of the swing."""

    swing_start: float | None = field(default=None, init=False)
    """Start of the swing, s; None before any."""
    shock: float = field(default=0.0, init=False)
    """Integral of the recent squared jerk over time, m^2/s^5."""
    mean_time: float = field(default=0.0, init=False)
    """Mean time of the shock, s."""
    peak_speed: float = field(default=0.0, init=False)
    """Largest speed of the swing, m/s."""
    peak_shock: float = field(default=0.0, init=False)
    """Largest shock since the time of the largest speed, m^2/s^5."""
    peak_shock_time: float = field(default=0.0, init=False)
    """Mean time of the largest shock, s."""

    def start_swing(self, t: float) -> None:
        """Start a swing at toe-off at `t`, s."""
        self.swing_start = self.mean_time = t
        self.shock = self.peak_speed = self.peak_shock = 0.0

    def add_sample(self, t: float, dt: float, previous_acc: Vec3, acc: Vec3, speed: float, landing: bool) -> None:
        """Add one sample of the swing.

        `previous_acc` and `acc` are the specific force before and now, m/s^2, `speed` is in m/s. While `landing` is
        True the shock does not decay."""
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
        if shock > self.peak_shock and (self.swing_start is None or self.mean_time - self.swing_start >= SHORTEST_LANDING_DELAY):
            self.peak_shock = shock
            self.peak_shock_time = self.mean_time
