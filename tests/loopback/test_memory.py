"""Emulated devices behind plain bleak, in memory and in virtual time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from math import ceil
from typing import Any

import looptime
import pytest
from benches import LEFT, RIGHT, ROUTE, walker
from bleak import BleakClient, BleakScanner
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.exc import BleakCharacteristicNotFoundError, BleakDeviceNotFoundError, BleakError, BleakGATTProtocolError

from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.devices.memory import MemoryRadio
from solepath.emulate.devices.peripheral import Characteristic, Peripheral, Service
from solepath.emulate.devices.standard import standard
from solepath.emulate.sensors.device import Device, device_numbers
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.link import profile
from solepath.types import Site

FRAME, INFO, CONTROL = (profile.INSOLE.channel(f"insole/{n}").characteristic for n in ("frame", "info", "control"))
CONFIG, PERIOD, MOVEMENT = (
    profile.CC2650.channel(n).characteristic
    for n in ("cc2650/movement-config", "cc2650/movement-period", "cc2650/movement")
)
NAME = "CC2650 SensorTag"


def virtually(main: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Run in virtual time: sleeping takes none."""
    with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
        runner.run(main())


def air(devices: dict[Site, Device], faults: str = "", **more: Any) -> MemoryRadio:
    bench = Bench(ROUTE, devices=devices, seed=3, faults=parse_faults(faults))
    return MemoryRadio(bench.peripherals, **more)


async def client(reach: MemoryRadio, name: str, gone: Callable[[BleakClient], None] | None = None) -> BleakClient:
    """A client of the device of this name, not connected yet."""
    device = await BleakScanner.find_device_by_name(name, timeout=5.0, backend=reach.backend.scanner)
    assert device is not None
    return BleakClient(device, gone, backend=reach.backend.client)


def test_a_walk_comes_through_as_the_emulator_emits_it() -> None:
    async def main() -> None:
        reach = air({RIGHT: Insole()})
        heard: list[bytes] = []
        async with await client(reach, "solepath R") as insole:
            assert insole.mtu_size == 247
            await insole.start_notify(FRAME, lambda _, data: heard.append(bytes(data)))
            info = bytes(await insole.read_gatt_char(INFO))
            await insole.write_gatt_char(CONTROL, b"\x01", response=True)
            await asyncio.sleep(walker().duration)
        emitted = Insole().emit(walker(), RIGHT, device_numbers(3, RIGHT))
        assert info in [n.data for n in emitted if n.channel == "insole/info"]
        frames = [n.data for n in emitted if n.channel == "insole/frame"]
        first = frames.index(heard[0])
        assert first < 20
        assert heard[: len(frames) - first] == frames[first:]

    virtually(main)


def test_services_are_discovered_with_properties_and_subscription_descriptors() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()})
        async with await client(reach, NAME) as tag:
            movement = tag.services.get_characteristic(MOVEMENT)
            assert movement is not None
            assert set(movement.properties) == {"read", "notify"}
            assert movement.max_write_without_response_size == 20
            (subscription,) = movement.descriptors
            assert await tag.read_gatt_descriptor(subscription) == b"\x00\x00"
            await tag.start_notify(movement, _ignore)
            assert await tag.read_gatt_descriptor(subscription) == b"\x01\x00"
            with pytest.raises(BleakError, match="already"):
                await tag.start_notify(movement, _ignore)
            with pytest.raises(BleakCharacteristicNotFoundError):
                await tag.read_gatt_char("1234")
            await tag.stop_notify(movement)
            assert await tag.read_gatt_descriptor(subscription) == b"\x00\x00"

    virtually(main)


def _ignore(characteristic: BleakGATTCharacteristic, data: bytearray) -> None:
    """Nobody listens."""


def test_only_the_services_that_are_asked_for_are_there() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()})
        device = await BleakScanner.find_device_by_name(NAME, backend=reach.backend.scanner)
        assert device is not None
        async with BleakClient(device, services=["180f"], backend=reach.backend.client) as tag:
            assert [service.uuid[4:8] for service in tag.services] == ["180f"]

    virtually(main)


def test_an_att_error_is_bleaks_protocol_error_with_its_code() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()}, "0 left_foot refuse cc2650/movement-period")
        async with await client(reach, NAME) as tag:
            for value, code in ((b"\x14", 0x80), (b"\x14\x00", 0x0D)):
                with pytest.raises(BleakGATTProtocolError) as caught:
                    await tag.write_gatt_char(PERIOD, value, response=True)
                assert caught.value.code == code
            await tag.write_gatt_char(PERIOD, b"\x14\x00", response=False)
            await tag.write_gatt_char(PERIOD, b"\x14", response=False)
            assert await tag.read_gatt_char(PERIOD) == b"\x14"
            with pytest.raises(BleakGATTProtocolError) as caught:
                await tag.write_gatt_char(MOVEMENT, b"\x14", response=True)
            assert caught.value.code == 0x03

    virtually(main)


class EverySecond:
    """40 bytes in every second of the walk."""

    def after(self, t: float) -> int:
        return ceil(t)

    def due(self, number: int) -> float:
        return float(number)

    def values(self, number: int, mtu: int) -> list[bytes]:
        return [bytes(range(40))]


class Talker(Peripheral):
    """A device that takes no heed of the MTU."""

    def __init__(self) -> None:
        said = Characteristic(standard(0x2A58), "talker/said", frozenset({"notify"}))
        service = Service(standard(0x1815), (said,))
        super().__init__(
            site=LEFT, address="F0:00:00:00:00:01", name="talker", services=[service], advertised=[service.uuid]
        )

    def begin(self) -> None:
        self.flow("talker/said", EverySecond(), self.walk_time)


def test_a_notification_longer_than_the_mtu_is_cut_without_a_word() -> None:
    async def main() -> None:
        heard: list[bytes] = []
        for mtu in (247, 43, 42, 23):
            reach = MemoryRadio([Talker()], mtu=mtu)
            async with await client(reach, "talker") as talker:
                assert talker.mtu_size == mtu
                await talker.start_notify("2a58", lambda _, data: heard.append(bytes(data)))
                await asyncio.sleep(1.0)
        assert heard == [bytes(range(n)) for n in (40, 40, 39, 20)]

    virtually(main)


def test_a_device_serves_one_host_at_a_time() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()})
        first, second = await client(reach, NAME), await client(reach, NAME)
        await first.connect()
        with pytest.raises(BleakDeviceNotFoundError):
            await BleakClient(first.address, timeout=3.0, backend=reach.backend.client).connect()
        await first.disconnect()
        await second.connect()
        assert second.is_connected

    virtually(main)


def test_a_callback_that_fails_stops_nothing() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()})
        failures: list[dict[str, Any]] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, context: failures.append(context))
        calls = 0

        def careless(characteristic: BleakGATTCharacteristic, data: bytearray) -> None:
            nonlocal calls
            calls += 1
            raise RuntimeError("careless")

        async with await client(reach, NAME) as tag:
            await tag.start_notify(MOVEMENT, careless)
            await tag.write_gatt_char(CONFIG, b"\x7f\x02", response=True)
            await asyncio.sleep(5.5)
        assert calls == len(failures) >= 5

    virtually(main)
