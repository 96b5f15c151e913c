"""Defines the options of `solepath track` for clinical outcomes."""

from __future__ import annotations

import argparse
from math import isfinite, nan
from pathlib import Path
from typing import TYPE_CHECKING

from ...recording import printable
from .failure import Failure

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.outcomes.references import Person

MAX_AGE, HEIGHTS, WEIGHTS = 120.0, (50.0, 250.0), (10.0, 400.0)
"""Oldest age, years, and the heights, cm, and weights, kg, that --reference takes; others are slips of the pen."""


def add_outcomes(command: argparse.ArgumentParser) -> None:
    """Add --outcomes, --six-minute-walk, --timed-up-and-go and --reference to a command."""
    command.add_argument(
        "--outcomes",
        action="store_true",
        help="walking bouts and mobility outcomes by the rules of Mobilise-D, variability, asymmetry; with --out also "
        "bouts.csv and outcomes.csv",
    )
    command.add_argument(
        "--six-minute-walk",
        metavar="START",
        nargs="?",
        type=_start,
        default=False,
        help="the six-minute walk from this time of the recording's clock, s (default: from the first step)",
    )
    command.add_argument(
        "--timed-up-and-go",
        metavar="START,STOP",
        help="the timed up and go between two times that an observer marked, s of the recording's clock",
    )
    command.add_argument(
        "--reference",
        metavar="AGE,SEX[,CM,KG]|FILE",
        action="append",
        help="compare with published values of healthy people, as in 72,female,162,68; height and weight are for the "
        "six-minute walk; or, in the report, with the bands of a .json or .csv file; may be given for each",
    )


def has_outcomes(options: argparse.Namespace) -> bool:
    """Return whether any outcome was requested, so that there are bouts.csv and outcomes.csv."""
    return bool(options.outcomes) or options.six_minute_walk is not False or options.timed_up_and_go is not None


def outcomes_of(options: argparse.Namespace) -> OutcomeRequest | None:
    """Return the outcomes that the options name; None without any; raise Failure when one is wrong."""
    if not has_outcomes(options):
        if options.reference and options.report is None:
            raise Failure("--reference goes with --report, --outcomes, --six-minute-walk or --timed-up-and-go")
        return None
    from ...show.outcomes.clinic import OutcomeRequest

    marks, up_and_go = None, options.timed_up_and_go
    if up_and_go is not None:
        first, last = _numbers(up_and_go) if up_and_go.count(",") == 1 else (None, None)
        if first is None or last is None or not first < last:
            raise Failure(f"--timed-up-and-go {printable(up_and_go, 80)} is not START,STOP, as in 12.5,24.1")
        marks = (first, last)
    return OutcomeRequest(
        outcomes=options.outcomes,
        six_minutes=options.six_minute_walk is not False,
        six_minutes_start=None if options.six_minute_walk is False else options.six_minute_walk,
        up_and_go=marks,
        person=person_of(options),
    )


def band_files_of(options: argparse.Namespace) -> list[Path]:
    """Return the files of bands among the references; raise Failure if there are any without a report."""
    files = [Path(text) for text in options.reference or () if _is_file(text)]
    if files and options.report is None:
        raise Failure("--reference with a file of bands goes with --report")
    return files


def person_of(options: argparse.Namespace) -> Person | None:
    """Return the person among the references; None without one; raise Failure if it is wrong or there are two."""
    texts = [text for text in options.reference or () if not _is_file(text)]
    if len(texts) > 1:
        raise Failure("--reference names two people; one and a file of bands go together")
    return _person(texts[0]) if texts else None


def _is_file(text: str) -> bool:
    return text.lower().endswith((".json", ".csv"))


def _start(text: str) -> float:
    """Parse the time of --six-minute-walk; argparse gives it whatever follows, which may be the recording."""
    (start, *others) = _numbers(text)
    if start is None or others:
        raise argparse.ArgumentTypeError(f"{text!r} is no time in s; the recording stands before this option")
    return start


def _person(text: str) -> Person:
    from ...show.outcomes.references import Person, Sex

    age_text, _, rest = text.partition(",")
    sex, _, size = rest.partition(",")
    (age,), sizes = _numbers(age_text), _numbers(size) if size else []
    words = {one.value: one for one in Sex}
    wrong = age is None or not 0.0 < age <= MAX_AGE or sex not in words or len(sizes) not in (0, 2)
    wrong |= any(
        value is None or not low <= value <= high for value, (low, high) in zip(sizes, (HEIGHTS, WEIGHTS), strict=False)
    )
    if wrong or age is None:
        raise Failure(f"--reference {printable(text, 80)} is not AGE,SEX[,CM,KG], as in 72,female,162,68")
    height, weight = sizes or (None, None)
    return Person(age, words[sex], None if height is None else height / 100.0, weight)


def _numbers(text: str) -> list[float | None]:
    """Return the finite numbers between commas, None for what is none."""
    found: list[float | None] = []
    for part in text.split(","):
        try:
            value = nan if "_" in part else float(part)  # Python reads 1_0 as ten
        except ValueError:
            found.append(None)
        else:
            found.append(value if isfinite(value) else None)
    return found
