"""What the tests of Bluetooth share: virtual time, emulated devices on either tier, and what an app hears of them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any, TypeVar

import looptime
from memory_radio import MemoryRadio

from solepath.ble import Backend, Devices
from solepath.emulate.controllers.server import virtual_air
from solepath.emulate.devices.bench import Bench
from solepath.types import Packet

T = TypeVar("T")


def in_virtual_time(main: Callable[[], Coroutine[Any, Any, T]]) -> T:
    """Run to the end on a loop whose clock jumps to whatever is due next: a minute takes what its work takes."""
    with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
        return runner.run(main())


@asynccontextmanager
async def memory(bench: Bench) -> AsyncIterator[Backend]:
    """The devices on the in-memory tier."""
    yield MemoryRadio(bench.peripherals).backend


def bumble(bench: Bench, interval: float | None = None) -> AbstractAsyncContextManager[Backend]:
    """The devices behind virtual Bluetooth controllers. `interval`: s between the connection events of their links."""
    return virtual_air(bench.peripherals, interval=interval)


TIERS = {"memory": memory, "bumble": bumble}


async def hear(devices: Devices, seconds: float) -> list[Packet]:
    """Everything that comes within so many seconds."""
    end = asyncio.get_running_loop().time() + seconds
    heard = []
    async for packet in devices:
        if packet.t > end:
            break
        heard.append(packet)
    return heard


def others() -> set[asyncio.Task[Any]]:
    """The tasks besides the one that asks."""
    return asyncio.all_tasks() - {asyncio.current_task()}
