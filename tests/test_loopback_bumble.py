"""Devices on the virtual air, reached by plain bleak: advertising, links, attributes, notifications, and their ends."""

from __future__ import annotations

import asyncio
import gc
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import looptime
import pytest
from bleak import BleakClient, BleakScanner
from bleak.backends.device import BLEDevice
from bleak.exc import BleakDeviceNotFoundError, BleakError, BleakGATTProtocolError
from bleak_retry_connector import establish_connection
from bumble.device import Connection

from solepath.ble.backend import Backend
from solepath.loopback.faults import parse_faults
from solepath.loopback.gatt import advertisement
from solepath.loopback.server import virtual_air
from strap import BATTERY, BEAT, BOOK, CONTROL, HEART_RATE, LEVEL, LOG, PAGE, Strap, standard

ONE, TWO = "F0:00:00:00:00:01", "F0:00:00:00:00:02"


def run(main: Callable[[], Awaitable[None]]) -> None:
    """In virtual time; nothing may be left running when it is over."""

    async def whole() -> None:
        await main()
        for _ in range(3):
            await asyncio.sleep(0)
        assert asyncio.all_tasks() == {asyncio.current_task()}

    troubles: list[dict[str, Any]] = []
    with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
        runner.get_loop().set_exception_handler(lambda loop, context: troubles.append(context))
        runner.run(whole())
    assert not troubles


def now() -> float:
    return asyncio.get_running_loop().time()


def strap(name: str = "one", address: str = ONE, faults: str = "", **given: object) -> Strap:
    return Strap(name, address, faults=parse_faults(faults), **given)


async def find(backend: Backend, name: str = "one") -> BLEDevice:
    found = await BleakScanner.find_device_by_name(name, 5.0, backend=backend.scanner)
    assert found is not None
    return found


class Host:
    """A client that remembers when it lost its link and what it was notified of."""

    def __init__(self, backend: Backend, device: BLEDevice | str) -> None:
        self.lost: list[float] = []
        self.heard: list[tuple[float, bytes]] = []
        self.client = BleakClient(device, self._gone, backend=backend.client)

    def _gone(self, client: BleakClient) -> None:
        self.lost.append(now())

    async def count(self, rate: int) -> None:
        await self.client.start_notify(BEAT, lambda _, value: self.heard.append((now(), bytes(value))))
        await self.client.write_gatt_char(CONTROL, bytes([rate]), response=True)

    @property
    def numbers(self) -> list[int]:
        return [int.from_bytes(value[:4], "little") for _, value in self.heard]


@asynccontextmanager
async def linked(device: Strap, mtu: int = 247) -> AsyncIterator[tuple[Host, Backend]]:
    async with virtual_air([device], mtu) as backend:
        host = Host(backend, await find(backend))
        async with host.client:
            yield host, backend


def test_a_scan_hears_names_services_and_addresses_of_all_who_advertise() -> None:
    async def main() -> None:
        async with virtual_air([strap(), strap("two", TWO, advertised=[HEART_RATE, LOG])]) as backend:
            heard = await BleakScanner.discover(1.0, return_adv=True, backend=backend.scanner)
            assert {address: said.local_name for address, (_, said) in heard.items()} == {ONE: "one", TWO: "two"}
            assert heard[ONE][1].service_uuids == [HEART_RATE]
            assert set(heard[TWO][1].service_uuids) == {HEART_RATE, LOG}
            only = await BleakScanner.discover(1.0, service_uuids=[LOG], backend=backend.scanner)
            assert [device.address for device in only] == [TWO]

    run(main)


def test_a_device_that_changes_its_name_is_heard_by_the_new_one() -> None:
    async def main() -> None:
        async with virtual_air([strap(faults='3 * name "another"')]) as backend:
            await find(backend, "one")
            await asyncio.sleep(3.0)
            assert (await find(backend, "another")).address == ONE

    run(main)


@pytest.mark.parametrize("services", [[], [standard(0xAA80), standard(0xFFE0)], [LOG], [LOG, standard(0x180F)]])
def test_an_advertisement_is_legal_with_and_without_room_for_flags(services: list[str]) -> None:
    flags = b"\x02\x01\x06"
    for size in range(1, 30):
        said = advertisement("n" * size, services)
        bare = said.removeprefix(flags)
        assert bare.endswith(bytes([size + 1, 0x09]) + b"n" * size)
        assert (bare != said) == (len(flags + bare) <= 31), "flags wherever there is room"


def test_discovery_shows_the_services_characteristics_and_descriptors_of_the_device() -> None:
    async def main() -> None:
        async with linked(strap()) as (host, _):
            services = {service.uuid: service for service in host.client.services}
            assert {HEART_RATE, BATTERY, LOG} <= services.keys()
            beat, control = services[HEART_RATE].characteristics
            assert (beat.uuid, beat.properties) == (BEAT, ["notify"])
            assert (control.uuid, set(control.properties)) == (CONTROL, {"read", "write", "write-without-response"})
            assert [each.uuid for each in beat.descriptors] == [standard(0x2901), standard(0x2902)]
            assert [each.uuid for each in control.descriptors] == [standard(0x2901)]
            assert await host.client.read_gatt_descriptor(beat.descriptors[0]) == b"strap/beat"
            assert await host.client.read_gatt_descriptor(beat.descriptors[1]) == b"\x00\x00"
            assert await host.client.read_gatt_char(LEVEL) == b"\x57"
            assert await host.client.read_gatt_char(PAGE) == BOOK
            assert host.client.name == "one"

    run(main)


def test_half_a_minute_at_100_hz_arrives_whole_in_order_and_in_time() -> None:
    async def main() -> None:
        async with linked(strap()) as (host, _):
            begun = now()
            await host.count(100)
            await asyncio.sleep(30.0)
            assert len(host.heard) in (3000, 3001)
            assert host.numbers == list(range(host.numbers[0], host.numbers[0] + len(host.heard)))
            assert host.heard[0][0] - begun < 0.02
            for (t, _), number in zip(host.heard, host.numbers, strict=True):
                assert t == pytest.approx(number / 100, abs=1e-3)

    run(main)


@pytest.mark.parametrize(("of_device", "of_host", "agreed"), [(247, 185, 185), (185, 247, 185), (23, 247, 23)])
def test_the_smaller_mtu_holds_and_a_longer_notification_is_cut_without_a_word(
    of_device: int, of_host: int, agreed: int
) -> None:
    async def main() -> None:
        device = strap(mtu=of_device)
        device.size = 240
        async with linked(device, of_host) as (host, _):
            assert host.client.mtu_size == agreed
            assert await host.client.read_gatt_char(PAGE) == BOOK
            await host.count(50)
            await asyncio.sleep(1.0)
            assert len(host.heard) >= 50
            assert {len(value) for _, value in host.heard} == {agreed - 3}

    run(main)


def test_the_device_obeys_writes_with_and_without_response() -> None:
    async def main() -> None:
        device = strap()
        async with linked(device) as (host, _):
            await host.count(10)
            assert await host.client.read_gatt_char(CONTROL) == b"\x0a"
            await asyncio.sleep(10.0)
            assert len(host.heard) in (100, 101)
            await host.client.write_gatt_char(CONTROL, b"\x00", response=False)
            await asyncio.sleep(10.0)
            assert len(host.heard) in (100, 101)
            assert device.rate == 0
            with pytest.raises(BleakError, match="do not fit"):
                await host.client.write_gatt_char(CONTROL, bytes(245), response=False)

    run(main)


def test_notifications_stop_when_they_are_no_longer_wanted() -> None:
    async def main() -> None:
        async with linked(strap()) as (host, _):
            await host.count(10)
            with pytest.raises(BleakError):
                await host.count(10)
            with pytest.raises(BleakError):
                await host.client.start_notify(LEVEL, lambda *_: None)
            await asyncio.sleep(2.0)
            await host.client.stop_notify(BEAT)
            heard = len(host.heard)
            await asyncio.sleep(2.0)
            assert len(host.heard) == heard >= 20
            await host.client.start_notify(BEAT, lambda _, value: host.heard.append((now(), bytes(value))))
            await asyncio.sleep(2.0)
            assert len(host.heard) >= heard + 20

    run(main)


def test_a_refusal_is_an_att_error_and_the_link_goes_on() -> None:
    async def main() -> None:
        async with linked(strap(faults="0 * refuse strap/control 2")) as (host, _):
            codes = []
            requests: list[Callable[[], Awaitable[object]]] = [
                lambda: host.client.write_gatt_char(CONTROL, b"\x01", response=True),
                lambda: host.client.read_gatt_char(CONTROL),
                lambda: host.client.write_gatt_char(CONTROL, b"\x01\x02", response=True),
                lambda: host.client.write_gatt_char(LEVEL, b"\x01", response=True),
                lambda: host.client.read_gatt_char(BEAT),
            ]
            for request in requests:
                with pytest.raises(BleakGATTProtocolError) as refused:
                    await request()
                codes.append(int(refused.value.code))
            assert codes == [0x80, 0x80, 0x0D, 0x03, 0x02]
            assert await host.client.read_gatt_char(LEVEL) == b"\x57"
            assert not host.lost

    run(main)


def test_a_request_that_is_never_answered_ends_with_the_link() -> None:
    async def main() -> None:
        async with linked(strap(faults="0 * hang")) as (host, _):
            asked = now()
            with pytest.raises(BleakError, match="link was lost"):
                await host.client.read_gatt_char(LEVEL)
            assert now() - asked == pytest.approx(1.0, abs=0.1)
            await asyncio.sleep(0.1)
            assert len(host.lost) == 1
            assert not host.client.is_connected
            with pytest.raises(BleakError):
                await host.client.read_gatt_char(LEVEL)

    run(main)


def test_a_request_that_its_caller_gives_up_does_not_have_its_answer_taken_for_the_next() -> None:
    async def main() -> None:
        async with linked(strap()) as (host, _):
            given_up = asyncio.create_task(host.client.read_gatt_char(PAGE))
            await asyncio.sleep(0)
            await asyncio.sleep(0)
            given_up.cancel()
            assert await host.client.read_gatt_char(LEVEL) == b"\x57"
            assert await host.client.read_gatt_char(CONTROL) == b"\x00"
            with pytest.raises(asyncio.CancelledError):
                await given_up

    run(main)


def test_a_lost_link_is_told_once_and_the_device_can_be_found_again() -> None:
    async def main() -> None:
        device = strap(faults="5 * disconnect")
        async with virtual_air([device]) as backend:
            host = Host(backend, await find(backend))
            await host.client.connect()
            await host.count(100)
            await asyncio.sleep(10.0)
            assert host.lost == [pytest.approx(5.0, abs=0.05)]
            assert not host.client.is_connected
            assert host.heard[-1][0] <= 5.0
            assert not device.is_connected
            again = await establish_connection(
                BleakClient, await find(backend), "one", host._gone, backend=backend.client
            )
            assert device.is_connected
            assert await again.read_gatt_char(LEVEL) == b"\x57"
            await again.disconnect()
            assert not device.is_connected
            await asyncio.sleep(0.1)
            assert len(host.lost) == 2

    run(main)


def test_who_is_still_connected_when_the_air_closes_is_told() -> None:
    async def main() -> None:
        device = strap()
        async with virtual_air([device]) as backend:
            host = Host(backend, await find(backend))
            await host.client.connect()
        await asyncio.sleep(0.1)
        assert len(host.lost) == 1
        assert not device.is_connected
        with pytest.raises(BleakError, match="closed"):
            await host.client.connect()

    run(main)


def test_a_vanished_device_is_neither_heard_nor_connected_to_until_it_comes_back() -> None:
    async def main() -> None:
        async with virtual_air([strap(faults="2 * vanish 60")]) as backend:
            device = await find(backend)
            await asyncio.sleep(3.0)
            assert await BleakScanner.find_device_by_name("one", 5.0, backend=backend.scanner) is None
            with pytest.raises(TimeoutError):
                await BleakClient(device, backend=backend.client, timeout=5.0).connect()
            with pytest.raises(BleakDeviceNotFoundError):
                await BleakClient(ONE, backend=backend.client, timeout=5.0).connect()
            await asyncio.sleep(62.5 - now())
            async with BleakClient(ONE, backend=backend.client, timeout=5.0) as client:
                assert client.is_connected

    run(main)


def test_a_device_that_does_not_answer_holds_up_the_others_for_seconds_only() -> None:
    async def main() -> None:
        gone, there = strap("one", ONE, "1 * vanish 12"), strap("two", TWO)
        async with virtual_air([gone, there]) as backend:
            first, second = await find(backend, "one"), await find(backend, "two")
            await asyncio.sleep(1.0)
            slow, quick = (BleakClient(device, backend=backend.client, timeout=20.0) for device in (first, second))
            waiting = asyncio.create_task(slow.connect())
            await asyncio.sleep(0.1)
            asked = now()
            await quick.connect()
            assert now() - asked < 2.5
            assert not waiting.done()
            await waiting
            assert 13.0 <= now() < 16.0
            assert slow.is_connected and quick.is_connected

    run(main)


def test_a_connection_that_its_caller_gives_up_leaves_nothing_behind() -> None:
    async def main() -> None:
        gone, there = strap("one", ONE, "1 * vanish 10"), strap("two", TWO)
        async with virtual_air([gone, there]) as backend:
            first, second = await find(backend, "one"), await find(backend, "two")
            await asyncio.sleep(1.0)
            waiting = asyncio.create_task(BleakClient(first, backend=backend.client).connect())
            await asyncio.sleep(0.5)
            waiting.cancel()
            with pytest.raises(asyncio.CancelledError):
                await waiting
            asked = now()
            async with BleakClient(second, backend=backend.client):
                assert now() - asked < 0.5
            await asyncio.sleep(15.0)
            assert not gone.is_connected

    run(main)


def test_two_devices_stream_at_once_whatever_their_names() -> None:
    async def main() -> None:
        async with virtual_air([strap("same", ONE), strap("same", TWO)]) as backend:
            found = await BleakScanner.discover(1.0, backend=backend.scanner)
            assert {device.address for device in found} == {ONE, TWO}
            assert {device.name for device in found} == {"same"}
            hosts = [Host(backend, device) for device in found]
            await asyncio.gather(*(host.client.connect() for host in hosts))
            await asyncio.gather(*(host.count(rate) for host, rate in zip(hosts, (100, 30), strict=True)))
            await asyncio.sleep(10.0)
            for host, rate in zip(hosts, (100, 30), strict=True):
                assert host.numbers == list(range(host.numbers[0], host.numbers[0] + len(host.heard)))
                assert len(host.heard) == pytest.approx(10 * rate, abs=2)
            await asyncio.gather(*(host.client.disconnect() for host in hosts))

    run(main)


def test_the_same_air_tells_the_same_at_the_same_times() -> None:
    told: list[list[tuple[float, bytes]]] = []

    async def main() -> None:
        devices = [strap("one", ONE, "2 * drop 3; 3 * flip 5; 4 * disconnect"), strap("two", TWO)]
        async with virtual_air(devices) as backend:
            hosts = [Host(backend, device) for device in (await find(backend, "one"), await find(backend, "two"))]
            await asyncio.gather(*(host.client.connect() for host in hosts))
            await asyncio.gather(*(host.count(100) for host in hosts))
            await asyncio.sleep(5.0)
            told.append(hosts[0].heard + hosts[1].heard)

    run(main)
    run(main)
    assert len(told[0]) > 800
    assert told[0] == told[1]


def test_fifty_reconnects_leave_no_task_and_no_link_behind() -> None:
    async def main() -> None:
        device = strap()
        async with virtual_air([device]) as backend:
            found = await find(backend)
            lost = 0
            tasks, objects = 0, 0
            for turn in range(50):
                host = Host(backend, found)
                await host.client.connect()
                await host.count(100)
                await asyncio.sleep(0.5)
                await host.client.disconnect()
                await asyncio.sleep(0.3)
                lost += len(host.lost)
                assert len(host.heard) >= 50
                if turn == 9:
                    del host
                    gc.collect()
                    tasks, objects = len(asyncio.all_tasks()), len(gc.get_objects())
            del host
            gc.collect()
            assert lost == 50
            assert len(asyncio.all_tasks()) == tasks == 1
            assert sum(isinstance(each, Connection) for each in gc.get_objects()) <= 2
            assert len(gc.get_objects()) < objects + 500

    run(main)


def test_links_come_and_go_without_a_word_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with virtual_air([strap(faults="2 * disconnect; 4 * hang; 8 * vanish 1")]) as backend:
            for _ in range(6):
                host = Host(backend, await find(backend))
                await host.client.connect()
                await host.count(200)
                await asyncio.sleep(1.5)
                if host.client.is_connected:
                    try:
                        await host.client.read_gatt_char(LEVEL)
                    except BleakError:
                        continue
                    await host.client.disconnect()

    run(main)
    assert not [record for record in caplog.records if record.levelname != "DEBUG"]


PROGRAM = """
import asyncio, logging
from bleak import BleakClient, BleakScanner
from solepath.loopback.server import virtual_air
from strap import Strap

async def main():
    async with virtual_air([Strap("one", "F0:00:00:00:00:01")]) as backend:
        device = await BleakScanner.find_device_by_name("one", 5.0, backend=backend.scanner)
        async with BleakClient(device, backend=backend.client) as client:
            print(len(list(client.services)), logging.getLogger().handlers)

asyncio.run(main())
"""


def test_a_programs_logging_is_left_alone() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], cwd=Path(__file__).parent, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("4 []\n", "")


def test_an_error_of_the_apps_callback_is_reported_and_the_next_notification_comes() -> None:
    async def main() -> None:
        async with linked(strap()) as (host, _):
            reported: list[dict[str, Any]] = []
            asyncio.get_running_loop().set_exception_handler(lambda loop, context: reported.append(context))
            await host.client.start_notify(BEAT, lambda *_: 1 // 0)
            await host.client.write_gatt_char(CONTROL, b"\x0a", response=True)
            await asyncio.sleep(1.0)
            assert len(reported) >= 10
            assert isinstance(reported[0]["exception"], ZeroDivisionError)

    run(main)
