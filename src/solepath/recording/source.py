"""A recording of packets or of samples as one stream for a session."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from attrs import define

from ..types import Foot, Packet, Sample
from .clock_offset import shift_clock
from .errors import RecordingError, Report, open_file, printable, warn
from .packets import read_packets

if TYPE_CHECKING:
    from .samples import SampleRecording

SAMPLE_SUFFIXES = (".npz", ".csv")
"""Suffixes of files that hold samples."""


@define
class Source:
    """The packets or samples of a recording, in the order in which a session needs them.

    Iterating raises RecordingError at data that cannot be used, after all packets or samples before them. A recording
    of packets that has only a header is no error, but is reported. `foot`, `report`: as in `open_source`."""

    path: Path
    foot: Foot | None
    report: Report
    total: int = 0
    """Size of a recording of packets, bytes, or number of samples."""
    done: int = 0
    """Part of `total` that was iterated, in the same unit."""
    samples: SampleRecording | None = None
    """Samples of the recording; None for a recording of packets."""
    clock_offset: float = 0.0
    """Time to add to the times of the right foot, s, when the feet were recorded with separate clocks."""

    def __iter__(self) -> Iterator[Packet | Sample]:
        items = self._iterate_packets() if self.samples is None else self._iterate_samples(self.samples)
        return shift_clock(items, self.clock_offset) if self.clock_offset else items

    def _iterate_samples(self, samples: SampleRecording) -> Iterator[Packet | Sample]:
        for sample in samples:
            self.done += 1
            yield sample

    def _iterate_packets(self) -> Iterator[Packet | Sample]:
        has_packets = has_used_packets = False
        for packet in read_packets(self.path, report=self.report, progress=partial(setattr, self, "done")):
            has_packets = True
            if self.foot is None or packet.site.foot in (None, self.foot):
                has_used_packets = True
                yield packet
        if not has_packets:
            self.report(f"{printable(str(self.path))}: holds no packets")
        elif self.foot is not None and not has_used_packets:
            raise RecordingError(self.path, f"holds no packets of the {self.foot.value} foot")


def open_source(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> Source:
    """Return the recording at `path`: samples if the file's name ends in .npz or .csv, else packets.

    `foot`: for samples that name no foot, the foot that wore the sensor (None: the right foot); for any other
    recording, the only foot to read (None: all). RecordingError when nothing can be used."""
    path = Path(path)
    if path.suffix.lower() in SAMPLE_SUFFIXES:
        from .samples import load_samples  # imports numpy, which packets do not need

        samples = load_samples(path, foot, report=report)
        return Source(path, foot, report, total=len(samples), samples=samples)
    open_file(path).close()
    return Source(path, foot, report, total=path.stat().st_size)


def read_samples(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> Iterator[Sample]:
    """Return an iterator over the samples of an .npz or .csv file, with both feet in order of time.

    `foot`: for samples that name no foot, the foot that wore the sensor (None: the right foot); else the only foot to
    read (None: both). A row that cannot be used raises RecordingError after all rows before it."""
    from .samples import load_samples

    return iter(load_samples(path, foot, report=report))
