"""Recording of packets before a session receives them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterable, AsyncIterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..recording import PacketWriter
from ..types import Packet


async def record(
    packets: AsyncIterable[Packet], path: Path | str, header: Mapping[str, Any] = {}, *, replace: bool = False
) -> AsyncIterator[Packet]:
    """Write each packet to the file and yield it, so that a replay feeds a session the same input.

        async for packet in record(devices, "walk.jsonl"):
            session.feed(packet)

    `header` holds further keys of the first line. `began`, the date and time (UTC), and `began_t`, the same moment on
    the packets' clock, s, are set by this function. Raises RecordingError for a file with content, unless `replace` is
    true, and when the file cannot be made or written any further (the disk is full); packets already in the file stay
    intact."""
    with PacketWriter(path, {**header, **start_keys()}, replace=replace) as writer:
        async for packet in packets:
            writer.write(packet)
            yield packet


def start_keys() -> dict[str, Any]:
    """Return the header keys of a recording that starts now: date and time (UTC), and packets' clock, s."""
    now = datetime.now(UTC).isoformat(timespec="milliseconds")
    return {"began": now, "began_t": asyncio.get_running_loop().time()}
