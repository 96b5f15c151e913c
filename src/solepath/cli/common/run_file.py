"""run.json, which says how the files beside it came about, and what is wrong with the recording.

It is JSON: {"solepath": version, "recipe": name, "recipe_sha256", "inputs": [{"name", "sha256"}], "options": {...},
"command_line": [...], "sites": {"left_foot": {"samples", "missing", "missing_s", "missing_share", "absent_s",
"delay_ms": {"sensor": [median, 95th percentile], "radio", "decision"}}}, "findings": [{"code", "site", "text"}],
"place": {"level", "room", "x_m", "y_m", "within_m", "candidates", "decided", "level_decided"}}.
The place is that at the end, on the floor plan; null without one. walk/links.py defines the figures of a site,
show/findings.py the findings; the site of one about both feet or the whole session is ""."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from attrs import asdict, has

from ...events import Placed
from ...recipes import Recipe
from ...saving.provenance import provenance
from ...show.findings import findings, links_of
from ...walk.links import LinkLedger
from ...walk.walk import Walk
from .files import WRITTEN, files_read

WITHOUT_EFFECT = {*WRITTEN, "command", "words", "force", "view", "no_browser", "speed", "processes"}
"""Options that say where results are written and shown, which do not depend on them."""


def made_by(recipe: Recipe, options: argparse.Namespace) -> dict[str, Any]:
    """Return how results of a command came about: `provenance` of its recipe, the files it reads and its options."""
    made = provenance(recipe, files_read(options), _given(options))
    return made | {"command_line": _command_line(options)}


def _command_line(options: argparse.Namespace) -> list[str]:
    """Return the words of the command, with which it can be run again where the files are.

    Of a file that was given from the root, the name is left. Options without effect on the results are left out, each
    with its value if it has one."""
    given = {f"--{name.replace('_', '-')}": getattr(options, name, None) for name in WITHOUT_EFFECT}
    values = [one for value in vars(options).values() for one in (value if isinstance(value, list) else [value])]
    names = {str(one): one.name for one in values if isinstance(one, Path) and one.is_absolute()}
    words, skips = list[str](), False
    for word in getattr(options, "words", ()):
        option, equals, value = word.partition("=")
        if option not in given and not skips:
            words.append(names[word] if word in names else option + equals + names.get(value, value))
        skips = option in given and not value and given[option] is not True
    return words


def write_run(path: Path, recipe: Recipe, walk: Walk, options: argparse.Namespace) -> None:
    """Write run.json of a recording that was run with this recipe, from what the walk has counted."""
    content = made_by(recipe, options) | {
        "sites": {site.value: _figures(link, walk.now) for site, link in links_of(walk)},
        "findings": [
            {"code": one.code, "site": "" if one.site is None else one.site.value, "text": one.what}
            for one in findings(walk)
        ],
        "place": walk.places.last and _place(walk.places.last),
    }
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _place(place: Placed) -> dict[str, Any]:
    """Return the place at the end; `decided` is the rule of summary, page, picture and report."""
    x, y, _ = place.position
    where = {"level": place.level, "room": place.room, "x_m": x, "y_m": y, "within_m": round(place.spread, 3)}
    decided = {"decided": place.decided, "level_decided": place.level_decided}
    return where | {"candidates": len(place.candidates)} | decided


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options that a person gave, as JSON has them; files are given by their names."""
    given = {name: value for name, value in sorted(vars(options).items()) if value not in (None, False, [], ())}
    return {name: _plain(value) for name, value in given.items() if not (name in WITHOUT_EFFECT or callable(value))}


def _plain(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if has(type(value)):
        return {name: _plain(one) for name, one in asdict(value, recurse=False).items()}
    return value if isinstance(value, bool | int | float | str | None) else getattr(value, "name", str(value))


def _figures(link: LinkLedger, now: float) -> dict[str, Any]:
    return {
        "samples": link.samples,
        "missing": link.missing,
        "missing_s": round(link.missing_time, 3),
        "missing_share": round(link.missing_share, 6),
        "absent_s": round(link.absent_time(now), 3),
        "delay_ms": {name: [round(1e3 * t, 1) for t in times] for name, times in link.delays.figures.items()},
    }
