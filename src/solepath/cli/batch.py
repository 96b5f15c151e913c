"""`solepath batch TABLE`: runs the recordings of a study as `track` does, and joins their tables.

What each recording gave stays in DIR/recordings, in a folder whose name ends with a hash of its files, recipe, options
and version. It is made under another name and moved when it is whole, so that what has this name is done."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
from argparse import Namespace
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from itertools import pairwise
from pathlib import Path
from typing import Any

from ..recording import printable
from ..saving.lock import locked
from . import track
from .common.failure import Failure, note, require
from .common.files import TRACK_KINDS, Kind, OutputFile, add_force, check_outputs, write_json
from .common.inputs import add_calibration, add_heading, recipe_option, recipes_of
from .common.outcomes import add_test
from .common.parser import Parser, command, option
from .common.processes import add_processes, run_jobs
from .common.sentences import sentences_of
from .common.tables import mapping_options

RECORDINGS, WHOLE_LATER = "recordings", ".part-"
"""Folder of what the recordings gave, and start of the names of folders in it that are not whole."""
FAILED_STATUS = 1
"""Exit status when a recording failed."""
MAX_SENTENCES = 10
"""Largest number of failures that are printed; failures.csv has all of them."""
UNITS = {"": "", "s": "_s", "m": "_m", "m/s": "_m_per_s", "1/min": "_per_min"}
"""Ends of the columns of outcomes.csv, by unit."""
TEXTS = ("foot", "flaws", "implausible", "findings", "reason")
"""Columns of words; all others of the results have numbers."""
KINDS = {
    ".csv": Kind(rb"\A[^\n]*\bfile\b[^\n]*,(flaws|steady|implausible|findings|reason)\n"),
    ".parquet": Kind(rb"\APAR1"),
}
"""Tables of a study: columns of one's own, then those of the results, with the last column of each table."""
MAX_STEM, HASH_LENGTH = 60, 16
"""Largest number of characters of a file's name, and number of digits of the hash, in the name of a folder."""
Line = tuple[Mapping[str, str], Path]
"""Cells of a line of the table, and the folder of its results."""


def run(options: Namespace) -> int:
    """Run the recordings that are not done, and write the tables; return 1 if a recording failed, else 0."""
    from concurrent.futures.process import BrokenProcessPool
    from hashlib import sha256

    from ..recording.text_table import read_rows
    from ..show.tables.progress import progress_bar
    from ..show.tables.table import counted
    from .common.loop import stop_signals_raise
    from .common.run_file import made_by

    if options.parquet:
        require("--parquet needs", "tables", "pyarrow")
    rows, recipe = [row.cells for row in read_rows(options.table, ("file",))], recipes_of(options)[0]
    outputs = _outputs(options, rows)
    named = [[one.strip() for one in row["file"].split(";") if one.strip()] for row in rows]
    of_rows = [_as_track(options, [options.table.parent / name for name in names]) for names in named]
    options.files = [*dict.fromkeys([file for one in of_rows for file in one.files])]
    check_outputs(options, [*outputs.values()])
    parts = options.out / RECORDINGS
    for one in of_rows:
        digest = sha256(json.dumps(made_by(recipe, one), sort_keys=True).encode()).hexdigest()
        one.out = parts / f"{one.files[0].stem[:MAX_STEM] if one.files else 'none'}-{digest[:HASH_LENGTH]}"
    jobs = [*{one.out: one for one in of_rows}.values()]
    parts.mkdir(parents=True, exist_ok=True)
    (parts / ".lock").touch()
    try:
        with stop_signals_raise(), locked(parts / ".lock"), progress_bar(options.table.name, len(jobs)) as show:
            for left in parts.glob(f"{WHOLE_LATER}*"):
                shutil.rmtree(left)
            new = [one for one in jobs if not one.out.exists()]
            before = len(jobs) - len(new)
            show(before)
            reasons = run_jobs(
                run_recording, new, processes=options.processes, progress=lambda done, _: show(before + done)
            )
            failed = {one.out: reason for one, reason in zip(new, reasons, strict=True) if reason}
            lines = [(row, one.out) for row, one in zip(rows, of_rows, strict=True)]
            _write(options, lines, failed, outputs, made_by(recipe, options))
    except BlockingIOError:
        raise Failure(f"{options.out}: another batch is writing into it") from None
    except BrokenProcessPool:
        what = "the system ended a process, perhaps for want of memory"
        raise Failure(f"{what}: the same command goes on from here, with --processes 1 if need be") from None
    for reason in [*failed.values()][:MAX_SENTENCES]:
        note(reason)
    count = len([folder for _, folder in lines if folder in failed])
    counts = f"{len(rows) - count} done ({len(new)} run now), {count} failed"
    print(f"{counted(len(rows), 'recording')}: {counts}; written to {printable(str(options.out))}")
    return FAILED_STATUS if failed else 0


def _as_track(options: Namespace, files: list[Path]) -> Namespace:
    """Return the options of `track` for the files of one recording."""
    top = Parser(prog="solepath")
    track.add_track(top.add_subparsers(dest="command", parser_class=Parser), "")
    known = vars(top.parse_args(["track", "-", "--outcomes"]))
    return Namespace(**{name: getattr(options, name, value) for name, value in known.items()} | {"files": files})


def run_recording(options: Namespace) -> str:
    """Write the results of one recording to the folder of --out; return why there are none, or "" when there are."""
    folder = options.out
    part = folder.with_name(f"{WHOLE_LATER}{os.urandom(8).hex()}")
    try:
        if not options.files:
            raise Failure("the column file is empty")
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            track.run(Namespace(**vars(options) | {"out": part}))
        for name in ("events.jsonl", "track.csv"):  # which are large, and nobody joins
            (part / name).unlink()
        part.rename(folder)
    except Exception as error:
        return "; ".join(sentences_of(error)) or f"{type(error).__name__}: {printable(str(error))}"
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return ""


def _tables() -> dict[str, Sequence[str]]:
    """Return the tables that are joined, with their columns."""
    from ..show.outcomes.files import BOUT_COLUMNS, BOUTS_FILE
    from ..show.output import CYCLE_COLUMNS, GAIT_CYCLES_FILE, STRIDE_COLUMNS, STRIDES_FILE

    return {STRIDES_FILE: STRIDE_COLUMNS, GAIT_CYCLES_FILE: CYCLE_COLUMNS, BOUTS_FILE: BOUT_COLUMNS}


def _outputs(options: Namespace, rows: Sequence[Mapping[str, str]]) -> dict[str, OutputFile]:
    """Return the files by the names that they have as .csv; raise Failure for a study that cannot be run."""
    if not rows:
        raise Failure(f"{options.table}: has no line below the names")
    taken = {column for columns in _tables().values() for column in columns} | {*TEXTS}
    if common := taken.intersection(rows[0]):
        raise Failure(f"{options.table}: has a column {min(common)}, as the results have: give it another name")
    suffix = ".parquet" if options.parquet else ".csv"
    names = [*_tables(), "outcomes.csv", "failures.csv"]
    outputs = {name: OutputFile((options.out / name).with_suffix(suffix), KINDS[suffix]) for name in names}
    return outputs | {"run.json": OutputFile(options.out / "run.json", TRACK_KINDS["run.json"])}


def _write(
    options: Namespace,
    lines: Sequence[Line],
    failed: Mapping[Path, str],
    outputs: Mapping[str, OutputFile],
    made: Mapping[str, Any],
) -> None:
    """Write all tables, and how they came about."""
    from ..show.output import table_writer

    def write(name: str, columns: Iterable[str], rows: Iterable[Sequence[str | None]]) -> None:
        def to(path: Path) -> None:
            with path.open("w", encoding="utf-8", newline="") as file:
                write_row = csv.writer(file).writerow if options.parquet else table_writer(file)
                for row in ([*own, *columns], *rows):
                    write_row(row)
            if options.parquet:
                _to_parquet(path, own, made)

        outputs[name].replace(to)
        earlier = outputs[name].path.with_suffix(".csv" if options.parquet else ".parquet")
        if earlier.is_file() and KINDS[earlier.suffix].is_own(earlier):
            earlier.unlink()

    own, done = [*lines[0][0]], [line for line in lines if line[1] not in failed]
    outcomes = [(row, _outcomes(folder)) for row, folder in done]
    named = ["findings"]
    for _, values in outcomes:  # a recording may lack outcomes that another has: each comes before its next one
        for following, column in pairwise([*values][::-1]):
            if column not in named:
                named.insert(named.index(following), column)
    if common := {*own}.intersection(named):
        raise Failure(f"{options.table}: has a column {min(common)}, as the results have: give it another name")
    for name, columns in _tables().items():
        write(name, columns, _joined(done, name))
    write("outcomes.csv", named, [[*row.values(), *map(values.get, named)] for row, values in outcomes])
    left_out = [[*row.values(), failed[folder]] for row, folder in lines if folder in failed]
    write("failures.csv", ["reason"], left_out)
    write_json(outputs["run.json"], {**made, "recordings": len(lines), "failed": len(left_out)})


def _joined(lines: Iterable[Line], name: str) -> Iterator[list[str]]:
    """Yield the rows of a table of all recordings, after the cells of their lines."""
    for row, folder in lines:
        with (folder / name).open(encoding="utf-8", newline="") as file:
            for cells in [*csv.reader(file)][1:]:
                yield [*row.values(), *cells]


def _outcomes(folder: Path) -> dict[str, str]:
    """Return the outcomes of a recording by column, and the codes of what was found wrong with it."""
    from ..show.outcomes.rows import MOBILITY

    with (folder / "outcomes.csv").open(encoding="utf-8", newline="") as file:
        rows = [*csv.DictReader(file)]
    parts = [re.sub(r"\W", "_", row["part"]) + "_" if row["part"] != MOBILITY else "" for row in rows]
    values = {
        f"{part}{row['outcome']}{UNITS[row['unit']]}": row["value"] for part, row in zip(parts, rows, strict=True)
    }
    found = json.loads((folder / "run.json").read_text("utf-8"))["findings"]
    return values | {"findings": " ".join(dict.fromkeys([one["code"] for one in found]))}


def _to_parquet(path: Path, own: Sequence[str], made: Mapping[str, Any]) -> None:
    """Replace a .csv by a Parquet file; columns of one's own are texts, so that 007 stays 007."""
    import pyarrow
    from pyarrow import csv as arrow_csv
    from pyarrow import parquet

    convert = arrow_csv.ConvertOptions(
        column_types=dict.fromkeys([*own, *TEXTS], pyarrow.string()), null_values=[""], strings_can_be_null=True
    )
    parse = arrow_csv.ParseOptions(newlines_in_values=True)
    table = arrow_csv.read_csv(path, convert_options=convert, parse_options=parse)
    kinds = [one.with_type(pyarrow.float64()) if pyarrow.types.is_null(one.type) else one for one in table.schema]
    parquet.write_table(table.cast(pyarrow.schema(kinds, {"solepath": json.dumps(made)})), path)


add_batch = command(
    "batch",
    "Run the recordings that a table lists, as `track` does, and join their strides, gait cycles, walking bouts and "
    "outcomes. The table has a column `file`, with ; between the files of one recording; all other columns, such as "
    "participant and condition, come back in every result. A recording that fails is a line of failures.csv, and the "
    "exit status is 1. Interrupted, the same command goes on with what is not done.",
    "solepath batch study.csv --out results",
    option("table", metavar="TABLE", type=Path, help="the study; files are found from its folder"),
    recipe_option(),
    add_heading,
    add_calibration,
    add_test,
    mapping_options,
    option("--out", metavar="DIR", type=Path, required=True, help="folder of the results"),
    option("--parquet", action="store_true", help="write .parquet in place of .csv (extra tables)"),
    add_processes,
    add_force,
    run=run,
)
