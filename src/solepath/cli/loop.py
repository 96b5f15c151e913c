"""What commands do on an event loop: reach the devices, stop when they are told to, and end with one line."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterable, AsyncIterator, Callable, Coroutine
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any

from ..ble import NATIVE, Backend, BluetoothError
from ..types import Packet
from .failure import Failure

INTERRUPTED = 130
"""The exit status of what was told to stop before it had begun."""


@asynccontextmanager
async def air(via: str | None) -> AsyncIterator[Backend]:
    """The Bluetooth of `--via`. Failure when it cannot be reached."""
    if via is None:
        yield NATIVE
        return
    from bleak.exc import BleakError

    try:
        from ..loopback.tcp import reach
    except ModuleNotFoundError as error:
        raise Failure(f"--via needs {error.name}: pip install 'solepath[loopback]'") from None
    async with AsyncExitStack() as stack:
        try:
            backend = await stack.enter_async_context(reach(via))
        except (BleakError, ValueError) as error:
            raise Failure(f"--via {via}: {error}") from None
        yield backend


class Interrupted(Exception):
    """It was told to stop before it had begun."""


def run_to_end(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> int:
    """asyncio.run of `main`, whose event is set by Ctrl-C and by SIGTERM; the exit status.

    Neither ends the program on the spot, however often it comes: what was begun is ended in good order. Errors of
    Bluetooth are a Failure.
    """
    with asyncio.Runner() as runner:
        loop, stop = runner.get_loop(), asyncio.Event()

        def told(number: int, frame: object) -> None:
            loop.call_soon_threadsafe(stop.set)

        before = {number: signal.signal(number, told) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            return runner.run(main(stop))
        except Interrupted:
            return INTERRUPTED
        except BluetoothError as error:
            raise Failure(str(error)) from None
        finally:
            for number, handler in before.items():
                # who was told already is on the way out
                signal.signal(number, signal.SIG_IGN if stop.is_set() else handler)


@asynccontextmanager
async def unless_told(stop: asyncio.Event) -> AsyncIterator[None]:
    """What is waited for within is given up when `stop` is set: Interrupted."""

    async def watch() -> None:
        await stop.wait()
        limit.reschedule(asyncio.get_running_loop().time())

    watching: asyncio.Task[None] | None = None
    try:
        async with asyncio.timeout(None) as limit:
            watching = asyncio.create_task(watch())
            try:
                yield
            finally:
                watching.cancel()
    except TimeoutError:
        if limit.expired():
            raise Interrupted from None
        raise
    if stop.is_set():
        raise Interrupted


async def until(packets: AsyncIterable[Packet], stop: asyncio.Event, seconds: float | None) -> AsyncIterator[Packet]:
    """`packets` until `stop`, or for so many seconds. Devices give a packet four times a second at least."""
    loop = asyncio.get_running_loop()
    end = None if seconds is None else loop.time() + seconds
    async for packet in packets:
        if stop.is_set() or (end is not None and loop.time() >= end):
            return
        yield packet
