"""The recipes that are compared on the walks of Bebek et al. 2010, and what the emulated wearers wear.

`VARIANTS` has ours, the printed one, the gyroscope with the corrector of each, and ours without one addition at a time.
`SETUPS` has the wearer and the boot of the table, and one change of them at a time."""

from __future__ import annotations

from typing import Any

from attrs import evolve, frozen

from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import Shoe
from solepath.foot.settings import CycleSettings
from solepath.foot.stance.shoe import GYRO_SQUARE
from solepath.papers.pressure_contour.bias_zupt import BiasZupt, BiasZuptSettings
from solepath.papers.pressure_contour.contour import PAPER_LEVELS, ContourSettings
from solepath.papers.pressure_contour.contour_stance import ContourVelocity, GyroscopeMagnitude
from solepath.papers.pressure_contour.recipe import AS_PRINTED, GYROSCOPE, PRESSURE_CONTOUR, PRESSURE_CONTOUR_PRINTED
from solepath.recipes import Recipe
from solepath.types import Foot

from ...emulated.boot import INERTIACUBE3, TILTED_INERTIACUBE3, WORN_CAPACITIVE, HeelPad, boot
from ...emulated.soles import WORN

RATE = 50.0
"""Sampling rate, Hz (assumed)."""
FOOT = Foot.RIGHT
"""Foot that wears the boot (assumed)."""
PACE = 0.8
"""Walking speed, m/s: that of the calibration walks, 235 m in 5 min (section V-D)."""

PUBLISHED_RATE = 0.5
"""Threshold of |w|, rad/s, of the gyroscope as printed: the paper has none; this one is after Tunca et al. 2017."""


GYROSCOPE_ROW, PRESSURE_ROW = "Gyroscope", "Pressure"
GYROSCOPE_PRINTED_ROW, PRESSURE_PRINTED_ROW = "Gyroscope as printed", "Pressure as printed"
_FIXED = CycleSettings(
    rolls=False, noise_per_rate_square=0.0, threshold_position=0.0, least_threshold=PUBLISHED_RATE**2 / GYRO_SQUARE
)
"""Settings of a gyroscope with the same threshold for all wearers."""

MAIN: dict[str, Recipe] = {
    GYROSCOPE_ROW: GYROSCOPE,
    PRESSURE_ROW: PRESSURE_CONTOUR,
    GYROSCOPE_PRINTED_ROW: Recipe("gyroscope as printed", GyroscopeMagnitude(settings=_FIXED), BiasZupt(AS_PRINTED)),
    PRESSURE_PRINTED_ROW: PRESSURE_CONTOUR_PRINTED,
}
"""The two detectors with our corrector, and with the printed one."""

SWING_DRIFT_ROW, KPA_ROW = "Pressure, swing drift stays", "Pressure, levels in kPa"
WITHOUT_BIAS_ROW = "Pressure as printed, no bias filter"
LESS: dict[str, Recipe] = {
    SWING_DRIFT_ROW: evolve(PRESSURE_CONTOUR, corrector=BiasZupt(BiasZuptSettings(remove_swing_drift=False))),
    KPA_ROW: evolve(PRESSURE_CONTOUR, detector=ContourVelocity(settings=ContourSettings(pascals=PAPER_LEVELS))),
    WITHOUT_BIAS_ROW: evolve(PRESSURE_CONTOUR_PRINTED, corrector=BiasZupt(evolve(AS_PRINTED, estimate_bias=False))),
}
"""Ours without one of its additions, and the printed one without the filter of (4) to (10)."""

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


SETUPS = (
    TABLE,
    _wearer("a patch of fixed size that only moves with the pitch", pad=None),
    _wearer("a heel bone that rolls twice as far", pad=HeelPad(roll=0.18)),
    _wearer("a worn sole, which bends and slips", shoe=Shoe(contact=WORN)),
    _device("no tilt that stays", attitude=INERTIACUBE3),
    _device("an array that bears the whole load", borne_share=1.0),
    _device("an array that bears 0.3 of the load", borne_share=0.3),
    _device("99 cells under the whole sole", cells=99, cell_part=WORN_CAPACITIVE, borne_share=1.0),
    _device("samples at 100 Hz", rate=100.0),
    _wearer("a wearer of 100 kg", mass=100.0),
    evolve(TABLE, name="a speed of 1.3 m/s", speed=1.3),
)
"""The setup of the table, and those that differ from it by one thing."""
