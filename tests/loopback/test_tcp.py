"""The virtual radio between processes, in real time: when one side is killed, the other one notices and continues."""

from __future__ import annotations

import asyncio
import socket
import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from functools import wraps
from typing import Any

import pytest
from bleak import BleakClient, BleakScanner
from bleak.exc import BleakError
from here import HELPERS
from strap import BEAT, CONTROL, LEVEL, Strap
from virtual import find

from solepath.ble import Backend, BluetoothError
from solepath.emulate.controllers.tcp import address_of, reach, serve

HERE = HELPERS / "radio"


def really(test: Callable[..., Awaitable[None]]) -> Callable[..., None]:
    """Run an async test in real time; no task may be left running at the end."""

    @wraps(test)
    def run_it(**given: Any) -> None:
        async def whole() -> None:
            async with asyncio.timeout(30.0):
                await test(**given)
            await asyncio.sleep(0.01)
            assert asyncio.all_tasks() == {asyncio.current_task()}

        asyncio.run(whole())

    return run_it


@asynccontextmanager
async def program(*arguments: str) -> AsyncIterator[asyncio.subprocess.Process]:
    """Run Python with these arguments and kill it at the end."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, *arguments, cwd=HERE, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        _, output = await process.communicate()
        assert output == b""


async def line(process: asyncio.subprocess.Process) -> str:
    assert process.stdout is not None
    return (await process.stdout.readline()).decode().strip()


async def connected(backend: Backend) -> tuple[BleakClient, asyncio.Event]:
    """Return a client, and an event that is set when it loses its link."""
    lost = asyncio.Event()
    client = BleakClient(await find(backend), lambda _: lost.set(), backend=backend.client)
    await client.connect()
    return client, lost


async def beats(client: BleakClient, count: int = 50) -> list[int]:
    """Return the first `count` received numbers."""
    numbers: list[int] = []
    enough = asyncio.Event()

    def beat(_: object, value: bytearray) -> None:
        numbers.append(int.from_bytes(value[:4], "little"))
        if len(numbers) == count:
            enough.set()

    await client.start_notify(BEAT, beat)
    await client.write_gatt_char(CONTROL, b"\x64", response=True)
    await asyncio.wait_for(enough.wait(), 10.0)
    return numbers


@pytest.mark.soak
@really
async def test_another_processs_devices_are_found_and_stream_until_it_is_killed_and_again_when_it_is_back() -> None:
    async with program("strap.py", "0") as server:
        port = await line(server)
        async with reach(f"tcp:127.0.0.1:{port}", mtu=185) as backend:
            client, lost = await connected(backend)
            assert client.mtu_size == 185
            numbers = await beats(client)
            assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))

            server.kill()
            await asyncio.wait_for(lost.wait(), 5.0)
            assert not client.is_connected
            with pytest.raises(BleakError, match=port):
                await BleakScanner.discover(0.1, backend=backend.scanner)
            with pytest.raises(BleakError, match=port):
                await client.connect()
            await server.wait()

            async with program("strap.py", port) as restarted:
                assert await line(restarted) == port
                await client.connect()
                assert await client.read_gatt_char(LEVEL) == b"\x57"
                await client.disconnect()


@really
async def test_a_port_without_a_server_is_one_clear_error() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(BluetoothError, match=f"nothing answers at tcp:127.0.0.1:{port}: start `solepath emulate`"):
        async with reach(f"tcp:127.0.0.1:{port}"):
            pass


@really
async def test_bytes_that_are_no_hci_end_that_connection_and_no_other() -> None:
    nonsense = (b"GET / HTTP/1.1\r\n\r\n", b"\x01\x01\x04\x00", b"\x02\x01\x00\xff\xff" + bytes(70000))
    strap = Strap("one", "F0:00:00:00:00:01")
    async with serve([strap], "127.0.0.1", 0) as (host, port), reach(f"tcp:{host}:{port}") as backend:
        for sent in nonsense:
            reader, writer = await asyncio.open_connection(host, port)
            writer.write(sent)
            writer.write_eof()
            with suppress(ConnectionError):
                await asyncio.wait_for(reader.read(), 2.0)
            writer.close()
        async with BleakClient(await find(backend), backend=backend.client) as client:
            assert await client.read_gatt_char(LEVEL) == b"\x57"


def test_an_address_has_a_scheme_a_host_and_a_port() -> None:
    assert address_of("tcp:127.0.0.1:9735") == ("127.0.0.1", 9735)
    assert address_of("tcp:[::1]:1") == ("::1", 1)
    for wrong in ("", "tcp:", "tcp:host", "tcp::1", "tcp:host:", "tcp:host:0", "tcp:host:65536", "udp:host:1", "h:1"):
        with pytest.raises(ValueError, match="tcp:HOST:PORT"):
            address_of(wrong)
