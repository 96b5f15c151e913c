"""Checks of the size of gravity and of angular rates, which show other units and gravity that was removed."""

from __future__ import annotations

from collections.abc import Sequence
from math import log2

from ...events import Defect
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY
from .finding import Finding

TOLERANCE = 0.15
"""Relative deviation from 1 g of the specific force in stance or at rest above which it is wrong.

Of the sensors in 378 recordings of a foot, the worst reads 1.08 g."""
LEAST_GRAVITY, LEAST_SCALE = 0.3, 0.05
"""Part of 1 g below which gravity is missing in a foot that walks, and below which it is in a foot at rest."""
MOVING_GYRO, ENOUGH_BLOCKS = 1.0, 6
"""Largest angular rate in a block of a foot that moves, rad/s, and number of such blocks that show how it moves."""
STANCES = 6
"""Number of stances whose median is judged."""
MOST_STANCES = 11
"""Largest number of stances that are kept."""
STILL_MOTION = 0.3
"""Motion in stance (stances.py) up to which a specific force of more than 1 g is no motion, rad/s."""
STILL_ACC = 0.6
"""Largest range of an axis of a foot at rest, m/s^2; chosen by hand."""
LARGEST_LIFT, LONGEST_LIFT_START = 0.3, 3.0
"""Change of the specific force in a lift, as a part of 1 g, and time that a lift takes to start or stop, s, at most."""
STILL_TIME = 0.6
"""Least duration of a rest that is judged, s."""
IN_G, LARGEST_IN_RUN = 1.0, 2.0
"""Specific force of a foot at rest, and the largest in a stance of a runner, in units of g."""
WALKING_RANGE = 9.0
"""Mean range of an axis in a block of motion above which a foot walks in m/s^2; in units of g it is 1 to 3."""
FASTEST_RATE = 45.0
"""Angular rate of an axis, rad/s, that no foot reaches; the fastest kicks have about 35."""
FAST_BLOCKS = 2
"""Number of blocks with a faster rate before it is reported."""
SHAKEN_ACC, IDLE_GYRO = 10.0, 0.25
"""Range of an axis in a block, m/s^2, of a foot that walks, and angular rate, rad/s, that it always exceeds.

A foot at rest stays below the latter."""
IDLE_BLOCKS = 6
"""Number of blocks of a foot that walks without any angular rate before it is reported."""


@define
class GravityCheck:
    """Looks at the specific force in stance and at rest, and at the largest angular rates."""

    stances: list[float] = field(factory=list)
    """Norm of the specific force in each of the newest stances, m/s^2."""
    still_since: float | None = None
    """Start of the rest that lasts, s; None in motion."""
    wrong_since: float | None = None
    """Time since which a foot at rest has another specific force than 1 g, s; None while it has 1 g."""
    moving_blocks: int = 0
    """Number of blocks of motion."""
    range_sum: float = 0.0
    """Sum of the ranges of the specific force in them, m/s^2."""
    fast_blocks: int = 0
    """Number of blocks with an angular rate that no foot has."""
    idle_blocks: int = 0
    """Number of blocks of a shaken foot without any angular rate."""

    def add_stance(self, acc: Vec3, motion: float) -> Finding | None:
        """Add the mean specific force of a stance, m/s^2, and its motion, rad/s; return the defect that stances show.

        A foot that turns in stance, as a runner's, has more than 1 g, never much less."""
        x, y, z = acc
        norm = (x * x + y * y + z * z) ** 0.5
        if motion > STILL_MOTION and (
            norm > (1.0 + TOLERANCE) * GRAVITY or 1.0 + TOLERANCE < norm / IN_G < LARGEST_IN_RUN
        ):
            return None
        self.stances = [*self.stances[1 - MOST_STANCES :], norm]
        if not self.knows_stances:
            return None
        return self._judge(sorted(self.stances)[len(self.stances) // 2], "in stance")

    @property
    def knows_stances(self) -> bool:
        """Return whether enough stances were seen to judge them."""
        return len(self.stances) >= STANCES

    def add_block(
        self, t: float, t_end: float, accs: Sequence[Vec3], acc_range: float, gyro_peak: float
    ) -> Finding | None:
        """Add a block from `t` to `t_end`, s; return the defect that it shows, if any.

        `acc_range` is the largest range of an axis, m/s^2, and `gyro_peak` the largest angular rate, rad/s."""
        if gyro_peak > FASTEST_RATE:
            self.fast_blocks += 1
            if self.fast_blocks >= FAST_BLOCKS:
                return Finding(
                    Defect.GYRO_UNIT,
                    f"angular rates of {gyro_peak:.0f} rad/s are faster than any foot: they look like degrees a second;"
                    " multiply them by pi / 180",
                )
            return None
        if gyro_peak > IDLE_GYRO:
            self.still_since = self.wrong_since = None
            self.idle_blocks = 0
            if gyro_peak > MOVING_GYRO:
                self.moving_blocks += 1
                self.range_sum += acc_range
            return None
        if acc_range > SHAKEN_ACC:
            self.idle_blocks += 1
            if self.idle_blocks >= IDLE_BLOCKS:
                return Finding(
                    Defect.GYRO_UNIT,
                    "the gyroscope reads almost nothing while the foot moves: switch it on, and give it in rad/s",
                )
        if acc_range > STILL_ACC:
            self.still_since = self.wrong_since = None
            return None
        if self.still_since is None:
            self.still_since = t
        if t_end - self.still_since < STILL_TIME:
            return None
        x, y, z = [sorted(axis)[len(axis) // 2] for axis in zip(*accs, strict=True)]
        norm = (x * x + y * y + z * z) ** 0.5
        finding = self._judge(norm, "at rest")
        if finding is None:
            self.wrong_since = None
            return None
        if self.wrong_since is None:
            self.wrong_since = t
        may_be_lift = abs(norm / GRAVITY - 1.0) < LARGEST_LIFT and t_end - self.wrong_since < LONGEST_LIFT_START
        return None if may_be_lift else finding

    def _judge(self, norm: float, when: str) -> Finding | None:
        """Return the defect of an accelerometer that reads `norm` `when` the foot stands; None if it reads 1 g."""
        ratio = norm / GRAVITY
        if abs(ratio - 1.0) <= TOLERANCE:
            return None
        if LEAST_SCALE <= ratio < LEAST_GRAVITY and self.moving_blocks < ENOUGH_BLOCKS:
            return None  # only motion shows whether gravity is missing or all of the specific force is small
        walks = self.range_sum > WALKING_RANGE * self.moving_blocks
        if abs(norm - IN_G) <= TOLERANCE * IN_G and not walks:
            text = f"the accelerometer reads {norm:.2f} {when}: it is in g; multiply it by 9.80665"
            return Finding(Defect.ACC_UNIT, text)
        text = f"the accelerometer reads {norm:.2f} m/s^2 {when}, not 9.81"
        times = round(log2(1.0 / ratio)) if ratio > 0.0 else 0
        if ratio < LEAST_GRAVITY and (walks or ratio < LEAST_SCALE):
            text = f"{text}: gravity was removed, or the sensor is off; send what it measures itself, with gravity"
            return Finding(Defect.NO_GRAVITY, text)
        if abs(times) in (1, 2, 3) and abs(ratio * 2.0**times - 1.0) <= TOLERANCE:
            text = f"{text}: the sensor's range is {2.0**times:g} times the range that is assumed"
            return Finding(Defect.WRONG_SCALE, text)
        return Finding(Defect.WRONG_SCALE, f"{text}: multiply it by {1.0 / ratio:.3g}")
