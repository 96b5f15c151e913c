"""The page without a mouse, without eyes, and on a phone: keys, what a screen reader is told, and narrow windows."""

from __future__ import annotations

import re

import pytest

from browsers import Browser, Browsing, Window
from shown import CONNECTED, after, between, opened, placed, show
from solepath.page.messages import Command
from solepath.page.scene import Playback

NARROW = 360
"""px."""
FAINT = """() => {
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
"""Texts with less contrast than WCAG 2.2 asks for at level AA (1.4.3)."""


class Tape:
    """A recording that does what the page asks for. `asked`: what it asked for."""

    def __init__(self) -> None:
        self.asked: list[Command] = []
        self.scene = after(20.0)
        self.scene.source = "recording"
        self.scene.playback = Playback(begin=0.0, end=43.0, t=20.0, state="playing", speed=1.0, seeking=None)

    def take(self, command: Command) -> None:
        self.asked.append(command)
        playback = self.scene.playback
        assert playback is not None
        match command:
            case Command("pause"):
                playback.state = "paused"
            case Command("play"):
                playback.state = "playing"
            case Command("speed", speed) if speed is not None:
                playback.speed = speed
            case Command("seek", t) if t is not None:
                playback.t = t


async def focused(view: Window) -> str:
    found: str = await view.tab.evaluate("() => document.activeElement.dataset.control ?? ''")
    return found


# --- keys -------------------------------------------------------------------------------------------------------------


def test_the_space_bar_pauses_and_the_arrows_seek(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        tape = Tape()
        async with opened(chromium, tape.scene, tape.take) as view:
            keys = view.tab.keyboard
            await view.tab.locator("#playback").wait_for(state="visible")
            for state, name in (("paused", "Play"), ("playing", "Pause")):
                await keys.press("Space")
                await view.until("(name) => document.getElementById('play').getAttribute('aria-label') === name", name)
                assert tape.scene.playback.state == state
            await keys.press("Space")
            for key, t in (("ArrowRight", 25.0), ("ArrowLeft", 20.0), ("Shift+ArrowLeft", 0.0)):
                await keys.press(key)
                await view.until("(t) => Math.abs(Number(document.getElementById('seek').value) - t) < 0.2", t)
                assert tape.asked[-1] == Command("seek", pytest.approx(t, abs=0.2))
            await view.tab.locator("#speed-choice").select_option("4")
            await view.until("document.getElementById('speed-choice').value === '4'")
            assert tape.asked[-1] == Command("speed", 4.0)

    browser.run(main)


def test_plus_minus_and_nought_look_nearer_and_farther_on_the_track(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        async with opened(chromium, after(20.0)) as view:
            await view.until("Number(document.getElementById('track').dataset.points) > 0")
            for key in "+-":
                await view.tab.keyboard.press(key)
                await view.until("document.getElementById('zoom-fit').ariaPressed === 'false'")
                await view.tab.keyboard.press("0")
                await view.until("document.getElementById('zoom-fit').ariaPressed === 'true'")

    browser.run(main)


def test_the_tab_key_reaches_every_control_in_the_order_of_the_page(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        tape = Tape()
        async with opened(chromium, tape.scene, tape.take) as view:
            await view.tab.locator("#playback").wait_for(state="visible")
            await view.tab.keyboard.press("Space")
            controls = await view.tab.evaluate(
                """() => [...document.querySelectorAll("a[href], button, input, select, summary, [tabindex]")]
                    .filter((one) => one.checkVisibility() && !one.disabled && one.tabIndex >= 0)
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
            assert reached == controls

    browser.run(main)


def test_a_page_that_may_only_watch_has_nothing_to_press_for_playing(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        tape = Tape()
        async with opened(chromium, tape.scene, tape.take, token=False) as view:
            await view.tab.keyboard.press("Space")
            await view.tab.keyboard.press("ArrowRight")
            await show(tape.scene, between(20.0, 20.5))
            assert await view.tab.evaluate(CONNECTED)
            assert tape.asked == []

    browser.run(main)


# --- a screen reader --------------------------------------------------------------------------------------------------


def test_a_screen_reader_finds_landmarks_pictures_in_words_and_a_table(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        async with opened(chromium, after(40.0)) as view:
            await view.until("[...document.querySelectorAll('canvas')].every((one) => !one.ariaLabel.includes('yet'))")
            names = await view.names()
            roles = [role for role, _ in names]
            assert roles.count("banner") == roles.count("main") == roles.count("contentinfo") == 1
            regions = {name for role, name in names if role == "region"}
            assert regions >= {"Activity", "Soles", "Phases", "Track", "Height", "Gait", "Links", "What happened"}
            assert len([name for role, name in names if role == "image"]) == 5
            [table] = [name for role, name in names if role == "table"]
            assert table.startswith("Means of steady strides")
            assert {"parameter", "left", "right"} <= {name for role, name in names if role == "columnheader"}
            assert any(name.startswith("stride length") for role, name in names if role == "rowheader")
            assert "status" in roles
            nameless = [role for role, name in names if role in ("button", "slider", "combobox", "image") and not name]
            assert nameless == []

    browser.run(main)


# --- narrow, dark, magnified ------------------------------------------------------------------------------------------


def test_a_phone_has_nothing_to_scroll_sideways_light_and_dark(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        for scene in (after(40.0), placed(29.0), Tape().scene):
            async with opened(chromium, scene, width=NARROW, height=740) as view:
                await view.until("document.querySelectorAll('#gait-rows tr').length > 0")
                grounds = []
                for scheme in ("light", "dark"):
                    await view.tab.emulate_media(color_scheme=scheme)
                    assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= NARROW
                    ground = await view.tab.evaluate("getComputedStyle(document.body).backgroundColor")
                    grounds.append(sum(map(int, re.findall(r"\d+", ground)[:3])))
                assert grounds[0] > 3 * 200 and grounds[1] < 3 * 55

    browser.run(main)


def test_every_text_stands_out_from_its_ground_light_and_dark(browser: Browsing) -> None:
    async def main(chromium: Browser) -> None:
        for dark in (False, True):
            async with opened(chromium, after(40.0), dark=dark) as view:
                await view.until("document.querySelectorAll('#gait-rows tr').length > 0")
                await view.tab.locator("summary").click()
                assert await view.tab.evaluate(FAINT) == []

    browser.run(main)
