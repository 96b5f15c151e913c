"""Reading of a file of samples as one stream, with both feet in order of time."""

from __future__ import annotations

import heapq
import re
from collections.abc import Iterator, Sequence
from operator import attrgetter
from pathlib import Path

import numpy as np
from attrs import frozen

from ...types import Foot, Sample
from ..bad_rows import MAX_NAMED, BadRows
from ..errors import RecordingError, Report, warn
from .npz import read_npz
from .sheet import read_csv
from .table import FootTable, check_units, remove_bad_rows

NAMED_LEFT = re.compile(r"^left(?![a-z])|(?<![a-z])left$", re.IGNORECASE)
"""Pattern of the name of a file of the left foot alone, as left.csv and walk-left.csv."""


@frozen
class SampleRecording:
    """The samples of a file without the rows that cannot be used, which `bad_rows` counts.

    Iterating gives the samples of all feet in order of time, the left foot first at equal times."""

    path: Path
    tables: tuple[FootTable, ...]
    bad_rows: BadRows

    def __len__(self) -> int:
        return sum(map(len, self.tables))

    def __iter__(self) -> Iterator[Sample]:
        return heapq.merge(*(table.make_samples() for table in self.tables), key=attrgetter("t"))


def load_samples(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> SampleRecording:
    """Return the samples in an .npz or .csv file, all read into memory.

    `foot`: for samples that name no foot, the foot that wore the sensor (None: the left foot if the name of the file
    starts or ends with the word "left", else the right one); else the only foot to read (None: both). `report` receives
    one sentence about an incomplete last line, and about each of the first rows that are left out. RecordingError when
    nothing can be used, or if most rows cannot."""
    path = Path(path)
    one_foot = foot or (Foot.LEFT if NAMED_LEFT.search(path.stem) else Foot.RIGHT)
    bad_rows = BadRows(path, report, "row")
    match path.suffix.lower():
        case ".npz":
            tables = read_npz(path, one_foot)
        case ".csv":
            tables = read_csv(path, one_foot, bad_rows)
        case _:
            raise RecordingError(path, "is neither .npz nor .csv, so it holds no samples")
    if not tables:
        bad_rows.finish()
        raise RecordingError(path, "holds no samples")
    return use_tables(path, tables, foot, bad_rows)


def use_tables(path: Path, tables: Sequence[FootTable], foot: Foot | None, bad_rows: BadRows) -> SampleRecording:
    """Return the tables of `foot` (None: all) without bad rows, as a recording; RecordingError if they are unusable."""
    used_tables = [table for table in tables if foot in (None, table.foot)]
    if not used_tables and foot is not None:
        raise RecordingError(path, f"holds nothing of the {foot.value} foot")
    _remove_bad_rows(used_tables, bad_rows)
    for table in used_tables:
        check_units(table)
    return SampleRecording(path, tuple(used_tables), bad_rows)


def _remove_bad_rows(tables: Sequence[FootTable], bad_rows: BadRows) -> None:
    """Remove the rows that cannot be used from the tables and report them, a row of both feet once."""
    total = max(map(len, tables))
    faults = [remove_bad_rows(table) for table in tables]
    numbers = np.unique(np.concatenate([fault.numbers for fault in faults]))
    named = {number: (where, what) for fault in faults for number, where, what in fault.named}
    for number in sorted(named)[:MAX_NAMED]:
        bad_rows.add(*named[number])
    bad_rows.add_many(len(numbers) - min(len(named), MAX_NAMED))
    bad_rows.good = total - len(numbers)
    bad_rows.finish()
