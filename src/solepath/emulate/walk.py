"""An emulated walk from end to end: a wearer on a route, devices on both feet, a radio, and the ground truth.

    walk = emulate(Route().stand(2).walk(100, 1.3).stop(2), radio=Radio(loss=0.05, jitter=0.05), seed=7)
    for packet in walk.packets: ...
    walk.truth.strides(Foot.LEFT)

Time 0 is the start of the first stand on the true clock, which is also the receiver's clock. The same arguments give
the same packets, byte for byte. The gait, each device and each radio channel have separate random generators: the same
seed gives the same gait with any devices and any radio."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter

import numpy as np
from attrs import frozen

from ..types import SITE_OF_FOOT, Foot, Packet, Sample, Site
from .radio import CLEAN, Radio
from .routes.route import Route
from .sensors.air import STILL_AIR, Air
from .sensors.device import Device, device_rng, foot_of
from .sensors.insole_device import Insole
from .sensors.magnetic_field import UNDISTURBED, MagneticField
from .wearers.gait import Wearer
from .wearers.truth import Truth
from .wearers.walker import Walker


@frozen(eq=False)
class EmulatedWalk:
    """The packets and the ground truth of an emulated walk."""

    packets: tuple[Packet, ...]
    """Packets of all sites in the order of arrival."""
    truth: Truth
    """Ground truth for sensors that are mounted like the devices on the feet."""
    walker: Walker
    """The walker whose motion the devices measured, with exact kinematics, loads, and samples without a radio."""


def emulate(
    route: Route,
    *,
    wearer: Wearer | None = None,
    devices: Mapping[Site, Device] | None = None,
    radio: Radio = CLEAN,
    field: MagneticField = UNDISTURBED,
    air: Air = STILL_AIR,
    seed: int = 1,
) -> EmulatedWalk:
    """Return the packets and the truth of a walk on `route`, in this magnetic field and this air.

    Without `devices`, both feet wear insoles of 96 cells at 100 Hz. Sites above the ankle can wear only a Dot;
    any other device raises ValueError there."""
    if devices is None:
        devices = {SITE_OF_FOOT[foot]: Insole() for foot in Foot}
    walker = Walker(route, wearer, seed, field, air)
    sites = list(Site)
    packets: list[Packet] = []
    for site in sorted(devices, key=sites.index):
        device = devices[site]
        sent = device.emit(walker, site, device_rng(seed, site))
        packets += radio.transmit(sent, site, np.random.default_rng([seed, 3, sites.index(site)]))
    packets.sort(key=attrgetter("t"))
    mountings = {site.foot: device.mounting for site, device in devices.items() if site.foot is not None}
    return EmulatedWalk(tuple(packets), walker.truth(mountings), walker)


@frozen(eq=False)
class SampledWalk:
    """The samples and the ground truth of an emulated walk without a radio."""

    samples: tuple[Sample, ...]
    """Samples of both feet in the order of time."""
    truth: Truth
    """Ground truth for sensors that are mounted like the insoles."""
    walker: Walker
    """The walker whose motion the insoles measured."""


def sampled(
    route: Route,
    *,
    wearer: Wearer | None = None,
    insoles: Mapping[Site, Insole] | None = None,
    field: MagneticField = UNDISTURBED,
    seed: int = 1,
) -> SampledWalk:
    """Return the samples, at their true times and without packets, of the walk that `emulate` makes on `route`."""
    if insoles is None:
        insoles = {SITE_OF_FOOT[foot]: Insole() for foot in Foot}
    walker = Walker(route, wearer, seed, field)
    samples = [
        sample for site, insole in insoles.items() for sample in insole.samples(walker, site, device_rng(seed, site))
    ]
    samples.sort(key=attrgetter("t"))
    mountings = {foot_of(site): insole.mounting for site, insole in insoles.items()}
    return SampledWalk(tuple(samples), walker.truth(mountings), walker)
