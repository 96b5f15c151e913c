"""Recordings of packets that tests write, and the files that commands make from them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from solepath.recording import PacketWriter
from solepath.types import Packet, Site

PACKETS = [
    Packet(12.5, Site.LEFT_FOOT, "device/battery", b"\x63"),
    Packet(12.5, Site.RIGHT_FOOT, "insole/frame", bytes(range(256))),
    Packet(0.1 + 12.65, Site.PELVIS, "cc2650/keys", b""),
]
"""Packets, one of which gives no event."""


def recorded(path: Path, packets: Iterable[Packet], header: dict[str, Any] | None = None) -> Path:
    """Write the packets into a recording, in place of one that exists, and return its path."""
    with PacketWriter(path, {} if header is None else header, replace=True) as writer:
        for packet in packets:
            writer.write(packet)
    return path


def into(folder: Path) -> tuple[object, ...]:
    """Return the options with which a command writes all its output files into `folder`."""
    return ("--out", folder / "out", "--report", folder / "r.html")


def written(folder: Path) -> dict[str, bytes]:
    """Return the contents of all files below `folder`, by relative path."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}
