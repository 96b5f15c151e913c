"""Packets that an app receives from devices, the ways to take them, and the state after leaving."""

from __future__ import annotations

from typing import Any

import pytest
from airs import received, troubles
from attrs import evolve
from belts import ONE, PELVIS, RATE, READ_AFTER, STRAP, LoggedRadio, address, logged_radio, strap, times
from benches import LEFT, RIGHT, ROUTE
from strap import BATTERY

from solepath import BatteryLevel, LayoutKnown, PacketRejected, Session
from solepath.ble import DeviceConfig
from solepath.emulate.devices.bench import Bench
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650 as Tag
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Access, Write
from solepath.types import Packet


def got(belt: LoggedRadio, *configs: DeviceConfig, seconds: float = 5.0, **more: Any) -> list[Packet]:
    return received(belt.backend, *configs, seconds=seconds, **more)


def channels(packets: list[Packet], *, but: str = "receiver/tick") -> list[str]:
    return [packet.channel for packet in packets if packet.channel != but]


def test_a_device_is_read_then_subscribed_then_written() -> None:
    bench = Bench(ROUTE, devices={LEFT: Insole(), RIGHT: Tag()}, seed=3)
    belt = logged_radio(*bench.peripherals)
    got(belt, DeviceConfig(LEFT, "F0:5E:00:00:00:01"), DeviceConfig(RIGHT, "F0:5E:00:00:00:02"))
    for device, profile in ((bench[LEFT], INSOLE), (bench[RIGHT], CC2650)):
        did = belt.of(device, "read", "subscribe", "write")
        notify = {channel.name for channel in profile.channels if channel.access is Access.NOTIFY}
        assert {channel for what, channel in did if what == "subscribe"} == notify
        assert [what for what, _ in did] == sorted((what for what, _ in did), key=["read", "subscribe", "write"].index)
        assert [channel for what, channel in did if what == "write"] == [write.channel for write in profile.setup]
        assert [channel for what, channel in did if what == "read"] == list(profile.reads)  # each of them once


@pytest.mark.parametrize("faults", ["", "2 * disconnect", "2 * freeze", "2 * refuse strap/control; 2 * disconnect"])
def test_nothing_is_ever_read_that_is_subscribed(faults: str) -> None:
    device = strap(faults=faults)
    belt = logged_radio(device)
    got(belt, DeviceConfig(PELVIS, address(1), READ_AFTER), seconds=12.0)
    subscribed: set[str] = set()
    for what, channel in belt.of(device, "connect", "read", "subscribe"):
        if what == "connect":
            subscribed.clear()
        elif what == "subscribe":
            subscribed.add(channel)
        else:
            assert channel not in subscribed


def test_what_was_read_and_written_comes_as_packets_before_the_stream() -> None:
    bench = Bench(ROUTE, devices={LEFT: Insole()}, seed=3)
    packets = got(logged_radio(*bench.peripherals), DeviceConfig(LEFT, "F0:5E:00:00:00:01"))
    expected = ["receiver/connected", *INSOLE.reads, "insole/control", "insole/frame"]
    assert channels(packets)[: len(expected)] == expected
    assert next(p.data for p in packets if p.channel == "insole/info") == bench[LEFT].value("insole/info", 0.0)
    assert next(p.data for p in packets if p.channel == "insole/control") == INSOLE.setup[0].value
    events = Session().feed(packets)
    assert [type(e) for e in events if isinstance(e, LayoutKnown | BatteryLevel)] == [LayoutKnown, BatteryLevel]
    assert not [event for event in events if isinstance(event, PacketRejected)]


def test_a_missing_setting_is_reported_and_skipped() -> None:
    device = strap()
    more = evolve(STRAP.channel("strap/control"), name="strap/nothing", characteristic=BATTERY)
    setup = (Write("strap/nothing", b"\x01"), *STRAP.setup)
    profile = evolve(READ_AFTER, channels=(*READ_AFTER.channels, more), setup=setup)
    packets = got(logged_radio(device), DeviceConfig(PELVIS, address(1), profile))
    assert troubles(packets) == ["strap/nothing is not there to be set: the device keeps to its own"]
    assert len(times(packets, "strap/beat")) > 4 * RATE


def test_every_packet_has_its_arrival_time_and_device() -> None:
    device = strap()
    device.log = []
    packets = got(logged_radio(device), ONE)
    beats = [packet for packet in packets if packet.channel == "strap/beat"]
    assert [packet.data for packet in beats] == [one.value for one in device.log[: len(beats)]]
    for packet in beats:
        assert packet.t == pytest.approx(int.from_bytes(packet.data[:4], "little") / RATE, abs=1e-3)
    assert {(p.site, p.device) for p in packets if p.channel != "receiver/tick"} == {(PELVIS, address(1))}
    assert [packet.t for packet in packets] == sorted(packet.t for packet in packets)


def test_without_packets_five_ticks_a_second_are_emitted() -> None:
    packets = got(logged_radio(), ONE, seconds=5.0, patience=100.0)
    assert set(channels(packets, but="")) == {"receiver/tick"}
    assert len(packets) in (24, 25)
    steps = [b.t - a.t for a, b in zip(packets, packets[1:], strict=False)]
    assert max(steps) <= 0.2501
    assert not Session().feed(packets)
