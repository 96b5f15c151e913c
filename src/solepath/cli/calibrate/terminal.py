"""A dialogue in a terminal while sensors send: a line that changes, and lines that a person types.

It needs no control code but the carriage return, so that it works in every terminal."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import AsyncIterator, Coroutine
from contextlib import asynccontextmanager

END = "q"
"""Line that ends a dialogue, as the end of the input does."""
MAX_LINE = 4096
"""Largest number of bytes of a typed line that are read; terminals themselves allow no more."""
WIDTH = 78
"""Width to which the changing line is filled, characters, so that nothing of a longer one stays."""


class Dialogue:
    """Lines that are typed and lines that are shown; made within a running event loop.

    A thread waits for lines, as there is no other way to wait for a terminal on every system. It reads the file itself
    and not `sys.stdin`, and so holds no lock when the program ends."""

    def __init__(self) -> None:
        self._typed: asyncio.Queue[str | None] = asyncio.Queue()
        self._loop = asyncio.get_running_loop()
        self._shown = ""
        threading.Thread(target=self._read, args=(sys.stdin.fileno(),), daemon=True).start()

    def _read(self, file: int) -> None:
        line = b""
        while True:
            try:
                part = os.read(file, MAX_LINE)
            except OSError:  # the terminal was closed
                part = b""
            line += part
            if part and not line.endswith(b"\n"):
                continue
            try:
                self._loop.call_soon_threadsafe(self._typed.put_nowait, line.decode(errors="replace") if part else None)
            except RuntimeError:  # the loop has ended
                return
            if not part:
                return
            line = b""

    def forget_typed(self) -> None:
        """Forget lines that were typed before anything was asked."""
        while not self._typed.empty():
            line = self._typed.get_nowait()
            if line is None:
                self._typed.put_nowait(None)
                return

    def typed(self) -> str | None:
        """Return the line that was typed, without spaces around it, or None if none was.

        What was shown stays above the next line. Raises EOFError for END, and at the end of the input."""
        return None if self._typed.empty() else self._checked(self._typed.get_nowait())

    async def prompt(self, question: str) -> str:
        """Print a question and return the line that is typed; raise EOFError for END, and at the end of the input."""
        self.forget_typed()
        print(f"{question} ", end="", flush=True)
        return self._checked(await self._typed.get())

    def _checked(self, line: str | None) -> str:
        if line is None:
            self._typed.put_nowait(None)
            raise EOFError
        self._shown = ""  # Enter has moved the terminal to a new line
        typed = line.strip()
        if typed == END:
            raise EOFError
        return typed

    def show(self, line: str) -> None:
        """Show a line in place of the one that was shown last."""
        if line != self._shown:
            self._shown = line
            print("\r" + line[:WIDTH].ljust(WIDTH), end="", flush=True)

    def print_line(self, line: str = "") -> None:
        """Print a line that stays, below what was shown."""
        if self._shown:
            print()
            self._shown = ""
        print(line, flush=True)


@asynccontextmanager
async def meanwhile(receiving: Coroutine[None, None, None]) -> AsyncIterator[asyncio.Task[None]]:
    """Yield the task that receives packets during a dialogue, and cancel it at the end of the context."""
    task = asyncio.create_task(receiving)
    try:
        yield task
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
