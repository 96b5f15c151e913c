"""The emulator: a wearer on a scripted route, devices and radio, and the truth. Needs numpy."""

from .radio import Radio
from .routes.route import Route
from .sensors.dot import Dot
from .sensors.insole_device import Insole
from .sensors.sensortags import CC2541, CC2650
from .walk import EmulatedWalk, SampledWalk, emulate, sampled
from .wearers.gait import Wearer
from .wearers.walker import Walker

__all__ = [
    "CC2541",
    "CC2650",
    "Dot",
    "EmulatedWalk",
    "Insole",
    "Radio",
    "Route",
    "SampledWalk",
    "Walker",
    "Wearer",
    "emulate",
    "sampled",
]
