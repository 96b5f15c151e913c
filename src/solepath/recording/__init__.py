"""Recordings of every format: packets, samples, btsnoop logs, MCAP."""

from .packets import FORMAT, LONGEST_LINE, VERSION, PacketWriter, began, read_header, read_packets
from .source import Source, open_source, read_samples
from .trouble import RecordingError, RecordingWarning, Report, open_file, printable, warn, why

__all__ = [
    "FORMAT",
    "LONGEST_LINE",
    "PacketWriter",
    "RecordingError",
    "RecordingWarning",
    "Report",
    "Source",
    "VERSION",
    "began",
    "open_file",
    "open_source",
    "printable",
    "read_header",
    "read_packets",
    "read_samples",
    "warn",
    "why",
]
