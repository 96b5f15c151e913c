"""Stance evidence of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans.
Instrum. Meas. 59, 2010): the heel's pressure contours stand still, or, as its baseline, the gyroscope does.
"""

from __future__ import annotations

from math import hypot, inf, sqrt

from attrs import define, field

from ..types import Layout, Phase, Quat, Vec3
from ..vector import IDENTITY, TIE, ZERO
from .contour import Contours
from .stance import Load, Stance

TARE_SAMPLES = 200
"""The tare is the mean of about so many samples in the air: some swings, since a swung shoe presses unevenly."""


@define
class GyroscopeMagnitude:
    """The sensor hardly turns, so it stands still: |w| has stayed below `below` for `lasting` s, and has not risen
    above `above` since. The statistic is |w|, rad/s. Latency: `lasting`.

    The paper says that angular velocity was used and no more. Stance by |w| below a threshold for some samples is that
    of Tunca et al. 2017 (Sensors 17, 825), with 0.5 rad/s in published code after it; a sensor 12 cm from the heel's
    end moves at 6 cm/s then. For zero velocity the thresholds here are lower: 3 cm/s at `below`. They find every stance
    of emulated walks at 0.8 and 1.3 m/s.
    """

    below: float = 0.25
    above: float = 0.40
    lasting: float = 0.03
    sigma: float = 0.01
    # state
    since: float | None = field(default=None, init=False)
    """Since when the rate has been low, s."""
    still: bool = field(default=False, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = sqrt(x * x + y * y + z * z)
        if rate >= (self.above if self.still else self.below):
            self.since, self.still = None, False
        else:
            if self.since is None or self.since > t:
                self.since = t
            self.still = self.still or t - self.since >= self.lasting - TIE
        if self.still:
            return Stance(ZERO, self.sigma, rate, Phase.STATIONARY)
        return Stance(ZERO, inf, rate, None)


@define
class ContourVelocity:
    """The contours of the loaded heel move by no more than `threshold` (3), so the shoe stands still; until they move
    by more than `leave` for longer than `hold`, or the heel is no longer loaded. The statistic is their speed, m/s.

    `leave` is higher because what is left of the load near heel-off makes noisy contours, and a foot that has stood
    does not move while its heel carries weight. Latency: that of `Contours`, 50 ms after the contours have stopped.

    Where no contour can be had (no cells, unknown places, too few under the heel), and as long as the wearer's full
    load is not known, the gyroscope stands in. So it does once a heel has borne weight for `blind` s and its contours
    have not come to rest: in a tight bend it stands on its edge, and what contours lie over cells are cut off.
    """

    threshold: float = 0.004
    """v_thrsh of (3): the paper's sensing bias, m/s."""
    leave: float = 0.020
    hold: float = 0.03
    """s."""
    loaded: float = 0.12
    """The heel carries at least this share of the wearer's full load."""
    blind: float = 0.2
    sigma: float = 0.01
    contours: Contours = field(factory=Contours)
    baseline: GyroscopeMagnitude = field(factory=GyroscopeMagnitude)
    # state
    lacking: str | None = field(default=None, init=False)
    """Why the gyroscope stands in for good, as a sentence; None while it does not."""
    count: int = field(default=0, init=False)
    """How many cells the layout has; 0 as long as there is none."""
    tare: list[float] = field(factory=list, init=False)
    """What the used cells show in the air, unit of the samples."""
    tared: int = field(default=0, init=False)
    """Samples in the air so far, up to `TARE_SAMPLES`."""
    still: bool = field(default=False, init=False)
    seen: float | None = field(default=None, init=False)
    """When contours last were at rest, or else when the heel came down; None while it carries too little, s."""

    def wear(self, layout: Layout) -> None:
        """The device said where its cells are."""
        why = self.contours.wear(layout)
        self.lacking = None if why is None else f"{why}; the gyroscope says when the foot stands"
        self.count = len(layout.cells)
        self.tare = [0.0] * len(self.contours.cells)
        self.tared = 0
        self.still = False

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        otherwise = self.baseline.update(t, dt, acc, gyro, load, attitude)
        if load is None or load.heel is None or not self.contours.points or len(load.cells) != self.count:
            return otherwise
        if load.heel < self.loaded:
            self.still, self.seen = False, None
            self.contours.interrupt()
            if not load.airborne:
                return Stance(ZERO, inf, 0.0, None)
            cells = load.cells
            self.tared = min(self.tared + 1, TARE_SAMPLES)
            k = 1.0 / self.tared
            self.tare = [zero + k * (cells[i] - zero) for i, zero in zip(self.contours.cells, self.tare, strict=True)]
            return Stance(ZERO, inf, 0.0, Phase.SWING)
        cells = load.cells
        above = [cells[i] - zero for i, zero in zip(self.contours.cells, self.tare, strict=True)]
        velocity = self.contours.velocity(t, above)
        if self.seen is None or self.seen > t:
            self.seen = t
        speed = hypot(*(velocity or ZERO))
        if velocity is not None and speed <= (self.leave if self.still else self.threshold):
            self.still = True
            self.seen = t
        self.still = self.still and t - self.seen <= self.hold + TIE
        if self.still:
            return Stance(ZERO, self.sigma, speed, Phase.STATIONARY)
        if t - self.seen >= self.blind - TIE:
            return otherwise
        return Stance(ZERO, inf, speed, None)
