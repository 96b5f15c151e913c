"""The site of README.md, docs/ and protocol/, with the pages of the API; docs/architecture.md has its command.

The pages are the files as they are; only links to folders, which a site does not have, become text. Nothing is loaded
from the network, neither while the site is built nor by its pages."""

import re
import runpy
import subprocess
import sys
import tomllib
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

ROOT = Path(__file__).resolve().parents[2]
about = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]

project, version = about["name"], about["version"]
project_copyright = re.search(r"\d{4} .*", (ROOT / "LICENSE").read_text("utf-8"))[0]
html_title = f"{project} {version}"
extensions = ["myst_parser"]
root_doc = "README"
include_patterns = ["README.md", "CHANGELOG.md", "docs/*.md", "docs/papers/*.md", "protocol/*.md"]
html_theme = "furo"
html_copy_source = html_show_sourcelink = False
myst_heading_anchors = 4
"""Headings up to this level have the anchors that links on the pages use."""
myst_enable_extensions = ["html_image"]
suppress_warnings = [
    "myst.header",  # README.md begins with a level that is not repeated
    "misc.highlighting_failure",  # byte tables of protocol/ are no JSON, though they say so
]

PAGE = re.compile(r"\]\((\w[\w-]*)\.md\)")
"""A link from docs/start.md to another page of docs/."""
LINK = re.compile(r"\[([^]]+)\]\(([^)\s#:]+)\)")


GO_ON = f"""<!doctype html>
<meta charset="utf-8"><title>{project}</title><meta http-equiv="refresh" content="0; url={root_doc}.html">
"""


def tables_of_contents() -> str:
    groups, title = {"Start": ["docs/start"]}, ""
    _, index = (ROOT / "docs" / "start.md").read_text("utf-8").split("\n## All pages\n", 1)
    for group in index.split("\n\n"):  # the order of the pages is the one of the index there
        if pages := dict.fromkeys(PAGE.findall(group)):
            groups[title] = [f"docs/{page}" for page in pages]
        else:
            title = group.strip().rstrip(":")
    groups |= {
        "Papers": [f"docs/papers/{path.stem}" for path in sorted((ROOT / "docs" / "papers").glob("*.md"))],
        "Protocol": [f"protocol/{path.stem}" for path in sorted((ROOT / "protocol").glob("*.md"))],
        "Project": ["CHANGELOG"],
    }
    return "\n\n".join(
        "\n".join(["```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```"])
        for caption, pages in groups.items()
    )


def modules() -> str:
    """Return links to the pages that pdoc makes, relative to docs/."""
    names = runpy.run_path(str(ROOT / ".ci" / "api"))["MODULES"]
    links = [f'<li><a href="../api/{name.replace(".", "/")}.html"><code>{name}</code></a></li>' for name in names]
    return "<ul>\n" + "\n".join(links) + "\n</ul>"


def read(app: Sphinx, name: str, source: list[str]) -> None:
    """Add the tables of contents to README.md and the modules to docs/architecture.md; links to folders become text."""
    here = (ROOT / f"{name}.md").parent

    def link(found: re.Match[str]) -> str:
        text, target = found.groups()
        return f"{text} (`{target.lstrip('./')}`)" if (here / target).is_dir() else found[0]

    source[0] = LINK.sub(link, source[0]).replace("<!-- modules -->", modules() if name == "docs/architecture" else "")
    if name == root_doc:
        source[0] += f"\n\n{tables_of_contents()}\n"


def add_pages(app: Sphinx, error: Exception | None) -> None:
    """Add the pages of the API, and an index.html, which servers and people look for first."""
    if error is None and app.builder.format == "html":
        out = Path(app.outdir)
        done = subprocess.run([sys.executable, ROOT / ".ci" / "api", out / "api"], capture_output=True, text=True)
        if done.returncode:
            raise ExtensionError(f"the pages of the API: {done.stderr}")
        (out / "index.html").write_text(GO_ON, "utf-8")


def setup(app: Sphinx) -> None:
    app.connect("source-read", read)
    app.connect("build-finished", add_pages)
