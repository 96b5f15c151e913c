"""The foot that a file is of, by its name, that of its folder, or that of the device."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from ...types import Foot

WORDS = {Foot.LEFT: {"left", "l", "lf", "lfoot", "leftfoot"}, Foot.RIGHT: {"right", "r", "rf", "rfoot", "rightfoot"}}
"""Words that name a foot, in lower case, if they stand alone: between other characters, digits, or capitals."""


def foot_of_text(text: str) -> Foot | None:
    """Return the foot that a text names; None if it names none, or both."""
    words = {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", text)}
    named = [foot for foot, its_words in WORDS.items() if words & its_words]
    return named[0] if len(named) == 1 else None


def feet_of_files(paths: Sequence[Path], patterns: Mapping[str, str]) -> list[Foot | None]:
    """Return the foot that the name of each file says, or the name of its folder if the files are in different ones."""
    use_folders = len({path.parent for path in paths}) > 1
    feet = []
    for path in paths:
        matching = [Foot(foot) for foot, pattern in patterns.items() if fnmatchcase(path.name, pattern)]
        foot = matching[0] if len(matching) == 1 else foot_of_text(path.stem)
        feet.append(foot_of_text(path.parent.name) if foot is None and use_folders else foot)
    return feet
