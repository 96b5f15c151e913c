"""Packets on their way, written down."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterable, AsyncIterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..recording import PacketWriter
from ..types import Packet


async def record(
    packets: AsyncIterable[Packet], path: Path | str, header: Mapping[str, Any] = {}
) -> AsyncIterator[Packet]:
    """The same packets, each in the file before it is passed on, so that a replay feeds a session what was fed live.

        async for packet in record(devices, "walk.jsonl"):
            session.feed(packet)

    `header`: further keys of the first line; `began`, the time of day (UTC), and `began_t`, what the packets' clock
    said then, are this recording's own. RecordingError when the file cannot be made, or not written any further (the
    disk is full): what is in it stays whole.
    """
    with PacketWriter(path, {**header, **beginning()}) as writer:
        async for packet in packets:
            writer.write(packet)
            yield packet


def beginning() -> dict[str, Any]:
    """The keys of a header that say when a recording began, now: time of day, and the packets' clock (recording.md)."""
    now = datetime.now(UTC).isoformat(timespec="milliseconds")
    return {"began": now, "began_t": asyncio.get_running_loop().time()}
