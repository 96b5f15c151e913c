"""The table of the page's situations, which docs/page.md prints, and what follows from it in a browser."""

from __future__ import annotations

import re

from browsers import Browser
from here import ROOT
from shown import open_page, scene_after

ROW = re.compile(r"^\| `(\w+)`: .* \| ([\w-]+) \| ?([\w, -]*?) ?\|$", re.MULTILINE)
TABLE = "import('/situation.js').then(({ TABLE, SITUATIONS }) => [TABLE, SITUATIONS])"
START = "computing"
"""Situation in which the page starts."""


async def test_the_documented_table_of_situations_is_total_and_that_of_the_page(chromium: Browser) -> None:
    text = (ROOT / "docs" / "page.md").read_text().partition("<!-- situations -->")[2]
    documented = {name: [to, unchanged.split(", ") if unchanged else []] for name, to, unchanged in ROW.findall(text)}
    async with open_page(chromium, scene_after(2.0)) as (view, _):
        table, names = await view.tab.evaluate(TABLE)
    assert documented == table and len(names) == 13
    assert {to for to, _ in table.values()} == set(names), "each situation is reached"
    reached = {START}
    while more := {to for one in reached for to, unchanged in table.values() if one not in unchanged} - reached:
        reached |= more
    assert reached == set(names)
    assert all(set(unchanged) <= set(names) for _, unchanged in table.values())
