"""Wearers of the experiments, the shoes and sensors that they may have, and the variants of the recipe.

A CC2541 in each insole samples at 20 Hz (section IV, "System Deployment"). Every wearer has another pair. The soles are
worn ones, which flex and slip (emulated/soles.py)."""

from __future__ import annotations

import numpy as np
from attrs import evolve, frozen

from solepath.body.fuse.both_feet import BothFeet
from solepath.emulate.radio import CLEAN, Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.air import STILL_AIR, Air, PressureStep
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.parts import MPU6050
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP
from solepath.papers.footstep_tracker.footsteps import Footsteps
from solepath.papers.footstep_tracker.projection import Projection, ProjectionSettings
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from solepath.papers.footstep_tracker.snake import PrintedSnake
from solepath.papers.footstep_tracker.static_zones import StaticZones, StaticZonesSettings
from solepath.types import SITE_OF_FOOT, Packet

from ...emulated.soles import SLIPPING, WORN
from ...emulated.wearers import random_wearer

RATE = 20.0
"""Sampling rate, Hz."""
WEATHER = Air(
    trend=0.014,
    gusts=6.0,
    steps=(PressureStep(60.0, 10.0), PressureStep(150.0, -25.0, lasting=20.0), PressureStep(240.0, 100.0, 120.0)),
)
"""A barometer that falls as fast as "slowly" allows, gusts, a door of a clean room, one of a stairwell, and a front.

emulate/sensors/air.py has the sources of the sizes; when the steps come, and how long they take, is assumed."""


@frozen(eq=False)
class FootstepSetting:
    """The shoe, the sensors, the radio and the air of a walk."""

    title: str
    """Words before its rows in the table."""
    contact: GroundContact = WORN
    """Contact of the sole with the ground."""
    device: Device = CC2541(rate=RATE, mounting=IN_SOLE)
    """Sensor in each shoe."""
    radio: Radio = CLEAN
    """Radio channel of each sensor."""
    air: Air = STILL_AIR
    """Air of the building."""
    activities: bool = False
    """Flag: activities are scored with this setting too; other settings change only the corridor."""


STANDARD = FootstepSetting("", activities=True)
SETTINGS = (
    FootstepSetting("rigid sole: ", RIGID),
    FootstepSetting("slip 2 cm: ", SLIPPING),
    FootstepSetting("flex: ", evolve(WORN, pivot_shift=-0.02, pivot_variation=0.006, radius_ratio=0.6)),
    FootstepSetting("on the instep: ", device=CC2541(rate=RATE, mounting=ON_INSTEP)),
    FootstepSetting("CC2650: ", device=CC2650(rate=RATE, mounting=IN_SOLE), activities=True),
    FootstepSetting("MPU-6050: ", device=CC2650(rate=RATE, mounting=IN_SOLE, chip=MPU6050), activities=True),
    FootstepSetting("3 % lost: ", radio=Radio(loss=0.03), activities=True),
    FootstepSetting("weather: ", air=WEATHER, activities=True),
)
"""Settings of the sensitivity rows; each differs from STANDARD in one thing."""

_UNRESTORED = Projection(ProjectionSettings(restores_clipped=False))
LENGTH_RECIPES = {
    "printed": FOOTSTEP_TRACKER_PRINTED,
    "closed at rest": evolve(
        FOOTSTEP_TRACKER, corrector=_UNRESTORED, detector=StaticZones(StaticZonesSettings(knows_offset=False))
    ),
    "+ offset": evolve(FOOTSTEP_TRACKER, corrector=_UNRESTORED),
    "one foot": FOOTSTEP_TRACKER,
}
"""Recipes of the stride length: printed, with our additions one after the other, and with all of them, one foot."""
ONE_METRE_RULE = FOOTSTEP_TRACKER.replace_part(BothFeet, Footsteps(), "one-metre rule")
"""Ours with the one-metre rule in the place of the fusion."""
PRINTED_TURN = evolve(FOOTSTEP_TRACKER, corrector=Projection(ProjectionSettings(as_printed=True)))
"""Ours with (5), (7) and the low-pass filter of turns alone."""
DROPS_AT_WALLS = evolve(FOOTSTEP_TRACKER, place=PrintedSnake())
"""Ours with the Snake game as printed."""
BAROMETERS = ("cc2541/barometer", "cc2650/barometer")
"""Channels of air pressure."""


@frozen
class WearerJob:
    """One wearer in one setting."""

    seed: int
    setting: FootstepSetting = STANDARD

    @property
    def is_standard(self) -> bool:
        """Flag: the setting is STANDARD."""
        return not self.setting.title

    @property
    def wearer(self) -> Wearer:
        """The wearer, in the shoes of the setting."""
        return in_shoes(random_wearer(np.random.default_rng([self.seed, 17]))[0], self.setting)

    @property
    def stature(self) -> float:
        """Stature of the wearer, m."""
        return random_wearer(np.random.default_rng([self.seed, 17]))[1]

    def walk(self, route: Route, more: int = 0, wearer: Wearer | None = None) -> EmulatedWalk:
        """Emulate a walk; `more` is added to the seed of gait and sensors, so that the wearer walks another time."""
        setting = self.setting
        devices = {site: setting.device for site in SITE_OF_FOOT.values()}
        wearer = self.wearer if wearer is None else in_shoes(wearer, setting)
        return emulate(
            route, wearer=wearer, devices=devices, radio=setting.radio, air=setting.air, seed=self.seed + more
        )


def in_shoes(wearer: Wearer, setting: FootstepSetting) -> Wearer:
    """Return the wearer with the soles of the setting."""
    return evolve(wearer, shoe=evolve(wearer.shoe, contact=setting.contact))


def without_barometer(packets: tuple[Packet, ...]) -> list[Packet]:
    """Return the packets without air pressure."""
    return [packet for packet in packets if packet.channel not in BAROMETERS]
