"""The API pages (`.ci/api`): each public name has an entry, with its docstring, and each field with its own."""

from __future__ import annotations

import html
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import attrs
import pytest
from here import ROOT

import solepath
from solepath import Session, StrideTaken
from solepath.body.part import Part

TAG = re.compile(r"<[^>]+>")


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


def test_each_field_of_an_event_has_an_entry() -> None:
    page = pages()["solepath"]
    for field in attrs.fields(StrideTaken):
        assert f'id="StrideTaken.{field.name}"' in page, field.name


def test_pages_load_nothing_from_the_network() -> None:
    for name, page in pages().items():
        loaded = re.findall(r"""<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=["']([^"']+)""", page)
        assert [url for url in loaded if re.match(r"(?:[a-z]+:)?//", url)] == [], name
        assert "@import" not in page and "url(http" not in page, name
