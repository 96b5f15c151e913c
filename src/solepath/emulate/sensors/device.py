"""The interface of emulated devices, which are worn at a site and send notifications by a clock of their own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from attrs import frozen

from ...link.profile import Profile
from ...types import Foot, Site
from ..wearers.curves import Array, Rng
from ..wearers.motion import Kinematics
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .magnetic_field import MagneticField
from .parts import TriadErrors
from .sensors import Sampling, instants, measure

CRYSTAL_PPM = 30.0
"""Standard deviation of a clock's rate error, ppm; usual 32 kHz crystals are within about +-50 ppm."""
HANDLING_TIME = 2e-3
"""Time from a measurement of a small sensor until the radio has its value, s (assumed)."""
SETUP_TIME = 0.05
"""Time of the walk at which the setup (reads and writes) is over and measuring starts, s (assumed)."""


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
    """True for a value that is read or written, not notified: it always arrives."""


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


def setup_notifications(profile: Profile, device_values: Mapping[str, bytes]) -> list[Notification]:
    """Return the values that a host reads and writes by `profile`, evenly spread over the time up to SETUP_TIME.

    `device_values` has, by channel, the values that are read, and the written values that differ from
    `profile.setup`."""
    values = [(channel, device_values[channel]) for channel in profile.reads]
    for write in profile.setup:
        values.append((write.channel, device_values.get(write.channel, write.value)))
        values += [(channel, device_values[channel]) for channel in write.then_read]
    spacing = SETUP_TIME / (len(values) + 1)
    return [Notification(spacing * k, channel, data, True) for k, (channel, data) in enumerate(values, 1)]


def device_rng(seed: int, site: Site, *more: int) -> Rng:
    """Return the random generator of the device at a site; with `more` that of one of its sensors."""
    return np.random.default_rng([seed, 2, list(Site).index(site), *more])


def foot_of(site: Site) -> Foot:
    """Return the foot at `site`; raise ValueError for the sites above the ankle."""
    if site.foot is None:
        raise ValueError(f"only feet can wear this device, got {site.value}")
    return site.foot


def draw_clock(rng: Rng, interval: float, ppm: float | None = None) -> DeviceClock:
    """Return a clock whose first sample is up to `interval`, s, after the setup, at random; `ppm` as in DeviceClock."""
    random_ppm = CRYSTAL_PPM * float(rng.standard_normal())
    return DeviceClock(random_ppm if ppm is None else ppm, SETUP_TIME + interval * float(rng.uniform()))


def make_sampling(walker: Walker, clock: DeviceClock, nominal: float, first: float | None = None) -> Sampling:
    """Return the instants of a sensor that measures every `nominal` s of its clock, from `first`, s, to the end."""
    start, interval = clock.first if first is None else first, clock.interval(nominal)
    return instants(start, interval, max(2, int((walker.duration - start) / interval)))


def in_sensor_frame(attitude: Array, vector: Array) -> Array:
    """Return the coordinates q* v q of world vectors v, (3) or (N, 3), in the sensor frames of attitudes q (N, 4)."""
    axis = -attitude[:, 1:]
    twice = 2.0 * np.cross(axis, vector)
    return np.asarray(vector + attitude[:, :1] * twice + np.cross(axis, twice))


def measure_field(true: Kinematics, field: MagneticField, sampling: Sampling, chip: TriadErrors, rng: Rng) -> Array:
    """Return the flux density, (N, 3), T, that a magnetometer with this motion at the fine instants measures."""
    flux = field.along(sampling.fine_times, true.position)
    return measure(in_sensor_frame(true.attitude, flux), sampling, chip, rng)
