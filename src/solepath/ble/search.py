"""Search for one device among all that advertise."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress

from .candidates import CHOICE_INTERVAL, Advertisement, Candidates
from .scanning import Scanner


async def find_device(scanner: Scanner, candidates: Candidates, report_trouble: Callable[[str], None]) -> Advertisement:
    """Return the device as soon as it advertises and no other device can be mistaken for it."""
    loop, advertised = asyncio.get_running_loop(), asyncio.Event()

    def on_advertisement(found: Advertisement) -> None:
        if candidates.add(found):
            advertised.set()

    with scanner.listening(on_advertisement):
        while True:
            found, trouble = candidates.choose(loop.time())
            if found is not None:
                return found
            if trouble:
                report_trouble(trouble)
            advertised.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout(CHOICE_INTERVAL):
                    await advertised.wait()
