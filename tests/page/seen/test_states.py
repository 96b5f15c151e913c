"""Tests what can be read on the page in the eight states of page_states.py, in three widths and both themes."""

from __future__ import annotations

import asyncio

import pytest
from browsers import Browser, Window
from measures import NARROWEST, OPEN_ALL, SCREENS, SCRIPT, THEMES, axe_faults, text_faults
from page_states import STATES

REDRAWING = 0.3
"""Time in which the page is drawn again in another size or theme, s."""


async def resize(view: Window, width: int, theme: str) -> str:
    """Show the page at a width in a theme, and return words for both."""
    await view.tab.set_viewport_size({"width": width, "height": (SCREENS | NARROWEST)[width]})
    await view.tab.emulate_media(color_scheme=theme)
    await asyncio.sleep(REDRAWING)
    return f"{width} px, {theme}"


@pytest.mark.parametrize("name", STATES)
async def test_texts_are_large_apart_clear_and_within_the_screen(chromium: Browser, name: str) -> None:
    found: dict[str, list[str]] = {}
    async with STATES[name].open(chromium, script=SCRIPT) as view:
        await view.tab.evaluate("measured.read()")
        for width in SCREENS:
            for theme in THEMES:
                found[await resize(view, width, theme)] = await text_faults(view)
        for width in NARROWEST:
            found[await resize(view, width, "light")] = await text_faults(view)
        await view.tab.evaluate(OPEN_ALL)
        await asyncio.sleep(REDRAWING)
        found["all is open"] = await text_faults(view)
    assert {where: faults for where, faults in found.items() if faults} == {}


@pytest.mark.parametrize("name", STATES)
async def test_axe_finds_no_violation(chromium: Browser, name: str) -> None:
    pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    found: dict[str, list[str]] = {}
    async with STATES[name].open(chromium) as view:
        for width in (max(SCREENS), min(SCREENS)):
            for theme in THEMES:
                found[await resize(view, width, theme)] = await axe_faults(view)
        await view.tab.evaluate(OPEN_ALL)
        found["all is open"] = await axe_faults(view)
        await view.tab.evaluate("document.getElementById('notice-list').showPopover()")
        found["the list of findings is open"] = await axe_faults(view)
    assert {where: faults for where, faults in found.items() if faults} == {}
