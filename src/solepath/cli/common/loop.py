"""What commands do on an event loop: they stop when they are told to, and in good order."""

from __future__ import annotations

import asyncio
import atexit
import os
import signal
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

STOP = [signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])]
"""What tells a command to stop: Ctrl-C, being ended, and a terminal that was closed."""
STOPPED_STATUS = 130
"""The exit status of what was told to stop before it had begun."""


class StoppedEarly(Exception):
    """It was told to stop before it had begun."""


def run_to_end(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> int:
    """asyncio.run of `main`, whose event is set by what tells a command to stop (STOP); the exit status.

    None of it ends the program on the spot, however often it comes: what was begun is ended in good order.
    """
    with asyncio.Runner() as runner:
        loop, stop = runner.get_loop(), asyncio.Event()

        def stop_main(number: int, frame: object) -> None:
            loop.call_soon_threadsafe(stop.set)

        before = _handle_signals(stop_main)
        try:
            return runner.run(main(stop))
        except StoppedEarly:
            return STOPPED_STATUS
        finally:
            for number, handler in before.items():
                # who was told already is on the way out
                signal.signal(number, _ignore_signal if stop.is_set() else handler)
            atexit.register(_ignore_at_exit)


@contextmanager
def stop_signals_raise() -> Iterator[None]:
    """Whatever tells the command to stop within is a KeyboardInterrupt, as Ctrl-C is, so that nothing half done stays;
    it is told once, and what is cleared away then is cleared away in peace."""

    def stopped(number: int, frame: object) -> None:
        for one in before:
            signal.signal(one, _ignore_signal)
        raise KeyboardInterrupt

    if threading.current_thread() is not threading.main_thread():
        yield  # others hear no signals
        return
    before = _handle_signals(stopped)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _handle_signals(handler: Callable[[int, object], None]) -> dict[signal.Signals, Any]:
    """From now on `handler` hears what tells the command to stop; who heard it before. What is ignored (nohup) stays
    ignored, and a terminal that was closed is not written to any more."""
    terminals = [number for number in (1, 2) if os.isatty(number)]

    def handle(number: int, frame: object) -> None:
        if number != signal.SIGINT and number != signal.SIGTERM:
            _discard_output(terminals)
        handler(number, frame)

    handled = [number for number in STOP if signal.getsignal(number) is not signal.SIG_IGN]
    return {number: signal.signal(number, handle) for number in handled}


def _ignore_signal(number: int, frame: object) -> None:
    """Whoever stops already need not be told again. Not SIG_IGN, which is of whoever started the command."""


def _ignore_at_exit() -> None:
    """Python takes its handlers away before it ends, and a signal would end it then; what is ignored stays so."""
    for number in STOP:
        if signal.getsignal(number) is _ignore_signal:
            signal.signal(number, signal.SIG_IGN)


def _discard_output(terminals: list[int]) -> None:
    """What is written there from now on is written to nobody: that it cannot be must not end what is being done."""
    nobody = os.open(os.devnull, os.O_WRONLY)
    for number in terminals:
        os.dup2(nobody, number)
    os.close(nobody)


@contextmanager
def stop_flag() -> Iterator[Callable[[], bool]]:
    """Whether something told the command to stop within, for work that ends at a good moment of its own."""
    stopped = False

    def handle(number: int, frame: object) -> None:
        nonlocal stopped
        stopped = True

    before = _handle_signals(handle)
    try:
        yield lambda: stopped
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@asynccontextmanager
async def unless_stopped(stop: asyncio.Event) -> AsyncIterator[None]:
    """What is waited for within is given up when `stop` is set: StoppedEarly."""

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
            raise StoppedEarly from None
        raise
    if stop.is_set():
        raise StoppedEarly
