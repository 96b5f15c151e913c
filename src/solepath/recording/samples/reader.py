"""A file of samples as one stream: the feet merged by time."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from operator import attrgetter, itemgetter
from pathlib import Path

from attrs import frozen

from ...types import Foot, Sample
from ..errors import RecordingError, Report, warn
from .npz import read_npz
from .sheet import read_csv
from .table import FootTable, check_table

KINDS = (".npz", ".csv")
"""Endings of the names of files that hold samples."""


@frozen
class SampleRecording:
    """A file of samples that was read and found usable, at least in its first rows.

    Iterating gives the samples of all its feet in the order of their times (the left foot first where times are equal)
    and, where a row cannot be used, RecordingError after everything that came before that row."""

    path: Path
    tables: tuple[FootTable, ...]
    flaw: RecordingError | None = None
    """Reason why the file could not be read beyond its last row here; None at the end of the file."""

    def __len__(self) -> int:
        return sum(map(len, self.tables))

    def __iter__(self) -> Iterator[Sample]:
        samples = heapq.merge(*(table.samples() for table in self.tables), key=attrgetter("t"))
        ends = [(float(table.t[-1]), table.flaw) for table in self.tables if table.flaw is not None]
        if not ends:
            yield from samples
            if self.flaw is not None:
                raise self.flaw
            return
        last, flaw = min(ends, key=itemgetter(0))
        for sample in samples:
            if sample.t > last:
                break
            yield sample
        raise flaw


def load_samples(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> SampleRecording:
    """Return the samples in an .npz or .csv file, all read into memory.

    `foot`: the foot of a file of one foot (the right one when None); of a file that names its feet, the only foot to
    read. `report` gets one sentence about a last line that was cut off. RecordingError when nothing can be used."""
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise RecordingError(path, f"is neither {' nor '.join(KINDS)}, so it holds no samples")
    one_foot = foot or Foot.RIGHT
    if kind == ".npz":
        tables, flaw = read_npz(path, one_foot), None
    else:
        tables, flaw = read_csv(path, one_foot, report)
    expected = [table for table in tables if foot in (None, table.foot)]
    if not tables:
        raise flaw or RecordingError(path, "holds no samples")
    if not expected and foot is not None:
        raise RecordingError(path, f"holds nothing of the {foot.value} foot")
    return SampleRecording(path, tuple(check_table(table) for table in expected), flaw)
