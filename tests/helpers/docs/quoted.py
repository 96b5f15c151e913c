"""Finds blocks and tables in README.md and docs/, runs programs there, and compares what is quoted with what is new."""

import io
import re
from contextlib import redirect_stdout
from typing import Any

import pytest
from here import DOCS, ROOT

PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", *sorted((DOCS).glob("*.md")))
}
"""Texts of README.md and of the pages in docs/, by their paths."""
README = PAGES["README.md"]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def blocks(text: str, language: str) -> list[str]:
    """Return the blocks of code in that language."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def run_page(page: str, name: str = "page", programs: slice = slice(None)) -> tuple[list[str], dict[str, Any]]:
    """Run the Python programs of a page one after the other; return what each printed, and their names.

    `name` is what they have as `__name__`, and `programs` chooses some of them."""
    names: dict[str, Any] = {"__name__": name}
    printed = []
    for program in blocks(PAGES[page], "python")[programs]:
        with redirect_stdout(io.StringIO()) as out:
            exec(compile(program, page, "exec"), names)
        printed.append(out.getvalue())
    return printed, names


def page_of(mark: str) -> str:
    """Return the path of the one page that holds the comment <!-- mark -->."""
    (path,) = (path for path, text in PAGES.items() if f"<!-- {mark} -->\n" in text)
    return path


def below(mark: str) -> list[str]:
    """Return the lines of the block or table below the comment <!-- mark -->, which is on one page."""
    lines = PAGES[page_of(mark)].split(f"<!-- {mark} -->\n", 1)[1].splitlines()
    if lines[0].startswith("```"):
        return lines[1 : lines.index("```", 1)]
    end = next((n for n, line in enumerate(lines) if not line.startswith("|")), len(lines))
    return lines[:end]


def nearly_the_same(quoted: list[str], fresh: list[str]) -> None:
    """Check that lines are the same, except that a figure may differ by one in its last digit."""
    assert [NUMBER.sub("#", line) for line in quoted] == [NUMBER.sub("#", line) for line in fresh]
    for old, new in zip(quoted, fresh, strict=True):
        for a, b in zip(NUMBER.findall(old), NUMBER.findall(new), strict=True):
            # another machine's rounding may move the last digit by one
            last = 10.0 ** -len(a.partition(".")[2])
            assert float(a) == pytest.approx(float(b), abs=1.01 * last), f"quoted: {old}\nprinted: {new}"
