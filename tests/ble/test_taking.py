"""How an app takes packets and leaves: too slowly, at any moment, twice, and from a Bluetooth whose scans fail."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from functools import cache
from typing import Any

import pytest
from airs import collect, in_virtual_time, others
from belts import ONE, PELVIS, STRAP, address, logged_radio, strap, times
from benches import LEFT, RIGHT
from memory_radio import MemoryRadio
from virtual import now, virtually

from solepath.ble import ConnectionState, DeviceConfig, Devices
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.types import Packet
from solepath.wire.receiver import PositionFrame, build_position, parse_dropped


@cache
def taken_late(capacity: int, wait: float) -> list[Packet]:
    """Return the packets of an app that takes nothing for a while, and then all."""

    async def main() -> list[Packet]:
        bench = Bench(Route().stand(12.0), seed=3)
        configs = [DeviceConfig(peripheral.site, peripheral.address) for peripheral in bench.peripherals]
        async with Devices(configs, backend=MemoryRadio(bench.peripherals).backend, capacity=capacity) as devices:
            await asyncio.sleep(wait)
            sent.extend(sum(p.sent.values()) for p in bench.peripherals)
        return [packet async for packet in devices]

    sent: list[int] = []
    packets = in_virtual_time(main)
    for site, count in zip((LEFT, RIGHT), sent, strict=True):
        kept = [p for p in packets if p.site is site and p.channel == "insole/frame"]
        dropped = [parse_dropped(p.data) for p in packets if p.site is site and p.channel == "receiver/dropped"]
        assert len(kept) + sum(dropped) == count
    return packets


def test_what_an_app_is_too_slow_for_goes_from_the_oldest_on_and_is_counted() -> None:
    packets = taken_late(capacity=300, wait=8.0)
    frames = [packet for packet in packets if packet.channel == "insole/frame"]
    assert len(frames) in range(290, 301)
    assert min(packet.t for packet in frames) > 6.0
    for site in (LEFT, RIGHT):
        mine = [packet for packet in packets if packet.site is site]
        assert [packet.t for packet in mine] == sorted(packet.t for packet in mine)
        setup = ["receiver/connected", *INSOLE.reads, "insole/control", "receiver/dropped"]
        assert [packet.channel for packet in mine][: len(setup)] == setup


@virtually
async def test_a_reported_position_comes_in_its_turn_also_when_an_app_is_too_slow() -> None:
    position, packets = PositionFrame((1.0, 2.0), 0.5), list[Packet]()
    devices = Devices([ONE], backend=logged_radio(strap()).backend, capacity=5)
    with pytest.raises(RuntimeError, match="in use"):
        devices.report_position(position)
    async with devices:
        await asyncio.sleep(10.0)
        devices.report_position(position)
        reported_at = now()
        with pytest.raises(ValueError, match="position"):
            devices.report_position(PositionFrame((1.0, 2.0), -1.0))
        await asyncio.sleep(10.0)
    packets = [packet async for packet in devices]
    assert [packet.t for packet in packets] == sorted(packet.t for packet in packets)
    (report,) = [packet for packet in packets if packet.channel == "receiver/position"]
    assert report == Packet(reported_at, PELVIS, "receiver/position", build_position(position))


@virtually
async def test_to_leave_disconnects_and_leaves_no_task_behind() -> None:
    devices = [strap(n) for n in (1, 2)]
    configs = [
        DeviceConfig(LEFT, address(1), STRAP),
        DeviceConfig(RIGHT, address(2), STRAP),
        DeviceConfig(PELVIS, "absent", STRAP),
    ]
    async with Devices(configs, backend=MemoryRadio(devices).backend) as open_devices:
        await collect(open_devices, 3.0)
        assert all(device.is_connected for device in devices)
    assert not any(device.is_connected for device in devices)
    assert not others()
    rest = [packet async for packet in open_devices]
    assert [packet async for packet in open_devices] == []
    await asyncio.sleep(0.0)
    assert {one.state for one in open_devices.connections} == {ConnectionState.SEEKING}
    assert {packet.site for packet in rest if packet.channel == "receiver/disconnected"} == {LEFT, RIGHT}


@pytest.mark.parametrize("moment", [0.001, 0.02, 0.05, 0.08, 0.12, 0.5])
@virtually
async def test_to_leave_at_any_moment_leaves_nothing_behind(moment: float) -> None:
    device = strap()
    open_devices = logged_radio(device)
    async with Devices([ONE], backend=open_devices.backend):
        await asyncio.sleep(moment)
    assert not others() and not device.is_connected and open_devices.scanning == 0


@virtually
async def test_devices_that_were_left_can_be_entered_again_but_not_twice_at_once() -> None:
    devices = Devices([ONE], backend=MemoryRadio([strap()]).backend)
    for _ in range(2):
        async with devices:
            packets = await collect(devices, 2.0)
            with pytest.raises(RuntimeError, match="in use"):
                await devices.__aenter__()
        assert times(packets, "strap/beat")
    assert not others()


@virtually
async def test_who_gives_up_waiting_loses_no_packet() -> None:
    found = []
    async with Devices([ONE], backend=logged_radio(strap()).backend) as devices:
        while now() < 10.0:
            with suppress(TimeoutError):
                async with asyncio.timeout(0.013):
                    found.append(await anext(devices))
    beats = [p for p in found if p.channel == "strap/beat"]
    numbers = [int.from_bytes(packet.data[:4], "little") for packet in beats]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers))) and len(numbers) > 90


@virtually
async def test_a_fault_of_the_program_itself_is_raised_to_whoever_takes_packets() -> None:
    class Faulty(DeviceConfig):
        def matches(self, *given: Any) -> bool:
            return True

        def is_address(self, address: str) -> bool:
            raise ZeroDivisionError("a fault")

    async with Devices([Faulty(LEFT, address(2), STRAP)], backend=logged_radio(strap(2)).backend) as devices:
        with pytest.raises(ZeroDivisionError, match="a fault"):
            await collect(devices, 5.0)
        with pytest.raises(ZeroDivisionError, match="a fault"):
            await anext(devices)
    assert not others()
