"""Each public class, function and method has a docstring, unless it overrides a method that has one."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator

from here import ROOT

SRC = ROOT / "src" / "solepath"
Function = ast.FunctionDef | ast.AsyncFunctionDef
SOURCES = {path.relative_to(SRC).as_posix(): path.read_text("utf-8") for path in sorted(SRC.rglob("*.py"))}
"""Texts of the modules by path."""


def names(expressions: list[ast.expr]) -> set[str]:
    """Return the last words of dotted names, without what is in brackets: {"Protocol"} of typing.Protocol[T]."""
    return {ast.unparse(one).partition("[")[0].partition("(")[0].split(".")[-1] for one in expressions}


def classes(sources: dict[str, str]) -> dict[str, list[ast.ClassDef]]:
    """Return the classes of all modules by name."""
    found: dict[str, list[ast.ClassDef]] = {}
    for text in sources.values():
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, []).append(node)
    return found


def described(cls: ast.ClassDef) -> set[str]:
    """Return the names of a class's methods that have docstrings."""
    return {one.name for one in cls.body if isinstance(one, Function) and ast.get_docstring(one)}


def inherited(cls: ast.ClassDef, known: dict[str, list[ast.ClassDef]]) -> set[str]:
    """Return the names of the methods that have docstrings in a base, however far up."""
    bases = [base for name in names(cls.bases) for base in known.get(name, ()) if base is not cls]
    return set().union(*(described(base) | inherited(base, known) for base in bases))


def is_foreign(cls: ast.ClassDef, known: dict[str, list[ast.ClassDef]]) -> bool:
    """Return whether a base, however far up, is of another package, which documents the methods that are overridden."""
    own_bases = [base for name in names(cls.bases) for base in known.get(name, ()) if base is not cls]
    plain = {"Protocol", "Generic", "Enum", "IntEnum", "NamedTuple", "TypedDict", *dir(builtins)}
    return bool(names(cls.bases) - known.keys() - plain) or any(is_foreign(base, known) for base in own_bases)


def bare(sources: dict[str, str]) -> Iterator[str]:
    """Yield path, line and name of each public definition without docstring."""
    known = classes(sources)
    # a class that implements a protocol need not name it
    promised = {m for same in known.values() for one in same if "Protocol" in names(one.bases) for m in described(one)}
    for path, text in sources.items():
        for node in ast.parse(text).body:
            if not isinstance(node, ast.ClassDef | Function) or node.name.startswith("_"):
                continue
            if not ast.get_docstring(node):
                yield f"{path}:{node.lineno} {node.name}"
            if isinstance(node, ast.ClassDef) and not is_foreign(node, known):
                done = promised | inherited(node, known)
                for one in node.body:
                    if not isinstance(one, Function) or one.name.startswith("_") or one.name in done:
                        continue
                    if not ast.get_docstring(one) and not names(one.decorator_list) & {"overload", "setter"}:
                        yield f"{path}:{one.lineno} {node.name}.{one.name}"


def test_each_public_class_function_and_method_has_a_docstring() -> None:
    assert list(bare(SOURCES)) == []


def test_a_definition_without_docstring_is_found_and_an_override_is_none() -> None:
    base = 'class Base:\n    """A base."""\n    def feed(self):\n        """Feed it."""\n'
    assert list(bare({"a.py": base + 'class Part(Base):\n    """A part."""\n    def feed(self): ...\n'})) == []
    assert list(bare({"a.py": "class Part:\n    def feed(self): ...\ndef run(): ...\n"})) == [
        "a.py:1 Part", "a.py:2 Part.feed", "a.py:3 run",
    ]  # fmt: skip
