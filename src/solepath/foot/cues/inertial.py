"""From numbers to cues: what a foot was seen to do, with hysteresis and debounce.

`InertialCues` reads stillness and the sagittal angular rate (about the axis that points to the wearer's left, so that
positive is toe down). Of a step that rate shows: a rise as the heel lifts, a peak of several rad/s as the toe pushes
off, a long negative hump while the leg swings, and a return through zero as the heel lands. Toe-off is where the rate
has fallen to half its peak, the steepest place of its fall. Landmarks of this kind are common in gait analysis
(Sabatini et al., IEEE Trans. Biomed. Eng. 52, 2005; Mariani et al., Gait & Posture 37, 2013).
The ground may stop the foot later than that, or earlier: heel-strike is the middle of the impact (impact.py).

Numbers that name no source were chosen by hand on the recordings of docs/accuracy.md and not swept; those of
heel-strike and toe-off on those that have such events.
"""

from __future__ import annotations

from math import sqrt
from typing import Final

from ...types import Phase, Vec3
from ...types.attrs import define, evolve, field
from ...types.vector import TIE, ZERO
from ..phase import Cue
from .cues import SeenCue
from .impact import Impact

SWING: Final = Phase.SWING
STATIONARY: Final = Phase.STATIONARY
PUSH_OFF: Final = Phase.PUSH_OFF
LOADING: Final = Phase.LOADING
"""Looked up once: a word of an enum costs as much as five multiplications."""

LEAST_TURN = 0.25
"""A foot that has turned by less than this was not pushing off, rad."""
SAME_AXIS = 0.5
"""Cosine of 60 degrees: axes that are further apart are not the same."""
MISFITS = 3
"""Push-offs in a row about another axis after which that one is believed."""
AXIS_GAIN = 0.2
"""Share of the newest push-off in the axis."""
GAP_TROUGH = 2.0
"""A swing that a gap has hidden was under way when its hump was taken to be so many times the least one."""
SETTLE = 0.009
"""Stillness, or its loss, must last this long, s."""
LEAST_PUSH = 1.5
"""A push-off's peak rate is at least this, rad/s."""
PAST_PEAK = 0.5
"""Toe-off is where the rate has fallen to this share of its peak."""
LEAST_TROUGH = 1.0
"""The swing's negative hump is at least this, rad/s."""
LANDING_RATE = 1.0
"""The heel lands about when the rate comes up through this, as the ground turns the sole down, rad/s."""
IMPACT_SETTLES = 0.04
"""Then the impact is heard out until its middle is this long ago, s: heel-strike is to be known within 60 ms."""
LONGEST_IMPACT = 0.1
"""An impact is heard out for no longer than this, s."""
LEAST_SHOCK = 1e4
"""A foot that has lost its speed has landed if the impact's squared jerk came to this, m^2/s^5: 600 m/s^3 for
30 ms. Muscles that swing a leg reach half of that jerk, the ground some thousands."""
SHORTEST_SWING = 0.1
"""No heel-strike sooner than this after toe-off, s."""
SHUFFLE_SPEED = 0.35
"""A foot that moves this fast for SHUFFLE_TIME is in swing, however it got there, m/s."""
SPEED_PER_RATE = 0.2
"""That speed is higher by this for each rad/s, m: no sensor is further from the toes, which a foot rolls over."""
SHUFFLE_TIME = 0.15
"""For so long a foot must be so fast to be in swing, s."""
LOADING_TIME = 0.4
"""For so long right after heel-strike, when the sensor still swings down with the sole, s."""
LOOKBACK = 0.02
"""Stillness is judged over a window, so it began about this long before it showed, s."""
ROLLING = 0.12
"""The heel came off when the sagittal rate was last below this, rad/s."""


@define
class InertialCues:
    """Latency: toe-off one sample; heel-strike IMPACT_SETTLES, or when the foot is still where no impact shows; foot-flat
    and heel-off SETTLE."""

    still_since: float | None = field(default=None, init=False)
    """Since when the evidence of zero velocity has been believed, s; None while it is not."""
    not_turning_at: float | None = field(default=None, init=False)
    """The last moment of this stance at which the foot did not turn, s."""
    moving_since: float | None = field(default=None, init=False)
    """Since when it has not been believed, s."""
    fast_since: float | None = field(default=None, init=False)
    """Since when the foot has been fast, s."""
    axis: Vec3 | None = field(default=None, init=False)
    """Unit vector to the wearer's left, sensor frame; learnt from how the foot turns as the heel lifts."""
    misfits: int = field(default=0, init=False)
    """Push-offs in a row that turned about another axis."""
    turned: Vec3 = field(default=ZERO, init=False)
    """Turn since the foot began to move, rad, sensor frame."""
    peak: float = field(default=0.0, init=False)
    """The highest sagittal rate of this push-off, rad/s."""
    trough: float = field(default=0.0, init=False)
    """The lowest sagittal rate of this swing, rad/s."""
    swing_start: float | None = field(default=None, init=False)
    """When the last swing began, s."""
    landing_at: float | None = field(default=None, init=False)
    """When the rate came up after the swing, s, until heel-strike is told."""
    force: Vec3 | None = field(default=None, init=False)
    """Specific force of the last sample, m/s^2."""
    impact: Impact = field(factory=Impact, init=False)
    sagittal: float = field(default=0.0, init=False)
    """Sagittal rate of the last sample, rad/s; the whole rate while the axis is unknown."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase
    ) -> SeenCue | None:
        """`acc` in m/s^2, `gyro` in rad/s without bias, `still`: the evidence of zero velocity was believed, `speed` in
        m/s."""
        before, axis = self.sagittal, self.axis
        gx, gy, gz = gyro
        if axis is None:
            now = sqrt(gx * gx + gy * gy + gz * gz)
        else:
            x, y, z = axis
            now = x * gx + y * gy + z * gz
        self.sagittal = now
        previous_force, self.force = self.force, acc
        if still:
            self.moving_since = self.fast_since = None
            if self.still_since is None:
                self.still_since = t
        else:
            self.still_since = None
            if self.moving_since is None:
                self.moving_since = t
                self.turned = ZERO
                self.peak = 0.0
            if speed < SHUFFLE_SPEED + SPEED_PER_RATE * (now if now > 0.0 else -now):
                self.fast_since = None
            elif self.fast_since is None:
                self.fast_since = t
        if phase is SWING:
            self.not_turning_at = None
            return self._in_swing(t, dt, speed, before, now, previous_force)
        if now < ROLLING and (still or self.not_turning_at is None):
            self.not_turning_at = t
        if self.still_since is not None:
            if phase is not STATIONARY and t - self.still_since >= SETTLE - TIE:
                return SeenCue(Cue.FLAT, self.still_since - LOOKBACK)
            return None
        x, y, z = self.turned
        self.turned = (x + gx * dt, y + gy * dt, z + gz * dt)
        if phase is STATIONARY:
            if now > self.peak:
                self.peak = now
            if self.moving_since is not None and t - self.moving_since >= SETTLE - TIE:
                return SeenCue(
                    Cue.LIFT,
                    self.moving_since if self.not_turning_at is None else min(self.not_turning_at, self.moving_since),
                )
            return None
        return self._in_push_off(t, dt, before, now, phase)

    def _in_push_off(self, t: float, dt: float, before: float, now: float, phase: Phase) -> SeenCue | None:
        if now > self.peak:
            self.peak = now
        limit = PAST_PEAK * self.peak
        if phase is PUSH_OFF and self.peak > LEAST_PUSH and now < limit and self._learn_axis():
            # between the last two samples, where a straight line meets the limit
            share = (before - limit) / (before - now) if before > limit > now else 1.0
            return self._report_clear(t - dt * (1.0 - share))
        patience = LOADING_TIME if phase is LOADING else SHUFFLE_TIME
        if self.fast_since is not None and t - self.fast_since >= patience - TIE:
            return self._report_clear(self.fast_since)
        return None

    def _in_swing(
        self, t: float, dt: float, speed: float, before: float, now: float, previous_force: Vec3 | None
    ) -> SeenCue | None:
        if now < self.trough:
            self.trough = now
        impact = self.impact
        landing_at = self.landing_at
        force = self.force
        if previous_force is not None and force is not None:
            impact.add_sample(t, dt, previous_force, force, speed, landing_at is not None)
        if landing_at is not None:
            middle = max(landing_at, impact.middle)
            over = t - middle >= IMPACT_SETTLES - TIE or t - landing_at >= LONGEST_IMPACT - TIE
            return self._report_contact(middle) if over or self.still_since is not None else None
        if self.still_since is not None:
            if t - self.still_since >= SETTLE - TIE:
                return self._report_contact(
                    impact.peak_shock_at if impact.peak_shock > 0.0 else self.still_since - LOOKBACK
                )
            return None
        if self.swing_start is not None and t - self.swing_start < SHORTEST_SWING - TIE:
            return None
        if before < LANDING_RATE <= now and self.trough < -LEAST_TROUGH and self.axis is not None:
            self.landing_at = t - dt * (now - LANDING_RATE) / (now - before)
        elif (
            speed < SHUFFLE_SPEED
            and impact.peak_shock > LEAST_SHOCK
            and t - impact.peak_shock_at >= IMPACT_SETTLES - TIE
        ):
            return self._report_contact(impact.peak_shock_at)
        return None

    def _report_contact(self, t: float) -> SeenCue:
        self.peak = 0.0
        self.turned = ZERO
        self.landing_at = self.fast_since = None
        return SeenCue(Cue.CONTACT, t)

    def reset(self) -> None:
        """What lasts must be seen to last: a gap counts neither as stillness nor as speed."""
        self.still_since = self.fast_since = None

    def restart(self) -> InertialCues:
        """For times that begin anew: the axis is kept."""
        fresh = evolve(self)
        fresh.axis = self.axis
        return fresh

    def cleared(self, t: float) -> SeenCue:
        """The toe left the ground at `t`, in a gap, and the swing was under way when that ended."""
        seen = self._report_clear(t)
        self.trough = -GAP_TROUGH * LEAST_TROUGH
        return seen

    def _report_clear(self, t: float) -> SeenCue:
        self.swing_start = t
        self.impact.start_swing(t)
        self.landing_at = None
        self.trough = self.peak = 0.0
        return SeenCue(Cue.CLEAR, t)

    def apply_toe_off(self, phase: Phase) -> None:
        """The load says that the toe has left the ground, in `phase`: how the foot has turned shows the axis all the
        same."""
        if phase is PUSH_OFF and self.peak > LEAST_PUSH:
            self._learn_axis()

    def _learn_axis(self) -> bool:
        """The heel lifts by a turn about the axis to the left; True when it turned far enough to be a push-off."""
        x, y, z = self.turned
        angle = sqrt(x * x + y * y + z * z)
        if angle < LEAST_TURN:
            return False
        x, y, z = x / angle, y / angle, z / angle
        if self.axis is None:
            self.axis = (x, y, z)
            return True
        u, v, w = self.axis
        if u * x + v * y + w * z < SAME_AXIS:
            # turned about another axis: not how this wearer pushes off, unless it keeps on doing so
            self.misfits += 1
            if self.misfits < MISFITS:
                return False
            u, v, w = x, y, z
        self.misfits = 0
        u, v, w = u + AXIS_GAIN * (x - u), v + AXIS_GAIN * (y - v), w + AXIS_GAIN * (z - w)
        k = 1.0 / sqrt(u * u + v * v + w * w)
        self.axis = (u * k, v * k, w * k)
        return True
