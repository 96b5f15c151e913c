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
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.link.devices import cc2650, insole
from solepath.types import Site

FRAME, INFO, CONTROL = (insole.PROFILE.channel(f"insole/{n}").characteristic for n in ("frame", "info", "control"))
CONFIG, PERIOD, MOVEMENT = (
    cc2650.PROFILE.channel(n).characteristic
    for n in ("cc2650/movement-config", "cc2650/movement-period", "cc2650/movement")
)
NAME = "CC2650 SensorTag"


def virtually(main: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Run in virtual time: sleeping takes none."""
    with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
        runner.run(main())


def now() -> float:
    return asyncio.get_running_loop().time()


def air(devices: dict[Site, Device], faults: str = "", **more: Any) -> MemoryRadio:
    bench = Bench(ROUTE, devices=devices, seed=3, faults=parse_faults(faults))
    return MemoryRadio(bench.peripherals, **more)


async def client(reach: MemoryRadio, name: str, gone: Callable[[BleakClient], None] | None = None) -> BleakClient:
    """A client of the device of this name, not connected yet."""
    device = await BleakScanner.find_device_by_name(name, timeout=5.0, backend=reach.backend.scanner)
    assert device is not None
    return BleakClient(device, gone, backend=reach.backend.client)


def test_a_scan_finds_what_advertises_with_name_services_and_address() -> None:
    async def main() -> None:
        reach = air({LEFT: Insole(), RIGHT: CC2541()})
        found = await BleakScanner.discover(1.0, return_adv=True, backend=reach.backend.scanner)
        names = {device.name: (address, said.service_uuids) for address, (device, said) in found.items()}
        assert names == {
            "solepath L": ("F0:5E:00:00:00:01", list(insole.PROFILE.services)),
            "SensorTag": ("F0:5E:00:00:00:02", []),
        }
        assert now() == pytest.approx(1.0, abs=0.1)
        only = await BleakScanner.discover(
            1.0, service_uuids=list(insole.PROFILE.services), backend=reach.backend.scanner
        )
        assert [device.name for device in only] == ["solepath L"]

    virtually(main)


def test_two_devices_of_one_name_are_told_apart_by_address() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650(), RIGHT: CC2650()})
        found = await BleakScanner.discover(1.0, backend=reach.backend.scanner)
        assert [device.name for device in found] == [NAME, NAME]
        async with (
            BleakClient(found[0], backend=reach.backend.client) as one,
            BleakClient(found[1], backend=reach.backend.client) as other,
        ):
            await one.write_gatt_char(PERIOD, b"\x14", response=True)
            assert await one.read_gatt_char(PERIOD) == b"\x14"
            assert await other.read_gatt_char(PERIOD) == b"\x64"
            assert await BleakScanner.discover(1.0, backend=reach.backend.scanner) == []

    virtually(main)


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


def test_an_insole_fragments_for_a_small_mtu() -> None:
    async def main() -> None:
        reach = air({LEFT: Insole()}, "0 left_foot mtu 65")
        heard: list[int] = []
        async with await client(reach, "solepath L") as insole:
            assert insole.mtu_size == 65
            await insole.start_notify(FRAME, lambda _, data: heard.append(len(data)))
            await insole.write_gatt_char(CONTROL, b"\x01", response=True)
            await asyncio.sleep(1.0)
        assert max(heard) == 62
        assert len(heard) == pytest.approx(300, abs=9)

    virtually(main)


def test_a_lost_link_is_told_once_and_the_device_can_be_had_again() -> None:
    async def main() -> None:
        reach = air({LEFT: Insole(cells=24)}, "3 left_foot disconnect")
        lost: list[float] = []
        heard: list[float] = []
        insole = await client(reach, "solepath L", lambda _: lost.append(now()))
        for _ in range(2):
            await insole.connect()
            await insole.start_notify(FRAME, lambda *_: heard.append(now()))
            await insole.write_gatt_char(CONTROL, b"\x01", response=True)
            await asyncio.sleep(4.0)
        assert lost == [pytest.approx(3.0)]
        assert insole.is_connected
        assert len(heard) == pytest.approx(700, abs=20)
        await insole.disconnect()
        assert len(lost) == 2
        await insole.disconnect()
        assert len(lost) == 2
        silent = len(heard)
        await asyncio.sleep(2.0)
        assert len(heard) == silent
        with pytest.raises(BleakError):
            await insole.read_gatt_char(INFO)

    virtually(main)


def test_a_pending_request_ends_when_the_link_does() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()}, "1 left_foot hang")
        tag = await client(reach, NAME)
        await tag.connect()
        await asyncio.sleep(2.0)
        asked = now()
        results = await asyncio.gather(
            tag.read_gatt_char(PERIOD), tag.write_gatt_char(CONFIG, b"\x7f\x02", response=True), return_exceptions=True
        )
        assert [type(result) for result in results] == [BleakError, BleakError]
        assert now() - asked == pytest.approx(1.0, abs=0.1)
        assert not tag.is_connected

    virtually(main)


def test_what_vanished_cannot_be_connected_until_it_is_back() -> None:
    async def main() -> None:
        reach = air({LEFT: CC2650()}, "2 left_foot vanish 30")
        tag = await client(reach, NAME)
        await tag.connect()
        await asyncio.sleep(3.0)
        assert not tag.is_connected
        assert await BleakScanner.find_device_by_name(NAME, timeout=5.0, backend=reach.backend.scanner) is None
        again = BleakClient(tag.address, timeout=10.0, backend=reach.backend.client)
        with pytest.raises(BleakDeviceNotFoundError):
            await again.connect()
        assert now() < 25.0
        found = await BleakScanner.find_device_by_name(NAME, timeout=60.0, backend=reach.backend.scanner)
        assert found is not None
        assert now() == pytest.approx(32.0, abs=0.2)
        await again.connect()
        assert again.is_connected
        assert again.name == NAME

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
