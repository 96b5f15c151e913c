"""What the tests of Bluetooth share: virtual time, emulated devices on either tier, and what an app hears of them."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any, TypeVar

import looptime
from attrs import evolve
from memory_radio import MemoryRadio

from solepath.ble import Backend, DeviceConfig, Devices
from solepath.emulate.controllers.server import virtual_air
from solepath.emulate.devices.bench import Bench
from solepath.link.devices.reassembly import Reassembly
from solepath.types import Packet, Site
from solepath.wire.fields import parse_text
from solepath.wire.fragment import is_fragment, parse_fragment

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


async def collect(devices: Devices, seconds: float) -> list[Packet]:
    """Everything that comes within so many seconds."""
    end = asyncio.get_running_loop().time() + seconds
    packets = []
    async for packet in devices:
        if packet.t > end:
            break
        packets.append(packet)
    return packets


def received(backend: Backend, *configs: DeviceConfig, seconds: float, **more: Any) -> list[Packet]:
    """What an app gets that wants these, in so many seconds of virtual time; it leaves nothing running."""

    async def main() -> list[Packet]:
        async with Devices(configs, backend=backend, **more) as devices:
            found = await collect(devices, seconds)
        assert not others()
        return found

    return in_virtual_time(main)


def troubles(packets: list[Packet]) -> list[str]:
    """What it is told of."""
    return [parse_text(packet.data) for packet in packets if packet.channel == "receiver/trouble"]


def whole(packets: list[Packet]) -> list[Packet]:
    """The same with fragments put together, each frame at the arrival of its last."""
    under_way = defaultdict[Site, Reassembly](Reassembly)
    found = []
    for packet in packets:
        if packet.channel == "insole/frame" and is_fragment(packet.data):
            frame, dropped = under_way[packet.site].feed(parse_fragment(packet.data))
            assert dropped is None
            if frame is not None:
                found.append(evolve(packet, data=bytes(frame)))
        else:
            found.append(packet)
    return found


def others() -> set[asyncio.Task[Any]]:
    """The tasks besides the one that asks."""
    return asyncio.all_tasks() - {asyncio.current_task()}
