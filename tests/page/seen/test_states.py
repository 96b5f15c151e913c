"""Tests what can be read on the page in eight states (tests/helpers/page/states.py), three widths and both themes."""

from __future__ import annotations

import asyncio

import pytest
from browsers import Browser
from measures import SCREENS, SCRIPT, THEMES, axe_faults, text_faults
from states import STATES

REDRAWING = 0.3
"""Time in which the page is drawn again in another size or theme, s."""


@pytest.mark.parametrize("name", STATES)
async def test_texts_are_large_enough_and_apart_and_within_the_screen(chromium: Browser, name: str) -> None:
    found: dict[int, list[str]] = {}
    async with STATES[name].open(chromium, script=SCRIPT) as view:
        for width, height in SCREENS.items():
            await view.tab.set_viewport_size({"width": width, "height": height})
            await asyncio.sleep(REDRAWING)
            found[width] = await text_faults(view)
    assert {width: faults for width, faults in found.items() if faults} == {}


@pytest.mark.parametrize("name", STATES)
async def test_axe_finds_no_violation(chromium: Browser, name: str) -> None:
    pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    found: dict[str, list[str]] = {}
    async with STATES[name].open(chromium) as view:
        for width in (min(SCREENS), max(SCREENS)):
            await view.tab.set_viewport_size({"width": width, "height": SCREENS[width]})
            for theme in THEMES:
                await view.tab.emulate_media(color_scheme=theme)
                await asyncio.sleep(REDRAWING)
                found[f"{width} {theme}"] = await axe_faults(view)
    assert {where: faults for where, faults in found.items() if faults} == {}
