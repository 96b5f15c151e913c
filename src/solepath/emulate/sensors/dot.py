"""An emulated Movella DOT in its mode "orientation" (protocol/dot-orientation.md), for any site of the body."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...link.devices.dot import ORIENTATION_DRIVER as DRIVER
from ...types import Site
from ..wearers.curves import Rng
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .device import HANDLING_TIME, Notification, draw_clock, make_sampling, setup_notifications
from .parts import CRE_CC02, AttitudeErrors
from .sensors import read_attitudes

SAMPLING_RATE = 60.0
"""Sampling rate after the usual setup, Hz."""
TICK_RATE = 1e6
"""Rate of the device's clock, ticks per s."""
BATTERY_VALUE = b"\x5a\x00"
"""Value of the battery channel: 90 percent, not charging."""


@frozen
class Dot:
    """A Movella DOT that sends its attitude at 60 Hz."""

    mounting: Mounting = Mounting((0.0, 0.0, 0.0))
    """Position, m, and attitude of the sensor in the frame of its segment (limbs.py)."""
    attitude: AttitudeErrors = CRE_CC02
    """Attitude errors; the default has those of the unit of Gong et al. 2023."""
    north: float = 0.0
    """Yaw of the device's world frame in the walk's world frame, rad, counter-clockwise positive."""
    ppm: float | None = None
    """Rate error of the clock, ppm; None: random."""
    ticks: int | None = None
    """Ticks at the first sample; None: random."""

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the device sends over the walk, in the order of sending."""
        clock = draw_clock(rng, 1.0 / SAMPLING_RATE, self.ppm)
        random_ticks = int(rng.integers(0, 2**32))
        first_ticks = random_ticks if self.ticks is None else self.ticks
        t = make_sampling(walker, clock, 1.0 / SAMPLING_RATE).times
        true_attitudes = walker.body.at(site, t, self.mounting).attitude
        attitudes = read_attitudes(true_attitudes, t, self.attitude, self.north, rng)
        sent = setup_notifications(DRIVER.profile, {"dot-orientation/battery": BATTERY_VALUE})
        (stream,) = DRIVER.profile.streams
        # Attitudes are sent as 32-bit floats.
        for k, (sample_time, quat) in enumerate(zip(t.tolist(), attitudes.astype(np.float32).tolist(), strict=True)):
            ticks = (first_ticks + round(k * TICK_RATE / SAMPLING_RATE)) % 2**32
            data = DRIVER.write(stream, {"ticks": ticks, "quat": quat})
            sent.append(Notification(sample_time + HANDLING_TIME, stream, data))
        return sent
