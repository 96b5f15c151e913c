"""run.json, which says how the files beside it came about, and what the recording lacks.

It is JSON: {"solepath": version, "recipe": name, "recipe_sha256", "inputs": [{"name", "sha256"}], "options": {...},
"sites": {"left_foot": {"samples", "missing", "missing_s", "missing_share", "absent_s"}}, "findings": [{"code", "site",
"text"}]}. walk/links.py defines the figures of a site, events/defect.py the codes of findings."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from hashlib import file_digest, sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from attrs import frozen

from ...recipes import Recipe
from ...saving import codec
from ...show.tables.summary import site_links
from ...walk.links import LinkLedger
from ...walk.walk import Walk

RUN_FILE = "run.json"


@frozen
class Run:
    """What a run of `solepath track` was made with."""

    recipe: Recipe
    inputs: Sequence[Path]
    """Files that were read: recordings, calibration, mapping, floor plan."""
    options: dict[str, Any]

    def describe(self, walk: Walk) -> dict[str, Any]:
        """Return the content of run.json for what the walk has counted."""
        recipe = json.dumps(codec.save(self.recipe), sort_keys=True)
        return {
            "solepath": version("solepath"),
            "recipe": self.recipe.name,
            "recipe_sha256": sha256(recipe.encode()).hexdigest(),
            "inputs": [{"name": path.name, "sha256": _digest(path)} for path in self.inputs if path.is_file()],
            "options": self.options,
            "sites": {site.value: _figures(link) for site, link in site_links(walk)},
            "findings": [
                {"code": defect.name.lower(), "site": site.value, "text": found.what}
                for (site, defect), found in walk.found_defects.items()
            ],
        }


def given_options(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options that a person gave a command, as JSON has them; files are given by their names."""
    given = {name: value for name, value in vars(options).items() if value not in (None, False, [], ())}
    return {name: _plain(value) for name, value in sorted(given.items()) if name != "command" and not callable(value)}


def inputs_of(options: argparse.Namespace) -> list[Path]:
    """Return the files that a command reads: recordings, mapping, calibration, floor plan."""
    given = [*options.files, options.mapping, options.calibration, options.floorplan]
    return [path for path in given if path is not None]


def _plain(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return value if isinstance(value, bool | int | float | str) else getattr(value, "name", str(value))


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return file_digest(file, "sha256").hexdigest()


def _figures(link: LinkLedger) -> dict[str, float]:
    return {
        "samples": link.samples,
        "missing": link.missing,
        "missing_s": round(link.missing_time, 3),
        "missing_share": round(link.missing_share, 6),
        "absent_s": round(link.absent_time, 3),
    }
