"""Runs a player on an event loop behind a page. The times below were chosen by hand and not swept."""

from __future__ import annotations

import asyncio

from ..server.server import Page
from .player import Player

TIME_SLICE = 0.02
"""Longest time for which the player computes before other tasks of the event loop run, s."""
CLOCK_INTERVAL = 0.02
"""Time between two reads of the clock, s."""


async def play_on(page: Page, player: Player, stop: asyncio.Event, *, once: bool = False) -> None:
    """Play by the event loop's clock until `stop` is set or, with `once`, until the recording was played to its end."""
    now = asyncio.get_running_loop().time
    previous_time = now()
    while not stop.is_set():
        start = now()
        player.advance(start - previous_time)
        previous_time = start
        more = player.feed_due(lambda end=start + TIME_SLICE: now() >= end)  # type: ignore[misc]
        page.scene = player.scene
        if once and not more and player.playback.state == "ended":
            return
        await asyncio.sleep(0.0 if more else CLOCK_INTERVAL)
