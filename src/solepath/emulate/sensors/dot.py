"""An emulated Movella DOT in its mode "orientation" (protocol/dot-orientation.md), for any site of the body."""

from __future__ import annotations

import struct

from attrs import frozen

from ...link.devices.dot_orientation import DRIVER
from ...types import Site
from ..wearers.curves import Rng
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .device import Notification, draw_clock, sampling_instants, setup_notifications
from .parts import CRE_CC02, AttitudePart
from .sensors import read_attitudes
from .tag_signals import HANDLING

RATE = 60.0
"""Hz that it streams after the usual setup."""
TICK_RATE = 1e6
BATTERY = b"\x5a\x00"
"""90 percent, not charging."""


@frozen
class Dot:
    """Sends its attitude at 60 Hz. `mounting`: on the segment that its site names, in that segment's frame (limbs.py).

    `attitude`: how far off it is; as the unit of Gong et al. 2023 when nothing is said, for whose experiments it is
    worn (MOVELLA_DOT are its own figures). `north`: how far the x axis of its world is turned from the walk's, rad.
    `ppm` and `ticks`: rate error and reading of the clock at its first sample; drawn when None.
    """

    mounting: Mounting = Mounting((0.0, 0.0, 0.0))
    attitude: AttitudePart = CRE_CC02
    north: float = 0.0
    ppm: float | None = None
    ticks: int | None = None

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        clock = draw_clock(rng, 1.0 / RATE, self.ppm)
        drawn = int(rng.integers(0, 2**32))
        first_ticks = drawn if self.ticks is None else self.ticks
        t = sampling_instants(walker, clock, 1.0 / RATE).taken
        true = walker.body.at(site, t, self.mounting).attitude
        attitudes = read_attitudes(true, t, self.attitude, self.north, rng)
        sent = setup_notifications(DRIVER.profile, {"dot-orientation/battery": BATTERY})
        (stream,) = DRIVER.profile.streams
        for k, (when, quat) in enumerate(zip(t.tolist(), attitudes.tolist(), strict=True)):
            ticks = (first_ticks + round(k * TICK_RATE / RATE)) % 2**32
            data = DRIVER.write(stream, {"ticks": ticks, "quat": struct.unpack("<4f", struct.pack("<4f", *quat))})
            sent.append(Notification(when + HANDLING, stream, data))
        return sent
