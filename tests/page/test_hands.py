"""Tests the page without a mouse, without eyes, and on a phone: keys, screen reader, and narrow windows."""

from __future__ import annotations

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from browsers import Browser, Window
from shown import CONNECTED, meanwhile, open_page, scene_after, scene_on_plan, walked

from solepath import Session
from solepath.emulate.routes.route import Route
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.player.player_loop import PlayerLoop
from solepath.show.page.scene.scene import Playback, Scene

NARROW_WIDTH = 360
"""Width of a narrow window, px."""
FIND_FAINT_TEXTS = """() => {
    const pen = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
    const luminance = (colours) => {
        for (const colour of ["#fff", ...colours]) {
            pen.fillStyle = colour;
            pen.fillRect(0, 0, 1, 1);
        }
        const linear = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
        const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].map((value) => linear(value / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const faint = [];
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let text = texts.nextNode(); text; text = texts.nextNode()) {
        const one = text.parentElement, style = getComputedStyle(one), grounds = [];
        const seen = one.checkVisibility({ opacityProperty: true, visibilityProperty: true });
        if (!seen || text.data.trim() === "" || one.closest(".unseen, option")) continue;
        for (let at = one; at; at = at.parentElement) grounds.unshift(getComputedStyle(at).backgroundColor);
        const [dark, bright] = [luminance(grounds), luminance([...grounds, style.color])].sort((a, b) => a - b);
        const contrast = (bright + 0.05) / (dark + 0.05), size = parseFloat(style.fontSize);
        const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        if (contrast < (large ? 3 : 4.5)) faint.push(`${text.data.trim()}: ${contrast.toFixed(2)}`);
    }
    return faint;
}"""
"""Script that finds texts with less contrast than WCAG 2.2 requires at level AA (1.4.3)."""


FIND_COVER = """() => {
    const at = document.activeElement, { x, y, width, height } = at.getBoundingClientRect();
    for (const share of [0.1, 0.5, 0.9]) {
        const on = document.elementFromPoint(x + width / 2, y + share * height);
        if (on === null || !at.contains(on)) return `${at.outerHTML} is behind ${on?.outerHTML ?? "an edge"}`;
    }
    return null;
}"""
"""Script that returns what hides a part of the control that has the focus, or null."""

WALK = Route().stand(1.0).walk(16.0, 1.3).stop(2.0)
"""Walk of about 16 s."""


@asynccontextmanager
async def played(chromium: Browser, **given: Any) -> AsyncIterator[tuple[Window, Playback]]:
    """Yield a page that plays a recording of WALK, and its player's state; `given` goes to `open_page`."""
    packets = PackedItems(walked(WALK, cells=16))
    player = Player(packets, Session(poses=True, pressures=True), Scene("a recording", "default", "recording"))
    playing = PlayerLoop(player)
    async with (
        open_page(chromium, player.scene, playing.command, **given) as (view, page),
        meanwhile(playing.run(page, asyncio.Event())),
    ):
        await view.tab.locator("#playback").wait_for(state="visible")
        yield view, player.playback


async def focused(view: Window) -> str:
    found: str = await view.tab.evaluate("() => document.activeElement.dataset.control ?? ''")
    return found


async def test_the_space_bar_pauses_and_goes_on_and_the_arrows_seek(chromium: Browser) -> None:
    async with played(chromium) as (view, playback):
        for state, name in (("paused", "Play"), ("playing", "Pause"), ("paused", "Play")):
            await view.tab.keyboard.press("Space")
            await view.until("(name) => document.getElementById('play').ariaLabel === name", name)
            assert playback.state == state
        t = playback.t
        for key, there in (("ArrowRight", t + 5.0), ("ArrowLeft", t), ("Shift+ArrowRight", playback.end)):
            await view.tab.keyboard.press(key)
            await view.until("(t) => Math.abs(document.getElementById('seek').value - t) < 0.3", there)
        await view.until("Number(document.getElementById('strides').textContent) > 8")
        await view.tab.keyboard.press("Shift+ArrowLeft")
        await view.until("Number(document.getElementById('seek').value) < 0.3")
        await view.until("!(Number(document.getElementById('strides').textContent) > 0)")


async def test_during_a_seek_the_page_shows_its_position_and_its_target(chromium: Browser) -> None:
    scene = scene_after(22.0)
    scene.playback = Playback(start=0.0, end=150.0, t=22.0, state="playing", seeking=115.0)
    async with open_page(chromium, scene, width=NARROW_WIDTH, height=740) as (view, _):
        await view.until("document.getElementById('seeking').innerText === 'Going to 1:55, now at 0:22'")
        await view.until("document.querySelector('main').ariaBusy === 'true'")
        await view.until("document.getElementById('announcer').textContent.includes('Going to 1:55')")
        assert await view.text("time-now") == "0:22"
        scene.playback = Playback(start=0.0, end=150.0, t=115.0, state="playing")
        await view.tab.locator("#seeking").wait_for(state="hidden")
        await view.until("document.querySelector('main').ariaBusy === 'false'")
        assert await view.tab.locator("#seek").get_attribute("aria-valuetext") == "1:55 of 2:30"


async def test_the_speed_is_chosen_from_a_list(chromium: Browser) -> None:
    async with played(chromium) as (view, playback):
        await view.tab.locator("#speed-choice").select_option("4")
        await view.until("document.getElementById('speed-choice').value === '4'")
        await view.until("solepath.state.playback.speed === 4")
        assert playback.speed == 4.0


async def test_plus_minus_and_zero_zoom_the_track(chromium: Browser) -> None:
    async with open_page(chromium, scene_after(20.0)) as (view, _):
        await view.until("Number(document.getElementById('track').dataset.points) > 0")
        for key in "+-":
            await view.tab.keyboard.press(key)
            await view.until("document.getElementById('zoom-fit').ariaPressed === 'false'")
            await view.tab.keyboard.press("0")
            await view.until("document.getElementById('zoom-fit').ariaPressed === 'true'")


async def test_the_tab_key_reaches_every_control_in_the_order_of_the_page(chromium: Browser) -> None:
    async with played(chromium, width=NARROW_WIDTH, height=800) as (view, _):
        await view.tab.keyboard.press("Space")
        await view.until("document.getElementById('play').ariaLabel === 'Play'")
        assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= NARROW_WIDTH
        # so that some of them lie where the playback bar is
        low = await view.tab.evaluate("document.getElementById('zoom').getBoundingClientRect().bottom")
        await view.tab.set_viewport_size({"width": NARROW_WIDTH, "height": round(low) + 10})
        controls = await view.tab.evaluate(
            """() => [...document.querySelectorAll("a[href], button, input, select, summary, [tabindex]")]
                .filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.disabled)
                .filter((one) => one.tabIndex >= 0)
                .map((one, k) => (one.dataset.control = String(k)))"""
        )
        assert len(controls) > 5
        reached = []
        for _ in controls:
            await view.tab.keyboard.press("Tab")
            reached.append(await focused(view))
            assert await view.tab.evaluate(
                "() => { const at = document.activeElement, style = getComputedStyle(at);"
                " return style.outlineStyle !== 'none' || style.boxShadow !== 'none'; }"
            ), f"nothing shows where the focus is: {await view.tab.evaluate('document.activeElement.outerHTML')}"
            assert await view.tab.evaluate(FIND_COVER) is None
        assert reached == controls


async def test_a_page_that_may_only_watch_pauses_nothing(chromium: Browser) -> None:
    async with played(chromium, token=False) as (view, playback):
        for key in ("Space", "ArrowLeft"):
            await view.tab.keyboard.press(key)
        t = playback.t
        await view.until("(t) => solepath.state.t > t", t + 0.5)
        assert playback.state == "playing"
        assert await view.tab.evaluate(CONNECTED)


async def test_a_screen_reader_finds_landmarks_pictures_in_words_and_a_table(chromium: Browser) -> None:
    async with open_page(chromium, scene_after(40.0)) as (view, _):
        await view.until("[...document.querySelectorAll('canvas')].every((one) => !one.ariaLabel.includes('yet'))")
        names = await view.names()
        roles = [role for role, _ in names]
        assert roles.count("banner") == roles.count("main") == roles.count("contentinfo") == 1
        regions = {name for role, name in names if role == "region"}
        assert regions >= {"Activity", "Soles", "Phases", "Track", "Height", "Gait", "Sensors", "What happened"}
        assert len([name for role, name in names if role == "image"]) == 5
        [table] = [name for role, name in names if role == "table"]
        assert table.startswith("Means of steady strides")
        assert {"mean of", "left", "right"} <= {name for role, name in names if role == "columnheader"}
        assert any(name.startswith("stride length") for role, name in names if role == "rowheader")
        assert "status" in roles
        nameless = [role for role, name in names if role in ("button", "slider", "combobox", "image") and not name]
        assert nameless == []


async def test_a_phone_has_nothing_to_scroll_sideways_light_and_dark(chromium: Browser) -> None:
    async def narrow(view: Window) -> None:
        grounds = []
        for scheme in ("light", "dark"):
            await view.tab.emulate_media(color_scheme=scheme)
            assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= NARROW_WIDTH
            ground = await view.tab.evaluate("getComputedStyle(document.body).backgroundColor")
            grounds.append(sum(map(int, re.findall(r"\d+", ground)[:3])))
        assert grounds[0] > 3 * 200 and grounds[1] < 3 * 55

    for scene in (scene_after(40.0), scene_on_plan(29.0)):
        async with open_page(chromium, scene, width=NARROW_WIDTH, height=740) as (view, _):
            await view.until("document.querySelectorAll('#gait-rows tr').length > 0")
            await narrow(view)


async def test_every_text_stands_out_from_its_ground_light_and_dark(chromium: Browser) -> None:
    for dark in (False, True):
        async with open_page(chromium, scene_after(40.0), dark=dark) as (view, _):
            await view.until("document.querySelectorAll('#gait-rows tr').length > 0")
            await view.open_folds()
            assert await view.tab.evaluate(FIND_FAINT_TEXTS) == []
