"""Reading of dataset.json, the file that says what the recordings of a data set are."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from solepath.saving.files import read_bounded

MAX_FILE_SIZE = 16_000_000
"""Largest size of a dataset.json, bytes: some two hundred times that of the 364 recordings of hugadb."""


def read_description(path: Path) -> Any:
    """Return the content of a dataset.json; raise OSError or ValueError when there is none or it is too large."""
    try:
        return json.loads(read_bounded(path, MAX_FILE_SIZE))
    except RecursionError:
        raise ValueError("is nested too deeply") from None
