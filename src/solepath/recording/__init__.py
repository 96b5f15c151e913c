"""Recordings of every format: packets, samples, btsnoop logs, MCAP."""

from .packets import (
    FORMAT,
    LONGEST_LINE,
    VERSION,
    PacketWriter,
    RecordingError,
    RecordingWarning,
    Report,
    began,
    open_file,
    printable,
    read_header,
    read_packets,
    warn,
    why,
)

__all__ = [
    "FORMAT",
    "LONGEST_LINE",
    "PacketWriter",
    "RecordingError",
    "RecordingWarning",
    "Report",
    "VERSION",
    "began",
    "open_file",
    "printable",
    "read_header",
    "read_packets",
    "warn",
    "why",
]
