"""What is known of a wearer, a pair of shoes and a pair of insoles beyond what they say themselves.

Everything here is optional: a session without a calibration runs on defaults and on what it learns. The file is JSON
(protocol/calibration.md); `solepath calibrate` writes it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TypeVar

from attrs import evolve, field, fields, frozen

from ..saving.codec import SnapshotError, load, save
from ..types import Cell, Foot, Layout, WalkingMode

FORMAT = "solepath-calibration"
VERSION = 1
LARGEST = 8_000_000
"""Bytes of a file; two insoles of a thousand cells have a hundredth of that."""


class CalibrationError(ValueError):
    """A calibration cannot be read or used: one sentence that says what is wrong."""


@frozen
class Newtons:
    """From a cell's raw value to newtons by a cubic, N = a + b c + c2 c^2 + c3 c^3, as fitted to gauge data (Gong et
    al. 2023, Sensors 23, 5417, fig. 6). Below `threshold` (N) a cell reads 0, beyond `most` (N) it reads `most`."""

    coefficients: tuple[float, float, float, float]
    threshold: float = 5.0
    most: float = 200.0


@frozen
class InsoleCalibration:
    """One insole. `layout`: where its cells are, for devices and files that do not say. `noise`: what each cell shows
    in the air, unit of the samples, or N where there are `newtons` (Chen et al. 2019, equation (1))."""

    layout: Layout | None = None
    newtons: Newtons | None = None
    noise: tuple[float, ...] = ()


@frozen
class ShoeGeometry:
    """The shoe as Chen et al. 2019 have it in figs. 5 to 7; the defaults are their shoe (10.5 US), in m.

    `heel_radius`: L_r from the heel's end to the point below the sensor. `height`: H_imu, from there to the sensor.
    `forefoot_radius` and `pivot_to_toe`: L_r and L_p2t as polynomials of the heel-up pitch (rad), constant first, good
    from flat to `steepest` (rad).

    The paper gives no coefficients for the forefoot. The defaults come from geometry: the sensor 12.5 cm before the
    heel's end of a shoe of 28.5 cm with a rigid sole, and from 19.5 cm on a rocker of radius R = 5 cm, tangent to the
    sole, that rolls without slip. A ruler along the flat bottom meets the ground R tan(p/2) behind the point of contact
    at pitch p, while that point has moved R p ahead on the ground. With the pivot where ruler and ground meet

        L_r = 0.070 + R tan(p/2)            L_p2t = 0.090 - R p + R tan(p/2)

    in m, exactly; tan(p/2) = p/2 + p^3/24 + p^5/240 + ... makes polynomials of them, to 0.2 mm up to `steepest`.
    """

    heel_radius: float = 0.125
    height: float = 0.029
    forefoot_radius: tuple[float, ...] = (0.070, 0.025, 0.0, 0.05 / 24.0, 0.0, 0.05 / 240.0)
    pivot_to_toe: tuple[float, ...] = (0.090, -0.025, 0.0, 0.05 / 24.0, 0.0, 0.05 / 240.0)
    steepest: float = 1.3


@frozen
class Limbs:
    """Lengths of the lower limbs, m: between the hip joints, thigh, shank, foot from below the ankle to its end, and
    height of the ankle above the ground.

    The defaults are those of a wearer of 1.75 m. Thigh 0.245, shank 0.246, foot 0.152 and ankle 0.039 of the height by
    the proportions of Drillis and Contini (1966), as in Winter, Biomechanics and Motor Control of Human Movement; three
    quarters of the foot lie before the ankle. Their 0.191 are the breadth of the hips; the joints lie inward of the
    spines, 0.24 m apart, by 14 % of that each (Bell, Brand and Pedersen 1989, Human Movement Science 8).
    """

    hip_width: float = 0.173
    thigh: float = 0.429
    shank: float = 0.431
    foot: float = 0.200
    ankle_height: float = 0.068


@frozen
class Calibration:
    """All of it; what was not calibrated is None or absent.

    `drift`: slope of a foot's position, m/s (x, y), in the world of the device where it tells its attitude, and else in
    the navigation frame, whose heading is that of the sensor at the start: then it holds for walks that start as the
    calibration did. `weight`: of the wearer, N.
    `modes`: compensation of a touchdown by foot and walking mode, (forward, left), m. `toe_out`: from a foot's way to
    where it points, outwards positive, rad (Liu et al. 2015, equation (1)).
    """

    insoles: dict[Foot, InsoleCalibration] = field(factory=dict)
    shoe: ShoeGeometry | None = None
    drift: dict[Foot, tuple[float, float]] = field(factory=dict)
    limbs: Limbs | None = None
    weight: float | None = None
    modes: dict[Foot, dict[WalkingMode, tuple[float, float]]] | None = None
    toe_out: dict[Foot, float] = field(factory=dict)

    def insole(self, foot: Foot) -> InsoleCalibration:
        """Of this foot's insole; an empty one where none is known."""
        return self.insoles.get(foot, InsoleCalibration())


def merged(known: Calibration, newer: Calibration) -> Calibration:
    """`known` with everything that `newer` holds in its place, insole by insole and part by part. Noise that was learnt
    in one unit is no longer known when newtons are: it goes."""
    insoles = dict(known.insoles)
    for foot, insole in newer.insoles.items():
        before = insoles.get(foot, InsoleCalibration())
        if insole.newtons is not None and insole.newtons != before.newtons:
            before = evolve(before, noise=())  # it was measured in another unit
        insoles[foot] = _over(before, insole)
    drift = {**known.drift, **newer.drift}
    toe_out = {**known.toe_out, **newer.toe_out}
    return evolve(
        _over(known, newer),
        insoles={foot: insoles[foot] for foot in Foot if foot in insoles},
        drift={foot: drift[foot] for foot in Foot if foot in drift},
        toe_out={foot: toe_out[foot] for foot in Foot if foot in toe_out},
    )


_Known = TypeVar("_Known", Calibration, InsoleCalibration)


def _over(known: _Known, newer: _Known) -> _Known:
    said = {f.name: getattr(newer, f.name) for f in fields(type(newer)) if getattr(newer, f.name)}
    return evolve(known, **said)


def write_calibration(path: Path | str, calibration: Calibration) -> None:
    """Write it to a file; OSError where that cannot be."""
    told = {"format": FORMAT, "version": VERSION, "calibration": save(calibration)}
    Path(path).write_text(json.dumps(told, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def read_calibration(path: Path | str) -> Calibration:
    """The calibration in a file. CalibrationError when the file cannot be read, is not one, or holds what cannot be."""
    try:
        if Path(path).exists() and not Path(path).is_file() and not Path(path).is_dir():
            raise CalibrationError(f"{path}: is no regular file")
        told = json.loads(bounded_text(Path(path)))
    except CalibrationError:
        raise
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise CalibrationError(f"{path}: is not JSON ({error})") from None
    except RecursionError:
        raise CalibrationError(f"{path}: is not a calibration: it is nested too deeply") from None
    if not isinstance(told, dict) or told.get("format") != FORMAT:
        raise CalibrationError(f"{path}: is not a calibration")
    if told.get("version") != VERSION:
        raise CalibrationError(f"{path}: is of version {told.get('version')!r}; this release reads {VERSION}")
    what = told.get("calibration")
    if isinstance(what, dict):
        what.setdefault("toe_out", {})  # files from before there was one are good
    try:
        found = load(Calibration, what)
    except SnapshotError as error:
        what = str(error).removeprefix("not a snapshot of Calibration: ")
        raise CalibrationError(f"{path}: is not a calibration ({what})") from None
    why_not = unusable(found)
    if why_not is not None:
        raise CalibrationError(f"{path}: {why_not}")
    return found


def bounded_text(path: Path, encoding: str = "utf-8") -> str:
    """What is in a file. CalibrationError when it is larger than any of ours, or never ends; OSError and ValueError
    when it cannot be read or is no text."""
    with path.open("rb") as file:
        data = file.read(LARGEST + 1)
    if len(data) > LARGEST:
        raise CalibrationError(f"{path}: is larger than {LARGEST // 1_000_000} MB, too large for what it should be")
    return data.decode(encoding)


# --- what can be ------------------------------------------------------------------------------------------------------

_Limit = tuple[str, object, float, float, str]
"""A key, its value, the least and the most that it can be, and their unit."""


def unusable(calibration: Calibration) -> str | None:
    """Why it cannot be used: the first key whose value is none of a wearer, a shoe or an insole; None when it can. The
    limits are those of protocol/calibration.md."""
    misshapen = next(_misshapen(calibration), None)
    if misshapen is not None:
        return misshapen
    for key, value, least, most, unit in _limits(calibration):
        if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
            return f"{key} is {_shown(value)}; it can be {least:g} to {most:g}{unit}"
    for foot, insole in calibration.insoles.items():
        if insole.newtons is not None and insole.newtons.threshold > insole.newtons.most:
            return f"insoles.{foot.value}.newtons.threshold is more than its most"
    if calibration.shoe is not None:
        return _unusable_shoe(calibration.shoe)
    return None


def _misshapen(calibration: Calibration) -> Iterator[str]:
    """What is of another kind than the records above say: a program may have put anything into them. Numbers are left
    to _limits."""
    yield from _table("insoles", calibration.insoles, Foot)
    for foot, insole in calibration.insoles.items():
        key = f"insoles.{foot.value}"
        yield from _kind(key, insole, InsoleCalibration)
        if insole.layout is not None:
            yield from _kind(f"{key}.layout", insole.layout, Layout)
            yield from _kind(f"{key}.layout.cells", insole.layout.cells, tuple)
            for cell in insole.layout.cells:
                yield from _kind(f"one of {key}.layout.cells", cell, Cell)
        if insole.newtons is not None:
            yield from _kind(f"{key}.newtons", insole.newtons, Newtons)
            yield from _row(f"{key}.newtons.coefficients", insole.newtons.coefficients, 4)
        yield from _row(f"{key}.noise", insole.noise)
    if calibration.shoe is not None:
        yield from _kind("shoe", calibration.shoe, ShoeGeometry)
        yield from _row("shoe.forefoot_radius", calibration.shoe.forefoot_radius)
        yield from _row("shoe.pivot_to_toe", calibration.shoe.pivot_to_toe)
    yield from _table("drift", calibration.drift, Foot)
    for foot, slope in calibration.drift.items():
        yield from _row(f"drift.{foot.value}", slope, 2)
    if calibration.limbs is not None:
        yield from _kind("limbs", calibration.limbs, Limbs)
    if calibration.modes is not None:
        yield from _table("modes", calibration.modes, Foot)
        for foot, modes in calibration.modes.items():
            yield from _table(f"modes.{foot.value}", modes, WalkingMode)
            for mode, way in modes.items():
                yield from _row(f"modes.{foot.value}.{mode.value}", way, 2)
    yield from _table("toe_out", calibration.toe_out, Foot)


def _kind(key: str, value: object, kind: type) -> Iterator[str]:
    if not isinstance(value, kind):
        yield f"{key} is {_shown(value)}, no {kind.__name__}"


def _table(key: str, value: object, keys: type) -> Iterator[str]:
    yield from _kind(key, value, dict)
    for one in value if isinstance(value, dict) else ():
        if not isinstance(one, keys):
            yield f"{key} has the key {_shown(one)}, no {keys.__name__}"


def _row(key: str, value: object, count: int | None = None) -> Iterator[str]:
    if not isinstance(value, tuple) or count is not None and len(value) != count:
        yield f"{key} is {_shown(value)}, not a tuple of {'numbers' if count is None else f'{count} numbers'}"


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
    if calibration.limbs is not None:
        for one in fields(Limbs):
            yield f"limbs.{one.name}", getattr(calibration.limbs, one.name), 0.001, 1.5, " m"
    if calibration.weight is not None:
        yield "weight", calibration.weight, 50.0, 5000.0, " N"
    for foot, modes in (calibration.modes or {}).items():
        for mode, way in modes.items():
            yield from ((f"modes.{foot.value}.{mode.value}", length, -0.5, 0.5, " m") for length in way)


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


def _unusable_shoe(shoe: ShoeGeometry) -> str | None:
    """The polynomials say lengths wherever they are good."""
    for key, polynomial in (("forefoot_radius", shoe.forefoot_radius), ("pivot_to_toe", shoe.pivot_to_toe)):
        for k in range(5):
            pitch, length = 0.25 * k * shoe.steepest, 0.0
            for coefficient in reversed(polynomial):
                length = length * pitch + coefficient
            if abs(length) > 1.0:
                return f"shoe.{key} is {length:g} m at {pitch:.2g} rad; it can be -1 to 1 m"
    return None


def _shown(value: object) -> str:
    if isinstance(value, int) and not abs(value) < 10**30:
        return "a huge number"  # Python does not write all of them
    if value is None or isinstance(value, str | int):
        return repr(value)[:40]
    return f"{value:g}" if isinstance(value, float) else f"a {type(value).__name__}"
