"""Each `from X import Y` of the tests, the examples and the programs of .ci names something that X has."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from here import EXAMPLES, HELPERS, ROOT, TESTS

SRC = ROOT / "src"
Scope = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
FOLDERS = (SRC, HELPERS, *sorted(path for path in HELPERS.iterdir() if path.is_dir()))
"""Folders from which the tests import by a top name."""


def programs() -> Iterator[Path]:
    """Yield the Python files of tests, examples and .ci."""
    for top in (TESTS, EXAMPLES, ROOT / ".ci"):
        for path in sorted(top.rglob("*")):
            if path.is_file() and (path.suffix == ".py" or path.read_bytes()[:64].split(b"\n")[0].endswith(b"python3")):
                yield path


def find(module: str, beside: Path) -> Path | None:
    """Return the file of a module of solepath, or of one in the helpers or `beside`; None for any other package."""
    for folder in (*FOLDERS, beside):
        path = folder.joinpath(*module.split("."))
        for file in (path.with_suffix(".py"), path / "__init__.py"):
            if file.is_file():
                return file
    return None


def outside_functions(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a module that are within neither a function nor a class, and the functions and classes."""
    for node in ast.iter_child_nodes(tree):
        yield node
        if not isinstance(node, Scope):
            yield from outside_functions(node)


@cache
def bound(file: Path) -> set[str]:
    """Return the names of a module: those it defines or imports, its submodules, and those it loads on request."""
    nodes = list(outside_functions(ast.parse(file.read_text("utf-8"))))
    names = {node.name for node in nodes if isinstance(node, Scope)}
    names |= {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    for node in nodes:
        if isinstance(node, ast.Import | ast.ImportFrom):
            names |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
    if "__getattr__" in names:
        names |= {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    if file.name == "__init__.py":
        names |= {path.stem for path in file.parent.iterdir()}
    return names


def broken(source: str, beside: Path) -> Iterator[str]:
    """Yield each import of a source that cannot be resolved."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.ImportFrom) or node.level or not node.module:
            continue
        file = find(node.module, beside)
        if file is None:
            if node.module.partition(".")[0] == "solepath" and not SRC.joinpath(*node.module.split(".")).is_dir():
                yield f"{node.lineno}: there is no module {node.module}"
            continue
        yield from (f"{node.lineno}: {node.module} has no {alias.name}" for alias in node.names
                    if alias.name != "*" and alias.name not in bound(file))  # fmt: skip


def test_each_name_imported_from_solepath_and_from_the_helpers_exists() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{one}" for path in programs() for one in broken(path.read_text("utf-8"), path.parent)
    ]
    assert not found, "\n".join(found)


def test_a_lost_module_and_a_lost_name_are_found() -> None:
    assert list(broken("from solepath.body.lost import Wear", TESTS)) == ["1: there is no module solepath.body.lost"]
    assert list(broken("from solepath.body.worn.wear import Lost", TESTS)) == ["1: solepath.body.worn.wear has no Lost"]
    assert list(broken("from here import LOST", TESTS)) == ["1: here has no LOST"]
    assert list(broken("from solepath import Session\nfrom here import ROOT\nfrom os import path", TESTS)) == []
