"""The API pages (`.ci/api`): each public name has an entry, with its docstring, and each field with its own."""

from __future__ import annotations

import ast
import html
import importlib
import inspect
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from here import DOCS, EXAMPLES, ROOT

import solepath
from solepath import Session, events
from solepath.body.part import Part
from solepath.events.happening import Happening

TAG = re.compile(r"<[^>]+>")
SRC = ROOT / "src" / "solepath"
THROUGH_THE_PACKAGE = {"solepath.types", "solepath.events", "solepath.session"}
"""Rooms whose names an app imports from `solepath`."""
COMMAND = {"solepath.cli"}
"""The room of the command line, which has pages of its own (docs/commands.md)."""
EXAMPLES_OF_A_KIND = {
    "solepath.body.fuse.position",
    "solepath.emulate.controllers",
    "solepath.fleet.bytewax",
    "solepath.fleet.lines",
    "solepath.fleet.spark",
    "solepath.foot.attitude",
    "solepath.foot.stance.cycle",
    "solepath.foot.stance.pressure",
    "solepath.link.devices.insole",
    "solepath.papers.kupt_dfpc.noise",
    "solepath.wire.receiver",
}
"""Modules that the documentation imports as one of several, without a page."""
SIGNATURES = {
    "solepath.recipes", "solepath.floorplan.plan", "solepath.foot.view", "solepath.foot.navigate.corrector",
    "solepath.events.foot",
}  # fmt: skip
"""Modules of the classes that the methods of an extension, or a session, receive and return."""


def listed() -> set[str]:
    """Return the names of the modules that .ci/api lists."""
    for node in ast.parse((ROOT / ".ci" / "api").read_text("utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "MODULES":
            return set(ast.literal_eval(node.value))
    raise AssertionError(".ci/api has no MODULES")


def rooms() -> set[str]:
    """Return the names of the packages directly below solepath that say what is public."""
    files = [file for file in SRC.glob("*/__init__.py") if "__all__" in file.read_text("utf-8")]
    return {f"solepath.{file.parent.name}" for file in files} | {"solepath"}


def shown_to_readers() -> set[str]:
    """Return the names of the modules that README.md, docs/ and examples/ import from."""
    texts = [path.read_text("utf-8") for path in (ROOT / "README.md", *DOCS.glob("*.md"), *EXAMPLES.rglob("*.py"))]
    return set(re.findall(r"^ *(?:from|import) (solepath[a-z0-9_.]*)", "\n".join(texts), re.MULTILINE))


def public(name: str) -> list[str]:
    """Return the names of a module's public classes and functions."""
    module = importlib.import_module(name)
    own = [key for key, value in vars(module).items() if getattr(value, "__module__", "") == name and key[0] != "_"]
    names = getattr(module, "__all__", own)
    return [key for key in names if inspect.isclass(getattr(module, key)) or inspect.isfunction(getattr(module, key))]


def field_texts(cls: type) -> dict[str, str]:
    """Return the docstrings below the fields that a class declares itself, by name; empty for none."""
    texts: dict[str, str] = {}
    body = ast.parse(inspect.getsource(cls)).body[0].body  # type: ignore[attr-defined]
    for field, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(field, ast.AnnAssign):
            texts[ast.unparse(field.target)] = ast.literal_eval(after.value) if isinstance(after, ast.Expr) else ""
    return texts


def letters(text: str) -> str:
    """Return letters and digits only, because the pages show Markdown and typographic quotes."""
    return re.sub(r"[\W_]+", "", text)


EVENT_CLASSES = sorted(
    {one for one in map(events.__dict__.get, solepath.__all__) if inspect.isclass(one) and issubclass(one, Happening)},
    key=lambda one: one.__name__,
)


@cache
def pages() -> dict[str, str]:
    """Return the text of each page, by the name of its module."""
    with TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / ".ci" / "api", folder], check=True, stdin=subprocess.DEVNULL)
        paths = Path(folder).rglob("*.html")
        return {".".join(path.relative_to(folder).with_suffix("").parts): path.read_text("utf-8") for path in paths}


def words(page: str) -> str:
    """Return the visible text of a page, with single spaces."""
    return " ".join(html.unescape(TAG.sub("", page)).split())


def test_each_name_of_the_package_has_an_entry() -> None:
    page = pages()["solepath"]
    assert [name for name in solepath.__all__ if f'id="{name}"' not in page and name != "recipes"] == []


@pytest.mark.parametrize("cls, module", [(Session, "solepath"), (Part, "solepath.body.part")])
def test_each_method_has_an_entry_with_its_docstring(cls: type, module: str) -> None:
    page = words(pages()[module])
    for name, value in vars(cls).items():
        text = getattr(value, "__doc__", None)
        if not name.startswith("_") and callable(value) and text:
            assert f'id="{cls.__name__}.{name}"' in pages()[module], name
            first = " ".join(text.split("\n\n")[0].split()).replace("`", "")
            assert first in page, name


def test_every_room_with_public_names_is_listed() -> None:
    assert rooms() - THROUGH_THE_PACKAGE - COMMAND <= listed()


def test_every_module_that_the_documentation_imports_is_listed() -> None:
    assert shown_to_readers() - THROUGH_THE_PACKAGE - EXAMPLES_OF_A_KIND <= listed()
    assert shown_to_readers() | rooms() | SIGNATURES >= listed() >= SIGNATURES


@pytest.mark.parametrize("module", sorted(listed()))
def test_each_public_class_and_function_of_a_listed_module_is_on_its_page(module: str) -> None:
    assert [name for name in public(module) if f'id="{name}"' not in pages()[module]] == []


@pytest.mark.parametrize("cls", EVENT_CLASSES, ids=lambda cls: cls.__name__)
def test_each_field_of_an_event_has_an_entry_with_its_docstring(cls: type) -> None:
    """Fields that a class inherits have their entry on the page of the class that declares them."""
    for declaring in cls.__mro__[:-1]:
        page = pages()["solepath" if hasattr(solepath, declaring.__name__) else declaring.__module__]
        entries = re.split(r'(?=<div id="|<section id=")', page)
        for name, text in field_texts(declaring).items():
            (entry,) = [one for one in entries if one.startswith(f'<div id="{declaring.__name__}.{name}"')]
            assert letters(text) in letters(words(entry)), name


def test_the_events_and_their_fields_are_found() -> None:
    assert {"StrideTaken", "HeelStrike", "WearerMoved"} <= {cls.__name__ for cls in EVENT_CLASSES}
    assert set(field_texts(Happening)) == {"t", "known_at", "final"}


def test_pages_load_nothing_from_the_network() -> None:
    for name, page in pages().items():
        loaded = re.findall(r"""<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=["']([^"']+)""", page)
        assert [url for url in loaded if re.match(r"(?:[a-z]+:)?//", url)] == [], name
        assert "@import" not in page and "url(http" not in page, name
