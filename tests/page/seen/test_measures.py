"""Tests the measures themselves on small pages, each with one thing wrong on purpose."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest
from browsers import Browser, Window, window
from measures import SCRIPT, axe_faults, key_faults, shifts, tab_faults, text_faults

SOUND = """<!doctype html><html lang="en"><title>A page</title>
<meta name="viewport" content="width=device-width">
<style>body { font: 14px sans-serif; color: #222; background: #fff } button { min-height: 32px }
:focus-visible { outline: 2px solid #05a } canvas { display: block } .over { position: relative; top: -1em }</style>
<main><h1>Heading</h1><p>A first line</p><p>A second line</p><canvas width="200" height="80"></canvas>
<button>Start</button> <button>Stop</button><details><summary>More</summary><p>Text</p></details></main>
<script>
const write = (words, x, y, size = 12) => {
  const context = document.querySelector("canvas").getContext("2d");
  context.font = `${size}px sans-serif`;
  context.fillText(words, x, y);
};
write("five metres", 10, 20);
write("start", 10, 60);
</script>"""
"""A page without a fault."""
BODY_END = "</main>"


def with_script(script: str) -> str:
    return SOUND + f"<script>{script}</script>"


def with_style(style: str) -> str:
    return SOUND.replace("</style>", f"{style}</style>")


@asynccontextmanager
async def small_page(chromium: Browser, content: str) -> AsyncIterator[Window]:
    async with window(chromium, "about:blank", script=SCRIPT, width=360, height=740) as view:
        await view.tab.set_content(content)
        yield view


TEXT_FAULTS = {
    "a text of 10 px": (with_style("p + p { font-size: 10px }"), 'small: 10.0 px: "A second line"'),
    "a label of 11 px": (with_script("write('here', 120, 60, 11)"), 'small: 11.0 px: "here" in canvas'),
    "a line over another": (with_style("p + p { margin-top: -22px }"), 'over: "A first line"'),
    "a label over another": (with_script("write('six metres', 30, 22)"), 'over: "five metres" in canvas'),
    "a label under a button": (
        with_style("button { position: relative; top: -72px }"),
        'over: "five metres" in canvas',
    ),
    "a label beyond its canvas": (with_script("write('far away', 180, 60)"), 'cut: "far away"'),
    "a line that is too long": (with_style("p { width: 400px; text-align: right }"), "wide: the page is 408 px wide"),
    "a word beyond the screen": (
        with_style("body { overflow-x: hidden } h1 { margin-left: 350px }"),
        'wide: "Heading"',
    ),
}


async def test_a_sound_page_has_no_fault(chromium: Browser) -> None:
    async with small_page(chromium, SOUND) as view:
        assert await text_faults(view) == []
        assert await tab_faults(view) == []
        assert await key_faults(view) == []
        assert await shifts(view) == []


@pytest.mark.parametrize("name", TEXT_FAULTS)
async def test_a_fault_of_a_text_is_found(chromium: Browser, name: str) -> None:
    content, fault = TEXT_FAULTS[name]
    async with small_page(chromium, content) as view:
        found = await text_faults(view)
        assert found and all(one.startswith((fault, fault.partition(":")[0])) for one in found)
        assert any(one.startswith(fault) for one in found), found


async def test_an_erased_label_does_not_count(chromium: Browser) -> None:
    erased = "write('six metres', 30, 22); document.querySelector('canvas').getContext('2d').clearRect(0, 0, 200, 80);"
    async with small_page(chromium, with_script(f"{erased} write('four metres', 30, 22)")) as view:
        assert await text_faults(view) == []


async def test_a_label_of_a_layer_counts_where_the_layer_is_drawn(chromium: Browser) -> None:
    layer = """const layer = new OffscreenCanvas(100, 40), context = layer.getContext("2d");
        context.font = "12px sans-serif";
        context.fillText("on a layer", 5, 20);
        document.querySelector("canvas").getContext("2d").drawImage(layer, 5, 0);"""
    async with small_page(chromium, with_script(layer)) as view:
        assert any("on a layer" in one for one in await text_faults(view))


async def test_axe_finds_a_button_without_a_name_a_pale_text_and_a_small_target(chromium: Browser) -> None:
    pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    broken = with_style("h1 { color: #bbb } .small { min-height: 0; width: 12px; height: 12px; padding: 0 }")
    small = '<button class="small" aria-label="One"></button><button class="small" aria-label="Two"></button>'
    for content, rules in (
        (SOUND, set()),
        (broken.replace("Start", "").replace(BODY_END, f"{small}{BODY_END}"), RULES),
    ):
        async with small_page(chromium, content) as view:
            assert {one.partition(":")[0] for one in await axe_faults(view)} == rules


RULES = {"button-name", "color-contrast", "target-size"}


async def test_a_jump_is_found_and_a_change_in_place_is_none(chromium: Browser) -> None:
    async with small_page(chromium, SOUND) as view:
        await asyncio.sleep(0.6)  # what follows set_content counts as input
        await view.tab.evaluate("document.querySelector('p').textContent = 'Another line'")
        await asyncio.sleep(0.2)
        assert await shifts(view) == []
        await view.tab.evaluate("document.querySelector('h1').after('a line that was not there')")
        await view.until("measured.shifts.length > 0")


TAB_FAULTS = {
    "no ring": (with_style("button:focus-visible { outline: none }"), 'no ring (contrast 0.0): button "Start"'),
    "a pale ring": (with_style(":focus-visible { outline-color: #ddd }"), 'no ring (contrast 1.4): button "Start"'),
    "a wrong order": (
        SOUND.replace("<button>Stop", '<button tabindex="1">Stop'),
        'button "Stop" before button "Start"',
    ),
    "a trap": (
        with_script(
            "onkeydown = (event) => { if (document.activeElement.textContent === 'Stop') event.preventDefault(); }"
        ),
        'Tab does not leave the page, but comes to button "Stop"',
    ),
}


@pytest.mark.parametrize("name", TAB_FAULTS)
async def test_a_fault_on_the_way_of_tab_is_found(chromium: Browser, name: str) -> None:
    content, fault = TAB_FAULTS[name]
    async with small_page(chromium, content) as view:
        assert fault in await tab_faults(view)


async def test_a_control_that_ignores_keys_is_found(chromium: Browser) -> None:
    deaf = "document.querySelector('button').addEventListener('keydown', (event) => event.preventDefault())"
    async with small_page(chromium, with_script(deaf)) as view:
        assert await key_faults(view) == [f'{key} does not operate button "Start"' for key in ("Enter", "Space")]
