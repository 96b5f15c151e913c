"""Public names have docstrings: each class, function and method, and each field of the classes that an app uses."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from here import ROOT

SRC = ROOT / "src" / "solepath"
FIELD_PLACES = (
    "events", "types", "calibration", "body/part.py", "link/driver.py", "link/profile.py", "session", "recipes.py",
    "link/setup/config.py", "recording", "emulate",
)  # fmt: skip
"""Folders and modules whose public fields have docstrings."""
NUMERIC = re.compile(r"\b(?:float|int|Vec3|Quat)\b")
REAL = re.compile(r"\b(?:float|Vec3|Quat)\b")
UNITS = "s|us|ms|m|mm|rad|Hz|N|Pa|hPa|kg|V|T|g|u|%|m\\^2|1/min|bytes|counts|seconds|degrees|dBm|ppm"
UNIT = re.compile(
    rf"(?:^|[\s(])(?:{UNITS})(?=$|[\s,.;:)])|[a-z0-9)]/(?:s|m|Hz|sqrt)|0 to 1|-1 to 1"
    r"|\b(?:[Ss]hare|no unit|ratio|quaternion)\b"
)
"""Words by which the docstring of a real number names its unit."""


def documented(statement: ast.stmt | None) -> str:
    """Return the text of a docstring; empty for another statement."""
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
        return str(statement.value.value).strip()
    return ""


def fields(top: Path) -> Iterator[tuple[str, str, str]]:
    """Yield place, annotation and docstring of each numeric field of the public attrs classes below a path."""
    for path in [top] if top.is_file() else sorted(top.rglob("*.py")):
        if any(part.startswith("_") and part != "__init__.py" for part in path.relative_to(SRC).parts):
            continue
        yield from fields_of(path.read_text("utf-8"), path.relative_to(SRC).as_posix())


def fields_of(source: str, place: str = "") -> Iterator[tuple[str, str, str]]:
    for cls in ast.walk(ast.parse(source)):
        if not isinstance(cls, ast.ClassDef) or cls.name.startswith("_") or not is_attrs(cls):
            continue
        for field, after in zip(cls.body, [*cls.body[1:], None], strict=True):
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
                annotation = ast.unparse(field.annotation)
                if NUMERIC.search(annotation) and "ClassVar" not in annotation and field.target.id[0] != "_":
                    yield f"{place}:{field.lineno} {cls.name}.{field.target.id}", annotation, documented(after)


def is_attrs(cls: ast.ClassDef) -> bool:
    return any(re.match(r"(attrs\.)?(frozen|define|mutable)\b", ast.unparse(one)) for one in cls.decorator_list)


def lack(annotation: str, text: str) -> str | None:
    """Return what the docstring of a field lacks; None for a complete one."""
    if not text:
        return "has no docstring"
    if REAL.search(annotation) and not UNIT.search(text):
        return f"names no unit: {text}"
    return None


@pytest.mark.parametrize("place", FIELD_PLACES)
def test_each_number_of_a_public_class_has_a_docstring_with_its_unit(place: str) -> None:
    found = [f"{where}: {annotation}: {fault}" for where, annotation, text in fields(SRC / place)
             if (fault := lack(annotation, text))]  # fmt: skip
    assert not found, "\n".join(found)
