"""What is known of a wearer, a pair of shoes and a pair of insoles beyond what they say themselves.

Everything here is optional: a session without a calibration runs on defaults and on what it learns.
"""

from __future__ import annotations

from typing import TypeVar

from ..types import Foot, Layout, WalkingMode
from ..types.attrs import evolve, field, fields, frozen


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
