"""An emulated walk from end to end: a wearer on a route, devices on both feet, a radio, and the truth beside it.

    walk = emulate(Route().stand(2).walk(100, 1.3).stop(2), radio=Radio(loss=0.05, jitter=0.05), seed=7)
    for packet in walk.packets: ...
    walk.truth.steps(Foot.LEFT)

Time 0 is the beginning of the first stand on the true clock, which is also the receiver's. The same arguments give the
same packets, byte for byte; the gait, each device and each radio link have random numbers of their own, so that the
same seed walks the same way whatever is worn and however it is received.
"""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter

import numpy as np
from attrs import frozen

from ..types import SITE_OF_FOOT, Foot, Packet, Sample, Site
from .radio import CLEAN, Radio
from .routes.route import Route
from .sensors.device import Device, device_numbers, foot_of
from .sensors.insole_device import Insole
from .wearers.gait import Wearer
from .wearers.truth import Truth
from .wearers.walker import Walker


@frozen(eq=False)
class EmulatedWalk:
    """`packets` of all sites in the order of arrival; `truth` for sensors where the devices have them; `walker`, for
    what lies beneath: exact kinematics, loads, and samples without a wire."""

    packets: tuple[Packet, ...]
    truth: Truth
    walker: Walker


def emulate(
    route: Route,
    *,
    wearer: Wearer | None = None,
    devices: Mapping[Site, Device] | None = None,
    radio: Radio = CLEAN,
    seed: int = 1,
) -> EmulatedWalk:
    """Walk `route` and record it. Without `devices`, both feet wear insoles of 96 cells at 100 Hz.

    Sites above the ankle wear what knows its own attitude (Dot). ValueError for a device that only feet can wear at a
    site that is none.
    """
    if devices is None:
        devices = {SITE_OF_FOOT[foot]: Insole() for foot in Foot}
    walker = Walker(route, wearer, seed)
    sites = list(Site)
    packets: list[Packet] = []
    for site in sorted(devices, key=sites.index):
        device = devices[site]
        sent = device.emit(walker, site, device_numbers(seed, site))
        packets += radio.transmit(sent, site, np.random.default_rng([seed, 3, sites.index(site)]))
    packets.sort(key=attrgetter("t"))
    mountings = {site.foot: device.mounting for site, device in devices.items() if site.foot is not None}
    return EmulatedWalk(tuple(packets), walker.truth(mountings), walker)


@frozen(eq=False)
class SampledWalk:
    """`samples` of both feet in the order of time; the rest as in EmulatedWalk."""

    samples: tuple[Sample, ...]
    truth: Truth
    walker: Walker


def sampled(
    route: Route, *, wearer: Wearer | None = None, insoles: Mapping[Site, Insole] | None = None, seed: int = 1
) -> SampledWalk:
    """The walk of `emulate` with these arguments, without wire and radio: the same values at their true times."""
    if insoles is None:
        insoles = {SITE_OF_FOOT[foot]: Insole() for foot in Foot}
    walker = Walker(route, wearer, seed)
    found = [
        one for site, insole in insoles.items() for one in insole.samples(walker, site, device_numbers(seed, site))
    ]
    found.sort(key=attrgetter("t"))
    mountings = {foot_of(site): insole.mounting for site, insole in insoles.items()}
    return SampledWalk(tuple(found), walker.truth(mountings), walker)
