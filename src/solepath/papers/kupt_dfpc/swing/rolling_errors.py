"""Errors of (5), (7) and (8) that a foot learns from its own strides, with the uncertainty of each.

Chen et al. 2019 (IEEE Internet of Things Journal 6, section III.C.3) measure the shoe once, in static postures. They
take the velocities of (5) and (7) for exact and the drift of (8) for linear. A shoe that bends elsewhere under the
weight of a walking body, or slides, makes them wrong, and fig. 14 shows that the drift is not linear. So a foot learns:

- The pivot of the forefoot (`PivotShift`): how much longer L_r of (6) is in walking. It shows in the height of the
  heel at toe-off, which grows by sin(pitch) times that length, and which the raw velocity gives to a few millimetres,
  because it started from rest 0.3 s ago.
- The slide at toe-off and after heel-strike (`RollingError`): the mean and the spread of the velocity of the rolling
  shoe minus that of the sensor. A velocity that is known badly then weighs little.
- The time of the drift (`DriftTime`): where between toe-off and heel-strike the velocity drifts. Of a stride of level
  walking the rise is known, it is zero. The rise by the raw velocity is the velocity error at the end, times the time
  since it arose. So the rises of the strides of one foot show that time. Half of the swing is the linear drift of (8).
- The scale of the drift (`DriftScale`): how large the velocity error is for the motion between samples.

Nothing here knows a shoe or a sensor. Starting values are wide; their origin is at each."""

from __future__ import annotations

from ....types.attrs import define, field

PIVOT_SPREAD = 0.02
"""Standard deviation of the pivot's place before the first stride, m: a shoe that is not the measured one."""
PIVOT_NOISE = 0.004
"""Standard deviation of a stride's rise of the sensor until toe-off, m: 0.1 m/s^2 in 0.3 s, and a sole that gives."""
SLIDE_SPREAD = 0.1
"""Standard deviation of a sliding velocity before the first stride, m/s: a quarter of the speed of a landing heel."""
FIRST_STRIDES, MOST_STRIDES = 4.0, 30.0
"""Weight of a starting value, and the largest weight of the past, in strides."""
TIME_SPREAD, TIME_MISMATCH = 0.3, 0.2
"""Standard deviation of the mean time of the drift before the first stride, and of its difference between the vertical
and the horizontal axes, as shares of the swing.

The first is that of an even distribution over the swing. The second was chosen by hand; emulated walks of 20 m at 30 Hz
differ by 0.01 m from 0.1 to 0.3."""
RISE_SPREAD, RISE_NOISE = 0.04, 0.01
"""Standard deviation of the mean rise of level strides by the raw velocity, and of one stride about it, m.

A bias of 0.1 m/s^2 raises a stride of 0.9 s by 0.04 m. The floor is level within a centimetre."""
TIME_WEIGHT = TIME_SPREAD**2 / (TIME_SPREAD**2 + TIME_MISMATCH**2)
"""Share of a deviation of the vertical time of the drift from one half that the horizontal time has on average."""
STEPPED_RISE = 0.1
"""Difference of a stride's rise from the expected one above which it went up or down a step, m."""


@define
class PivotShift:
    """Excess of the length L_r in walking over the measured one, m, with its variance."""

    shift: float = field(default=0.0, init=False)
    variance: float = field(default=PIVOT_SPREAD * PIVOT_SPREAD, init=False)

    def add(self, rise: float, sin_pitch: float) -> None:
        """Add a stride whose sensor rose at toe-off by `rise` m more than (6) gives, at the sine of that pitch."""
        gain = self.variance * sin_pitch / (sin_pitch * sin_pitch * self.variance + PIVOT_NOISE * PIVOT_NOISE)
        self.shift += gain * (rise - sin_pitch * self.shift)
        self.variance *= 1.0 - gain * sin_pitch


@define
class RollingError:
    """Mean and spread of the velocity of the sensor minus that of the rolling shoe, along the foot, m/s."""

    mean: float = field(default=0.0, init=False)
    variance: float = field(default=SLIDE_SPREAD * SLIDE_SPREAD, init=False)
    """Variance of `mean`, m^2/s^2."""
    spread: float = field(default=SLIDE_SPREAD * SLIDE_SPREAD, init=False)
    """Variance of one stride about the mean, m^2/s^2."""
    strides: float = field(default=FIRST_STRIDES, init=False)
    """Weight of `spread`, in strides."""

    @property
    def noise(self) -> float:
        """Variance of the velocity of the rolling shoe in the next stride, m^2/s^2."""
        return self.variance + self.spread

    def add(self, error: float, raw_variance: float) -> None:
        """Add the difference of one stride, m/s, of which the raw velocity has the variance `raw_variance`."""
        innovation = error - self.mean
        surplus = max(innovation * innovation - raw_variance - self.variance, 0.0)
        self.strides = min(self.strides + 1.0, MOST_STRIDES)
        self.spread += (surplus - self.spread) / self.strides
        noise = self.variance + self.spread + raw_variance
        gain = self.variance / noise if noise > 0.0 else 0.0
        self.mean += gain * innovation
        self.variance *= 1.0 - gain


@define
class DriftTime:
    """Mean time at which the velocity drifts in swing, as a share of the swing from toe-off to heel-strike.

    The rises of strides show that of the vertical velocity, `vertical`. The horizontal velocity need not drift at the
    same time, so its share is in between that and one half. The rise that all strides have in common comes from a bias.
    It is learnt beside the time and tells nothing of it."""

    vertical: float = field(default=0.5, init=False)
    """Share for the vertical velocity."""
    rise: float = field(default=0.0, init=False)
    """Rise that all strides have in common, m."""
    vertical_variance: float = field(default=TIME_SPREAD**2 + TIME_MISMATCH**2, init=False)
    """Variance of `vertical`."""
    covariance: float = field(default=0.0, init=False)
    """Covariance of `vertical` and `rise`, m."""
    rise_variance: float = field(default=RISE_SPREAD * RISE_SPREAD, init=False)
    """Variance of `rise`, m^2."""

    @property
    def share(self) -> float:
        """Share for the horizontal velocity."""
        return 0.5 + TIME_WEIGHT * (self.vertical - 0.5)

    @property
    def share_variance(self) -> float:
        """Variance of `share`."""
        return (1.0 - TIME_WEIGHT) * TIME_SPREAD**2 + TIME_WEIGHT * TIME_WEIGHT * self.vertical_variance

    def add(self, rise: float, slope: float) -> None:
        """Add a stride with this rise, m, if all of the drift came at toe-off; `slope` is its change per share, m."""
        error = rise - self.rise - slope * self.vertical
        if abs(error) > STEPPED_RISE:
            return
        cross = self.covariance + slope * self.vertical_variance
        whole = self.rise_variance + slope * self.covariance
        variance = whole + slope * cross + RISE_NOISE * RISE_NOISE
        self.vertical = min(max(self.vertical + cross / variance * error, 0.0), 1.0)
        self.rise += whole / variance * error
        self.vertical_variance -= cross * cross / variance
        self.covariance -= cross * whole / variance
        self.rise_variance -= whole * whole / variance


@define
class DriftScale:
    """Scale of the drift: variance of the velocity per unit of `MotionMoment.drift`, no unit.

    The difference between two samples stands for the motion between them, which the integration does not see."""

    ratio: float = field(default=0.01, init=False)
    """Ratio of the squared velocity error to the drift: a tenth of each difference before the first stride."""
    strides: float = field(default=FIRST_STRIDES, init=False)
    """Weight of `ratio`, in strides."""

    def add(self, squared_error: float, drift: float) -> None:
        """Add a stride with this squared velocity error per axis at its end, m^2/s^2."""
        if drift > 0.0:
            self.strides = min(self.strides + 1.0, MOST_STRIDES)
            self.ratio += (squared_error / drift - self.ratio) / self.strides
