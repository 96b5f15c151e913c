"""`python -m solepath.saving.pin`: writes down the shape of the state of this version, so that later ones can read it.

Run it when a version is done, once. Exit status 1 when this version was pinned and has another shape now.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..session.state import VERSION
from .records import shape, snapshot_shape
from .rows import ROWS
from .shape import Shape

FOLDER = Path(__file__).parent / "shapes"


def changed(now: str) -> str | None:
    """What to do where the state's shape `now` is not the one that was pinned for its version; None where it is."""
    file = FOLDER / f"{VERSION}.json"
    if not file.exists():
        return f"version {VERSION} of the state is not pinned: run `python -m solepath.saving.pin`"
    if file.read_text("utf-8") == now:
        return None
    return (
        f"what a session remembers, or a setting, is not what it was when version {VERSION} of its state was pinned: "
        f"raise VERSION in state.py to {VERSION + 1}, add the step from {VERSION} to saving/upgrades.py, and run "
        "`python -m solepath.saving.pin`. If no release had that version yet, remove its file in saving/shapes "
        "and pin it again."
    )


def as_text() -> str:
    """Both shapes, a record a line, and what is in fields of bytes."""
    return f'{{"packed": {_told(shape())}, "snapshot": {_told(snapshot_shape())}, "rows": {_lines(ROWS)}}}\n'


def _told(one: Shape) -> str:
    return f'{{"root": {json.dumps(one.root)}, "enums": {_lines(one.enums)}, "records": {_lines(one.records)}}}'


def _lines(held: Mapping[str, Any]) -> str:
    return "{\n" + ",\n".join([f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in held.items()]) + "\n}"


def main() -> int:
    """Pin it, or say why not."""
    file = FOLDER / f"{VERSION}.json"
    if not file.exists():
        FOLDER.mkdir(exist_ok=True)
        file.write_text(as_text(), "utf-8")
        print(f"wrote {file}")
    why_not = changed(as_text())
    if why_not is not None:
        print(why_not, file=sys.stderr)
    return 0 if why_not is None else 1


if __name__ == "__main__":
    raise SystemExit(main())
