"""What commands do on an event loop: they stop when they are told to, and in good order."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

INTERRUPTED = 130
"""The exit status of what was told to stop before it had begun."""


class Interrupted(Exception):
    """It was told to stop before it had begun."""


def run_to_end(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> int:
    """asyncio.run of `main`, whose event is set by Ctrl-C and by SIGTERM; the exit status.

    Neither ends the program on the spot, however often it comes: what was begun is ended in good order.
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
        finally:
            for number, handler in before.items():
                # who was told already is on the way out
                signal.signal(number, signal.SIG_IGN if stop.is_set() else handler)


@contextmanager
def listening() -> Iterator[Callable[[], bool]]:
    """Whether Ctrl-C or SIGTERM came within, for work that ends at a good moment of its own."""
    told = False

    def hear(number: int, frame: object) -> None:
        nonlocal told
        told = True

    before = {number: signal.signal(number, hear) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: told
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


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
