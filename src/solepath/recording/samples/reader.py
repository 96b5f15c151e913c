"""Reading of files of samples as one stream, with both feet in order of time."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from datetime import UTC, datetime
from fnmatch import fnmatchcase
from math import isnan
from operator import attrgetter
from pathlib import Path
from typing import Any

from attrs import evolve, frozen

from ...types import Foot, Sample
from ...types.doubles import doubles
from ..bad_rows import BadRows
from ..errors import RecordingError, Report, UnusableValues, printable, warn
from ..mapping.mapping import MEASURED, TableMapping
from ..mapping.words import foot_of_text
from ..unpacking import content_name
from .columns import TableColumns, find_columns
from .guess import UnknownTable, guess_mapping, merge_guesses
from .join import join_files
from .mixed import find_mixture, repair_mixture
from .numbers import choose_values, fill_tables, read_rows
from .plausible import list_unit_problems
from .sheet import open_sheet
from .table import FootTable, remove_bad_rows

SINCE_1970 = 1e8
"""Time above which times of another format are counted from 1970, s: no recording lasts three years."""
EPOCH_TICKS = 1e6
"""Parts of a second that times since 1970 can hold: 0.24 us is the resolution of such a number."""


@frozen
class SampleRecording:
    """The samples of one or more files without the rows that cannot be used, which `bad_rows` counts.

    Iterating gives the samples of all feet in order of time, the left foot first at equal times."""

    path: Path
    """Path of the first file."""
    tables: tuple[FootTable, ...]
    bad_rows: BadRows
    start_time: datetime | None = None
    """Moment of time 0, UTC, if the files have times since 1970 that are counted from the first one."""
    left_out: tuple[str, ...] = ()
    """Sentences on the sensors that are broken and were left out."""

    def __len__(self) -> int:
        return sum(map(len, self.tables))

    def __iter__(self) -> Iterator[Sample]:
        return heapq.merge(*(table.make_samples() for table in self.tables), key=attrgetter("t"))


def load_samples(
    files: Path | str | Sequence[Path | str],
    foot: Foot | Sequence[Foot] | None = None,
    *,
    mapping: TableMapping | None = None,
    report: Report = warn,
) -> SampleRecording:
    """Return the samples in a file, or in the files of both feet or of several sensors, all read into memory.

    `foot`: for samples that name no foot, the foot that wore the sensor (None: what the name of the file says; else the
    right foot for one file, and an error for the files of both feet); else the only foot to read (None: both). A
    sequence has the foot of each file. `mapping`: what columns mean, as far as the files do not say it. `report`
    receives one sentence about an incomplete last line, and about each of the first rows that are left out.
    RecordingError, with all that is wrong, when something cannot be used."""
    paths = [Path(file) for file in ([files] if isinstance(files, str | Path) else files)]
    for number, path in enumerate(paths):
        if path.resolve() in [earlier.resolve() for earlier in paths[:number]]:
            raise RecordingError(path, "is given twice")
    mapping = mapping or TableMapping()
    feet: list[Foot | None] = list(_feet_of_files(paths, mapping.feet))
    only = foot if isinstance(foot, Foot) else None
    if foot is not None and (only is None or len(paths) == 1):
        feet = [foot] if isinstance(foot, Foot) else list(foot)
        if len(feet) != len(paths):
            raise ValueError(f"there are {len(feet)} feet for {len(paths)} files")
    files_read = [SampleFile(path, one, mapping) for path, one in zip(paths, feet, strict=True)]
    return load_files(files_read, only, report)


@frozen
class SampleFile:
    """A file of samples, and what is known of it."""

    path: Path
    foot: Foot | None
    """Foot of samples that name none."""
    mapping: TableMapping
    names: Sequence[str] = ()
    """Names of the columns, if another file has them; a row without a whole inertial quantity is then no sample."""
    units: Sequence[str] = ()
    """Units of these columns."""
    delay: float = 0.0
    """Time to add to those of the file, s."""


def load_files(files: Sequence[SampleFile], only: Foot | None, report: Report) -> SampleRecording:
    """Return the samples of the foot `only` (None: of both) in some files; RecordingError with all that is wrong."""
    paths = [file.path for file in files]
    total = BadRows(paths[0], report, "row")
    problems: list[RecordingError] = []
    tables: list[FootTable] = []
    headers, guessed = list[TableColumns](), list[TableColumns]()
    for file in files:
        bad_rows = BadRows(file.path, report, "row")
        try:
            tables += _clean(_read_file(file, bad_rows, headers, is_alone=len(files) == 1), only, bad_rows)
        except RecordingError as error:
            problems += error.problems
            guessed += [error.found] if isinstance(error, UnknownTable) and error.found is not None else []
        total.count, total.good = total.count + bad_rows.count, total.good + bad_rows.good
    found_keys = {key for found in headers for key in found.found_keys}
    for found in headers:
        problems += found.list_problems(set() if found.is_empty else found.elsewhere & found_keys)
    unnamed = {
        found.header.path: found.quantities
        for found in [*guessed, *headers]
        if any(table.is_assumed for table in found.feet)
    }
    if not tables and not problems and only is not None:
        problems.append(RecordingError(paths[0], f"holds nothing of the {only.value} foot"))
    example = _name_feet(paths, unnamed, problems)
    wrong, left_out = list_unit_problems(tables)
    problems += wrong
    for sentence in left_out:
        report(sentence)
    tables = [table for table in tables if table.columns]
    start_time = _count_from_start(tables)
    joined = [] if problems else join_files(tables, problems)
    if problems:
        raise RecordingError.of(merge_guesses(problems, example))
    if not any(map(len, joined)):
        raise RecordingError(paths[0], "holds no samples")
    return SampleRecording(paths[0], tuple(joined), total, start_time, tuple(left_out))


def _feet_of_files(paths: Sequence[Path], patterns: Mapping[str, str]) -> Iterator[Foot | None]:
    """Yield the foot that the name of each file says, or the name of its folder if the files are in different ones."""
    use_folders = len({path.parent for path in paths}) > 1
    for path in paths:
        matching = [Foot(foot) for foot, pattern in patterns.items() if fnmatchcase(path.name, pattern)]
        foot = matching[0] if len(matching) == 1 else foot_of_text(Path(content_name(path)).stem)
        yield foot_of_text(path.parent.name) if foot is None and use_folders else foot


def _read_file(file: SampleFile, bad_rows: BadRows, headers: list[TableColumns], *, is_alone: bool) -> list[FootTable]:
    """Return the tables of the feet in one file, of which only the cells were read; its columns go to `headers`.

    There are none for a sheet whose columns have faults."""
    path, mapping = file.path, file.mapping
    if Path(content_name(path)).suffix.lower() == ".npz":
        from .npz import check_lengths, open_npz  # imports numpy, which text does not need

        layout, mapping, columns = open_npz(path, mapping)
        sheet: Any = nullcontext((layout, iter(())))
    else:
        sheet, columns = open_sheet(path, mapping), {}
    with sheet as (layout, rows):
        if file.names:
            if len(layout.names) != len(file.names):
                raise RecordingError(path, f"has {len(layout.names)} columns, and {len(file.names)} are described")
            layout = evolve(layout, names=file.names, units=file.units)
        found = find_columns(layout, mapping, file.foot, is_alone=is_alone)
        if not found.feet and not found.faults:
            raise guess_mapping(layout, rows, mapping, file.foot)
        headers.append(found)
        if found.is_empty or found.list_problems(found.elsewhere):
            return []
        if columns:
            columns = choose_values(found, columns) if found.chosen else columns
            tables = fill_tables(found, columns, check_lengths(found, columns), None)
        else:
            tables = read_rows(rows, found, bad_rows)
    for table in tables if file.names else ():
        inertial = [zip(*columns, strict=True) for q, columns in table.columns.items() if q != "pressure"]
        table.select([any(not any(map(isnan, vector)) for vector in row) for row in zip(*inertial, strict=True)])
        table.t = doubles([t + file.delay for t in table.t])
    if not file.names:
        for table in tables:
            if (mixture := find_mixture(table)) is not None:
                repair = ""
                if not columns and path.is_file():  # a pipe cannot be read again
                    with open_sheet(path, mapping) as (_, again):
                        repair = repair_mixture(found, list(again), mixture)
                raise UnusableValues(path, mixture.what, table.names["t"], repair)
    for flaw in [] if found.export is None else found.export.list_flaws(layout):
        bad_rows.report(f"{printable(str(path))}: {flaw}")
    if not any(map(len, tables)):
        bad_rows.finish()
        raise RecordingError(path, "holds no samples")
    return tables


def _name_feet(paths: Sequence[Path], unnamed: dict[Path, set[str]], problems: list[RecordingError]) -> str:
    """Add a problem for files that do not say which foot they are of, if they cannot all be of one foot.

    `unnamed` has the quantities of each such file. The option that names the feet is returned; "" if none is needed."""
    quantities = [quantity for its_quantities in unnamed.values() for quantity in its_quantities & set(MEASURED)]
    if not unnamed or len(paths) == 1 or (len(unnamed) == len(paths) and len(set(quantities)) == len(quantities)):
        return ""
    feet = [[*Foot][k * 2 // len(paths)] for k in range(len(paths))]
    option = f"--foot {','.join([foot.value for foot in feet])}"
    in_python = ", ".join([f"Foot.{foot.name}" for foot in feet])
    repair = f"name the feet in the order of the files: {option}, or in Python read_samples(files, [{in_python}])"
    problems += [
        RecordingError(path, "nothing says of which foot it is", repair=repair) for path in paths if path in unnamed
    ]
    return option


def _count_from_start(tables: Sequence[FootTable]) -> datetime | None:
    """Subtract the first time of all from times since 1970, and return that moment; None for any other times."""
    start = min((table.t[0] for table in tables), default=0.0)
    if any(table.is_own for table in tables) or not start > SINCE_1970:
        return None
    for table in tables:
        table.t = doubles([round((t - start) * EPOCH_TICKS) / EPOCH_TICKS for t in table.t])
    with suppress(OverflowError, OSError, ValueError):
        return datetime.fromtimestamp(start, UTC)
    return None


def _clean(tables: Sequence[FootTable], only: Foot | None, bad_rows: BadRows) -> list[FootTable]:
    """Return the tables of `only` (None: all) without the rows that cannot be used.

    A row of both feet is reported once. RecordingError for a table that is left with too few rows."""
    used = [table for table in tables if only in (None, table.foot)]
    if used:
        total = max(map(len, used))
        faults = {number: (where, what) for table in used for number, where, what in remove_bad_rows(table)}
        bad_rows.good = total - len(faults)
        for number in sorted(faults):
            bad_rows.add(*faults[number])
        bad_rows.finish()
    return [table for table in used if len(table)]
