"""The fields of all events with their units and meanings, from the classes' sources."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from textwrap import dedent
from typing import Any, get_args, get_origin, get_type_hints

import attrs

from solepath.events.frames import RENAMED, UNITS

Row = tuple[str, str, str]
"""Name, unit ("" without one) and meaning of a field."""
USUAL = {
    "site": "Site of the sensor.",
    "foot": "Foot of the event.",
    "reason": "Kind of fault.",
    "channel": "Channel of the packets.",
    "defect": "Kind of defect.",
}
"""Meanings of fields whose names say them, where the class says no more."""
NOT_IN_FILES = "Not in `events.jsonl`."
"""What is said of a property: it follows from the fields, so that `to_dict` leaves it out."""


def documents(cls: type[Any]) -> dict[str, str]:
    """Return the text after each field of a class and its bases ("" without one), and that of each property."""
    found: dict[str, str] = {}
    for one in reversed(cls.__mro__):
        if not attrs.has(one):
            continue
        (node,) = ast.parse(dedent(inspect.getsource(one))).body
        assert isinstance(node, ast.ClassDef)
        for field, text in zip(node.body, [*node.body[1:], None], strict=True):
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
                has_text = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
                found[field.target.id] = (
                    " ".join(str(text.value.value).split()) if has_text else found.get(field.target.id, "")
                )
        for method in node.body:
            if isinstance(method, ast.FunctionDef) and "property" in map(ast.unparse, method.decorator_list):
                found[method.name] = " ".join([*(ast.get_docstring(method) or "").split(), NOT_IN_FILES])
    return found


def rows(cls: type[Any], owner: str = "", prefix: str = "") -> Iterator[Row]:
    """Yield the rows of a class, with those of the records that it holds."""
    owner, hints = owner or cls.__name__, get_type_hints(cls)
    for name, text in documents(cls).items():
        column = prefix.replace(".", "_").replace("[]", "") + RENAMED.get((owner, name), name)
        unit = UNITS.get(column, "")
        yield f"{prefix}{name}", unit, text or USUAL[name]
        hint = hints.get(name)
        for inner in (hint, *get_args(hint)):
            if attrs.has(inner) and inner.__module__.startswith("solepath.events."):
                many = "[]" if get_origin(hint) is tuple else ""
                yield from rows(inner, owner, f"{prefix}{name}{many}.")
