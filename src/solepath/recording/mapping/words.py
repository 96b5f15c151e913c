"""Words in the names of columns, channels and files: the quantity, the axis and the foot that they mean."""

from __future__ import annotations

import re
from itertools import pairwise
from unicodedata import normalize

from ...types import Foot
from .units import UNITS, unit_of_name

QUANTITY_WORDS = {
    "t": r"(?:^|[^a-z])(?:t|time|times|timestamp|sampletime|elapsed|zeit|temps|tiempo)(?:[^a-z]|$)",
    "gyro": r"(?:^|[^a-z])[gw](?:[^a-z]|[xyz](?:[^a-z]|$))|gyr|omega|ang(?:ular)?.?(?:vel|rate)|dreh|rot",
    "acc": r"(?:^|[^a-z])a(?:[^a-z]|[xyz](?:[^a-z]|$)|$)|acc|beschl",
}
"""Pattern of each quantity in names in lower case."""
OTHER = r"free|lin(?:ear)?.?acc|user.?acc|gravity|mag|quat|euler|angle|roll|pitch|yaw|temp[^o]|baro"
"""Pattern of what is none of them."""
AXIS = r"([xyz])(?:[^a-z]*(?:axis|achse)?)$|[^a-z]([xyz])(?:[^a-z]|$)|(?<![0-9])([123])$"
"""Pattern of the axis in a name in lower case without its unit: at its end, or alone; it may have a number."""
FOOT_WORDS = {
    foot: frozenset([word for line in lines for word in line.split()])
    for foot, lines in {
        Foot.LEFT: (
            "left l lf lfoot leftfoot",  # English
            "links linker linke linkes",  # German, Dutch
            "gauche izquierdo izquierda izq esquerdo esquerda esq",  # French, Spanish, Portuguese
            "sinistro sinistra sx",  # Italian
            "lewa lewy lewe levá levý левая левый левое лев",  # Polish, Czech, Russian
            "vänster venstre vasen kiri",  # Swedish, Danish and Norwegian, Finnish, Indonesian
            "左 左脚 左足 왼발 왼쪽",  # Chinese, Japanese, Korean
        ),
        Foot.RIGHT: (
            "right r rf rfoot rightfoot",
            "rechts rechter rechte rechtes",
            "droite droit derecho derecha direito direita",
            "destro destra dx",
            "prawa prawy prawe pravá pravý правая правый правое прав",
            "höger højre høyre oikea kanan",
            "右 右脚 右足 오른발 오른쪽",
        ),
    }.items()
}
"""Words that name a foot, in lower case, if they stand alone: between other characters, digits, or capitals."""
LAST_FOOT_WORDS = {Foot.LEFT: frozenset(("li",)), Foot.RIGHT: frozenset(("re", "der", "dir"))}
"""Abbreviations that are words or names as well (Li, re-test): they name a foot as the last word of a text only."""


def foot_of_text(text: str) -> Foot | None:
    """Return the foot that a text names, in any of several languages; None if it names none, or both."""
    words = _words_of(text)
    named = [foot for foot, its_words in FOOT_WORDS.items() if its_words.intersection(words)]
    if not named:
        named = [foot for foot, its_words in LAST_FOOT_WORDS.items() if its_words.intersection(words[-1:])]
    return named[0] if len(named) == 1 else None


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
    if re.search(OTHER, spaced):
        return "", ""
    unit = next((quantity for quantity in UNITS if unit_of_name(name, quantity)), "")
    axis = re.search(AXIS, spaced)
    named = next((q for q in ("gyro", "acc") if re.search(QUANTITY_WORDS[q], spaced)), sensor)
    quantity = unit if unit in ("acc", "gyro") else named
    if axis is not None and quantity:
        foot = foot_of_text(text)
        found = axis[1] or axis[2] or "xyz"[int(axis[3]) - 1]
        return quantity + ("" if foot is None else f"_{foot.value}"), found
    return ("t" if unit == "t" or re.search(QUANTITY_WORDS["t"], spaced) else ""), ""
