"""The pitch of a shoe in static postures, from the accelerometer at rest (Chen et al. 2019, section III.C.3).

At rest the accelerometer shows where up is. Pitch is counted from the shoe that stands flat, as it is in a walk
(kinematics.py), so the sensor may be mounted in any way. The steepest posture so far shows which way the sensor tilts
when the heel is raised. A tilt across that way is a lean sideways and is no pitch. Before any posture was taken, the
pitch is the whole tilt. Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections import deque
from math import atan2, fsum, hypot, sqrt

from ....types import Vec3
from ....types.attrs import frozen, state, stateful
from ....types.vector import GRAVITY, across, cross, dot, sub
from ..kinematics import length, of_length_1

STILL_TIME = 1.0
"""Time for which a shoe must be still before its pitch is taken, s; the pitch is the mean over this time."""
PRESENT_TIME = 0.25
"""Time over which the pitch that is shown is the mean, s: less shows the noise, more lags behind the hand."""
STILL_SCATTER = 0.15
"""Largest root mean square deviation of the acceleration from its mean of a still shoe, m/s^2.

It is that of a shoe that turns steadily by 3 degrees within a second. An accelerometer of 8 bits at 2 g, with steps of
0.15, scatters by 0.08."""
STILL_OFFSET = 1.0
"""Largest difference of the mean acceleration of a still shoe from gravity, m/s^2: offsets of cheap sensors."""
LEAST_SAMPLES = 5
"""Smallest number of samples in STILL_TIME from which the shoe can be called still: half of those at 10 Hz."""
STEEP_ENOUGH = 0.1
"""Tilt of a taken posture from which it shows which way the heel rises, rad."""


@frozen
class PitchReading:
    """The present attitude of a shoe."""

    pitch: float
    """Heel-up pitch, rad, from the shoe that stood flat; before that was taken, 0."""
    sideways: float
    """Lean to either side, rad; 0 before the way of the heel is known."""
    is_still: bool
    """True if the shoe was still for STILL_TIME."""


@stateful
class PitchGauge:
    """Measures the pitch of a shoe from its accelerations: first flat, then in postures with the heel raised.

    Memory is bounded by the samples of STILL_TIME."""

    flat: Vec3 | None = None
    """Direction up in the sensor frame while the shoe stood flat, of length 1; None before it was taken."""
    heel_way: Vec3 | None = None
    """Direction across `flat`, of length 1, towards which up turns as the heel rises; None before it is known."""
    steepest: float = 0.0
    """Tilt of the posture that gave `heel_way`, rad."""
    recent: deque[tuple[float, Vec3]] = state(factory=deque)
    """Time, s, and acceleration, m/s^2, of the samples of the last STILL_TIME, and one before."""

    def add_sample(self, t: float, acc: Vec3) -> None:
        """Add an acceleration in the sensor frame, m/s^2, at `t`, s."""
        if self.recent and t <= self.recent[-1][0]:
            self.recent.clear()  # the clock restarted
        self.recent.append((t, acc))
        while len(self.recent) > 1 and self.recent[1][0] <= t - STILL_TIME:
            self.recent.popleft()

    def restart(self) -> None:
        """Forget the samples, after a time without any; what is known of the shoe stays."""
        self.recent.clear()

    def read(self) -> PitchReading | None:
        """Return the present attitude; None without samples, or if no direction is up."""
        if not self.recent:
            return None
        newest = self.recent[-1][0]
        mean = _mean([acc for t, acc in self.recent if t > newest - PRESENT_TIME])
        return None if length(mean) == 0.0 else self._reading(of_length_1(mean))

    def _reading(self, up: Vec3) -> PitchReading:
        """Return the attitude in which `up`, of length 1, is the direction up in the sensor frame."""
        still = self._is_still()
        if self.flat is None:
            return PitchReading(0.0, 0.0, still)
        upright = dot(up, self.flat)
        if self.heel_way is None:
            return PitchReading(atan2(length(across(up, self.flat)), upright), 0.0, still)
        raised = dot(up, self.heel_way)
        return PitchReading(
            atan2(raised, upright), atan2(dot(up, cross(self.flat, self.heel_way)), hypot(raised, upright)), still
        )

    def take(self) -> float | None:
        """Take the present posture and return its pitch, rad; None, and nothing changes, while the shoe is not still.

        The first posture that is taken is the flat one, with pitch 0."""
        if not self._is_still():
            return None
        up = of_length_1(_mean([acc for _, acc in self.recent]))
        if self.flat is None:
            self.flat = up
            return 0.0
        way = across(up, self.flat)
        tilt = atan2(length(way), dot(up, self.flat))
        if tilt > max(self.steepest, STEEP_ENOUGH):
            self.steepest, self.heel_way = tilt, of_length_1(way)
        return self._reading(up).pitch

    def _is_still(self) -> bool:
        """Return whether the shoe was still for STILL_TIME."""
        if len(self.recent) <= LEAST_SAMPLES or self.recent[-1][0] - self.recent[0][0] < STILL_TIME:
            return False
        values = [acc for _, acc in self.recent]
        mean = _mean(values)
        scatter = sqrt(fsum([length(sub(value, mean)) ** 2 for value in values]) / len(values))
        return scatter <= STILL_SCATTER and abs(length(mean) - GRAVITY) <= STILL_OFFSET


def _mean(values: list[Vec3]) -> Vec3:
    x, y, z = (fsum([value[axis] for value in values]) / len(values) for axis in range(3))
    return (x, y, z)
