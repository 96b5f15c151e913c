"""The recipes that are compared on the walks of Li et al. 2016, and what the emulated wearers wear.

`LESS` has ours without one addition at a time. `SETUPS` has the shoe and the sensor of the table, and one change of
them at a time."""

from __future__ import annotations

from typing import Any

from attrs import evolve, frozen

from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, Imu
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.shoe import ON_HEEL, ON_INSTEP, Mounting
from solepath.papers.shoe_sensing.gated_tilt import ShoeSensing, ShoeSensingSettings
from solepath.papers.shoe_sensing.printed import GatedTilt, GatedTiltSettings
from solepath.papers.shoe_sensing.recipe import SHOE_MAGNITUDE, SHOE_SENSING, SHOE_SENSING_PRINTED
from solepath.papers.shoe_sensing.short_time_energy import AccelerationMagnitude, printed_energy
from solepath.recipes import DEFAULT, Recipe
from solepath.types import Foot
from solepath.types.vector import from_rotation_vector

from ...emulated.soles import SLIPPING, WORN

TILTED = Mounting(ON_INSTEP.position, from_rotation_vector((0.0, 0.4, 0.0)))
"""Mounting on the laces, which slope down to the toe by 0.4 rad (assumed)."""
FOOT = Foot.RIGHT
"""Foot that wears the sensor ("attached to one of the user's shoes"); the side is assumed."""
RATE = 100.0
"""Sampling rate of the paper, Hz."""
LEVEL, STAIRS = ("walking", "jogging"), ("upstairs", "downstairs")
STATES = (*LEVEL, *STAIRS)
"""Ways of moving whose strides are scored."""

OURS, PRINTED, DEFAULT_ROW = "ours", "printed", "default"
METHODS = (PRINTED, OURS)
"""The two methods that are compared everywhere."""
MAGNITUDE, GATED_MAGNITUDE = "magnitude", "magnitude, gate of speed"
BEFORE = {OURS: "ours, heights stay", PRINTED: "printed, heights stay"}
"""Names of the recipes that do not remove the height errors of level strides, by the recipe that does."""


def _ours(**changes: Any) -> Recipe:
    return evolve(SHOE_SENSING, corrector=ShoeSensing(ShoeSensingSettings(**changes)))


MAIN: dict[str, Recipe] = {
    OURS: SHOE_SENSING,
    PRINTED: SHOE_SENSING_PRINTED,
    BEFORE[OURS]: _ours(eliminate=False),
    BEFORE[PRINTED]: evolve(SHOE_SENSING_PRINTED, corrector=GatedTilt(GatedTiltSettings(eliminate=False))),
}
"""Recipes that walk every long walk."""

BY_ANGLE = "ours, level by angle"
LESS: dict[str, Recipe] = {
    "ours, energy alone": evolve(SHOE_SENSING, detector=printed_energy()),
    "ours, no gate of speed": _ours(gates_speed=False),
    "ours, late motion lost": _ours(detector_delay=0.0),
    "ours, no tilt from velocity": _ours(tilt_share=0.0),
    BY_ANGLE: _ours(finds_slopes=False),
    "ours, first attitude as printed": _ours(initial_time=GatedTiltSettings().initial_time),
}
"""Ours without one of its additions, each by a name of its own."""
WINDOWS = (0.05, 0.10, 0.15, 0.20, 0.30)
"""Durations of N samples, s: "N is critical"; fig. 3 has several, without their lengths."""
BY_WINDOW: dict[str, Recipe] = {
    f"printed, N {window:g} s": evolve(SHOE_SENSING_PRINTED, detector=printed_energy(window)) for window in WINDOWS
}
SHORT: dict[str, Recipe] = {
    OURS: SHOE_SENSING,
    **LESS,
    PRINTED: SHOE_SENSING_PRINTED,
    **BY_WINDOW,
    MAGNITUDE: evolve(SHOE_SENSING_PRINTED, detector=AccelerationMagnitude()),
    GATED_MAGNITUDE: SHOE_MAGNITUDE,
    DEFAULT_ROW: DEFAULT,
}
"""Recipes that walk the short walk in all states."""
RECIPES: dict[str, Recipe] = {**MAIN, **SHORT}
"""All recipes by their names in the table."""


@frozen
class ShoeSetup:
    """The shoe and the sensor of a walk."""

    name: str
    """Name in the table."""
    contact: GroundContact = WORN
    """Contact of the sole with the ground."""
    chip: Imu = MPU6050
    """Chip of the sensor."""
    rate: float = RATE
    """Sampling rate, Hz."""
    mounting: Mounting = TILTED
    """Place of the sensor on the shoe."""
    standing: float = 6.0
    """Time for which the wearer stands before the first step, s."""


TABLE = ShoeSetup("worn sole")
"""Setup of the table: a foot that flexes and slips (emulated/soles.py)."""
SETUPS = (
    TABLE,
    *(ShoeSetup(f"{rate:g} Hz", rate=rate) for rate in (40.0, 50.0, 60.0, 80.0)),
    ShoeSetup("rigid sole", RIGID),
    ShoeSetup("slip 2 cm", SLIPPING),
    ShoeSetup("impact 50 ms", evolve(WORN, impact_time=0.05, impact_variation=0.0)),
    ShoeSetup("on the heel", mounting=ON_HEEL),
    ShoeSetup("LSM6DSOX", chip=LSM6DSOX),
    ShoeSetup("two seconds of standing", standing=2.0),
)
"""The setup of the table, and those that differ from it by one thing; the rates are those of section 3.3."""
