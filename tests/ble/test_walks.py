"""A whole walk of two insoles through true ATT."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

import pytest
from airs import bumble, collect, in_virtual_time, whole
from attrs import evolve
from soak import longer
from walks import run_session

from solepath import PacketRejected, SampleGap, StrideTaken
from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Route, emulate
from solepath.emulate.devices.bench import Bench
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.types import Foot, Packet, Site

FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
INSOLE_ROUTES = {
    247: Route().stand(1.5).walk(6.0).stop(1.0),
    23: Route().stand(1.5).walk(2.5).stop(1.0),  # in fragments, each of which costs as much as a packet
}
"""Route of the insoles for each MTU, bytes."""


def receive(bench: Bench, configs: Sequence[DeviceConfig], seconds: float) -> tuple[list[Packet], float]:
    """What arrives from the beginning of the search until the walk has lasted so long; and when it began."""

    async def listen() -> tuple[list[Packet], float]:
        started_at = asyncio.get_running_loop().time() + 5.0
        bench.walk_from(started_at)
        bench.prepare()
        async with bumble(bench) as backend, Devices(configs, backend=backend) as devices:
            return await collect(devices, 5.0 + seconds), started_at

    return in_virtual_time(listen)


@pytest.mark.parametrize("mtu", [247, *longer(23)])
def test_a_walk_of_two_insoles_arrives_whole_and_in_order_and_means_the_same_as_the_walk_fed_directly(mtu: int) -> None:
    """Compared are, byte for byte, the frames that arrive with those of the emulator, and the delay of each; then the
    events of what arrived with the events of the emulator's own frames, stamped with the times at which they arrived
    here. So the events show that nothing is added, missing or out of order, and nothing about the stamps: those are
    held by the delay, which is below 10 ms.
    """
    route = INSOLE_ROUTES[mtu]
    bench = Bench(route, mtu=mtu)
    duration = bench.truth().duration
    packets, started_at = receive(bench, [DeviceConfig(None, profile=INSOLE)] * 2, duration)
    arrived = whole(packets)

    # the walk's own frames, as they leave the device without any link
    walk = [packet for packet in emulate(route).packets if packet.channel == "insole/frame"]
    direct = {site: [packet for packet in walk if packet.site is site] for site in FEET}
    fed = []
    for site in FEET:
        frames = [packet for packet in arrived if packet.site is site and packet.channel == "insole/frame"]
        first = next(k for k, packet in enumerate(frames) if packet.data == direct[site][0].data)
        walked = frames[first : first + len(direct[site])]
        assert len(walked) > 95.0 * duration
        assert [packet.data for packet in walked] == [packet.data for packet in direct[site]]
        # none waited for anything: they were with the radio when they were heard
        assert max(abs(a.t - started_at - b.t) for a, b in zip(walked, direct[site], strict=True)) < 0.01
        stamped = [evolve(b, t=a.t, device=a.device) for a, b in zip(walked, direct[site], strict=True)]
        fed += stamped
        known = {id(packet) for packet in walked}
        fed += [packet for packet in arrived if packet.site is site and id(packet) not in known]
    fed.sort(key=lambda packet: packet.t)

    events = run_session(packets, poses=True)
    assert events == run_session(fed, poses=True)
    assert {event.foot for event in events if isinstance(event, StrideTaken)} == set(Foot)
    assert not [event for event in events if isinstance(event, SampleGap | PacketRejected | SampleGap)]
    if mtu == 23:
        assert len(packets) > 9 * len(arrived)
