"""The foot that a file is of, by its name, that of its folder, or that of the device."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import pairwise
from pathlib import Path
from unicodedata import normalize

from ...types import Foot

WORDS = {
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
LAST_WORDS = {Foot.LEFT: frozenset(("li",)), Foot.RIGHT: frozenset(("re", "der", "dir"))}
"""Abbreviations that are words or names as well (Li, re-test): they name a foot as the last word of a text only."""


def foot_of_text(text: str) -> Foot | None:
    """Return the foot that a text names, in any of several languages; None if it names none, or both."""
    words = _words_of(text)
    named = [foot for foot, its_words in WORDS.items() if its_words.intersection(words)]
    if not named:
        named = [foot for foot, its_words in LAST_WORDS.items() if its_words.intersection(words[-1:])]
    return named[0] if len(named) == 1 else None


def _words_of(text: str) -> list[str]:
    """Return the words of a text in lower case: runs of letters, which a capital parts as well (walkLeft, IMULeft)."""
    parted = ""
    padded = f" {normalize('NFC', text)} "
    for (before, letter), after in zip(pairwise(padded), padded[2:], strict=False):
        is_start = letter.isupper() and (before.islower() or (before.isupper() and after.islower()))
        parted += (f" {letter}" if is_start else letter) if letter.isalpha() else " "
    return parted.lower().split()


def feet_of_files(paths: Sequence[Path], patterns: Mapping[str, str]) -> list[Foot | None]:
    """Return the foot that the name of each file says, or the name of its folder if the files are in different ones."""
    use_folders = len({path.parent for path in paths}) > 1
    feet = []
    for path in paths:
        matching = [Foot(foot) for foot, pattern in patterns.items() if fnmatchcase(path.name, pattern)]
        foot = matching[0] if len(matching) == 1 else foot_of_text(path.stem)
        feet.append(foot_of_text(path.parent.name) if foot is None and use_folders else foot)
    return feet
