"""What commands do on an event loop: reach the devices, stop when they are told to, and end with one line."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterable, AsyncIterator, Coroutine, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from typing import Any, TypeVar

from ..ble import NATIVE, Backend, BluetoothError
from ..types import Packet
from .failure import Failure

_T = TypeVar("_T")


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
    try:
        async with reach(via) as backend:
            yield backend
    except (BleakError, ValueError) as error:
        raise Failure(f"--via {via}: {error}") from None


def run_to_end(main: Coroutine[Any, Any, _T]) -> _T:
    """asyncio.run, with the errors of Bluetooth as a Failure."""
    try:
        return asyncio.run(main)
    except BluetoothError as error:
        raise Failure(str(error)) from None


@contextmanager
def stopping() -> Iterator[asyncio.Event]:
    """An event that Ctrl-C and SIGTERM set instead of ending the program on the spot."""
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    with suppress(NotImplementedError):  # Windows: Ctrl-C cancels the main task there
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, stop.set)
    try:
        yield stop
    finally:
        with suppress(NotImplementedError):
            for number in (signal.SIGINT, signal.SIGTERM):
                loop.remove_signal_handler(number)


async def until(packets: AsyncIterable[Packet], stop: asyncio.Event, seconds: float | None) -> AsyncIterator[Packet]:
    """`packets` until `stop`, or for so many seconds. Devices give a packet four times a second at least."""
    loop = asyncio.get_running_loop()
    end = None if seconds is None else loop.time() + seconds
    async for packet in packets:
        if stop.is_set() or (end is not None and loop.time() >= end):
            return
        yield packet
