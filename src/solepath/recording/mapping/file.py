"""Reading of a mapping from a TOML file."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from ..errors import RecordingError, open_file
from .mapping import TableMapping

MAX_SIZE = 1_000_000
"""Largest size of a file with a mapping, bytes."""
TABLES = ("columns", "units", "scale", "rows", "feet")
"""Keys of a mapping whose values are tables of their own."""
KEYS = ("rate", "wrap", "separator", "decimal", "header", "format", *TABLES)
"""Keys of a mapping."""


def read_mapping(path: Path | str) -> TableMapping:
    """Return the mapping in a TOML file.

    RecordingError, with all its problems and the lines to change, for a file that is no mapping."""
    path = Path(path)
    with open_file(path) as file:
        data = file.read(MAX_SIZE + 1)
    if len(data) > MAX_SIZE:
        raise RecordingError(path, f"is larger than {MAX_SIZE // 1_000_000} MB, so it is no mapping")
    try:
        values: dict[str, Any] = tomllib.loads(data.decode("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(path, f"is not TOML ({error})") from None
    problems = [
        RecordingError(path, f"{key} is no key of a mapping", repair=f"the keys are {', '.join(KEYS)}")
        for key in values.keys() - {*KEYS}
    ]
    for key in TABLES:
        if not isinstance(values.get(key, {}), dict):
            problems.append(RecordingError(path, "is a value", key, f"write [{key}] in a line of its own"))
            del values[key]
    for key, names in values.get("columns", {}).items():
        listed = names if isinstance(names, list) else [names]
        # columns of a table without names have numbers
        values["columns"][key] = [str(name) if type(name) is int else name for name in listed]
    values["rows"] = {name: str(value) for name, value in values.get("rows", {}).items()}
    try:
        mapping = TableMapping(**{key: values[key] for key in KEYS if key in values}, origin=path.name)
    except ValueError as error:
        problems += [RecordingError(path, line) for line in str(error).splitlines()]
    if problems:
        raise RecordingError.of(problems)
    return mapping
