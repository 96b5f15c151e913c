"""Recordings that tests make for themselves."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from solepath import Packet
from solepath.recording import PacketWriter


def written(path: Path, packets: Iterable[Packet]) -> Path:
    """A recording of them at this path."""
    with PacketWriter(path) as writer:
        for packet in packets:
            writer.write(packet)
    return path
