"""Helpers of the Bluetooth tests: virtual time, emulated devices on either tier, and the packets that an app gets."""

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
from solepath.emulate.controllers.server import virtual_link
from solepath.emulate.devices.bench import Bench
from solepath.types import Packet, Site
from solepath.wire.fields import parse_text
from solepath.wire.fragment import Reassembly, is_fragment, parse_fragment

T = TypeVar("T")


def in_virtual_time(main: Callable[[], Coroutine[Any, Any, T]]) -> T:
    """Run to the end on a loop whose clock jumps to the next timer, so that waiting takes no real time."""
    with asyncio.Runner(loop_factory=looptime.new_event_loop) as runner:
        return runner.run(main())


@asynccontextmanager
async def memory(bench: Bench) -> AsyncIterator[Backend]:
    """Yield a backend of the devices on the in-memory tier."""
    yield MemoryRadio(bench.peripherals).backend


def bumble(bench: Bench) -> AbstractAsyncContextManager[Backend]:
    """Return a backend of the devices behind virtual controllers."""
    return virtual_link(bench.peripherals)


TIERS = {"memory": memory, "bumble": bumble}


async def collect(devices: Devices, seconds: float) -> list[Packet]:
    """Return all packets that arrive within `seconds`."""
    end = asyncio.get_running_loop().time() + seconds
    packets = []
    async for packet in devices:
        if packet.t > end:
            break
        packets.append(packet)
    return packets


def received(backend: Backend, *configs: DeviceConfig, seconds: float, **more: Any) -> list[Packet]:
    """Return the packets that an app with these configs gets in `seconds` of virtual time; no task is left running."""

    async def main() -> list[Packet]:
        async with Devices(configs, backend=backend, **more) as devices:
            found = await collect(devices, seconds)
        assert not others()
        return found

    return in_virtual_time(main)


def troubles(packets: list[Packet]) -> list[str]:
    """Return the texts of the trouble packets."""
    return [parse_text(packet.data) for packet in packets if packet.channel == "receiver/trouble"]


def whole(packets: list[Packet]) -> list[Packet]:
    """Return the packets with fragments joined to frames, which arrive when their last fragment arrives."""
    reassemblies = defaultdict[Site, Reassembly](Reassembly)
    found = []
    for packet in packets:
        if packet.channel == "insole/frame" and is_fragment(packet.data):
            frame, dropped = reassemblies[packet.site].feed(parse_fragment(packet.data))
            assert dropped is None
            if frame is not None:
                found.append(evolve(packet, data=bytes(frame)))
        else:
            found.append(packet)
    return found


def others() -> set[asyncio.Task[Any]]:
    """Return all tasks except the current one."""
    return asyncio.all_tasks() - {asyncio.current_task()}
