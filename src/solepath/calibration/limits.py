"""Checks of the type and the range of every value of a calibration, because a program may put anything into it."""

from __future__ import annotations

from collections.abc import Iterator

from ..types import Cell, Foot, Layout, WalkingMode
from ..types.attrs import fields
from .records import (
    Calibration,
    HeadingCalibration,
    InsoleCalibration,
    Limbs,
    Newtons,
    RestNoise,
    SensorCalibration,
    ShoeGeometry,
    TriadCalibration,
)

_Limit = tuple[str, object, float, float, str]
"""Key, value, smallest and largest allowed value, and unit of one number of a calibration."""


def find_fault(calibration: Calibration) -> str | None:
    """Return the reason why a calibration cannot be used, or None when it can be used.

    The sentence names the first key whose value is impossible for a wearer, a shoe or an insole. The limits are those
    of protocol/calibration.md."""
    wrong_type = next(_type_problems(calibration), None)
    if wrong_type is not None:
        return wrong_type
    for key, value, least, most, unit in _limits(calibration):
        if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
            return f"{key} is {_describe(value)}; it can be {least:g} to {most:g}{unit}"
    for foot, insole in calibration.insoles.items():
        if insole.newtons is not None and insole.newtons.threshold > insole.newtons.most:
            return f"insoles.{foot.value}.newtons.threshold is more than its most"
    if calibration.shoe is not None:
        return _unusable_shoe(calibration.shoe)
    return None


def _type_problems(calibration: Calibration) -> Iterator[str]:
    """Yield a sentence for every value of a wrong type, except for the numbers, which `_limits` yields."""
    yield from _check_dict("insoles", calibration.insoles, Foot)
    for foot, insole in calibration.insoles.items():
        key = f"insoles.{foot.value}"
        yield from _check_type(key, insole, InsoleCalibration)
        if insole.layout is not None:
            yield from _check_type(f"{key}.layout", insole.layout, Layout)
            yield from _check_type(f"{key}.layout.cells", insole.layout.cells, tuple)
            for cell in insole.layout.cells:
                yield from _check_type(f"one of {key}.layout.cells", cell, Cell)
        if insole.newtons is not None:
            yield from _check_type(f"{key}.newtons", insole.newtons, Newtons)
            yield from _check_tuple(f"{key}.newtons.coefficients", insole.newtons.coefficients, 4)
        yield from _check_tuple(f"{key}.noise", insole.noise)
    if calibration.shoe is not None:
        yield from _check_type("shoe", calibration.shoe, ShoeGeometry)
        yield from _check_tuple("shoe.forefoot_radius", calibration.shoe.forefoot_radius)
        yield from _check_tuple("shoe.pivot_to_toe", calibration.shoe.pivot_to_toe)
    yield from _check_dict("drift", calibration.drift, Foot)
    for foot, slope in calibration.drift.items():
        yield from _check_tuple(f"drift.{foot.value}", slope, 2)
    if calibration.limbs is not None:
        yield from _check_type("limbs", calibration.limbs, Limbs)
    if calibration.modes is not None:
        yield from _check_dict("modes", calibration.modes, Foot)
        for foot, modes in calibration.modes.items():
            yield from _check_dict(f"modes.{foot.value}", modes, WalkingMode)
            for mode, compensation in modes.items():
                yield from _check_tuple(f"modes.{foot.value}.{mode.value}", compensation, 2)
    yield from _check_dict("toe_out", calibration.toe_out, Foot)
    yield from _check_dict("headings", calibration.headings, Foot)
    for foot, heading in calibration.headings.items():
        yield from _check_type(f"headings.{foot.value}", heading, HeadingCalibration)
    yield from _check_dict("rest", calibration.rest, Foot)
    for foot, noise in calibration.rest.items():
        yield from _check_type(f"rest.{foot.value}", noise, RestNoise)
    yield from _check_dict("sensors", calibration.sensors, Foot)
    for foot, sensor in calibration.sensors.items():
        yield from _check_type(f"sensors.{foot.value}", sensor, SensorCalibration)
        for name, triad in (("acc", sensor.acc), ("gyro", sensor.gyro)):
            yield from _check_type(f"sensors.{foot.value}.{name}", triad, TriadCalibration)
            for part, count in (("matrix", 9), ("bias", 3), ("matrix_sigma", 9), ("bias_sigma", 3)):
                yield from _check_tuple(f"sensors.{foot.value}.{name}.{part}", getattr(triad, part), count)


def _check_type(key: str, value: object, kind: type) -> Iterator[str]:
    if not isinstance(value, kind):
        yield f"{key} is {_describe(value)}, no {kind.__name__}"


def _check_dict(key: str, value: object, keys: type) -> Iterator[str]:
    yield from _check_type(key, value, dict)
    for one in value if isinstance(value, dict) else ():
        if not isinstance(one, keys):
            yield f"{key} has the key {_describe(one)}, no {keys.__name__}"


def _check_tuple(key: str, value: object, count: int | None = None) -> Iterator[str]:
    if not isinstance(value, tuple) or count is not None and len(value) != count:
        yield f"{key} is {_describe(value)}, not a tuple of {'numbers' if count is None else f'{count} numbers'}"


def _limits(calibration: Calibration) -> Iterator[_Limit]:
    for foot, insole in calibration.insoles.items():
        yield from _limits_of_insole(f"insoles.{foot.value}.", insole)
    if calibration.shoe is not None:
        shoe = calibration.shoe
        yield "shoe.heel_radius", shoe.heel_radius, 0.001, 1.0, " m"
        yield "shoe.height", shoe.height, 0.0, 1.0, " m"
        yield "shoe.steepest", shoe.steepest, 0.01, 1.6, " rad"
        for key, polynomial in (("forefoot_radius", shoe.forefoot_radius), ("pivot_to_toe", shoe.pivot_to_toe)):
            yield f"the number of coefficients in shoe.{key}", len(polynomial), 1, 16, ""
            yield from ((f"shoe.{key}", coefficient, -100.0, 100.0, "") for coefficient in polynomial)
    for foot, slope in calibration.drift.items():
        yield from ((f"drift.{foot.value}", speed, -1.0, 1.0, " m/s") for speed in slope)
    for foot, angle in calibration.toe_out.items():
        yield f"toe_out.{foot.value}", angle, -1.0, 1.0, " rad"
    for foot, heading in calibration.headings.items():
        yield f"headings.{foot.value}.drift", heading.drift, -0.05, 0.05, " rad"
        yield f"headings.{foot.value}.turning", heading.turning, -0.1, 0.1, ""
        yield f"headings.{foot.value}.drift_sigma", heading.drift_sigma, 1e-6, 0.05, " rad"
        yield f"headings.{foot.value}.turning_sigma", heading.turning_sigma, 1e-6, 0.2, ""
    for foot, noise in calibration.rest.items():
        yield f"rest.{foot.value}.acc_density", noise.acc_density, 1e-6, 1.0, " m/s^2/sqrt(Hz)"
        yield f"rest.{foot.value}.acc_wander", noise.acc_wander, 0.0, 0.1, " m/s^2/sqrt(s)"
        yield f"rest.{foot.value}.gyro_density", noise.gyro_density, 1e-7, 0.1, " rad/s/sqrt(Hz)"
        yield f"rest.{foot.value}.gyro_wander", noise.gyro_wander, 0.0, 0.01, " rad/s/sqrt(s)"
        yield f"rest.{foot.value}.rate", noise.rate, 1.0, 10_000.0, " Hz"
    for foot, sensor in calibration.sensors.items():
        yield from _limits_of_triad(f"sensors.{foot.value}.acc", sensor.acc, 5.0, " m/s^2")
        yield from _limits_of_triad(f"sensors.{foot.value}.gyro", sensor.gyro, 1.0, " rad/s")
    if calibration.limbs is not None:
        for one in fields(Limbs):
            yield f"limbs.{one.name}", getattr(calibration.limbs, one.name), 0.001, 1.5, " m"
    if calibration.weight is not None:
        yield "weight", calibration.weight, 50.0, 5000.0, " N"
    for foot, modes in (calibration.modes or {}).items():
        for mode, compensation in modes.items():
            yield from ((f"modes.{foot.value}.{mode.value}", length, -0.5, 0.5, " m") for length in compensation)


def _limits_of_insole(key: str, insole: InsoleCalibration) -> Iterator[_Limit]:
    layout, newtons = insole.layout, insole.newtons
    if layout is not None:
        yield f"{key}layout.length", layout.length, 0.01, 1.0, " m"
        yield f"the number of cells in {key}layout", len(layout.cells), 1, 4096, ""
        for i, cell in enumerate(layout.cells):
            yield f"{key}layout.cells[{i}].x", cell.x, -1.0, 1.0, " m"
            yield f"{key}layout.cells[{i}].y", cell.y, -1.0, 1.0, " m"
            yield f"{key}layout.cells[{i}].area", cell.area, 0.0, 1.0, " m^2"
        if layout.scale is not None:
            yield f"{key}layout.scale", layout.scale, 1e-9, 1e6, " N"
        yield f"{key}layout.full_scale", layout.full_scale, 1e-6, 1e9, ""
    if newtons is not None:
        yield from ((f"{key}newtons.coefficients", one, -1e12, 1e12, "") for one in newtons.coefficients)
        yield f"{key}newtons.threshold", newtons.threshold, 0.0, 1e5, " N"
        yield f"{key}newtons.most", newtons.most, 0.001, 1e5, " N"
    yield from ((f"{key}noise[{i}]", value, 0.0, 1e6, "") for i, value in enumerate(insole.noise))


def _limits_of_triad(key: str, triad: TriadCalibration, largest_bias: float, unit: str) -> Iterator[_Limit]:
    for k, value in enumerate(triad.matrix):
        one = float(k % 4 == 0)  # on the diagonal
        yield f"{key}.matrix[{k}]", value, one - 0.3, one + 0.3, ""
    yield from ((f"{key}.bias", value, -largest_bias, largest_bias, unit) for value in triad.bias)
    yield from ((f"{key}.matrix_sigma", value, 0.0, 0.1, "") for value in triad.matrix_sigma)
    yield from ((f"{key}.bias_sigma", value, 0.0, largest_bias, unit) for value in triad.bias_sigma)


def _unusable_shoe(shoe: ShoeGeometry) -> str | None:
    """Return a sentence if a polynomial gives a length above 1 m at one of five pitches to `steepest`, or None."""
    for key, polynomial in (("forefoot_radius", shoe.forefoot_radius), ("pivot_to_toe", shoe.pivot_to_toe)):
        for k in range(5):
            pitch, length = 0.25 * k * shoe.steepest, 0.0
            for coefficient in reversed(polynomial):
                length = length * pitch + coefficient
            if abs(length) > 1.0:
                return f"shoe.{key} is {length:g} m at {pitch:.2g} rad; it can be -1 to 1 m"
    return None


def _describe(value: object) -> str:
    if isinstance(value, int) and not abs(value) < 10**30:
        return "a huge number"  # Python does not convert very long integers to text
    if value is None or isinstance(value, str | int):
        return repr(value)[:40]
    return f"{value:g}" if isinstance(value, float) else f"a {type(value).__name__}"
