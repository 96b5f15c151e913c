"""Links on the virtual radio: start, end, and no remains after it."""

from __future__ import annotations

import asyncio
import subprocess
import sys

import pytest
from bleak import BleakClient
from bleak.exc import BleakError
from here import HELPERS
from strap import CONTROL, LEVEL, PAGE
from virtual import ONE, TWO, Host, find, linked, now, run, strap, virtually

from solepath.emulate.controllers.server import virtual_link


@virtually
async def test_a_request_that_its_caller_gives_up_does_not_have_its_answer_taken_for_the_next() -> None:
    async with linked(strap()) as (host, _):
        given_up = asyncio.create_task(host.client.read_gatt_char(PAGE))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        given_up.cancel()
        assert await host.client.read_gatt_char(LEVEL) == b"\x57"
        assert await host.client.read_gatt_char(CONTROL) == b"\x00"
        with pytest.raises(asyncio.CancelledError):
            await given_up


@virtually
async def test_a_connected_client_is_notified_when_the_radio_closes() -> None:
    device = strap()
    async with virtual_link([device]) as backend:
        host = Host(backend, await find(backend))
        await host.client.connect()
    await asyncio.sleep(0.1)
    assert len(host.lost) == 1
    assert not device.is_connected
    with pytest.raises(BleakError, match="closed"):
        await host.client.connect()


@virtually
async def test_a_device_that_does_not_answer_holds_up_the_others_for_seconds_only() -> None:
    absent, there = strap("one", ONE, "1 * vanish 12"), strap("two", TWO)
    async with virtual_link([absent, there]) as backend:
        first, second = await find(backend, "one"), await find(backend, "two")
        await asyncio.sleep(1.0)
        slow, quick = (BleakClient(device, backend=backend.client, timeout=20.0) for device in (first, second))
        waiting = asyncio.create_task(slow.connect())
        await asyncio.sleep(0.1)
        t_request = now()
        await quick.connect()
        assert now() - t_request < 2.5
        assert not waiting.done()
        await waiting
        assert 13.0 <= now() < 16.0
        assert slow.is_connected and quick.is_connected


@virtually
async def test_a_connection_that_its_caller_gives_up_leaves_nothing_behind() -> None:
    absent, there = strap("one", ONE, "1 * vanish 10"), strap("two", TWO)
    async with virtual_link([absent, there]) as backend:
        first, second = await find(backend, "one"), await find(backend, "two")
        await asyncio.sleep(1.0)
        waiting = asyncio.create_task(BleakClient(first, backend=backend.client).connect())
        await asyncio.sleep(0.5)
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        t_request = now()
        async with BleakClient(second, backend=backend.client):
            assert now() - t_request < 0.5
        await asyncio.sleep(15.0)
        assert not absent.is_connected


def test_the_same_devices_send_the_same_values_at_the_same_times() -> None:
    runs: list[list[tuple[float, bytes]]] = []

    async def main() -> None:
        devices = [strap("one", ONE, "2 * drop 3; 3 * flip 5; 4 * disconnect"), strap("two", TWO)]
        async with virtual_link(devices) as backend:
            hosts = [Host(backend, device) for device in (await find(backend, "one"), await find(backend, "two"))]
            await asyncio.gather(*(host.client.connect() for host in hosts))
            await asyncio.gather(*(host.count(100) for host in hosts))
            await asyncio.sleep(5.0)
            runs.append(hosts[0].received + hosts[1].received)

    run(main)
    run(main)
    assert len(runs[0]) > 800
    assert runs[0] == runs[1]


def test_links_start_and_end_without_a_line_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with virtual_link([strap(faults="2 * disconnect; 4 * hang; 8 * vanish 1")]) as backend:
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
from solepath.emulate.controllers.server import virtual_link
from strap import Strap

async def main():
    async with virtual_link([Strap("one", "F0:00:00:00:00:01")]) as backend:
        device = await BleakScanner.find_device_by_name("one", 5.0, backend=backend.scanner)
        async with BleakClient(device, backend=backend.client) as client:
            print(len(list(client.services)), logging.getLogger().handlers)

asyncio.run(main())
"""


def test_a_programs_logging_is_left_alone() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], cwd=HELPERS / "radio", capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("4 []\n", "")
