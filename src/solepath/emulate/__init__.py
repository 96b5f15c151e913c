"""The emulator: a wearer on a scripted route, devices, a radio link and the ground truth. Needs numpy."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING

from .devices.bench import Bench
from .radio import Radio
from .routes.course import Course
from .routes.route import Route
from .routes.ways import case_study
from .sensors.dot import Dot
from .sensors.insole_device import Insole
from .sensors.insoles import layout
from .sensors.sensortags import CC2541, CC2650
from .sensors.suit import suit
from .walk import EmulatedWalk, SampledWalk, emulate, sampled
from .wearers.gait import Wearer
from .wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from .wearers.walker import Walker

if TYPE_CHECKING:
    from ..ble import Backend

__all__ = [
    "Bench",
    "CC2541",
    "CC2650",
    "Course",
    "Dot",
    "EmulatedWalk",
    "IN_SOLE",
    "Insole",
    "Mounting",
    "ON_INSTEP",
    "Radio",
    "Route",
    "SampledWalk",
    "Walker",
    "Wearer",
    "case_study",
    "emulate",
    "layout",
    "reach",
    "sampled",
    "suit",
]


def reach(where: str) -> AbstractAsyncContextManager[Backend]:
    """Return a context that gives `Devices` the emulated sensors of `solepath emulate` at `where`, tcp:HOST:PORT.

    Needs the extra `loopback`. Raises ValueError for other words, and BluetoothError, on entering, when nothing
    answers."""
    from .controllers import reach

    return reach(where)
