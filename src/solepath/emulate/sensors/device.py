"""What every emulated device is: something worn at a site that sends notifications by a clock of its own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from attrs import frozen

from ...link.profile import Profile
from ...types import Foot, Site
from ..wearers.curves import Array, Rng
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .sensors import Instants, instants

CRYSTAL_PPM = 30.0
"""Standard deviation of a crystal's rate between devices: the usual 32 kHz tuning fork is within +-50 ppm or so."""
SETUP = 0.05
"""s after t = 0 at which reading and writing are over and measuring begins."""


@frozen
class Notification:
    """One value as a device hands it to its radio at `t`, s.

    `acknowledged`: a value that was read or written, not notified; the link layer repeats those until they get through.
    """

    t: float
    channel: str
    data: bytes
    acknowledged: bool = False


@frozen
class DeviceClock:
    """A device's own time: it runs fast by `ppm` millionths, and `first` is the true time of its first sample, s."""

    ppm: float
    first: float

    def interval(self, nominal: float) -> float:
        """True s for what the device takes to be `nominal` s."""
        return nominal / (1.0 + 1e-6 * self.ppm)


class Device(Protocol):
    """An emulated device. `mounting`: where its inertial sensor sits on the foot or the limb."""

    @property
    def mounting(self) -> Mounting: ...

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """All that the device sends over the walk, in the order of sending."""


def setup_notifications(profile: Profile, own: Mapping[str, bytes]) -> list[Notification]:
    """What a host reads and writes by `profile` before measuring begins, spread evenly over the time until `SETUP`.

    `own`: by channel, the values that the device is read for, and those written otherwise than in `profile.setup`.
    """
    values = [(channel, own[channel]) for channel in profile.reads]
    for write in profile.setup:
        values.append((write.channel, own.get(write.channel, write.value)))
        values += [(channel, own[channel]) for channel in write.then_read]
    each = SETUP / (len(values) + 1)
    return [Notification(each * k, channel, data, True) for k, (channel, data) in enumerate(values, 1)]


def device_numbers(seed: int, site: Site, *more: int) -> Rng:
    """The random numbers of the device at a site; with `more`, of a part of it."""
    return np.random.default_rng([seed, 2, list(Site).index(site), *more])


def foot_of(site: Site) -> Foot:
    """The foot at `site`, for what only feet can wear. ValueError for the sites above the ankle."""
    if site.foot is None:
        raise ValueError(f"only feet can wear this device, got {site.value}")
    return site.foot


def draw_clock(rng: Rng, interval: float, ppm: float | None = None) -> DeviceClock:
    """A clock that begins to sample at some moment within one `interval` after the setup."""
    drawn = CRYSTAL_PPM * float(rng.standard_normal())
    return DeviceClock(drawn if ppm is None else ppm, SETUP + interval * float(rng.uniform()))


def sampling_instants(walker: Walker, clock: DeviceClock, nominal: float, first: float | None = None) -> Instants:
    """The instants of a sensor that measures every `nominal` s of the device's time until the walk ends."""
    start, interval = clock.first if first is None else first, clock.interval(nominal)
    return instants(start, interval, max(2, int((walker.duration - start) / interval)))


FIELD: Array = np.array([16e-6, 12e-6, -43e-6])
"""The earth's magnetic field in the world frame, T: 20 uT horizontal, 43 uT down, as in Central Europe."""


def in_sensor_frame(attitude: Array, vector: Array) -> Array:
    """A world vector in the axes of sensors with these attitudes (N, 4): q* v q, (N, 3)."""
    axis = -attitude[:, 1:]
    twice = 2.0 * np.cross(axis, vector)
    return np.asarray(vector + attitude[:, :1] * twice + np.cross(axis, twice))
