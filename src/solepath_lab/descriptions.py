"""What recordings are: dataset.json says it of the recordings of a data set, known.toml what is known beside that."""

from __future__ import annotations

import csv
import json
import tomllib
from pathlib import Path
from typing import Any

from solepath.saving.files import read_bounded


def read_rows(module: str, name: str) -> list[dict[str, str]]:
    """Return the rows of a .csv file beside a module, which is given by its `__file__`."""
    with Path(module).with_name(name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


KNOWN: dict[str, Any] = tomllib.loads(Path(__file__).with_name("known.toml").read_text(encoding="utf-8"))
MAX_FILE_SIZE = 16_000_000
"""Largest size of a dataset.json, bytes: some two hundred times that of the 364 recordings of hugadb."""


def read_description(path: Path) -> Any:
    """Return the content of a dataset.json; raise OSError or ValueError when there is none or it is too large."""
    try:
        return json.loads(read_bounded(path, MAX_FILE_SIZE))
    except RecursionError:
        raise ValueError("is nested too deeply") from None
