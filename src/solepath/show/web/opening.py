"""Finds out what a file is that a person opens on the page, and reads recordings, with errors in words."""

from __future__ import annotations

import codecs
from collections import deque
from collections.abc import Generator
from pathlib import Path

from attrs import frozen

from ...calibration.file import FORMAT as CALIBRATION_FORMAT
from ...recording import RecordingError, read_packets
from ...recording.errors import SAMPLE_SUFFIXES
from ...recording.packets import FORMAT as RECORDING_FORMAT
from ...recording.packets import read_header
from ..page.player.packed_items import PackedItems
from ..report.bands import COLUMNS as BAND_COLUMNS
from ..tables.words import moment_text

MAX_START = 4096
"""Number of bytes from which the kind of a file is recognised."""
PACKETS_PER_STEP = 256
"""Number of packets that are read before the worker may do something else."""
NOTE_COUNT = 5
"""Largest number of sentences about the flaws of a file that are shown; chosen by hand."""


@frozen
class OpenedRecording:
    """A recording in memory."""

    items: PackedItems
    title: str
    when: str
    """Date and time at which it started, as text; "" if they are not known."""
    notes: tuple[str, ...]
    """Sentences on lines that were left out."""


def kind_of(path: Path) -> str:
    """Return "recording", "plan", "calibration" or "bands" for a file; raise RecordingError for samples."""
    with path.open("rb") as file:
        start = file.read(MAX_START)
    if start.removeprefix(codecs.BOM_UTF8).startswith(b",".join(map(str.encode, BAND_COLUMNS))):
        return "bands"
    if path.suffix.lower() in SAMPLE_SUFFIXES:
        raise RecordingError(path, "holds samples; this page opens recordings of packets (.jsonl), not samples")
    if path.suffix.lower() == ".jsonl" or f'"{RECORDING_FORMAT}"'.encode() in start:
        return "recording"
    if f'"{CALIBRATION_FORMAT}"'.encode() in start:
        return "calibration"
    if b'"bands"' in start:
        return "bands"
    if start.lstrip(b"\xef\xbb\xbf \t\r\n").startswith((b"PK", b"<", b"{")):
        return "plan"
    raise RecordingError(path, "is neither a recording of packets, nor a floor plan, a calibration or bands")


def open_recording(path: Path) -> Generator[float, None, OpenedRecording]:
    """Read a recording of packets; yield the share that was read, 0 to 1, and return the recording.

    RecordingError is raised for a file without any packet that can be used. A flaw behind good packets is a note."""
    header = read_header(path)
    size, done, notes = max(1, path.stat().st_size), deque([0], maxlen=1), list[str]()
    items = PackedItems()
    try:
        for packet in read_packets(path, report=notes.append, progress=done.append):
            items.append(packet)
            if len(items) % PACKETS_PER_STEP == 0:
                yield done[-1] / size
    except RecordingError as error:
        if not len(items):
            raise
        notes.append(str(error))
    if not len(items):
        raise RecordingError(path, "holds no packets")
    return OpenedRecording(items, path.name, moment_text(header), tuple(notes[:NOTE_COUNT]))
