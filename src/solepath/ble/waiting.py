"""Waiting for something or for a time, whichever is first."""

from __future__ import annotations

import asyncio


async def either(event: asyncio.Event, seconds: float | None) -> None:
    """Until `event`, or so long; None: however long."""
    try:
        async with asyncio.timeout(seconds):
            await event.wait()
    except TimeoutError:
        pass
