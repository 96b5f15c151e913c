"""The seam to bleak: every call of a client goes through it, so that bleak's faults are told from those of our own."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from .trouble import FAILURES, Surprise

LOG = logging.getLogger("solepath.ble")
LOG.addHandler(logging.NullHandler())  # who wants to see it says so; a terminal is not ours to write to


@asynccontextmanager
async def calling(seconds: float) -> AsyncIterator[None]:
    """Around one call into bleak, which may last so long (TimeoutError after that). Nothing but FAILURES comes out.

    What should never come out of bleak does: its BlueZ client, for one, asserts that its bus is still there while it
    waits for an answer. That ends this connection, never another one; the traceback is logged.
    """
    try:
        async with asyncio.timeout(seconds):
            yield
    except FAILURES:
        raise
    except Exception as error:
        LOG.error("an unexpected exception out of bleak: the connection is begun anew", exc_info=True)
        raise Surprise(error) from error
