"""All cases of the golden corpus, by the part that a test file checks, and which of them differ from the tables."""

from __future__ import annotations

from functools import cache

from body_cases import BODY
from cases import DEVICES, FAULTS, PLACES, RECIPES, recorded
from corpus import Case, Rows, read_table, rows_of, this_platform
from kept import kept
from paper_cases import PAPERS
from part_cases import PARTS_ALONE
from place_cases import MORE_PLACES
from recording_cases import RECORDINGS

PARTS: dict[str, tuple[Case, ...]] = {
    "devices": DEVICES,
    "faults": FAULTS,
    "recipes": RECIPES,
    "papers": PAPERS,
    "body": (*BODY, *PARTS_ALONE),
    "places": PLACES,
    "plans": MORE_PLACES,
    "recordings": RECORDINGS,
}


@cache
def all_cases() -> dict[str, Case]:
    """Return every case by its name, the long ones first, since several are computed at a time."""
    order = ("plans", "places", "recipes", "devices", "recordings", "body", "faults", "papers")
    parts = [case for name in order for case in PARTS[name]]
    cases = [*parts, *recorded()]
    named = {case.name: case for case in cases}
    assert len(named) == len(cases), "two cases have one name"
    return named


@kept
def kept_rows(name: str) -> Rows:
    """Return the rows of a case, which only code and files of this project can change."""
    return rows_of(all_cases()[name])


def rows_by_name(name: str) -> Rows:
    """Return the rows of a case; of recorded data anew, else once a run, by a test or by `.ci/golden`."""
    case = all_cases()[name]
    return rows_of(case) if case.recorded else kept_rows(name)


@cache
def table_of(recorded: bool) -> tuple[str, dict[str, Rows]]:
    """Return a table, read once a process."""
    return read_table(recorded)


def differences(case: Case) -> list[str]:
    """Return the kinds of events of a case that are not as in its table.

    Where the platform is not the table's, only the numbers of events are compared: values may differ in their last bits
    there (contract 7), and `.ci/golden check` compares them with those of the older code."""
    platform, table = table_of(case.recorded)
    before, now = table[case.name], rows_by_name(case.name)
    compared = slice(None) if platform == this_platform() else slice(1)
    return [kind for kind in {**before, **now} if before.get(kind, ())[compared] != now.get(kind, ())[compared]]
