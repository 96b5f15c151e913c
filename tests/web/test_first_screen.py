"""The first screen of the site while Python has not started, here a worker that never does; and what would move it."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from browsers import Browser, Window, window
from measures import SCRIPT, shifts

from solepath.show.web.serve import serving

NO_PYTHON = "globalThis.Worker = class { postMessage() {} terminate() {} };"
HEADING = "document.getElementById('activity').textContent"
LONG = "A recording that cannot be read for a reason that takes many words. " * 8
SAY = "(words) => import('./computer.js').then(({ computer }) => computer.emit('words', words))"
WALK = "{ began: Date.now() / 1000, title: '', name: 'walk', resumed: false, t: 0 }"
START = f"import('./computer.js').then(({{ computer }}) => computer.emit('walk', {WALK}))"
FOOT = "{ phase: null, position: null, peak: null, cells: null, centre: null, strides: 0, distance: 0 }"
SCENE = """(foot) => import('./computer.js').then(({ computer }) => computer.emit('text', JSON.stringify({
    type: 'scene', title: 'a walk', recipe: 'default', source: 'live', control: true, plan: null,
    layouts: { left: null, right: null }, tracks: { left: [], right: [], wearer: [] },
    phases: { left: [], right: [] },
    places: [], log: [], reports: [],
    frame: { t: 1, feet: { left: foot, right: foot }, wearer: null, place: null, activity: null,
             pace: null, support: null,
        touchdown: null, body: null, fused: null, gait: null, total: null,
        scales: {}, spoilt: [], findings: [], links: {},
        playback: null, posture: null },
})))"""
OFFERED = "document.getElementById('here-place').checkVisibility({ visibilityProperty: true })"
NEWS = "document.querySelector('.news').checkVisibility()"


@asynccontextmanager
async def opened(chromium: Browser, site: Path) -> AsyncIterator[Window]:
    script = f"{NO_PYTHON}{SCRIPT}"
    with serving(site) as url:
        async with window(chromium, url, width=390, height=844, script=script) as view:
            await view.until(f"{HEADING} === 'Choose a sensor'")
            yield view


@pytest.mark.long
async def test_a_sensor_can_be_chosen_before_python_has_started_and_who_asks_for_more_is_told_to_wait(
    chromium: Browser, site: Path
) -> None:
    async with opened(chromium, site) as view:
        assert await view.tab.locator("#connect").is_enabled()
        await view.tab.locator("#demo").click()
        await view.until(f"{HEADING} === 'One moment'")
        assert not view.complaints, view.complaints


@pytest.mark.long
async def test_a_long_message_lies_over_the_page_until_it_is_closed_and_nothing_moves(
    chromium: Browser, site: Path
) -> None:
    async with opened(chromium, site) as view:
        await view.tab.evaluate("measured.shifts.length = 0")
        await view.tab.evaluate(SAY, LONG)
        await view.until(NEWS)
        assert not await shifts(view)
        await view.tab.locator("#news-close").click()
        await view.until(f"!{NEWS}")


@pytest.mark.long
async def test_a_person_may_say_where_they_are_once_there_are_data(chromium: Browser, site: Path) -> None:
    async with opened(chromium, site) as view:
        await view.tab.evaluate(START)
        await view.tab.evaluate(SCENE, None)
        await view.until("solepath.state.known")
        await view.tab.evaluate("new Promise((resolve) => setTimeout(resolve, 200))")
        assert not await view.tab.evaluate(OFFERED)
        await view.tab.evaluate(f"(({SCENE})({FOOT}))")
        await view.until(OFFERED)
