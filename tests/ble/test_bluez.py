"""bleak's unchanged backend for Linux, over D-Bus, with a BlueZ service of the tests; in real time."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Coroutine
from pathlib import Path
from time import monotonic
from typing import Any

import pytest
from airs import others, troubles
from bluez import Bluez
from bus import DAEMON, message_bus

from solepath.ble import BluetoothError, DeviceConfig, Devices, scan
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.types import Packet, Site

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="BlueZ is Linux's"),
    pytest.mark.skipif(DAEMON is None, reason="dbus-daemon is not installed"),
]
LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
THE_LEFT = DeviceConfig(None, "F0:5E:00:00:00:01")
TIME_LIMIT = 30.0
"""Time limit of a test, s."""
BUS = "DBUS_SYSTEM_BUS_ADDRESS"


def bench(faults: str = "", **devices: Device) -> Bench:
    worn = {Site(site): device for site, device in devices.items()} or {LEFT: Insole()}
    bench_ = Bench(Route().walk(20.0), devices=worn, started_at=monotonic(), faults=parse_faults(faults))
    bench_.prepare()
    return bench_


@pytest.fixture
def on_a_bus(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[[Callable[[str], Coroutine[Any, Any, Any]]], Any]:
    """Return a function that runs a coroutine with a new bus as the system bus; the coroutine gets its address."""

    def run(main: Callable[[str], Coroutine[Any, Any, Any]]) -> Any:
        async def alone() -> Any:
            async with message_bus(tmp_path) as address:
                monkeypatch.setenv(BUS, address)
                async with asyncio.timeout(2 * TIME_LIMIT):
                    return await main(address)

        return asyncio.run(alone())

    return run


async def until(devices: Devices, enough: Callable[[list[Packet]], bool]) -> list[Packet]:
    """Return the packets up to the first one that satisfies the condition."""
    received = []
    async with asyncio.timeout(TIME_LIMIT):
        async for packet in devices:
            received.append(packet)
            if enough(received):
                break
    return received


def of(packets: list[Packet], channel: str, site: Site = LEFT) -> list[bytes]:
    return [packet.data for packet in packets if packet.channel == channel and packet.site is site]


def frames(count: int) -> Callable[[list[Packet]], bool]:
    return lambda received: received[-1].channel == "insole/frame" and len(of(received, "insole/frame")) >= count


def test_a_scan_lists_advertising_devices_and_leaves_the_adapter_alone_afterwards(on_a_bus):
    async def main(address):
        async with Bluez(bench(left_foot=Insole(), right_foot=CC2650()).peripherals).serving(address) as bluez:
            return await scan(0.5), bluez.is_idle

    devices_found, idle = on_a_bus(main)
    assert [(device.address, device.name, device.profile.name, device.signal) for device in devices_found] == [
        ("F0:5E:00:00:00:01", "solepath L", "insole", -60),
        ("F0:5E:00:00:00:02", "CC2650 SensorTag", "cc2650", -60),
    ]
    assert idle


def test_every_frame_of_two_insoles_arrives_once_and_in_order(on_a_bus):
    pair = bench(left_foot=Insole(), right_foot=Insole())
    for site in (LEFT, RIGHT):
        pair[site].log = []

    async def main(address):
        async with Bluez(pair.peripherals).serving(address) as bluez:
            async with Devices([DeviceConfig(None, "solepath R"), DeviceConfig(None, "solepath L")]) as devices:
                received = await until(
                    devices, lambda received: all(len(of(received, "insole/frame", s)) > 150 for s in (LEFT, RIGHT))
                )
                tasks = others()
            remaining = others()
            return received, bluez.is_idle, len(tasks) - len(remaining)

    received, idle, ended = on_a_bus(main)
    for site in (LEFT, RIGHT):
        arrived = of(received, "insole/frame", site)
        assert arrived == [sent.value for sent in pair[site].log if sent.channel == "insole/frame"][: len(arrived)]
        # what is read comes once, although BlueZ tells of it as if it had been notified
        read_once = ["insole/info", "device/firmware", "device/battery", "insole/control", "receiver/connected"]
        assert [len(of(received, channel, site)) for channel in read_once] == [1] * len(read_once)
    assert not troubles(received)
    assert idle and ended >= 3  # the search, and two connections
    assert not any(device.is_connected for device in pair.peripherals)


@pytest.mark.soak
def test_bluetooth_that_is_switched_off_is_reported_and_waited_for(on_a_bus):
    worn = bench()

    async def main(address):
        async with Bluez(worn.peripherals).serving(address) as bluez, Devices([THE_LEFT]) as devices:
            received = await until(devices, frames(10))
            bluez.power(False)
            received += await until(devices, lambda received: bool(troubles(received)))
            bluez.power(True)
            return received, await until(devices, frames(10))

    before, after = on_a_bus(main)
    assert troubles(before) == ["cannot look for devices: Bluetooth is off: turn it on"]
    assert len(of(before, "receiver/disconnected")) == len(of(after, "receiver/connected")) == 1


@pytest.mark.soak
def test_a_bluetooth_service_that_dies_is_reported_and_its_successor_used(on_a_bus):
    worn = bench()

    async def main(address):
        devices = Devices([THE_LEFT])
        async with Bluez(worn.peripherals).serving(address):
            await devices.__aenter__()
            received = await until(devices, frames(10))
        received += await until(devices, lambda received: len(troubles(received)) == 2)
        async with Bluez(worn.peripherals).serving(address):
            after = await until(devices, frames(10))
            await devices.__aexit__(None, None, None)
        return received, after

    before, after = on_a_bus(main)
    dead = "the Bluetooth service does not run: systemctl start bluetooth"
    assert troubles(before) == [dead, f"cannot look for devices: {dead}"]
    assert len(of(after, "receiver/connected")) == 1


def test_a_write_that_is_rejected_is_reported_with_the_devices_own_code(on_a_bus):
    worn = bench("0 left_foot refuse insole/control")

    async def main(address):
        async with Bluez(worn.peripherals).serving(address), Devices([THE_LEFT]) as devices:
            return await until(devices, frames(5))

    received = on_a_bus(main)
    assert [what.partition(" (")[0] for what in troubles(received)] == [
        "insole/control was not set to 01: the device answered with the ATT error 0x80"
    ]


@pytest.mark.parametrize(
    ("bluez", "message"),
    [
        (None, "the Bluetooth service does not run: systemctl start bluetooth"),
        (Bluez([], adapter=False), "this machine has no Bluetooth adapter: plug one in"),
        (Bluez([], powered=False), "Bluetooth is off: turn it on"),
    ],
    ids=["no service", "no adapter", "off"],
)
def test_a_reason_why_bluetooth_cannot_be_used_is_reported_at_once(on_a_bus, bluez, message):
    async def main(address):
        if bluez is None:
            await scan(0.1)
        else:
            async with bluez.serving(address):
                await scan(0.1)

    with pytest.raises(BluetoothError, match=message):
        on_a_bus(main)


@pytest.mark.parametrize("address", ["unix:path=/there/is/none", "not an address"])
def test_without_a_bus_there_is_no_bluetooth_but_a_sentence(monkeypatch, address):
    monkeypatch.setenv(BUS, address)
    with pytest.raises(BluetoothError) as caught:
        asyncio.run(scan(0.1))
    assert "\n" not in str(caught.value)
