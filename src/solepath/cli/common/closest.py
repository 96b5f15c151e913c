"""Finds the name that was probably meant, for the errors about a name that does not exist."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from ...recording import printable

MIN_SIMILARITY = 0.6
"""Least similarity (Ratcliff and Obershelp's, 0 to 1) of a name that is suggested: the default of difflib."""
MIN_FILE_SIMILARITY = 0.75
"""The same for names of files, which often share their ending; chosen by hand."""
MAX_NAMES = 20
"""Largest number of names that are listed where none is similar; chosen by hand."""
MAX_FILES = 2000
"""Largest number of files of a folder that are compared; chosen by hand."""


def closest(name: str, names: Iterable[str], min_similarity: float = MIN_SIMILARITY) -> str | None:
    """Return the name that is most similar, whatever the case of its letters; None if none is similar."""
    from difflib import get_close_matches

    by_text = {one.lower(): one for one in names}
    starts = [text for text in by_text if len(name) >= 3 and text.startswith(name.lower())]
    found = starts if len(starts) == 1 else get_close_matches(name.lower(), by_text, n=1, cutoff=min_similarity)
    return by_text[found[0]] if found else None


def unknown(what: str, name: str, names: Iterable[str]) -> str:
    """Return the sentence about a name that does not exist; `what` says of what, such as "recipe".

    It ends with the similar name as a question, or with all names."""
    listed = list(names)
    meant = closest(name, listed)
    more = f" and {len(listed) - MAX_NAMES} more" if len(listed) > MAX_NAMES else ""
    end = f"; there are: {', '.join(listed[:MAX_NAMES])}{more}" if meant is None else f": did you mean {meant}?"
    return f"there is no {what} {printable(repr(name), 80)}{end}"


def closest_file(path: Path) -> str:
    """Return the question for a similar name beside a path that does not exist; "" if there is none."""
    try:
        names = [entry.name for entry in islice(path.parent.iterdir(), MAX_FILES)]
    except OSError:
        return ""
    meant = closest(path.name, names, MIN_FILE_SIMILARITY)
    return "" if meant is None else f": did you mean {path.parent / meant}?"
