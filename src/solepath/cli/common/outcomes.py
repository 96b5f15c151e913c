"""Defines the options of `solepath track` for clinical outcomes."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ...recording import printable
from .failure import Failure, finite, parse_span
from .parser import option, together

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.outcomes.references import Person

MAX_AGE, HEIGHTS, WEIGHTS = 120.0, (50.0, 250.0), (10.0, 400.0)
"""Oldest age, years, and the heights, cm, and weights, kg, that --reference takes; others are slips of the pen."""


def has_outcomes(options: Namespace) -> bool:
    """Return whether any outcome was requested, so that there are bouts.csv and outcomes.csv."""
    return bool(options.outcomes) or options.six_minute_walk is not False or options.timed_up_and_go is not None


def outcomes_of(options: Namespace) -> OutcomeRequest | None:
    """Return the outcomes that the options name; None without any; raise Failure when one is wrong."""
    people = [one for one in options.reference if not isinstance(one, Path)]
    if len(people) > 1:
        raise Failure("--reference names two people; one and a file of bands go together")
    if band_files_of(options) and options.report is None:
        raise Failure("--reference with a file of bands goes with --report")
    if not has_outcomes(options):
        if people and options.report is None:
            raise Failure("--reference goes with --report, --outcomes, --six-minute-walk or --timed-up-and-go")
        return None
    from ...show.outcomes.clinic import OutcomeRequest

    return OutcomeRequest(
        outcomes=options.outcomes,
        six_minutes=options.six_minute_walk is not False,
        six_minutes_start=None if options.six_minute_walk is False else options.six_minute_walk,
        up_and_go=options.timed_up_and_go,
        person=person_of(options),
    )


def band_files_of(options: Namespace) -> list[Path]:
    """Return the files of bands among the references."""
    return [one for one in options.reference if isinstance(one, Path)]


def person_of(options: Namespace) -> Person | None:
    """Return the person among the references; None without one."""
    return next((one for one in options.reference if not isinstance(one, Path)), None)


def _start(text: str) -> float:
    """Parse the time of --six-minute-walk; argparse gives it whatever follows, which may be the recording."""
    try:
        return finite(text)
    except ValueError:
        what = f"{text!r} is no time in s; the recording stands before this option"
        raise ArgumentTypeError(what) from None


def _reference(text: str) -> Person | Path:
    """Parse a value of --reference: a person, or a file of bands."""
    if text.lower().endswith((".json", ".csv")):
        return Path(text)
    from ...show.outcomes.references import Person, Sex

    try:
        age, sex, *size = text.split(",")
        height, weight = map(finite, size or ("0", "0"))
        person = Person(finite(age), Sex(sex), *([height / 100.0, weight] if size else []))
        in_limits = not size or HEIGHTS[0] <= height <= HEIGHTS[1] and WEIGHTS[0] <= weight <= WEIGHTS[1]
        if 0.0 < person.age <= MAX_AGE and in_limits:
            return person
    except ValueError:
        pass
    raise ArgumentTypeError(f"{printable(text, 80)} is not AGE,SEX[,CM,KG], as in 72,female,162,68")


add_six_minute_walk = option(
    "--six-minute-walk",
    metavar="START",
    nargs="?",
    type=_start,
    default=False,
    help="the six-minute walk from this time of the recording's clock, s (default: from the first step)",
)
"""--six-minute-walk."""

add_outcomes = together(
    option(
        "--outcomes",
        action="store_true",
        help="walking bouts and mobility outcomes by the rules of Mobilise-D, variability, asymmetry; with --out also "
        "bouts.csv and outcomes.csv",
    ),
    add_six_minute_walk,
    option(
        "--timed-up-and-go",
        metavar="START,STOP",
        type=partial(parse_span, "START,STOP"),
        help="the timed up and go between two times that an observer marked, s of the recording's clock",
    ),
    option(
        "--reference",
        metavar="AGE,SEX[,CM,KG]|FILE",
        type=_reference,
        action="append",
        default=[],
        help="compare with published values of healthy people, as in 72,female,162,68; height and weight are for the "
        "six-minute walk; or, in the report, with the bands of a .json or .csv file; may be given for each",
    ),
)
"""--outcomes, --six-minute-walk, --timed-up-and-go and --reference."""
