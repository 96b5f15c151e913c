"""Event loops of commands, and the signals that stop them; a stopped command still closes its files and connections."""

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
"""Signals that stop a command: Ctrl-C, being ended, and a terminal that was closed."""
STOPPED_STATUS = 130
"""Exit status of a command that was stopped before it had started."""


class StoppedEarly(Exception):
    """The command was stopped before it had started."""


def run_to_end(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> int:
    """Run `main` with asyncio, with an event that a signal of STOP sets; return the exit status.

    No signal ends the program at once, however often it comes: everything that was started is closed first."""
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
                # after a stop, further signals are ignored
                signal.signal(number, _ignore_signal if stop.is_set() else handler)
            atexit.register(_ignore_at_exit)


@contextmanager
def stop_signals_raise() -> Iterator[None]:
    """Turn every signal of STOP within the context into a KeyboardInterrupt, so that nothing half done stays.

    It is raised once; further signals do not disturb the cleaning up."""

    def stopped(number: int, frame: object) -> None:
        for one in before:
            signal.signal(one, _ignore_signal)
        raise KeyboardInterrupt

    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread gets signals
        return
    before = _handle_signals(stopped)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _handle_signals(handler: Callable[[int, object], None]) -> dict[signal.Signals, Any]:
    """Let `handler` handle the signals of STOP from now on; return the handlers before it.

    What is ignored (nohup) stays ignored. After a terminal was closed nothing more is written to it."""
    terminals = [number for number in (1, 2) if os.isatty(number)]

    def handle(number: int, frame: object) -> None:
        if number != signal.SIGINT and number != signal.SIGTERM:
            _discard_output(terminals)
        handler(number, frame)

    handled = [number for number in STOP if signal.getsignal(number) is not signal.SIG_IGN]
    return {number: signal.signal(number, handle) for number in handled}


def _ignore_signal(number: int, frame: object) -> None:
    """Ignore a signal, since the command stops already.

    It is not SIG_IGN, which belongs to whoever started the command."""


def _ignore_at_exit() -> None:
    """Ignore the signals at exit, where Python removes its handlers and a signal would end it."""
    for number in STOP:
        if signal.getsignal(number) is _ignore_signal:
            signal.signal(number, signal.SIG_IGN)


def _discard_output(terminals: list[int]) -> None:
    """Discard what is written to these terminals from now on: a failed write must not end the work."""
    nobody = os.open(os.devnull, os.O_WRONLY)
    for number in terminals:
        os.dup2(nobody, number)
    os.close(nobody)


@contextmanager
def stop_flag() -> Iterator[Callable[[], bool]]:
    """Yield a function that returns whether a signal of STOP came, for work that chooses when to end."""
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
    """Give up what is awaited within when `stop` is set: StoppedEarly."""

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
