"""Finds the name that was probably meant, for the errors about a name that does not exist."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...recording import printable

MIN_SIMILARITY = 0.6
"""Least similarity (Ratcliff and Obershelp's, 0 to 1) of a name that is suggested: the default of difflib."""
MIN_FILE_SIMILARITY = 0.75
"""The same for names of files, which often share their ending; chosen by hand."""
MIN_OPTION_SIMILARITY = 0.7
"""The same for options, which are short, and of which a command has many; chosen by hand."""
MAX_NAMES = 20
"""Largest number of names that are listed where none is similar; chosen by hand."""
MAX_FILES = 2000
"""Largest number of files of a folder that are compared; chosen by hand."""


def closest(name: str, names: Iterable[str], min_similarity: float = MIN_SIMILARITY) -> str | None:
    """Return the name that is most similar, whatever the case of its letters; None if none is similar."""
    from difflib import get_close_matches

    by_text = {one.lower(): one for one in names}
    if len(name) >= 3 and len(starts := [one for text, one in by_text.items() if text.startswith(name.lower())]) == 1:
        return starts[0]
    found = get_close_matches(name.lower(), by_text, n=1, cutoff=min_similarity)
    return by_text[found[0]] if found else None


def suggestion(name: str, names: Iterable[str]) -> str:
    """Return what comes after "there is no ...": the similar name as a question, or all names."""
    listed = list(names)
    meant = closest(name, listed)
    if meant is not None:
        return f": did you mean {meant}?"
    more = f" and {len(listed) - MAX_NAMES} more" if len(listed) > MAX_NAMES else ""
    return f"; there are: {', '.join(listed[:MAX_NAMES])}{more}" if listed else ""


def unknown(what: str, name: str, names: Iterable[str]) -> str:
    """Return the sentence about a name that does not exist; `what` says of what, such as "recipe"."""
    return f"there is no {what} {printable(repr(name), 80)}{suggestion(name, names)}"


def closest_file(path: Path) -> str:
    """Return the question for a similar name beside a path that does not exist; "" if there is none."""
    try:
        names = [entry.name for _, entry in zip(range(MAX_FILES), path.parent.iterdir(), strict=False)]
    except OSError:
        return ""
    meant = closest(path.name, names, MIN_FILE_SIMILARITY)
    return "" if meant is None else f": did you mean {printable(str(path.parent / meant))}?"
