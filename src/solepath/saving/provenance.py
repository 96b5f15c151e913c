"""How a file came about: the one record that run.json, reports, storage files, datasets and data frames give.

    made_by = provenance(session.recipe, ["walk.csv"])
    frame = to_frame(events, made_by=made_by)

It is JSON: {"solepath": version, "recipe": name, "recipe_sha256", "inputs": [{"name", "sha256"}], "options": {...}}."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from hashlib import file_digest, sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from . import codec


def installed_version() -> str:
    """Return the version of solepath; "" where it runs from a folder without being installed."""
    try:
        return version("solepath")
    except PackageNotFoundError:
        return ""


def provenance(
    recipe: Any = None, inputs: Iterable[Path | str] = (), options: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return how results came about: version, recipe with the hash of its settings, and files with their hashes.

    `recipe` is that of the session. `inputs` are the files that were read: recordings, a calibration, a floor plan; one
    that is no file, such as a pipe, is left out. A file has its name alone, with that of its folder where two names are
    the same. `options` are what was asked for, as JSON has it. OSError when a file cannot be read."""
    paths = [path for path in map(Path, inputs) if path.is_file()]
    content: dict[str, Any] = {"solepath": installed_version()}
    if recipe is not None:
        settings = json.dumps(codec.save(recipe), sort_keys=True)
        content |= {"recipe": recipe.name, "recipe_sha256": sha256(settings.encode()).hexdigest()}
    named = zip(names_of(paths), paths, strict=True)
    content["inputs"] = [{"name": name, "sha256": _digest(path)} for name, path in named]
    return content | ({} if options is None else {"options": dict(options)})


def names_of(paths: Iterable[Path]) -> list[str]:
    """Return the names of files, with those of their folders if two names are the same."""
    files = [*paths]
    names = [path.name for path in files]
    return names if len({*names}) == len(names) else [f"{path.parent.name}/{path.name}" for path in files]


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return file_digest(file, "sha256").hexdigest()
