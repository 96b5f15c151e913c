"""Recordings: packets are read and written, tables of samples and btsnoop logs are read, MCAP files are written."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .bad_rows import LONGEST_LINE
    from .clock_offset import shift_clock
    from .errors import RecordingError, RecordingWarning, Report, open_file, os_error_text, printable, warn
    from .mapping import TableMapping, read_mapping
    from .packet_writer import PacketWriter
    from .packets import FORMAT, VERSION, read_header, read_packets, read_start_time
    from .source import Source, open_source, read_samples

_MODULES = ("errors", "bad_rows", "packets", "packet_writer", "mapping", "clock_offset", "source")
"""Modules of the names in `__all__`. A module is imported when a name is first used."""


def __dir__() -> list[str]:
    return sorted({*__all__, *_MODULES})


def __getattr__(name: str) -> object:
    if name in _MODULES:
        return import_module(f"{__name__}.{name}")  # which sets the attribute
    for module in _MODULES if name in __all__ else ():
        if hasattr(found := import_module(f"{__name__}.{module}"), name):
            return globals().setdefault(name, getattr(found, name))
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "FORMAT",
    "LONGEST_LINE",
    "VERSION",
    "PacketWriter",
    "RecordingError",
    "RecordingWarning",
    "Report",
    "Source",
    "TableMapping",
    "open_file",
    "open_source",
    "os_error_text",
    "printable",
    "read_header",
    "read_mapping",
    "read_packets",
    "read_samples",
    "read_start_time",
    "shift_clock",
    "warn",
]
