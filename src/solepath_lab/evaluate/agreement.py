"""How far reported times, shares and lengths of gait cycles agree with references: bias, limits, ICC(2,1).

    solepath-lab agreement DIR [--only NAME] [--processes N]

prints a table as Markdown, of the default recipe; docs/accuracy.md has most rows. A cycle of the reference goes from
contact to contact; it is compared with the gait cycle that ends at most 400 ms from it, unless that is degraded. Double
support is the sum of the times from this foot's contact to the other's toe-off, and from the other's contact to this
foot's toe-off. The references differ in what they call a contact: labels by hand (ipol), a light barrier (tripod),
switches (marpino), the vendor's program (moticon), force (gaitpdb)."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

from solepath.cli.common.processes import run_jobs
from solepath.recipes import DEFAULT
from solepath.types import OTHER
from solepath.validate.agreement import NoMatch, PairCells, WalkComparison, compare_walk
from solepath.validate.truth_table import Kind, TrueRow

from ..tables import markdown
from .datasets import DataSet
from .insoles import force_sensors, switches
from .jobs import find_data_sets, recordings
from .run import RecordingRun, RunSettings, truth_of
from .run import run as run_recording
from .timing import CONTACTS, LONGEST_STRIDE_TIME, Contacts, FeetContacts

Runner = Callable[[Path, RunSettings], RecordingRun]
RUNNERS: dict[str, Runner] = {
    "ipol_10m_uturn": run_recording,
    "tripod_treadmill": run_recording,
    "marpino_heel_toe": partial(run_recording, without_pressure=True),
    "marpino_pressed": partial(run_recording, calibration=switches()),
    "moticon_pressed": run_recording,
    "gaitpdb_vgrf": partial(run_recording, calibration=force_sensors()),
}
"""How the recordings are run of each data set whose reference has both contacts of a foot."""
UNITS = {"_s": ("ms", "ms", 1e3, 0), "_m": ("cm", "cm", 1e2, 1), "_share": ("%", "points", 1e2, 1)}
"""Unit, that of a difference, factor and digits in the table, by the ending of a parameter."""
HEADER = ["data", "parameter", "cycles", "mean of the truth", "bias", "95 % limits of agreement", "ICC(2,1)"]


def true_rows(name: str, feet: FeetContacts) -> Iterator[TrueRow]:
    """Yield the cycles of both feet from contact to contact."""
    for foot, own in feet.items():
        other = feet.get(OTHER[foot], Contacts([], []))
        for start, end in pairwise(own.strikes):
            off, their_off, their_strike = [
                next((t for t in times if start < t < end), None) for times in (own.offs, other.offs, other.strikes)
            ]
            if off is None or end - start > LONGEST_STRIDE_TIME:
                continue
            values = {"stride_time_s": end - start, "stance_time_s": off - start, "swing_time_s": end - off}
            if their_off is not None and their_strike is not None and their_off < their_strike < off:
                values["double_support_share"] = (their_off - start + off - their_strike) / (end - start)
            if start in own.lengths:
                values["stride_length_m"] = own.lengths[start]
            yield TrueRow(Kind.STRIDE, name, foot, {}, False, start, end, values=values)


def compare(job: tuple[str, Path]) -> list[PairCells]:
    """Return the pairs of values of a recording of a data set; none if no cycle was found."""
    name, path = job
    rows = [*true_rows(path.stem, CONTACTS[path.parent.name](truth_of(path)))]
    found = RUNNERS[name](path, RunSettings(DEFAULT)).walk
    with suppress(NoMatch):
        return compare_walk(rows, found, path.stem, start=0.0)
    return []


def table_rows(name: str, agreement: Any) -> Iterator[list[str]]:
    """Yield the rows of the table of a data set, without what a finding withholds in all of it."""
    for one in agreement[agreement.n > 0].itertuples():
        known = next(known for ending, known in UNITS.items() if one.parameter.endswith(ending))
        unit, difference, factor, digits = known
        truth, bias, lower, upper = [
            f"{factor * value:.{digits}f}" for value in (one.truth, one.bias, one.lower, one.upper)
        ]
        label = one.parameter.rpartition("_")[0].replace("_", " ")
        values = [f"{truth} {unit}", f"{bias} {difference}", f"{lower} to {upper} {difference}", f"{one.icc:.2f}"]
        yield [f"`{name}`", label, str(one.n), *values]


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    data_sets: list[DataSet] = [
        one for one in find_data_sets(options.dir, options.only or [*RUNNERS]) if one.name in RUNNERS
    ]
    jobs = [(one.name, path) for one in data_sets for path, _ in recordings(options.dir, one)]
    found = [*run_jobs(compare, jobs, processes=options.processes)]
    rows: list[list[str]] = []
    for one in data_sets:
        pairs = WalkComparison.of(
            [cells for (name, _), part in zip(jobs, found, strict=True) if name == one.name for cells in part]
        )
        means = pairs.pairs.groupby("parameter", sort=False)["true"].mean()
        rows += table_rows(one.name, pairs.agreement.assign(truth=[*means]))
    print("\n".join(markdown.table(HEADER, rows, left=2)))
    return 0
