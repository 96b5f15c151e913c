"""Defines the options of `solepath track` for clinical outcomes."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ...recording import printable
from .failure import Failure, finite
from .parser import option, together

if TYPE_CHECKING:
    from ...show.outcomes.clinic import OutcomeRequest
    from ...show.outcomes.references import Person

MAX_AGE, HEIGHTS, WEIGHTS = 120.0, (50.0, 250.0), (10.0, 400.0)
"""Oldest age, years, and the heights, cm, and weights, kg, that --reference takes; others are slips of the pen."""
TWO_MARKS = 2
"""Number of marks of a timed up and go."""
MARKS = {"six-minute": (0, 1), "tug": (TWO_MARKS,), "walk": (0,)}
"""Numbers of marks that each test may have."""


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


def _test(text: str) -> tuple[str, tuple[float, ...]]:
    """Parse --test: the name of a test, and the marks of an observer."""
    name, _, marks = text.partition("=")
    with suppress(ValueError):
        times = _marks(marks)
        if len(times) in MARKS.get(name, ()):
            return name, times
    raise ArgumentTypeError(f"{printable(text, 80)} is not six-minute, six-minute=START, tug=START,STOP or walk")


def _marks(text: str) -> tuple[float, ...]:
    """Parse the marks of an observer, s: none, a start, or a start and a later stop."""
    times = tuple([finite(time) for time in text.split(",")]) if text else ()
    if len(times) > TWO_MARKS or list(times) != sorted(set(times)):
        raise ValueError
    return times


def _marks_before(text: str) -> tuple[float, ...]:
    """Parse --test-before."""
    with suppress(ValueError):
        if times := _marks(text):
            return times
    raise ArgumentTypeError(f"{printable(text, 80)} is not START or START,STOP, as in 12.5,24.1")


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


add_test = option(
    "--test",
    metavar="NAME[=MARKS]",
    type=_test,
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
        type=_marks_before,
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
