"""Parses what a person writes to order clinical outcomes, for the command line and for the site alike.

A ValueError of these functions has a sentence for a person."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from ..recording import printable
from ..recording.errors import finite

if TYPE_CHECKING:
    from .outcomes.references import Person

MAX_AGE, HEIGHTS, WEIGHTS = 120.0, (50.0, 250.0), (10.0, 400.0)
"""Oldest age, years, and the heights, cm, and weights, kg, of a person; others are slips of the pen."""
TWO_MARKS = 2
"""Number of marks of a timed up and go."""
MARKS = {"six-minute": (0, 1), "tug": (TWO_MARKS,), "walk": (0,)}
"""Numbers of marks that each test may have."""


def parse_test(text: str) -> tuple[str, tuple[float, ...]]:
    """Return the name of a test, and the marks of an observer, s."""
    name, _, marks = text.partition("=")
    with suppress(ValueError):
        times = _marks(marks)
        if len(times) in MARKS.get(name, ()):
            return name, times
    raise ValueError(f"{printable(text, 80)} is not six-minute, six-minute=START, tug=START,STOP or walk")


def parse_marks(text: str) -> tuple[float, ...]:
    """Return the marks of an observer, s: a start, or a start and a later stop."""
    with suppress(ValueError):
        if times := _marks(text):
            return times
    raise ValueError(f"{printable(text, 80)} is not START or START,STOP, as in 12.5,24.1")


def _marks(text: str) -> tuple[float, ...]:
    times = tuple([finite(time) for time in text.split(",")]) if text else ()
    if len(times) > TWO_MARKS or list(times) != sorted(set(times)):
        raise ValueError
    return times


def parse_person(text: str) -> Person:
    """Return the person whom AGE,SEX or AGE,SEX,CM,KG describes."""
    from .outcomes.references import Person, Sex

    with suppress(ValueError):
        age, sex, *size = text.split(",")
        height, weight = map(finite, size or ("0", "0"))
        person = Person(finite(age), Sex(sex), *([height / 100.0, weight] if size else []))
        in_limits = not size or HEIGHTS[0] <= height <= HEIGHTS[1] and WEIGHTS[0] <= weight <= WEIGHTS[1]
        if 0.0 < person.age <= MAX_AGE and in_limits:
            return person
    raise ValueError(f"{printable(text, 80)} is not AGE,SEX[,CM,KG], as in 72,female,162,68")
