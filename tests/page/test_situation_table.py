"""The table of the page's situations, whose names are in docs/browser.md, and what follows from it in a browser."""

from __future__ import annotations

import re

import pytest
from browsers import Browser
from here import DOCS
from shown import empty_scene, open_page, packets_between, scene_after, show

from solepath import Connected, Disconnected, Site

TABLE = "import('/situation.js').then(({ TABLE, SITUATIONS }) => [TABLE, SITUATIONS])"
START = "computing"
"""Situation in which the page starts."""


async def test_the_table_of_situations_is_total_and_the_documented_names_are_its_own(chromium: Browser) -> None:
    text = (DOCS / "browser.md").read_text().split("\n## Situations\n", 1)[1].split("\n## ", 1)[0]
    async with open_page(chromium, scene_after(2.0)) as (view, _):
        table, names = await view.tab.evaluate(TABLE)
    assert sorted(re.findall(r"\*([\w-]+)\*", text)) == sorted(names) and len(names) == 13
    assert {to for to, _ in table.values()} == set(names), "each situation is reached"
    reached = {START}
    while more := {to for one in reached for to, unchanged in table.values() if one not in unchanged} - reached:
        reached |= more
    assert reached == set(names)
    assert all(set(unchanged) <= set(names) for _, unchanged in table.values())


@pytest.mark.soak
async def test_a_live_page_says_what_is_from_the_first_sensor_to_a_lost_one(chromium: Browser) -> None:
    scene, left = empty_scene(), Site.LEFT_FOOT
    async with open_page(chromium, scene) as (view, _):
        seen = "[document.body.dataset.situation, document.getElementById('activity').textContent].join()"
        await view.until(f"{seen} === 'connecting,Connecting'")
        scene.take(None, [Connected(t=0.0, known_at=0.0, site=left, device="", name="Insole", signal=-50)])
        await view.until(f"{seen} === 'connected,Connected'")
        await show(scene, packets_between(-1.0, 8.0), speed=8.0)
        await view.until(f"{seen} === 'walking,Walking'")
        scene.take(None, [Disconnected(t=scene.now, known_at=scene.now, site=left)])
        await view.until(f"{seen} === 'lost,Walking'")
