"""Words in the names of columns, channels and files: the quantity, the axis and the foot that they mean."""

from __future__ import annotations

import re
from itertools import pairwise
from unicodedata import normalize

from ...types import Foot
from .units import UNITS, WORDS, unit_of_name

PATTERNS: dict[str, str] = WORDS["patterns"]
"""What a name in lower case means."""


def foot_of_text(text: str) -> Foot | None:
    """Return the foot that a text names, in any of several languages; None if it names none, or both."""
    words = _words_of(text)
    for key, used in (("feet", words), ("last_feet", words[-1:])):
        named = [foot for foot, lines in WORDS[key].items() if not set(" ".join(lines).split()).isdisjoint(used)]
        if named:
            return Foot(named[0]) if len(named) == 1 else None
    return None


def _words_of(text: str) -> list[str]:
    """Return the words of a text in lower case: runs of letters, which a capital parts as well (walkLeft, IMULeft)."""
    parted = ""
    padded = f" {normalize('NFC', text)} "
    for (before, letter), after in zip(pairwise(padded), padded[2:], strict=False):
        is_start = letter.isupper() and (before.islower() or (before.isupper() and after.islower()))
        parted += (f" {letter}" if is_start else letter) if letter.isalpha() else " "
    return parted.lower().split()


def key_of_name(name: str, sensor: str = "") -> tuple[str, str]:
    """Return the key of a mapping that the name of a column suggests, and the axis; "" where it suggests none.

    `sensor` is the quantity of an axis without a name of a quantity. A time has no axis."""
    text = re.sub(r"[\[(].*?[\])]", " ", name).strip()
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower()
    if re.search(PATTERNS["other"], spaced):
        return "", ""
    unit = next((quantity for quantity in UNITS if unit_of_name(name, quantity)), "")
    axis = re.search(PATTERNS["axis"], spaced)
    named = next((q for q in ("gyro", "acc") if re.search(PATTERNS[q], spaced)), sensor)
    quantity = unit if unit in ("acc", "gyro") else named
    if axis is not None and quantity:
        foot = foot_of_text(text)
        found = axis[1] or axis[2] or "xyz"[int(axis[3]) - 1]
        return quantity + ("" if foot is None else f"_{foot.value}"), found
    return ("t" if unit == "t" or re.search(PATTERNS["t"], spaced) else ""), ""
