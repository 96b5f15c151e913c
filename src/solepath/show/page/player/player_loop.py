"""Runs a player on an event loop behind a page. The times below were chosen by hand and not swept."""

from __future__ import annotations

import asyncio

from ..messages import Command
from ..server.server import Page
from .player import Player

TIME_SLICE = 0.02
"""Longest time for which the player computes before other tasks of the event loop run, s."""
CLOCK_INTERVAL = 0.02
"""Time between two reads of the clock while the recording plays, s."""
IDLE_INTERVAL = 0.5
"""Time between two reads of the clock while nothing plays, s."""


class PlayerLoop:
    """Plays `player` by the event loop's clock while `run` runs; a Page calls `command`."""

    def __init__(self, player: Player) -> None:
        self.player = player
        self._command_received = asyncio.Event()

    def command(self, command: Command) -> None:
        """Execute a command and wake the loop; raise CommandError for one that a player has not."""
        self.player.command(command)
        self._command_received.set()

    async def run(self, page: Page, stop: asyncio.Event, *, once: bool = False) -> None:
        """Run until `stop` is set or, with `once`, until the recording was played to its end."""
        player, loop = self.player, asyncio.get_running_loop()
        previous_time = loop.time()
        while not stop.is_set():
            now = loop.time()
            player.advance(now - previous_time)
            previous_time, end = now, now + TIME_SLICE
            more = player.feed_due(lambda end=end: loop.time() >= end)  # type: ignore[misc]
            if page.scene is not player.scene:
                page.scene = player.scene
            if more:
                await asyncio.sleep(0)
            elif once and player.playback.state == "ended":
                return
            else:
                await self._wait(stop)

    async def _wait(self, stop: asyncio.Event) -> None:
        """Wait for the next read of the clock; while nothing plays, a command or `stop` ends the wait."""
        if self.player.playback.state == "playing":
            await asyncio.sleep(CLOCK_INTERVAL)
            return
        self._command_received.clear()
        tasks = [asyncio.ensure_future(event.wait()) for event in (self._command_received, stop)]
        try:
            await asyncio.wait(tasks, timeout=IDLE_INTERVAL, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
