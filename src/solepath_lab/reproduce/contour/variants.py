"""The recipes that are compared on the walks of Bebek et al. 2010, and what the emulated wearers wear.

`VARIANTS` has ours, the printed one, the gyroscope with the corrector of each, and ours without one addition at a time.
`SETUPS` has the wearer and the boot of the table, and one change of them at a time."""

from __future__ import annotations

from math import inf, radians

from attrs import evolve, frozen

from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.wearers.contact import GroundContact
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


def _attitude_source(tilt_degrees: float, memory: float) -> Insole:
    return evolve(
        TABLE.device, attitude=evolve(TILTED_INERTIACUBE3, steady_tilt=radians(tilt_degrees), correlation_time=memory)
    )


def _pad(**changes: float) -> Wearer:
    return evolve(TABLE.wearer, pad=HeelPad(**changes))


def _in_shoe(contact: GroundContact) -> Wearer:
    return evolve(TABLE.wearer, shoe=Shoe(contact=contact))


TABLE = Setup(
    "the boot of the table",
    Wearer(rest_pitch=0.01, pad=HeelPad()),
    evolve(boot(FOOT, RATE), attitude=TILTED_INERTIACUBE3, borne_share=0.5),
)
"""Setup of the half-hour walks.

The array bears half of the load above it (assumed). With all of it the emulated pressure would exceed the array's range
of 140 kPa, and the contours of figure 4 would lie outside of the array in most of the stance."""

SETUPS = (
    TABLE,
    Setup("a patch of fixed size that only moves with the pitch", evolve(TABLE.wearer, pad=None), TABLE.device),
    Setup("a patch that spreads and does not move", _pad(roll=0.0, fore_aft_share=0.0), TABLE.device),
    Setup("a heel bone that rolls twice as far", _pad(roll=0.18), TABLE.device),
    Setup("a pad of half the stiffness in shear", _pad(shear_stiffness=20e3), TABLE.device),
    Setup("feet that hardly turn in stance", evolve(TABLE.wearer, rest_pitch=4e-4), TABLE.device),
    Setup("feet that turn twice as far in stance", evolve(TABLE.wearer, rest_pitch=0.02), TABLE.device),
    Setup("a worn sole, which bends and slips", _in_shoe(WORN), TABLE.device),
    Setup("a worn sole, pivot 2 cm ahead", _in_shoe(evolve(WORN, pivot_shift=0.02)), TABLE.device),
    Setup("a worn sole that slips by 2 cm", _in_shoe(SLIPPING), TABLE.device),
    Setup("no low pass before sampling", TABLE.wearer, evolve(TABLE.device, bandwidth=inf)),
    Setup("no tilt that stays", TABLE.wearer, evolve(TABLE.device, attitude=INERTIACUBE3)),
    Setup("a tilt of half a degree that stays", TABLE.wearer, _attitude_source(0.5, 30.0)),
    Setup("attitude errors of one degree", TABLE.wearer, evolve(
        TABLE.device, attitude=evolve(TILTED_INERTIACUBE3, tilt=radians(1.0), steady_tilt=radians(1.0)))),
    Setup("attitude errors that last five minutes", TABLE.wearer, _attitude_source(0.25, 300.0)),
    Setup("attitude errors that last half an hour", TABLE.wearer, _attitude_source(0.25, 1800.0)),
    Setup("an array that bears the whole load", TABLE.wearer, evolve(TABLE.device, borne_share=1.0)),
    Setup("an array that bears 0.3 of the load", TABLE.wearer, evolve(TABLE.device, borne_share=0.3)),
    Setup("99 cells under the whole sole", TABLE.wearer, evolve(
        TABLE.device, cells=99, cell_part=WORN_CAPACITIVE, borne_share=1.0)),
    Setup("99 cells, and a load that moves inwards under the forefoot in bends", evolve(
        TABLE.wearer, load_law=LoadLaw.HEEL_OUT_FOREFOOT_IN), evolve(
        TABLE.device, cells=99, cell_part=WORN_CAPACITIVE, borne_share=1.0)),
    Setup("samples at 100 Hz", TABLE.wearer, evolve(TABLE.device, rate=100.0)),
    Setup("a wearer of 100 kg", evolve(TABLE.wearer, mass=100.0), TABLE.device),
    Setup("a speed of 1.3 m/s", TABLE.wearer, TABLE.device, speed=1.3),
)  # fmt: skip
"""The setup of the table, and those that differ from it by one thing.

The second load law is tried with 99 cells: under the heel, where the array is, both laws move the load alike."""
