"""Calibration records: data on a wearer, a pair of shoes and a pair of insoles that the devices do not send.

All of it is optional: a session without a calibration uses defaults and what it learns. A record is not checked when it
is made, but when it is read from a file or given to a session (`contradiction` and the limits, types/checking.py)."""

from __future__ import annotations

from typing import Any

from ..types import Floats, Foot, Layout, Sample, Vec2, Vec3, WalkingMode
from ..types.attrs import COUNT, evolve, field, fields, frozen, limited, limits
from ..types.vector import dot, sub

MAX_CELLS = 4096
"""Largest number of cells of an insole."""
MAX_TILT = 0.3
"""Largest error of the scale of a sensor, and largest share of one axis in another."""

USUAL_STRIDE = 0.8
"""Length from which a stride swings through the whole loop of rotations, m; that of a shorter one is smaller."""


class CalibrationError(ValueError):
    """A calibration cannot be read or used; the message is one sentence that says what is wrong."""


@frozen
class Newtons:
    """Cubic that turns a cell's raw value c into newtons: N = a + b c + c2 c^2 + c3 c^3.

    It is fitted to measurements with a force gauge (Gong et al. 2023, Sensors 23, 5417, fig. 6)."""

    coefficients: tuple[float, float, float, float] = field(metadata=limits(-1e12, 1e12))
    """Coefficients a, b, c2 and c3, N per power of the raw value."""
    threshold: float = limited(5.0, 0.0, 1e5, "N")
    """Force below which the result is 0, N."""
    most: float = limited(200.0, 0.001, 1e5, "N")
    """Largest force, N: the result for every force above it."""

    def contradiction(self) -> str | None:
        """Return what is wrong with the two forces (types/checking.py)."""
        return " has a threshold that is more than its most" if self.threshold > self.most else None


@frozen
class InsoleCalibration:
    """Calibration of one insole."""

    layout: Layout | None = None
    """Positions of the cells, for devices and files that do not send them."""
    newtons: Newtons | None = None
    """Conversion of raw values to N; None when the values stay in their own unit."""
    noise: Floats = field(default=(), metadata=limits(-1e6, 1e6))
    """Value of each unloaded cell, in the unit of the samples (Chen et al. 2019, equation (1))."""

    def contradiction(self) -> str | None:
        """Return what is wrong with the number of cells."""
        count = 1 if self.layout is None else len(self.layout.cells)
        return None if 1 <= count <= MAX_CELLS else f".layout has {count} cells; it can have 1 to {MAX_CELLS}"


POLYNOMIAL = {COUNT: (1, 16), **limits(-100.0, 100.0)}
"""Limits of a polynomial of a shoe: the number of its coefficients, and each of them."""


@frozen
class ShoeGeometry:
    """Geometry of a shoe, as in figs. 5 to 7 of Chen et al. 2019. The defaults are their shoe (10.5 US).

    The paper gives no coefficients for the forefoot. The defaults come from geometry: a shoe of 28.5 cm with the sensor
    12.5 cm in front of the heel's rear end. The sole is flat and rigid up to 19.5 cm. In front of that it is a rocker:
    a cylinder of radius R = 5 cm, tangent to the flat part, that rolls without slip. At pitch p the plane of the flat
    part meets the ground R tan(p/2) behind the point of contact, which has moved R p forward on the ground. The pivot
    is the line where plane and ground meet: L_r = 0.070 + R tan(p/2) and L_p2t = 0.090 - R p + R tan(p/2), m, exactly.
    The series p/2 + p^3/24 + p^5/240 + ... of tan(p/2) makes them polynomials, to 0.2 mm up to `steepest`."""

    heel_radius: float = limited(0.125, 0.001, 1.0, "m")
    """Radius L_r of the heel, from its rear end to the point of the sole below the sensor, m."""
    height: float = limited(0.029, 0.0, 1.0, "m")
    """Height H_imu of the sensor above that point of the sole, m."""
    forefoot_radius: Floats = field(default=(0.070, 0.025, 0.0, 0.05 / 24.0, 0.0, 0.05 / 240.0), metadata=POLYNOMIAL)
    """Radius L_r of the forefoot, m, as a polynomial of the pitch (rad, heel up positive), constant first."""
    pivot_to_toe: Floats = field(default=(0.090, -0.025, 0.0, 0.05 / 24.0, 0.0, 0.05 / 240.0), metadata=POLYNOMIAL)
    """Distance L_p2t of the forefoot, m, as a polynomial of the pitch (rad, heel up positive), constant first."""
    steepest: float = limited(1.3, 0.01, 1.6, "rad")
    """Largest pitch for which the polynomials hold, rad; the smallest is 0."""

    def contradiction(self) -> str | None:
        """Return which polynomial gives a length above 1 m at one of five pitches to `steepest`."""
        for name, polynomial in (("forefoot_radius", self.forefoot_radius), ("pivot_to_toe", self.pivot_to_toe)):
            for k in range(5):
                pitch, length = 0.25 * k * self.steepest, 0.0
                for coefficient in reversed(polynomial):
                    length = length * pitch + coefficient
                if abs(length) > 1.0:
                    return f".{name} is {length:g} m at {pitch:.2g} rad; it can be -1 to 1 m"
        return None


LIMB = limits(0.001, 1.5, "m")
"""Limits of the length of a limb."""


@frozen
class Limbs:
    """Lengths of the lower limbs.

    The defaults are those of a wearer of 1.75 m. Thigh 0.245, shank 0.246, foot 0.152 and ankle 0.039 of the height are
    the proportions of Drillis and Contini (1966), as in Winter, Biomechanics and Motor Control of Human Movement; three
    quarters of the foot lie in front of the ankle. Their 0.191 is the breadth of the hips, not the distance of the hip
    joints. The anterior iliac spines are 0.24 m apart, and each joint lies inward of its spine by 14 % of that distance
    (Bell, Brand and Pedersen 1989, Human Movement Science 8)."""

    hip_width: float = field(default=0.173, metadata=LIMB)
    """Distance between the hip joints, m."""
    thigh: float = field(default=0.429, metadata=LIMB)
    """Length of the thigh, m."""
    shank: float = field(default=0.431, metadata=LIMB)
    """Length of the shank, m."""
    foot: float = field(default=0.200, metadata=LIMB)
    """Length from below the ankle to the end of the foot, m."""
    ankle_height: float = field(default=0.068, metadata=LIMB)
    """Height of the ankle above the ground, m."""


def usual_strides(length: float) -> float:
    """Return the number of usual strides as which one of `length` m counts for the drift of the heading, 0 to 1."""
    return min(1.0, length / USUAL_STRIDE)


@frozen
class HeadingCalibration:
    """Drift of the heading of one foot, from a walk there and back (`solepath calibrate walk`).

    The errors of a gyroscope turn the track by nearly the same angle in every stride, and by a share of every turn.
    They belong to this sensor on this shoe of this wearer. Standard deviations include what changes from day to day."""

    drift: float = field(metadata=limits(-0.05, 0.05, "rad"))
    """Angle by which the track must be turned in a usual stride, rad, positive to the left."""
    turning: float = field(metadata=limits(-0.1, 0.1))
    """Angle by which the track must be turned for a turn of 1 rad, no unit."""
    drift_sigma: float = field(metadata=limits(1e-6, 0.05, "rad"))
    """Standard deviation of `drift` on another day, rad."""
    turning_sigma: float = field(metadata=limits(1e-6, 0.2))
    """Standard deviation of `turning` on another day, no unit."""


@frozen
class TriadCalibration:
    """Correction of a three-axis sensor: the true values are `matrix` times (reading - `bias`)."""

    matrix: Floats = field(metadata={COUNT: (9, 9), **limits(-MAX_TILT, 1.0 + MAX_TILT)})
    """Nine elements, row by row, no unit."""
    bias: Vec3 = field(metadata=limits(-5.0, 5.0, "m/s^2"))
    """Reading where the true value is 0, m/s^2 or rad/s."""
    matrix_sigma: Floats = field(metadata={COUNT: (9, 9), **limits(0.0, 0.1)})
    """Standard deviations of `matrix`, no unit."""
    bias_sigma: Vec3 = field(metadata=limits(0.0, 5.0, "m/s^2"))
    """Standard deviations of `bias` on the day of the calibration, m/s^2 or rad/s."""

    def correct(self, reading: Vec3) -> Vec3:
        """Return the true value for a reading."""
        v, (xx, xy, xz, yx, yy, yz, zx, zy, zz) = sub(reading, self.bias), self.matrix
        return dot((xx, xy, xz), v), dot((yx, yy, yz), v), dot((zx, zy, zz), v)

    def contradiction(self) -> str | None:
        """Return which element of `matrix` is too far from that of a sensor without errors."""
        for k, value in enumerate(self.matrix):
            least, most = (1.0 - MAX_TILT, 1.0 + MAX_TILT) if k % 4 == 0 else (-MAX_TILT, MAX_TILT)
            if not least <= value <= most:
                return f".matrix[{k}] is {value:g}; it can be {least:g} to {most:g}"
        return None


@frozen
class SensorCalibration:
    """Scale, axes and bias of one sensor (`solepath calibrate sensor`), in the frame of its accelerometer."""

    acc: TriadCalibration
    """Correction of the accelerometer."""
    gyro: TriadCalibration
    """Correction of the gyroscope, which also turns its axes to those of the accelerometer."""

    def correct(self, sample: Sample) -> Sample:
        """Return the sample with corrected values, of which None stays None."""
        acc, gyro = sample.acc, sample.gyro
        return evolve(sample, acc=acc and self.acc.correct(acc), gyro=gyro and self.gyro.correct(gyro))

    def contradiction(self) -> str | None:
        """Return what is wrong with the bias of the gyroscope, which is smaller than that of an accelerometer."""
        largest = max(map(abs, (*self.gyro.bias, *self.gyro.bias_sigma)))
        return None if largest <= 1.0 else f".gyro has a bias or bias_sigma of {largest:g}; it can be up to 1 rad/s"


@frozen
class Calibration:
    """The calibration of one wearer; a value that was not calibrated is None or absent."""

    insoles: dict[Foot, InsoleCalibration] = field(factory=dict)
    """Calibrations of the insoles by foot."""
    shoe: ShoeGeometry | None = None
    """Geometry of the shoes."""
    drift: dict[Foot, Vec2] = field(factory=dict, metadata=limits(-1.0, 1.0, "m/s"))
    """Rate at which the position of each foot drifts, (x, y), m/s, world frame of a device that sends its attitude, or
    else navigation frame, so that it holds for walks that start with the heading of the calibration."""
    limbs: Limbs | None = None
    """Lengths of the wearer's lower limbs."""
    weight: float | None = limited(None, 50.0, 5000.0, "N")
    """Weight of the wearer, N."""
    modes: dict[Foot, dict[WalkingMode, Vec2]] | None = field(default=None, metadata=limits(-0.5, 0.5, "m"))
    """Compensation of a touchdown by foot and walking mode, (forward, left), m."""
    toe_out: dict[Foot, float] = field(factory=dict, metadata=limits(-1.0, 1.0, "rad"))
    """Angle from the direction of walking to each foot's long axis, outwards positive, rad (Liu et al. 2015, equation
    (1))."""
    headings: dict[Foot, HeadingCalibration] = field(factory=dict)
    """Drift of the heading of each foot."""
    sensors: dict[Foot, SensorCalibration] = field(factory=dict)
    """Scale, axes and bias of each foot's sensor, which correct its samples for any recipe."""

    def insole(self, foot: Foot) -> InsoleCalibration:
        """Return the calibration of this foot's insole, or an empty one."""
        return self.insoles.get(foot, InsoleCalibration())


def merged(known: Calibration, newer: Calibration) -> Calibration:
    """Return `known` with its values replaced by those that `newer` has, field by field and insole by insole.

    A foot's heading and drift are discarded when its sensor is corrected otherwise, because they are what its errors
    caused."""
    stale = stale_feet(known, newer)
    values: dict[str, Any] = {}
    for one in fields(Calibration):
        old, new = getattr(known, one.name), getattr(newer, one.name)
        if one.name == "insoles":
            new = {foot: _merged_insoles(known.insole(foot), insole) for foot, insole in new.items()}
        if one.name in ("headings", "drift"):
            old = {foot: value for foot, value in old.items() if foot not in stale}
        if one.default is None:
            values[one.name] = new or old
        else:  # values by foot
            values[one.name] = {foot: (old | new)[foot] for foot in Foot if foot in old | new}
    return Calibration(**values)


def _merged_insoles(known: InsoleCalibration, newer: InsoleCalibration) -> InsoleCalibration:
    return InsoleCalibration(newer.layout or known.layout, newer.newtons or known.newtons, newer.noise or known.noise)


def stale_feet(known: Calibration, newer: Calibration) -> list[Foot]:
    """Return the feet whose sensor `newer` corrects otherwise than `known`."""
    return [foot for foot, sensor in newer.sensors.items() if known.sensors.get(foot) != sensor]
