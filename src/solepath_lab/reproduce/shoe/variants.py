"""The recipes that are compared on the walks of Li et al. 2016, and what the emulated wearers wear.

`LESS` has ours without one addition at a time. `SETUPS` has the shoe and the sensor of the table, and one change of
them at a time."""

from __future__ import annotations

from math import hypot, inf
from typing import ClassVar

from attrs import evolve, frozen

from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, Imu
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.shoe import ON_HEEL, ON_INSTEP, Mounting
from solepath.foot.stance.stance import Detector, Load, Stance
from solepath.papers.shoe_sensing.additions import ShoeSensing
from solepath.papers.shoe_sensing.printed import GatedTilt
from solepath.papers.shoe_sensing.recipe import SHOE_SENSING, SHOE_SENSING_PRINTED
from solepath.papers.shoe_sensing.short_time_energy import printed_energy
from solepath.recipes import DEFAULT, Recipe
from solepath.types import Foot, Phase, Quat, Vec3
from solepath.types.attrs import stateful
from solepath.types.vector import GRAVITY, IDENTITY, ZERO, from_rotation_vector

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
MAGNITUDE = "magnitude"
BEFORE = {OURS: "ours, heights stay", PRINTED: "printed, heights stay"}
"""Names of the recipes that do not remove the height errors of level strides, by the recipe that does."""


@stateful
class AccelerationMagnitude(Detector):
    """Detector: the foot stands while the magnitude of the specific force, |a|, is about 1 g.

    Li et al. compare with it in section 4.2.1, but give no threshold. Here it is condition C1 of Jimenez and others, "A
    comparison of pedestrian dead-reckoning algorithms using a low-cost MEMS IMU" (IEEE WISP 2009): 9 m/s^2 < |a| < 11
    m/s^2. The statistic is |a| - g, m/s^2. It has no latency."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        magnitude = hypot(*acc)
        if 9.0 < magnitude < 11.0:
            return Stance(ZERO, 0.01, magnitude - GRAVITY, Phase.STATIONARY)
        return Stance(ZERO, inf, magnitude - GRAVITY, None)


@stateful
class HeightsStay(ShoeSensing):
    """Ours without the removal of height errors."""

    def flat(self, start: Vec3, turn: float) -> None:
        return


@stateful
class LevelByAngle(HeightsStay):
    """Ours with level strides by their angle per metre, as printed."""

    def height_at_end(self, x: float, y: float, z: float) -> float:
        return GatedTilt.height_at_end(self, x, y, z)


@stateful
class PrintedHeightsStay(GatedTilt):
    """The printed corrector without the removal of height errors."""

    def height_at_end(self, x: float, y: float, z: float) -> float:
        return z


@stateful
class NoGate(ShoeSensing):
    """Ours with a stance at any integrated speed."""

    speed_limit: ClassVar[float] = 1e3


@stateful
class NoDelay(ShoeSensing):
    """Ours without the motion before the detected end of a stance."""

    detector_delay: ClassVar[float] = 0.0


@stateful
class NoTilt(ShoeSensing):
    """Ours without a tilt from the velocity left after a motion."""

    tilt_share: ClassVar[float] = 0.0


def _ours(corrector: ShoeSensing) -> Recipe:
    return evolve(SHOE_SENSING, corrector=corrector)


MAIN: dict[str, Recipe] = {
    OURS: SHOE_SENSING,
    PRINTED: SHOE_SENSING_PRINTED,
    BEFORE[OURS]: _ours(HeightsStay()),
    BEFORE[PRINTED]: evolve(SHOE_SENSING_PRINTED, corrector=PrintedHeightsStay()),
}
"""Recipes that walk every long walk."""

BY_ANGLE = "ours, level by angle"
LESS: dict[str, Recipe] = {
    "ours, energy alone": evolve(SHOE_SENSING, detector=printed_energy()),
    "ours, no gate of speed": _ours(NoGate()),
    "ours, late motion lost": _ours(NoDelay()),
    "ours, no tilt from velocity": _ours(NoTilt()),
    BY_ANGLE: _ours(LevelByAngle()),
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


TABLE = ShoeSetup("worn sole")
"""Setup of the table: a foot that flexes and slips (emulated/soles.py)."""
SETUPS = (
    TABLE,
    *(ShoeSetup(f"{rate:g} Hz", rate=rate) for rate in (40.0, 50.0, 60.0, 80.0)),
    ShoeSetup("rigid sole", RIGID),
    ShoeSetup("slip 2 cm", SLIPPING),
    ShoeSetup("on the heel", mounting=ON_HEEL),
    ShoeSetup("LSM6DSOX", chip=LSM6DSOX),
)
"""The setup of the table, and those that differ from it by one thing; the rates are those of section 3.3."""
