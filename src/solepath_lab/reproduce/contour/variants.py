"""The recipes that are compared on the walks of Bebek et al. 2010, and what the emulated wearers wear.

`VARIANTS` has ours, the printed one, the gyroscope with the corrector of each, and ours without one addition at a time.
`SETUPS` has the wearer and the boot of the table, and one change of them at a time."""

from __future__ import annotations

from math import inf, radians
from typing import Any

from attrs import evolve, frozen

from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.wearers.gait import LoadLaw, Wearer
from solepath.emulate.wearers.shoe import Shoe
from solepath.papers.pressure_contour.bias_zupt import BiasZupt, BiasZuptSettings
from solepath.papers.pressure_contour.contour import PAPER_LEVELS, Contours, ContourSettings
from solepath.papers.pressure_contour.contour_stance import (
    ContourVelocity,
    ContourVelocitySettings,
    GyroscopeMagnitude,
    GyroscopeSettings,
)
from solepath.papers.pressure_contour.recipe import AS_PRINTED, GYROSCOPE, PRESSURE_CONTOUR, PRESSURE_CONTOUR_PRINTED
from solepath.recipes import Recipe
from solepath.types import Foot

from ...emulated.boot import INERTIACUBE3, TILTED_INERTIACUBE3, WORN_CAPACITIVE, HeelPad, boot
from ...emulated.soles import SLIPPING, WORN

RATE = 50.0
"""Sampling rate, Hz (assumed)."""
FOOT = Foot.RIGHT
"""Foot that wears the boot (assumed)."""
PACE = 0.8
"""Walking speed, m/s: that of the calibration walks, 235 m in 5 min (section V-D)."""

PUBLISHED_RATE = 0.5
"""Threshold of |w|, rad/s, of the gyroscope as printed: the paper has none; this one is after Tunca et al. 2017."""


def fixed_gyroscope(threshold: float) -> GyroscopeMagnitude:
    """Return a detector whose threshold, rad/s, is the same for all wearers."""
    return GyroscopeMagnitude(GyroscopeSettings(below=threshold, first=threshold, ceiling=threshold))


GYROSCOPE_ROW, PRESSURE_ROW = "Gyroscope", "Pressure"
GYROSCOPE_PRINTED_ROW, PRESSURE_PRINTED_ROW = "Gyroscope as printed", "Pressure as printed"

MAIN: dict[str, Recipe] = {
    GYROSCOPE_ROW: GYROSCOPE,
    PRESSURE_ROW: PRESSURE_CONTOUR,
    GYROSCOPE_PRINTED_ROW: Recipe("gyroscope as printed", fixed_gyroscope(PUBLISHED_RATE), BiasZupt(AS_PRINTED)),
    PRESSURE_PRINTED_ROW: PRESSURE_CONTOUR_PRINTED,
}
"""The two detectors with our corrector, and with the printed one."""

WITHOUT_BIAS_ROW = "Pressure as printed, no bias filter"
WITHOUT_SWING_DRIFT_ROW, WITHOUT_SHARES_ROW = "Pressure, swing drift stays", "Pressure, levels in kPa"
WITHOUT_OWN_THRESHOLD_ROW, WITHOUT_GATE_ROW = "Pressure, 4 mm/s for all", "Pressure, every slope used"


def _ours(detector: ContourVelocity, settings: BiasZuptSettings) -> Recipe:
    return evolve(PRESSURE_CONTOUR, detector=detector, corrector=BiasZupt(settings))


LESS: dict[str, Recipe] = {
    WITHOUT_SWING_DRIFT_ROW: _ours(ContourVelocity(), BiasZuptSettings(remove_swing_drift=False)),
    WITHOUT_SHARES_ROW: _ours(
        ContourVelocity(contours=Contours(ContourSettings(pascals=PAPER_LEVELS))), BiasZuptSettings()
    ),
    WITHOUT_OWN_THRESHOLD_ROW: _ours(ContourVelocity(ContourVelocitySettings(leave=0.004)), BiasZuptSettings()),
    WITHOUT_GATE_ROW: _ours(ContourVelocity(), BiasZuptSettings(gate_drift=False)),
    WITHOUT_BIAS_ROW: evolve(PRESSURE_CONTOUR_PRINTED, corrector=BiasZupt(evolve(AS_PRINTED, estimate_bias=False))),
    **{
        f"Gyroscope, {threshold:g} rad/s for all": evolve(GYROSCOPE, detector=fixed_gyroscope(threshold))
        for threshold in (0.1, 0.25)
    },
}
"""Ours without one of its additions, the printed one without the filter of (4) to (10), and a stricter gyroscope."""

VARIANTS = {**MAIN, **LESS}


@frozen
class Setup:
    """A wearer with a boot."""

    name: str
    """Name, which completes the sentence "with ...", or of a change: "with ... instead"."""
    wearer: Wearer
    device: Insole
    speed: float = PACE
    """Walking speed of the laps, m/s. If it is another one than PACE, the whole walk has it."""


TABLE = Setup(
    "the boot of the table",
    Wearer(rest_pitch=0.01, pad=HeelPad()),
    evolve(boot(FOOT, RATE), attitude=TILTED_INERTIACUBE3, borne_share=0.5),
)
"""Setup of the half-hour walks.

The array bears half of the load above it (assumed). With all of it the emulated pressure would exceed the array's range
of 140 kPa, and the contours of figure 4 would lie outside of the array in most of the stance."""


def _wearer(name: str, **changes: Any) -> Setup:
    """Return the setup of the table with another wearer."""
    return evolve(TABLE, name=name, wearer=evolve(TABLE.wearer, **changes))


def _device(name: str, **changes: Any) -> Setup:
    """Return the setup of the table with another device."""
    return evolve(TABLE, name=name, device=evolve(TABLE.device, **changes))


def _attitude(name: str, **changes: Any) -> Setup:
    """Return the setup of the table with other errors of the attitude."""
    return _device(name, attitude=evolve(TILTED_INERTIACUBE3, **changes))


WHOLE_SOLE = _device("99 cells under the whole sole", cells=99, cell_part=WORN_CAPACITIVE, borne_share=1.0)
INWARDS = "99 cells, and a load that moves inwards under the forefoot in bends"
SETUPS = (
    TABLE,
    _wearer("a patch of fixed size that only moves with the pitch", pad=None),
    _wearer("a patch that spreads and does not move", pad=HeelPad(roll=0.0, fore_aft_share=0.0)),
    _wearer("a heel bone that rolls twice as far", pad=HeelPad(roll=0.18)),
    _wearer("a pad of half the stiffness in shear", pad=HeelPad(shear_stiffness=20e3)),
    _wearer("feet that hardly turn in stance", rest_pitch=4e-4),
    _wearer("feet that turn twice as far in stance", rest_pitch=0.02),
    _wearer("a worn sole, which bends and slips", shoe=Shoe(contact=WORN)),
    _wearer("a worn sole, pivot 2 cm ahead", shoe=Shoe(contact=evolve(WORN, pivot_shift=0.02))),
    _wearer("a worn sole that slips by 2 cm", shoe=Shoe(contact=SLIPPING)),
    _device("no low pass before sampling", bandwidth=inf),
    _device("no tilt that stays", attitude=INERTIACUBE3),
    _attitude("a tilt of half a degree that stays", steady_tilt=radians(0.5), correlation_time=30.0),
    _attitude("attitude errors of one degree", tilt=radians(1.0), steady_tilt=radians(1.0)),
    _attitude("attitude errors that last five minutes", steady_tilt=radians(0.25), correlation_time=300.0),
    _attitude("attitude errors that last half an hour", steady_tilt=radians(0.25), correlation_time=1800.0),
    _device("an array that bears the whole load", borne_share=1.0),
    _device("an array that bears 0.3 of the load", borne_share=0.3),
    WHOLE_SOLE,
    evolve(WHOLE_SOLE, name=INWARDS, wearer=evolve(TABLE.wearer, load_law=LoadLaw.HEEL_OUT_FOREFOOT_IN)),
    _device("samples at 100 Hz", rate=100.0),
    _wearer("a wearer of 100 kg", mass=100.0),
    evolve(TABLE, name="a speed of 1.3 m/s", speed=1.3),
)
"""The setup of the table, and those that differ from it by one thing.

The second load law is tried with 99 cells: under the heel, where the array is, both laws move the load alike."""
