"""The interface of every emulated device: worn at a site, it sends notifications by its own clock."""

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
"""Standard deviation of the crystals' rate, ppm: the usual 32 kHz tuning fork is within about +-50 ppm."""
SETUP = 0.05
"""Time at which the setup (reads and writes) is over and measuring starts, s."""


@frozen
class Notification:
    """One value that a device hands to its radio."""

    t: float
    """Time at which the radio has the value, s."""
    channel: str
    """Name of the channel."""
    data: bytes
    """Value as the device encodes it."""
    acknowledged: bool = False
    """True for a value that was read or written, not notified: the link layer repeats it until it arrives."""


@frozen
class DeviceClock:
    """The clock of a device."""

    ppm: float
    """Rate error of the clock, ppm; positive when it runs fast."""
    first: float
    """True time of the first sample, s."""

    def interval(self, nominal: float) -> float:
        """Return the true duration, s, of `nominal` s of the device's clock."""
        return nominal / (1.0 + 1e-6 * self.ppm)


class Device(Protocol):
    """An emulated device."""

    @property
    def mounting(self) -> Mounting:
        """Position and attitude of the inertial sensor on the foot or the limb."""
        ...

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the device sends over the walk, in the order of sending."""


def setup_notifications(profile: Profile, own: Mapping[str, bytes]) -> list[Notification]:
    """Return what a host reads and writes by `profile` before measuring starts, evenly spread over the time to `SETUP`.

    `own` has by channel the values that are read, and the written values that differ from `profile.setup`."""
    values = [(channel, own[channel]) for channel in profile.reads]
    for write in profile.setup:
        values.append((write.channel, own.get(write.channel, write.value)))
        values += [(channel, own[channel]) for channel in write.then_read]
    each = SETUP / (len(values) + 1)
    return [Notification(each * k, channel, data, True) for k, (channel, data) in enumerate(values, 1)]


def device_numbers(seed: int, site: Site, *more: int) -> Rng:
    """Return the random generator of the device at a site, or of one part of it with `more`."""
    return np.random.default_rng([seed, 2, list(Site).index(site), *more])


def foot_of(site: Site) -> Foot:
    """Return the foot at `site`; raise ValueError for the sites above the ankle."""
    if site.foot is None:
        raise ValueError(f"only feet can wear this device, got {site.value}")
    return site.foot


def draw_clock(rng: Rng, interval: float, ppm: float | None = None) -> DeviceClock:
    """Return a clock whose first sample is at a random time within one `interval` after the setup."""
    drawn = CRYSTAL_PPM * float(rng.standard_normal())
    return DeviceClock(drawn if ppm is None else ppm, SETUP + interval * float(rng.uniform()))


def sampling_instants(walker: Walker, clock: DeviceClock, nominal: float, first: float | None = None) -> Instants:
    """Return the instants of a sensor that measures every `nominal` s of the device's clock until the walk ends."""
    start, interval = clock.first if first is None else first, clock.interval(nominal)
    return instants(start, interval, max(2, int((walker.duration - start) / interval)))


FIELD: Array = np.array([16e-6, 12e-6, -43e-6])
"""Magnetic field of the earth in the world frame, T: 20 uT horizontal, 43 uT down, as in Central Europe."""


def in_sensor_frame(attitude: Array, vector: Array) -> Array:
    """Return a world vector in the sensor frames of these attitudes (N, 4): q* v q, (N, 3)."""
    axis = -attitude[:, 1:]
    twice = 2.0 * np.cross(axis, vector)
    return np.asarray(vector + attitude[:, :1] * twice + np.cross(axis, twice))
