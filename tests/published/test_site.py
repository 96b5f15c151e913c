"""The site (docs/architecture.md): it builds without a warning, links lead somewhere, nothing comes from elsewhere."""

from __future__ import annotations

import re
import subprocess
import sys
from functools import cache
from html import unescape
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from here import DOCS, PROTOCOL, ROOT

pytest.importorskip("sphinx", reason="the extra docs is not installed")

LOADED = {"img", "script", "link", "iframe", "source", "video", "audio"}
"""Elements whose address the browser fetches by itself."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the built site; the command is that of docs/architecture.md."""
    out = tmp_path_factory.mktemp("site")
    (command,) = re.findall(r"^sphinx-build (.+) site$", (DOCS / "architecture.md").read_text("utf-8"), re.MULTILINE)
    words = [sys.executable, "-m", "sphinx", *command.split(), str(out), "-q"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return out


@cache
def page(path: Path) -> tuple[set[str], set[str], set[str]]:
    """Return the anchors of a page, where its links lead, and what a browser loads with it."""
    text = re.sub(r"(<script[^>]*>).*?</script>", r"\1", path.read_text("utf-8"), flags=re.DOTALL)
    links: set[str] = set()
    loads: set[str] = set()
    for tag, attributes in re.findall(r"<(\w+)\s([^>]*)>", text):
        if target := re.search(r'\b(?:href|src)="([^"]+)"', attributes):
            (loads if tag in LOADED and 'rel="canonical"' not in attributes else links).add(unescape(target[1]))
    return {"", *map(unescape, re.findall(r'\b(?:id|name)="([^"]+)"', text))}, links, loads


@pytest.mark.soak
def test_every_page_of_the_checkout_is_in_the_site(site: Path) -> None:
    sources = [ROOT / "README.md", ROOT / "CHANGELOG.md", *DOCS.rglob("*.md"), *PROTOCOL.glob("*.md")]
    assert [path for path in sources if not (site / path.relative_to(ROOT).with_suffix(".html")).is_file()] == []
    assert (site / "api" / "solepath" / "recording.html").is_file()
    contents = page(site / "README.html")[1]
    assert [
        path for path in DOCS.rglob("*.md") if f"{path.relative_to(ROOT).with_suffix('.html')}" not in contents
    ] == []


@pytest.mark.soak
def test_every_link_leads_to_a_page_and_to_a_place_on_it(site: Path) -> None:
    dead = []
    for path in site.rglob("*.html"):
        _, links, loads = page(path)
        for target in links | loads:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            file = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            file = file / "index.html" if file.is_dir() else file
            if not file.is_file() or file.suffix == ".html" and unquote(parts.fragment) not in page(file)[0]:
                dead.append(f"{path.relative_to(site)}: {target}")
    assert dead == []


@pytest.mark.soak
def test_no_page_loads_anything_from_elsewhere(site: Path) -> None:
    for path in site.rglob("*.html"):
        assert [url for url in page(path)[2] if re.match(r"(?:[a-z]+:)?//", url)] == [], path.name
    for path in site.rglob("*.css"):
        assert not re.search(r"@import|url\([\"']?(?:https?:)?//", path.read_text("utf-8")), path.name
