"""Devices that require pairing: the messages to an app, and the encryption of a link."""

from __future__ import annotations

import asyncio

import pytest
from airs import TIERS, collect, in_virtual_time, troubles
from soak import soaked

from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.sensors import sensortags
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.link.devices.cc2541 import PROFILE as CC2541
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Profile
from solepath.types import Packet, Site

LEFT = Site.LEFT_FOOT
ROUTE = Route().stand(2.0).walk(6.0).stop(2.0)
KINDS: dict[str, tuple[Profile, Device]] = {
    "insole": (INSOLE, Insole()),
    "cc2650": (CC2650, sensortags.CC2650()),
    "cc2541": (CC2541, sensortags.CC2541()),
}


both = pytest.mark.parametrize("tier", ["memory", *soaked("bumble")])


def bench(faults: str, device: Device | None = None) -> Bench:
    worn = Bench(ROUTE, devices={LEFT: device or Insole()}, faults=parse_faults(faults))
    worn.prepare()
    return worn


def receive(tier: str, faults: str, pair: bool, seconds: float, kind: str = "insole") -> list[Packet]:
    profile, device = KINDS[kind]

    async def listen() -> list[Packet]:
        worn = bench(faults, device)
        worn.walk_from(asyncio.get_running_loop().time())
        configs = [DeviceConfig(LEFT, worn[LEFT].address, profile)]
        async with TIERS[tier](worn) as backend, Devices(configs, backend=backend, pair=pair) as devices:
            return await collect(devices, seconds)

    return in_virtual_time(listen)


def streamed(packets: list[Packet], profile: Profile) -> list[float]:
    return [packet.t for packet in packets if packet.channel in profile.streams]


@pytest.mark.parametrize("kind", KINDS)
def test_without_pairing_only_the_need_to_pair_is_reported(kind: str) -> None:
    packets = receive("memory", "0 * pairing", False, 20.0, kind)
    assert streamed(packets, KINDS[kind][0]) == []
    first = {"insole": "insole/info cannot be read", "cc2650": "cc2650/movement cannot be subscribed"}
    [trouble] = set(troubles(packets))
    assert trouble.startswith(first.get(kind, "cc2541/accelerometer cannot be subscribed"))
    assert trouble.endswith("the device must be paired first: pair=True, or --pair")


@both
@pytest.mark.parametrize("kind", KINDS)
def test_a_paired_device_streams_also_after_a_reconnect_without_pairing_again(tier: str, kind: str) -> None:
    # an attempt to pair on the second link would be refused, and told
    packets = receive(tier, "0 * pairing; 5 * refuse pairing; 6 * disconnect", True, 10.0, kind)
    assert troubles(packets) == []
    connected = [packet.t for packet in packets if packet.channel == "receiver/connected"]
    assert len(connected) == 2
    times = streamed(packets, KINDS[kind][0])
    first, second = (sum(t_connected < t < t_connected + 3.0 for t in times) for t_connected in connected)
    assert first > 25
    assert second == pytest.approx(first, rel=0.1)


def test_a_device_that_needs_pairing_from_some_time_on_falls_silent_and_the_remedy_is_reported() -> None:
    packets = receive("memory", "4 * pairing", False, 12.0)
    assert 3.9 < max(streamed(packets, INSOLE)) < 4.1
    assert any("the device must be paired first" in what for what in troubles(packets))


def test_a_rejected_pairing_is_a_connection_that_fails_and_the_next_attempt_is_another() -> None:
    packets = receive(
        "memory", "0 * pairing; 0 * refuse pairing 2", True, 5.0
    )  # two, since each search is good for two
    (trouble,) = troubles(packets)
    assert "the device rejected the pairing" in trouble
    assert len(streamed(packets, INSOLE)) > 300
