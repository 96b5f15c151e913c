"""`python -m solepath.session.schema`: what a packed session holds, as JSON (protocol/snapshot.md)."""

from __future__ import annotations

import json
from typing import Any

from ..recipes import LINKS, PARTS, part_class
from ..saving.packed import told_of
from ..saving.schema import described, record_of, remembers
from .packed import schema
from .state import VERSION


def as_data() -> dict[str, Any]:
    """The version, the schema of a session, and those of links and parts, by what is packed of an open record."""
    parts = {}
    for name in (*LINKS, *PARTS):
        cls = part_class(name)
        record = record_of(cls, made=name in PARTS and remembers(cls))
        parts[told_of(record)] = described(record)
    return {"version": VERSION, "session": schema(), "parts": parts}


if __name__ == "__main__":
    print(json.dumps(as_data(), indent=1))
