"""A person at a terminal is led through a calibration while sensors send.

The dialogue needs no control code but the carriage return, so that it works in every terminal."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from argparse import Namespace
from collections import deque
from collections.abc import AsyncIterable, AsyncIterator, Callable
from contextlib import AsyncExitStack, suppress
from typing import Protocol

from ...ble import Devices
from ...show.page.scene.scene import Scene
from ...types import Packet
from ..bluetooth.backend import backend_of
from ..bluetooth.devices import named_devices
from ..common.loop import unless_stopped
from ..common.view import PageAddress, serve_page

END = "q"
"""Line that ends a dialogue, as the end of the input does."""
MAX_LINE = 4096
"""Largest number of bytes of a typed line that are read; terminals themselves allow no more."""
WIDTH = 78
"""Width to which the changing line is filled, characters, so that nothing of a longer one stays."""
REDRAW_INTERVAL = 0.1
"""Time between two pictures of the changing line, s; chosen by hand."""


class Guided(Protocol):
    """A calibration through which a person is led."""

    @property
    def scene(self) -> Scene:
        """Scene for a page, which shows the same."""

    async def receive(self, packets: AsyncIterable[Packet]) -> None:
        """Take packets until cancelled."""

    async def lead(self, talk: Dialogue) -> None:
        """Say what to do and wait for it; raise EOFError when the person ends."""


async def guide(options: Namespace, address: PageAddress | None, guided: Guided, stop: asyncio.Event) -> int:
    """Connect to the sensors and lead a person; return 0. Raise StoppedEarly at a signal.

    With an `address`, a page there shows what `guided` shows as well."""
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(unless_stopped(stop))
        backend = await stack.enter_async_context(backend_of(options.via))
        connections = Devices(named_devices(options), backend=backend, pair=options.pair)
        packets = await stack.enter_async_context(connections)
        if address is not None:
            await stack.enter_async_context(serve_page(guided.scene, address))
        receiving = asyncio.create_task(guided.receive(packets))
        try:
            await guided.lead(Dialogue(receiving))
        finally:
            receiving.cancel()
            await asyncio.gather(receiving, return_exceptions=True)
    return 0


class Dialogue:
    """Lines that are typed and lines that are shown while `receiving` takes packets.

    A thread waits for lines, as there is no other way to wait for a terminal on every system. It reads the file itself
    and not `sys.stdin`, and so holds no lock when the program ends."""

    def __init__(self, receiving: asyncio.Task[None]) -> None:
        self._receiving = receiving
        self._typed: deque[str] = deque()
        """Lines that were not used; the end of the input is END."""
        self._shown = ""
        threading.Thread(target=self._read, args=(sys.stdin.fileno(),), daemon=True).start()

    def _read(self, file: int) -> None:
        with suppress(OSError):  # the terminal was closed
            while part := os.read(file, MAX_LINE):
                self._typed.append(part.decode(errors="replace").strip())
        self._typed.append(END)

    async def turns(self, line: Callable[[], str]) -> AsyncIterator[str | None]:
        """Yield each line that is typed, or None while none is.

        The line that `line` returns is shown meanwhile, and stays above the next one. EOFError is raised for END, and
        at the end of the input; an error of `receiving` is raised too."""
        while True:
            if self._receiving.done():
                self._receiving.result()
            if self._typed:
                self._shown = ""  # Enter has moved the terminal to a new line
                if self._typed[0] == END:
                    raise EOFError
                yield self._typed.popleft()
            else:
                yield None
            if (text := line()) != self._shown:
                self._shown = text
                print("\r" + text[:WIDTH].ljust(WIDTH), end="", flush=True)
            await asyncio.sleep(REDRAW_INTERVAL)

    async def prompt(self, question: str) -> str:
        """Print a question and return the line that is typed; raise EOFError for END, and at the end of the input."""
        self._print(f"{question} ")
        async for typed in self.turns(lambda: self._shown):
            if typed is not None:
                return typed
        raise EOFError

    def print_line(self, line: str = "") -> None:
        """Print a line that stays, below what was shown."""
        self._print("\n" * bool(self._shown) + line + "\n")
        self._shown = ""

    def _print(self, text: str) -> None:
        """Print a text, and forget what was typed before it."""
        while self._typed and self._typed[0] != END:
            self._typed.popleft()
        print(text, end="", flush=True)
