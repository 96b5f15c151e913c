"""Tests the page with nothing but a keyboard."""

from __future__ import annotations

import asyncio

import pytest
from browsers import Browser
from measures import OPEN_ALL, SCREENS, SCRIPT, THEMES, focused, key_faults, tab_faults
from page_states import STATES

REDRAWING = 0.3
"""Time in which the page is drawn again in another size or theme, s."""
OPERATED = ("plan", "finished")
"""States with all controls that there are."""
REACHED = (*OPERATED, "lost-link", "no-insole")
"""States with other controls, and with regions at other places."""


@pytest.mark.parametrize("name", REACHED)
async def test_tab_reaches_every_control_in_visual_order_and_shows_where_it_is(chromium: Browser, name: str) -> None:
    found: dict[str, list[str]] = {}
    async with STATES[name].open(chromium, script=SCRIPT) as view:
        for width, height in SCREENS.items():
            await view.tab.set_viewport_size({"width": width, "height": height})
            for theme in THEMES:
                await view.tab.emulate_media(color_scheme=theme)
                await asyncio.sleep(REDRAWING)
                found[f"{width} {theme}"] = await tab_faults(view)
        await view.tab.evaluate(OPEN_ALL)
        await asyncio.sleep(REDRAWING)
        found["all is open"] = await tab_faults(view)
    assert {where: faults for where, faults in found.items() if faults} == {}


@pytest.mark.parametrize("name", OPERATED)
async def test_keys_operate_every_control(chromium: Browser, name: str) -> None:
    async with STATES[name].open(chromium, script=SCRIPT) as view:
        assert await key_faults(view) == []


async def test_escape_leaves_the_report_of_a_position_and_the_focus_stays(chromium: Browser) -> None:
    async with STATES["plan"].open(chromium, script=SCRIPT) as view:
        pressed = "document.getElementById('here-place').ariaPressed"
        await view.tab.locator("#here-place").focus()
        for key, state in (("Enter", "true"), ("Escape", "false")):
            await view.tab.keyboard.press(key)
            await view.until(f"{pressed} === '{state}'")
        now = await focused(view)
        assert now is not None and now.name == "#here-place"
