"""Defines the options of `solepath track` for clinical outcomes."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ...show.outcome_options import MARKS, parse_marks, parse_person, parse_test
from .failure import Failure
from .parser import option, together

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.outcomes.references import Person

T = TypeVar("T")


def has_outcomes(options: Namespace) -> bool:
    """Return whether any outcome was requested, so that there are bouts.csv and outcomes.csv."""
    return bool(options.outcomes) or options.test is not None


def outcomes_of(options: Namespace) -> OutcomeRequest | None:
    """Return the outcomes that the options name; None without any; raise Failure when one is wrong."""
    people = [one for one in options.reference if not isinstance(one, Path)]
    if len(people) > 1:
        raise Failure("--reference names two people; one and a file of bands go together")
    if band_files_of(options) and options.report is None:
        raise Failure("--reference with a file of bands goes with --report")
    if not has_outcomes(options):
        if people and options.report is None:
            raise Failure("--reference goes with --report, --outcomes or --test")
        return None
    return _request(options, () if options.test is None else options.test[1])


def outcomes_before(options: Namespace) -> OutcomeRequest | None:
    """Return the same outcomes of the recording of --compare, with its own marks; raise Failure when they are wrong."""
    marks = options.test_before or ()
    allowed = () if options.test is None or options.compare is None else MARKS[options.test[0]]
    if marks and not allowed:
        raise Failure("--test-before goes with --test and --compare")
    if allowed and len(marks) not in allowed:
        if not marks:
            raise Failure("--test tug with --compare needs --test-before START,STOP: the marks in the recording before")
        raise Failure("--test-before has the marks that its test may have: START of six-minute, START,STOP of tug")
    return _request(options, marks) if has_outcomes(options) else None


def _request(options: Namespace, marks: tuple[float, ...]) -> OutcomeRequest:
    from ...show.outcomes.clinic import OutcomeRequest, WalkTest

    test = None if options.test is None else WalkTest(options.test[0])
    return OutcomeRequest(outcomes=options.outcomes, test=test, marks=marks, person=person_of(options))


def band_files_of(options: Namespace) -> list[Path]:
    """Return the files of bands among the references."""
    return [one for one in options.reference if isinstance(one, Path)]


def person_of(options: Namespace) -> Person | None:
    """Return the person among the references; None without one."""
    return next((one for one in options.reference if not isinstance(one, Path)), None)


def _parsed(parse: Callable[[str], T], text: str) -> T:
    """Return what a text orders, by a parser of show/outcome_options.py, with its sentence for argparse."""
    try:
        return parse(text)
    except ValueError as error:
        raise ArgumentTypeError(str(error)) from None


def _reference(text: str) -> Person | Path:
    """Parse a value of --reference: a person, or a file of bands."""
    return Path(text) if text.lower().endswith((".json", ".csv")) else _parsed(parse_person, text)


add_test = option(
    "--test",
    metavar="NAME[=MARKS]",
    type=partial(_parsed, parse_test),
    help="the test that was ordered: six-minute, from its first step, or six-minute=START; tug=START,STOP, the timed "
    "up and go; walk, at the usual pace; marks are s of the recording's clock. Its result comes first",
)
"""--test."""

add_outcomes = together(
    option(
        "--outcomes",
        action="store_true",
        help="walking bouts and mobility outcomes by the rules of Mobilise-D, variability, asymmetry; with --out also "
        "bouts.csv and outcomes.csv",
    ),
    add_test,
    option(
        "--test-before",
        metavar="MARKS",
        type=partial(_parsed, parse_marks),
        help="the marks of the test in the recording of --compare: START, or START,STOP",
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
"""--outcomes, --test, --test-before and --reference."""
