"""The emulator: a wearer on a scripted route, devices and radio, and the truth. Needs numpy."""

from .dot import Dot
from .gait import Wearer
from .insole_device import Insole
from .radio import Radio
from .route import Route
from .sensortags import CC2541, CC2650
from .walk import EmulatedWalk, SampledWalk, emulate, sampled
from .walker import Walker

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
