"""Whole walks through true ATT: two insoles, and SensorTags at the rates that they have."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from itertools import pairwise

import pytest
from airs import bumble, collect, in_virtual_time, whole
from attrs import evolve
from walks import run_session

from solepath import Event, FootFlat, HeelOff, HeelStrike, PacketRejected, PacketsLost, SampleGap, StrideTaken, ToeOff
from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Route, emulate
from solepath.emulate.devices.bench import Bench
from solepath.emulate.sensors import sensortags
from solepath.emulate.sensors.device import Device
from solepath.lab.emulated.compare import compare
from solepath.lab.evaluate.gathered import EventCollection
from solepath.link.devices.cc2541 import PROFILE as CC2541
from solepath.link.devices.cc2541 import PROFILE_20HZ as CC2541_20HZ
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Profile
from solepath.types import Foot, Packet, Site

FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
ONE_MINUTE_ROUTE = Route().stand(3.0).walk(20.0).turn(1.5, radius=1.5).walk(40.0, speed=1.2).stop(7.0)
MEDIUM_ROUTE = Route().stand(3.0).walk(8.0).turn(1.5, radius=1.5).walk(4.0, speed=1.2).stop(3.0)
SHORT_ROUTE = Route().stand(1.5).walk(2.5).stop(1.0)
"""A walk of 4 s, for devices that send in fragments, since each fragment costs as much as a packet."""
DURATIONS = {ONE_MINUTE_ROUTE: 60.0, MEDIUM_ROUTE: 15.0, SHORT_ROUTE: 4.0}
"""Duration of each route, s."""


def receive(
    bench: Bench, configs: Sequence[DeviceConfig], seconds: float, interval: float | None = None
) -> tuple[list[Packet], float]:
    """What arrives from the beginning of the search until the walk has lasted so long; and when it began.

    `interval`: of the links, s.
    """

    async def listen() -> tuple[list[Packet], float]:
        started_at = asyncio.get_running_loop().time() + 5.0
        bench.walk_from(started_at)
        bench.prepare()
        async with bumble(bench, interval) as backend, Devices(configs, backend=backend) as devices:
            return await collect(devices, 5.0 + seconds), started_at

    return in_virtual_time(listen)


@pytest.mark.parametrize(
    ("mtu", "route"),
    [
        pytest.param(247, ONE_MINUTE_ROUTE, marks=pytest.mark.soak, id="247, a minute"),
        pytest.param(247, MEDIUM_ROUTE, id="247"),
        pytest.param(185, SHORT_ROUTE, marks=pytest.mark.soak, id="185"),  # a frame is whole, as with 247
        pytest.param(23, SHORT_ROUTE, id="23"),
    ],
)
def test_a_walk_of_two_insoles_arrives_whole_and_in_order_and_means_the_same_as_the_walk_fed_directly(
    mtu: int, route: Route
) -> None:
    """Compared are, byte for byte, the frames that arrive with those of the emulator, and the delay of each; then the
    events of what arrived with the events of the emulator's own frames, stamped with the times at which they arrived
    here. So the events show that nothing is added, missing or out of order, and nothing about the stamps: those are
    held by the delay, which is below 10 ms.
    """
    bench = Bench(route, mtu=mtu)
    duration = bench.truth().duration
    assert duration > DURATIONS[route]
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
    assert not [event for event in events if isinstance(event, PacketsLost | PacketRejected | SampleGap)]
    if mtu == 23:
        assert len(packets) > 9 * len(arrived)


TAGS: dict[str, tuple[Profile, Device]] = {
    "cc2650 at 10 Hz": (CC2650, sensortags.CC2650()),
    "cc2541 at 10 Hz": (CC2541, sensortags.CC2541()),
    "cc2541 at 20 Hz": (CC2541_20HZ, sensortags.CC2541(rate=20.0)),
}
TAG_ROUTE = Route().stand(3.0).walk(30.0).turn(1.5, radius=1.5).walk(15.0, speed=1.1).stop(3.0)


@pytest.mark.soak
def test_insoles_whose_links_wait_for_connection_events_give_the_same_steps_at_the_same_times() -> None:
    interval = 0.03
    settled = 8.0  # s of the walk until the clock knows which of the frames did not have to wait
    found: list[list[Event]] = []
    for waits in (None, interval):
        bench = Bench(TAG_ROUTE)
        packets, started_at = receive(bench, [DeviceConfig(None, profile=INSOLE)] * 2, bench.truth().duration, waits)
        frames = [packet.t for packet in packets if packet.site is FEET[0] and packet.channel == "insole/frame"]
        apart = [b - a for a, b in pairwise(frames) if b > a]
        if waits is not None:  # they came in threes, as they do from a radio
            assert min(apart) > 0.99 * interval
            assert len(frames) > 2.9 * len(apart)
        events = run_session([evolve(packet, t=packet.t - started_at) for packet in packets], poses=True)
        assert not [event for event in events if isinstance(event, PacketsLost | PacketRejected | SampleGap)]
        found.append([event for event in events if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff)])
    for foot in Foot:
        for kind in (HeelStrike, FootFlat, HeelOff, ToeOff):
            at_once, waited = (
                [event.t for event in events if isinstance(event, kind) and event.foot is foot and event.t > settled]
                for events in found
            )
            assert len(at_once) > 20
            assert waited == pytest.approx(at_once, abs=0.005)


@pytest.mark.parametrize(
    ("seeds", "interval"),
    [
        pytest.param((11,), None, id="a walk"),
        pytest.param((11, 12, 13), None, id="three walks", marks=pytest.mark.soak),
        pytest.param((11, 12, 13), 0.03, id="three walks, waiting", marks=pytest.mark.soak),
    ],
)
@pytest.mark.parametrize("tag", TAGS)
def test_sensortags_give_the_steps_of_a_walk_end_to_end(
    tag: str, seeds: tuple[int, ...], interval: float | None
) -> None:
    profile, device = TAGS[tag]
    true = found = invented = 0
    for seed in seeds:
        bench = Bench(TAG_ROUTE, devices=dict.fromkeys(FEET, device), seed=seed)
        configs = [DeviceConfig(worn.site, worn.address, profile) for worn in bench.peripherals]
        packets, started_at = receive(bench, configs, bench.truth().duration, interval)
        shifted = [evolve(packet, t=packet.t - started_at) for packet in packets]
        collection = EventCollection()
        for event in run_session(shifted, poses=True):
            collection.add(event)
        for foot in compare(bench.truth(), {foot: collection.foot(foot) for foot in Foot}):
            true += foot.strides_true
            found += foot.strides_found
            invented += foot.strides_invented
    assert 2 * found / (found + invented + true) >= 0.95, f"{found} of {true} found, {invented} invented"
