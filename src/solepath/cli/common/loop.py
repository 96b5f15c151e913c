"""Runs the event loops of commands, and handles the signals that stop a command.

A stopped command still closes its files and connections."""

from __future__ import annotations

import asyncio
import atexit
import os
import signal
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

STOP_SIGNALS = [signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])]
"""Signals that stop a command: Ctrl-C, a request to terminate, and a terminal that was closed."""
STOPPED_STATUS = 130
"""Exit status of a command that was stopped during its preparation."""


class StoppedEarly(Exception):
    """The command was stopped during its preparation, within `unless_stopped`."""


def run_to_end(main: Callable[[asyncio.Event], Coroutine[Any, Any, int]]) -> int:
    """Run `main` with asyncio, with an event that a signal of STOP_SIGNALS sets; return the exit status.

    No such signal, however often it comes, ends the program before everything that was started is closed."""
    with asyncio.Runner() as runner:
        loop, stop = runner.get_loop(), asyncio.Event()
        with _handled(lambda: loop.call_soon_threadsafe(stop.set), is_over=stop.is_set):
            atexit.register(_ignore_at_exit)
            try:
                return runner.run(main(stop))
            except StoppedEarly:
                return STOPPED_STATUS


@contextmanager
def stop_signals_raise() -> Iterator[None]:
    """Raise KeyboardInterrupt at a signal of STOP_SIGNALS within the context, so that incomplete work is cleaned up.

    Further signals are ignored, so that they do not disturb the cleaning up."""

    def stop() -> None:
        for number in STOP_SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, _ignore_signal)
        raise KeyboardInterrupt

    with _handled(stop):
        yield


@contextmanager
def stop_flag() -> Iterator[Callable[[], bool]]:
    """Yield a function that returns whether a signal of STOP_SIGNALS came, for work that chooses when to end."""
    stopped = threading.Event()
    with _handled(stopped.set):
        yield stopped.is_set


@contextmanager
def _handled(stop: Callable[[], object], is_over: Callable[[], bool] = lambda: False) -> Iterator[None]:
    """Call `stop` at the signals of STOP_SIGNALS within the context; only the main thread gets any.

    They have their previous handlers again afterwards, or are ignored if `is_over()`. A signal that is ignored already
    (nohup) stays ignored. After SIGHUP nothing more is written to the terminal."""
    terminals = [number for number in (1, 2) if os.isatty(number)]

    def handle(number: int, frame: object) -> None:
        if number not in (signal.SIGINT, signal.SIGTERM):
            devnull = os.open(os.devnull, os.O_WRONLY)
            for terminal in terminals:  # so that no failed write ends the work
                os.dup2(devnull, terminal)
            os.close(devnull)
        stop()

    is_main = threading.current_thread() is threading.main_thread()
    handled = [one for one in STOP_SIGNALS if is_main and signal.getsignal(one) is not signal.SIG_IGN]
    previous = {number: signal.signal(number, handle) for number in handled}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, _ignore_signal if is_over() else handler)


def _ignore_signal(number: int, frame: object) -> None:
    """Ignore a signal, since the command stops already; SIG_IGN would look as if the parent process had set it."""


def _ignore_at_exit() -> None:
    """Set SIG_IGN at exit, when Python removes its handlers and a signal would end it at once."""
    for number in STOP_SIGNALS:
        if signal.getsignal(number) is _ignore_signal:
            signal.signal(number, signal.SIG_IGN)


@asynccontextmanager
async def unless_stopped(stop: asyncio.Event) -> AsyncIterator[None]:
    """Cancel what is awaited within the context when `stop` is set, and raise StoppedEarly."""

    async def watch() -> None:
        await stop.wait()
        limit.reschedule(asyncio.get_running_loop().time())

    watcher: asyncio.Task[None] | None = None
    try:
        async with asyncio.timeout(None) as limit:
            watcher = asyncio.create_task(watch())
            try:
                yield
            finally:
                watcher.cancel()
    except TimeoutError:
        if limit.expired():
            raise StoppedEarly from None
        raise
    if stop.is_set():
        raise StoppedEarly
