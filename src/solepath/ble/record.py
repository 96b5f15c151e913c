"""Packets on their way, written down."""

from __future__ import annotations

from collections.abc import AsyncIterable, AsyncIterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..recording import PacketWriter
from ..types import Packet


async def record(packets: AsyncIterable[Packet], path: Path | str, **header: Any) -> AsyncIterator[Packet]:
    """The same packets, each in the file before it is passed on, so that a replay feeds a session what was fed live.

        async for packet in record(devices, "walk.jsonl"):
            session.feed(packet)

    `header`: further keys of the first line; `began`, the time of day (UTC), is there already. OSError when the file
    cannot be made, RecordingError when it cannot be written any further (the disk is full): what is in it stays whole.
    """
    with PacketWriter(path, began=datetime.now(UTC).isoformat(timespec="milliseconds"), **header) as writer:
        async for packet in packets:
            writer.write(packet)
            yield packet
