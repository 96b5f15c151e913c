"""The API pages (`.ci/api`) have what the documentation imports, and each public name has an entry there."""

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
from solepath import Session

TAG = re.compile(r"<[^>]+>")
SRC = ROOT / "src" / "solepath"
THROUGH_THE_PACKAGE = {"solepath.types", "solepath.events", "solepath.session"}
"""Rooms whose names an app imports from `solepath`."""
COMMAND = {"solepath.cli"}
"""The room of the command line, which has pages of its own (docs/commands.md)."""
EXAMPLES_OF_A_KIND = {
    "solepath.body.fuse.position",
    "solepath.emulate.controllers",
    "solepath.fleet.jvm",
    "solepath.fleet.spark",
    "solepath.foot.attitude",
    "solepath.foot.stance.cycle",
    "solepath.link.devices.cc2650",
    "solepath.link.devices.insole",
    "solepath.papers.kupt_dfpc.noise",
    "solepath.wire.receiver",
}
"""Modules that the documentation imports as one of several, without a page."""
SIGNATURES = {
    "solepath.session.host",
    "solepath.link.setup.device_setup",
    "solepath.recipes", "solepath.floorplan.plan", "solepath.foot.view", "solepath.foot.navigate.corrector",
    "solepath.events.foot",
    "solepath.recording.bids.names", "solepath.recording.bids.writer",
    "solepath.recording.lsl.clock", "solepath.recording.lsl.inlet", "solepath.recording.lsl.outlet",
}  # fmt: skip
"""Modules of the classes that the methods of an extension, or a session, receive and return, and of formats that
docs/formats.md leaves to their API pages."""


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


@cache
def pages() -> dict[str, str]:
    """Return the text of each page, by the name of its module."""
    with TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / ".ci" / "api", folder], check=True, stdin=subprocess.DEVNULL)
        paths = Path(folder).rglob("*.html")
        return {".".join(path.relative_to(folder).with_suffix("").parts): path.read_text("utf-8") for path in paths}


def test_every_room_and_every_module_that_the_documentation_imports_is_listed() -> None:
    assert rooms() - THROUGH_THE_PACKAGE - COMMAND <= listed()
    assert shown_to_readers() - THROUGH_THE_PACKAGE - EXAMPLES_OF_A_KIND <= listed()
    assert shown_to_readers() | rooms() | SIGNATURES >= listed() >= SIGNATURES


@pytest.mark.soak
def test_each_public_name_has_an_entry_with_its_docstring_and_nothing_is_loaded_from_the_network() -> None:
    assert [name for name in solepath.__all__ if f'id="{name}"' not in pages()["solepath"] and name != "recipes"] == []
    for module in sorted(listed()):
        assert [name for name in public(module) if f'id="{name}"' not in pages()[module]] == [], module
    text = " ".join(html.unescape(TAG.sub("", pages()["solepath"])).split())
    for name, value in vars(Session).items():
        if not name.startswith("_") and inspect.isfunction(value):
            assert f'id="Session.{name}"' in pages()["solepath"], name
            assert " ".join((value.__doc__ or "?").split("\n\n")[0].split()).replace("`", "") in text, name
    assert 'id="StrideTaken.length"' in pages()["solepath"]
    for name, page in pages().items():
        loaded = re.findall(r"""<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=["']([^"']+)""", page)
        assert [url for url in loaded if re.match(r"(?:[a-z]+:)?//", url)] == [], name
        assert "@import" not in page and "url(http" not in page, name
