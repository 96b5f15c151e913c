"""Tests of the virtual radio in virtual time, in which sleeping takes no real time; a strap, and a host that logs."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import wraps
from typing import Any

import looptime
from bleak import BleakClient, BleakScanner
from bleak.backends.device import BLEDevice
from strap import BEAT, CONTROL, Strap

from solepath.ble.scanning import Backend
from solepath.emulate.controllers.server import virtual_link
from solepath.emulate.devices.faults import parse_faults

ONE, TWO = "F0:00:00:00:00:01", "F0:00:00:00:00:02"


def run(main: Callable[[], Awaitable[None]]) -> None:
    """Run a coroutine in virtual time; no task may be left running at the end."""

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


def virtually(test: Callable[..., Awaitable[None]]) -> Callable[..., None]:
    """Run an async test in virtual time."""

    @wraps(test)
    def run_in_virtual_time(*given: Any, **named: Any) -> None:
        run(lambda: test(*given, **named))

    return run_in_virtual_time


def now() -> float:
    return asyncio.get_running_loop().time()


def strap(name: str = "one", faults: str = "", **given: object) -> Strap:
    return Strap(name, ONE, faults=parse_faults(faults), **given)


async def find(backend: Backend) -> BLEDevice:
    found = await BleakScanner.find_device_by_name("one", 5.0, backend=backend.scanner)
    assert found is not None
    return found


class Host:
    """A client that logs the times of lost links and the received notifications."""

    def __init__(self, backend: Backend, device: BLEDevice | str) -> None:
        self.lost: list[float] = []
        self.received: list[tuple[float, bytes]] = []
        self.client = BleakClient(device, self._on_disconnect, backend=backend.client)

    def _on_disconnect(self, client: BleakClient) -> None:
        self.lost.append(now())

    async def count(self, rate: int) -> None:
        await self.client.start_notify(BEAT, lambda _, value: self.received.append((now(), bytes(value))))
        await self.client.write_gatt_char(CONTROL, bytes([rate]), response=True)

    @property
    def numbers(self) -> list[int]:
        return [int.from_bytes(value[:4], "little") for _, value in self.received]


@asynccontextmanager
async def linked(device: Strap, mtu: int = 247) -> AsyncIterator[tuple[Host, Backend]]:
    async with virtual_link([device], mtu) as backend:
        host = Host(backend, await find(backend))
        async with host.client:
            yield host, backend
