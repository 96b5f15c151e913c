"""When the ground stopped a foot.

That a foot has landed shows in how it turns, or in the speed that is gone; when it did, in the jerk. The ground stops
it within some hundredths of a second, and heel-strike is the middle of that: the mean time weighted by the squared
jerk, j = d acc / dt,

    t_HS = sum t |j|^2 dt / sum |j|^2 dt.

It needs no threshold on the force, holds at any mounting and rate, and does not come early where a sole is turned down
well before it bears weight.
"""

from __future__ import annotations

from ...types import Vec3
from ...types.attrs import define, field

MOST_SHOCK = 1e12
"""A jolt weighs no more than this, m^2/s^5."""
SHOCK_MEMORY = 0.02
"""What is older than about this is no part of it, s."""
AFTER_TOE_OFF = 0.1
"""A jolt nearer than this to toe-off is that of leaving the ground, s."""


@define
class Impact:
    """One swing's, and what ends it. Feed it every sample of the swing."""

    swing_start: float | None = field(default=None, init=False)
    """When the swing did, s; None: before anybody looked."""
    shock: float = field(default=0.0, init=False)
    """Squared jerk of the last moments, summed over time, m^2/s^5."""
    middle: float = field(default=0.0, init=False)
    """Its mean time, s."""
    peak_speed: float = field(default=0.0, init=False)
    """Speed of the swing, m/s."""
    peak_shock: float = field(default=0.0, init=False)
    """The largest shock since it was that fast, m^2/s^5."""
    peak_shock_at: float = field(default=0.0, init=False)
    """When that was, s."""

    def start_swing(self, t: float) -> None:
        """The toe left the ground at `t`, s."""
        self.swing_start = self.middle = t
        self.shock = self.peak_speed = self.peak_shock = 0.0

    def add_sample(self, t: float, dt: float, previous_acc: Vec3, acc: Vec3, speed: float, landing: bool) -> None:
        """Specific force before (`previous_acc`) and now, m/s^2; `speed` in m/s; `landing`: nothing is forgotten any more."""
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
        jolt = (x * x + y * y + z * z) / dt
        if jolt > MOST_SHOCK:
            jolt = MOST_SHOCK
        shock = self.shock
        if not landing:
            shock = shock * (1.0 - dt / SHOCK_MEMORY) if dt < SHOCK_MEMORY else 0.0
        self.shock = shock = shock + jolt
        if jolt > 0.0:
            self.middle += (t - 0.5 * dt - self.middle) * jolt / shock
        if shock > self.peak_shock and (self.swing_start is None or self.middle - self.swing_start >= AFTER_TOE_OFF):
            self.peak_shock = shock
            self.peak_shock_at = self.middle
