"""Limits of files, folders and names at the top; unique class names, and settings apart from state."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import get_type_hints

import attrs
from here import ROOT, TESTS

from solepath.saving.schema import alternatives, is_frozen, is_open, is_part
from solepath.types import Foot, Site

SRC = ROOT / "src" / "solepath"
MAX_LINES, MAX_FILES, MAX_NAMES = 300, 14, 20
"""Largest number of lines of a file, of Python files in a folder, and of names at the top of src/solepath."""


def lines(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def python(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.rglob("*.py")) if "__pycache__" not in path.parts]


def test_no_file_is_longer_than_300_lines() -> None:
    found = {path.relative_to(ROOT).as_posix(): lines(path) for top in (SRC, TESTS) for path in python(top)}
    assert {name: count for name, count in found.items() if count > MAX_LINES} == {}, "split them by subject"


def test_no_folder_holds_more_than_14_python_files() -> None:
    files = [path for top in (SRC, TESTS) for path in python(top) if path.name != "__init__.py"]
    folders = Counter(path.parent.relative_to(ROOT).as_posix() for path in files)
    assert {name: count for name, count in folders.items() if count > MAX_FILES} == {}, "this is two rooms"


def test_there_are_at_most_20_names_at_the_top() -> None:
    beside = {"__init__", "__main__", "__pycache__", "py"}
    names = {path.stem for path in SRC.iterdir() if path.is_dir() or path.suffix == ".py"} - beside
    assert len(names) <= MAX_NAMES, sorted(names)


def test_no_class_has_the_name_of_another() -> None:
    named = Counter(
        node.name
        for path in python(SRC)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
    )
    assert {name for name, count in named.items() if count > 1} == set()


DIVIDED_FOLDERS = ("foot", "body", "papers", "session")


def mixed() -> Iterator[str]:
    """Fields of classes with state that are chosen when one is made, and are neither a frozen record, a part of the
    kind that a recipe chooses, nor whose it is."""
    whose = {Foot, Site}
    for path in (path for room in DIVIDED_FOLDERS for path in python(SRC / room) if path.name != "__init__.py"):
        module = import_module(".".join(path.relative_to(ROOT / "src").with_suffix("").parts))
        for cls in vars(module).values():
            if not (isinstance(cls, type) and cls.__module__ == module.__name__ and attrs.has(cls) and is_part(cls)):
                continue
            hints = get_type_hints(cls)
            for one in attrs.fields(cls):
                kinds = set(alternatives(hints[one.name])) - {type(None)}
                records = [attrs.has(kind) and (is_frozen(kind) or is_part(kind)) or is_open(kind) for kind in kinds]
                if one.init and not (all(records) or kinds <= whose):
                    yield f"{cls.__name__}.{one.name}"


def test_what_has_state_has_its_settings_in_a_frozen_record() -> None:
    assert list(mixed()) == [], "a setting stands among what changes while it runs"
