"""Reading of a file of samples as one stream, with both feet in order of time."""

from __future__ import annotations

import heapq
import re
from collections.abc import Iterator
from operator import attrgetter, itemgetter
from pathlib import Path

from attrs import frozen

from ...types import Foot, Sample
from ..errors import RecordingError, Report, warn
from .npz import read_npz
from .sheet import read_csv
from .table import FootTable, check_table

NAMED_LEFT = re.compile(r"^left(?![a-z])|(?<![a-z])left$", re.IGNORECASE)
"""Pattern of the name of a file of the left foot alone, as left.csv and walk-left.csv."""
SAMPLE_SUFFIXES = (".npz", ".csv")
"""Suffixes of files that hold samples."""


@frozen
class SampleRecording:
    """The samples of a file, of which at least the first rows are usable.

    Iterating gives the samples of all feet in order of time, the left foot first at equal times. A row that cannot be
    used raises RecordingError after all samples before it."""

    path: Path
    tables: tuple[FootTable, ...]
    flaw: RecordingError | None = None
    """Reason why the file could not be read beyond the last row of `tables`; None if it was read to its end."""

    def __len__(self) -> int:
        return sum(map(len, self.tables))

    def __iter__(self) -> Iterator[Sample]:
        samples = heapq.merge(*(table.make_samples() for table in self.tables), key=attrgetter("t"))
        flawed_ends = [(float(table.t[-1]), table.flaw) for table in self.tables if table.flaw is not None]
        if not flawed_ends:
            yield from samples
            if self.flaw is not None:
                raise self.flaw
            return
        last_t, flaw = min(flawed_ends, key=itemgetter(0))
        for sample in samples:
            if sample.t > last_t:
                break
            yield sample
        raise flaw


def load_samples(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> SampleRecording:
    """Return the samples in an .npz or .csv file, all read into memory.

    `foot`: for samples that name no foot, the foot that wore the sensor (None: the left foot if the name of the file
    starts or ends with the word "left", else the right one); else the only foot to read (None: both). `report` receives
    one sentence about an incomplete last line. RecordingError when nothing can be used."""
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SAMPLE_SUFFIXES:
        raise RecordingError(path, f"is neither {' nor '.join(SAMPLE_SUFFIXES)}, so it holds no samples")
    one_foot = foot or (Foot.LEFT if NAMED_LEFT.search(path.stem) else Foot.RIGHT)
    if suffix == ".npz":
        tables, flaw = read_npz(path, one_foot), None
    else:
        tables, flaw = read_csv(path, one_foot, report)
    used_tables = [table for table in tables if foot in (None, table.foot)]
    if not tables:
        raise flaw or RecordingError(path, "holds no samples")
    if not used_tables and foot is not None:
        raise RecordingError(path, f"holds nothing of the {foot.value} foot")
    return SampleRecording(path, tuple(check_table(table) for table in used_tables), flaw)
