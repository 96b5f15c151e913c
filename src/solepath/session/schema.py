"""`python -m solepath.session.schema`: the schema of a packed session, as JSON (protocol/snapshot.md)."""

from __future__ import annotations

import json
from typing import Any

from ..recipes import part_class
from ..saving.packed import identify_record
from ..saving.schema import describe, has_state, record_of
from ..types.registry import TABLE
from .packed import schema
from .state import VERSION


def make_schemas() -> dict[str, Any]:
    """Return the version, the schema of a session, and the schemas of links and parts by their packed identity."""
    parts = {}
    for name in (*TABLE["link"], *TABLE["aid"], *TABLE["part"]):
        cls = part_class(name)
        record = record_of(cls, made=name in TABLE["part"] and has_state(cls))
        parts[identify_record(record)] = describe(record)
    return {"version": VERSION, "session": schema(), "parts": parts}


if __name__ == "__main__":
    print(json.dumps(make_schemas(), indent=1))
