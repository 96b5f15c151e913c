"""A recording of either kind, packets or samples, as one stream for a session."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from attrs import define

from ..types import Foot, Packet, Sample
from .errors import RecordingError, Report, open_file, printable, warn
from .packets import read_packets

if TYPE_CHECKING:
    from .samples import SampleRecording

SAMPLE_FILES = (".npz", ".csv")
"""Endings of the names of files that hold samples."""


@define
class Source:
    """The content of a recording, in the order in which a session takes it.

    Iterating raises RecordingError at data that cannot be used, after everything that came before. A recording of
    packets that ends after its header is whole: that it is empty is reported, and no error. `done` of `total` (bytes of
    packets, or samples) is the progress of the iteration."""

    path: Path
    foot: Foot | None
    report: Report
    total: int = 0
    done: int = 0
    samples: SampleRecording | None = None
    """Samples of the recording; None for a recording of packets."""

    def __iter__(self) -> Iterator[Packet | Sample]:
        return self._packets() if self.samples is None else self._samples(self.samples)

    def _samples(self, samples: SampleRecording) -> Iterator[Sample]:
        for sample in samples:
            self.done += 1
            yield sample

    def _packets(self) -> Iterator[Packet]:
        found_any = used = False
        for packet in read_packets(self.path, report=self.report, progress=partial(setattr, self, "done")):
            found_any = True
            if self.foot is None or packet.site.foot in (None, self.foot):
                used = True
                yield packet
        if not found_any:
            self.report(f"{printable(str(self.path))}: holds no packets")
        elif self.foot is not None and not used:
            raise RecordingError(self.path, f"holds no packets of the {self.foot.value} foot")


def open_source(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> Source:
    """Return the recording at `path`: samples when its name ends in .npz or .csv, packets otherwise.

    `foot`: the foot of a recording of one foot's samples (the right one when None); of any other, the only foot to use.
    RecordingError when nothing in it can be used."""
    path = Path(path)
    if path.suffix.lower() in SAMPLE_FILES:
        from .samples import load_samples  # imports numpy, which packets do not need

        samples = load_samples(path, foot, report=report)
        return Source(path, foot, report, total=len(samples), samples=samples)
    open_file(path).close()
    return Source(path, foot, report, total=path.stat().st_size)


def read_samples(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> Iterator[Sample]:
    """Return an iterator over the samples in an .npz or .csv file, merged over the feet by time.

    `foot`: the foot of a file of one foot (the right one when None); of a file that names its feet, the only foot to
    read. RecordingError where a row cannot be used, after everything before it, or when nothing can."""
    from .samples import load_samples

    return iter(load_samples(path, foot, report=report))
