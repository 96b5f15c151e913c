"""`solepath validate TRUTH FILE...`: compares recordings with what a reference system measured."""

from __future__ import annotations

import re
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..recording import printable
from .common.closest import closest
from .common.failure import Failure, note, parse_number, parse_positive, require
from .common.files import REPORT, TRACK_KINDS, Kind, OutputFile, add_force, check_outputs, write_json
from .common.inputs import (
    Recording,
    add_calibration,
    add_heading,
    calibration_of,
    check_pressure,
    recipe_option,
    recipes_of,
)
from .common.own_devices import drivers_of
from .common.parser import command, option
from .common.processes import add_processes, run_jobs
from .common.sentences import sentences_of
from .common.tables import source_named, table_options

if TYPE_CHECKING:
    from ..validate.agreement import PairCells
    from ..validate.truth_table import TrueRow

FAILED_STATUS = 1
"""Exit status when a recording could not be compared."""
NUMBER = re.compile(r"-?\d+[.,]\d+")
"""A number that is measured rather than a name or a count."""
Job = tuple[Namespace, str, "list[TrueRow]"]
"""Options with the files of a recording, its name, and the rows of its truth."""


def run(options: Namespace) -> int:
    """Compare all recordings; return 1 if one could not be compared, else 0."""
    require("validate needs", "validate", "pingouin")
    from ..show.tables.progress import progress_bar
    from ..show.tables.table import table
    from ..validate.agreement import WalkComparison, rows_by_walk
    from ..validate.agreement_files import HEADER, agreement_cells, agreement_writers
    from ..validate.truth_table import read_truth
    from .common.loop import stop_signals_raise
    from .common.run_file import made_by

    outputs = _outputs(options)
    truth = read_truth(options.truth, rate=options.truth_rate, offset=options.offset)
    files = _recordings(options.files)
    rows = rows_by_walk(truth, [*files])
    if without := files.keys() - rows.keys():
        note(f"the truth has no row of {printable(', '.join(sorted(without)))}")
    for sentence in _left_out(truth, rows):
        note(printable(sentence))
    jobs: list[Job] = [(Namespace(**vars(options) | {"files": files[name]}), name, of) for name, of in rows.items()]
    with stop_signals_raise(), progress_bar(options.truth.name, len(jobs)) as show:
        found = run_jobs(compare, jobs, processes=options.processes, progress=lambda done, _: show(done))
        results = [*found]
    reasons = [one for one in results if isinstance(one, str)]
    for reason in reasons:
        note(reason)
    cells = [pair for one in results if not isinstance(one, str) for pair in one]
    if not cells:
        raise Failure("no recording could be compared")
    comparison = WalkComparison.of(cells)
    for sentence in comparison.unit_warnings:
        note(sentence)
    groups = agreement_cells(comparison.groups)
    print(table(HEADER, [*agreement_cells(comparison.agreement), *([[], *groups] if groups else [])]))
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        made = made_by(recipes_of(options)[0], options)
        for name, write in agreement_writers(comparison, made).items():
            outputs[name].replace(write)
        write_json(outputs["run.json"], made)
        print(f"written to {printable(str(options.out))}")
    return FAILED_STATUS if reasons else 0


def _outputs(options: Namespace) -> dict[str, OutputFile]:
    kinds = {
        "agreement.csv": Kind(rb"\Aparameter,n,bias,lower,"),
        "agreement_groups.csv": Kind(rb"\Aby,group,parameter,n,"),
        "pairs.csv": Kind(rb"\Arecording,foot,parameter,true,"),
        "agreement.html": REPORT,
        "run.json": TRACK_KINDS["run.json"],
    }
    outputs = (
        {} if options.out is None else {name: OutputFile(options.out / name, kind) for name, kind in kinds.items()}
    )
    check_outputs(options, [*outputs.values()])
    return outputs


def _recordings(files: Sequence[Path]) -> dict[str, list[Path]]:
    """Return the files of each recording by its name: of samples, those of both feet are one recording."""
    from ..validate.agreement import by_key
    from ..validate.truth_table import foot_named, recording_name

    found = by_key(files, recording_name)
    for name, of in found.items():
        if len({*map(foot_named, of)}) < len(of):
            raise Failure(f"{of[0]} and {of[1]} are both of the recording {printable(name)}: rename one")
    return found


def _left_out(truth: Sequence[TrueRow], rows: Mapping[str, Sequence[TrueRow]]) -> Iterator[str]:
    """Yield sentences on what of a truth is compared with nothing: rows of other recordings, and unknown columns."""
    from ..show.tables.table import counted
    from ..validate.truth_table import FIGURES

    used = {id(row) for of in rows.values() for row in of}
    for recording, count in Counter([row.recording for row in truth if id(row) not in used]).items():
        what = f"are of {recording}, of which there is no file" if recording else "name no recording"
        yield f"{counted(count, 'row')} of the truth {what}"
    for column in dict.fromkeys([column for row in truth for column in row.groups]):
        if any([NUMBER.fullmatch(row.groups.get(column, "")) for row in truth]):
            meant = closest(column, FIGURES)
            hint = "" if meant is None else f": did you mean {meant}?"
            yield f"the column {column} has numbers, and none of the known names, so that it is a group{hint}"


def compare(job: Job) -> list[PairCells] | str:
    """Return the pairs of one recording, or why there are none."""
    from ..link.kinds import make_kinds
    from ..session import Session
    from ..show.findings import findings
    from ..validate.agreement import compare_walk
    from ..walk.walk import Walk

    options, name, rows = job
    try:
        drivers = drivers_of(options)
        session = Session(recipes_of(options)[0], calibration=calibration_of(options), losses=True, profiles=drivers)
        source = source_named(options)
        check_pressure(recipes_of(options)[0], source, drivers)
        walk, recording = Walk(limit=None, keeps_all=True, kinds=make_kinds(drivers)), Recording(source)
        start: float | None = None
        for item in recording:
            start = item.t if start is None else start
            walk.take(item, session.feed(item))
        if recording.failure is not None:
            raise recording.failure
        walk.take(None, session.finish())
        for one in findings(walk):
            if one.act:
                note(f"{printable(name)}: {one.text}")
        return compare_walk(rows, walk, name, start=start or 0.0, tolerance=options.tolerance)
    except Exception as error:
        if not (sentences := sentences_of(error)):
            raise
        return "; ".join(sentences)


def _parse_offset(text: str) -> float:
    return parse_number("a number of seconds", -1e12, 1e12, text)


add_validate = command(
    "validate",
    "Compare recordings with a table of what a reference system measured: events, strides, or parameters of a walk. "
    "Prints bias, 95 % limits of agreement and ICC(2,1) of each parameter, by foot and by each other column of the "
    "table. Needs the extra validate.",
    "solepath validate truth.csv S01.csv S02.csv --out agreement",
    option(
        "truth",
        metavar="TRUTH",
        type=Path,
        help="events, strides or parameters, or a list of gaitmap or mobgap (docs/researcher.md)",
    ),
    table_options(),
    recipe_option(),
    add_heading,
    add_calibration,
    option(
        "--tolerance",
        metavar="S",
        type=parse_positive,
        help="largest time between what is matched (default: 0.25 for events, 0.4 for the ends of strides)",
    ),
    option("--offset", metavar="S", type=_parse_offset, default=0.0, help="seconds to add to the times of the truth"),
    option("--truth-rate", metavar="HZ", type=parse_positive, help="samples a second of a truth of gaitmap or mobgap"),
    add_processes,
    option(
        "--out",
        metavar="DIR",
        type=Path,
        help="write agreement.csv, agreement_groups.csv, pairs.csv, run.json, and agreement.html with the pictures",
    ),
    add_force,
    run=run,
)
