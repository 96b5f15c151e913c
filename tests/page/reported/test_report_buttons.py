"""Tests the buttons of the page with which a person reports where the wearer is."""

from __future__ import annotations

import asyncio
from math import hypot
from typing import Any

import pytest
from browsers import Browser, Window
from shown import CONNECTED, open_page, scene_after, scene_on_plan, walked

from solepath import Session, Site
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.events import PositionRejected, PositionReported, TrackNode, TrackRevised
from solepath.show.page.live_commands import position_of
from solepath.show.page.messages import Command
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.scene.scene import Scene
from solepath.wire.receiver import PositionFrame

PHONE_WIDTH = 360
"""Width of a phone's screen, px."""
SETTLED = "Number(document.getElementById('track').dataset.points) > 0"
POINTING = "document.getElementById('here-place').ariaPressed === 'true'"


class Reports(list[PositionFrame]):
    """The positions that a page has reported; `take` is for its commands."""

    def take(self, command: Command) -> None:
        self.append(position_of(command, BUILDING))

    async def next(self) -> PositionFrame:
        """Return the next position when it comes."""
        async with asyncio.timeout(10.0):
            while not self:
                await asyncio.sleep(0.02)
        return self.pop(0)


async def place_of(view: Window, at: tuple[float, float]) -> tuple[float, float]:
    """Return where on the canvas, px, a place of the drawing, m, is shown, once the drawing does not move any more."""
    before: Any = None
    while True:
        part = await view.tab.evaluate("solepath.track.shownPart")
        if part == before:
            break
        before = part
        await asyncio.sleep(0.3)
    (mx, my), scale = part["middle"], part["scale"]
    return (mx + (at[0] - part["x"]) * scale, my - (at[1] - part["y"]) * scale)


async def click(view: Window, at: tuple[float, float], by: tuple[float, float] = (0.0, 0.0)) -> None:
    """Press the mouse at a place of the drawing, m, move it by so many px, and let it go."""
    x, y = await place_of(view, at)
    await view.tab.locator("#track").scroll_into_view_if_needed()
    box = await view.tab.locator("#track").bounding_box()
    assert box is not None
    mouse = view.tab.mouse
    await mouse.move(box["x"] + x, box["y"] + y)
    await mouse.down()
    if by != (0.0, 0.0):
        await mouse.move(box["x"] + x + by[0], box["y"] + y + by[1], steps=4)
    await mouse.up()


def near(at: tuple[float, float], position: PositionFrame) -> bool:
    assert position.position is not None
    return hypot(position.position[0] - at[0], position.position[1] - at[1]) < 0.3


async def test_one_button_reports_that_the_wearer_is_back_at_the_start(chromium: Browser) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(20.0), reports.take) as (view, _):
        await view.tab.get_by_role("button", name="Back where I started").click()
        assert await reports.next() == PositionFrame(None, 1.0)


async def test_a_click_on_the_track_reports_a_place_in_the_world_frame(chromium: Browser) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(20.0), reports.take) as (view, _):
        await view.until(SETTLED)
        await click(view, (5.0, 1.0))  # without the mode a click reports nothing
        await view.tab.get_by_role("button", name="I am here").click()
        await view.until(POINTING)
        assert "Click where you are on the track" in await view.text("here-note")
        await click(view, (5.0, 1.0))
        position = await reports.next()
        assert near((5.0, 1.0), position) and position.level == ""
        assert 1.0 <= position.sigma < 1.5
        await view.until(f"!({POINTING})")
        await click(view, (5.0, 1.0))
        await asyncio.sleep(0.3)
        assert reports == []


async def test_a_click_on_the_plan_reports_a_place_on_the_level_that_is_shown(chromium: Browser) -> None:
    reports = Reports()
    level = BUILDING.levels[1]
    async with open_page(chromium, scene_on_plan(20.0), reports.take) as (view, _):
        await view.until("document.getElementById('track').dataset.view === 'plan'")
        await view.tab.get_by_role("button", name=level.name or level.id, exact=True).click()
        await view.tab.get_by_role("button", name="I am here").click()
        await view.until(POINTING)
        await click(view, (10.0, 3.0))
        position = await reports.next()
        assert near((10.0, 3.0), position) and position.level == level.id
        await view.tab.locator("#show-track").click()
        await view.until("document.getElementById('track').dataset.view === 'track'")
        await view.tab.get_by_role("button", name="I am here").click()
        await click(view, (2.0, 0.0))
        position = await reports.next()
        assert near((2.0, 0.0), position) and position.level == ""


async def test_who_drags_the_drawing_or_leaves_the_mode_reports_nothing(chromium: Browser) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(20.0), reports.take) as (view, _):
        await view.until(SETTLED)
        await view.tab.get_by_role("button", name="I am here").click()
        await view.until(POINTING)
        await click(view, (5.0, 1.0), by=(40.0, 10.0))
        assert await view.tab.evaluate(POINTING), "the drawing was moved, and the place is still to be chosen"
        await view.tab.keyboard.press("Escape")
        await view.until(f"!({POINTING})")
        await asyncio.sleep(0.3)
        assert reports == []


async def test_without_a_mouse_the_place_below_the_cross_is_reported(chromium: Browser) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(20.0), reports.take) as (view, _):
        await view.until(SETTLED)
        await view.tab.locator("#here-place").focus()
        await view.tab.keyboard.press("Enter")
        await view.until(POINTING)
        await view.until("document.getElementById('announcer').textContent.includes('below the cross')")
        for key in ("ArrowRight", "ArrowUp", "Tab"):
            await view.tab.keyboard.press(key)
        await place_of(view, (0.0, 0.0))
        part = await view.tab.evaluate("solepath.track.shownPart")
        await view.tab.keyboard.press("Enter")
        assert near((part["x"], part["y"]), await reports.next())


async def test_a_revision_and_a_rejection_are_shown_and_announced_once(chromium: Browser) -> None:
    scene = scene_after(20.0)
    assert scene.wearer.moved is not None
    (x, y, _), t = scene.wearer.moved.position, scene.now + 0.1
    async with open_page(chromium, scene, Reports().take) as (view, _):
        await view.until(SETTLED)
        reported = PositionReported(t=t, known_at=t, site=Site.LEFT_FOOT, position=(x + 3.0, y), sigma=1.0)
        nodes = (TrackNode(1.0, 0.0, 0.0), TrackNode(t, x + 3.2, y))
        revised = TrackRevised(t=t, known_at=t, by=(3.2, 0.0), turn=0.07, nodes=nodes)
        scene.take(None, [reported, revised])
        await view.until("document.getElementById('log').innerText.includes('moved by 3.2 m, turned by 4 degrees')")
        await view.until("document.getElementById('announcer').textContent.includes('Track revised: moved by 3.2 m')")
        track = await view.tab.evaluate("solepath.state.tracks.wearer")
        assert track[-1][1:3] == [round(x + 3.2, 3), round(y, 3)]
        assert await view.tab.evaluate("solepath.state.reports") == [
            {"level": None, "x": round(x + 3.0, 3), "y": round(y, 3), "used": True}
        ]
        rejected = PositionRejected(t=t + 1.0, known_at=t + 1.0, distance=50.0, sigma=1.0, what="this is 50 m off")
        far = PositionReported(t=t + 1.0, known_at=t + 1.0, site=Site.LEFT_FOOT, position=(x + 50.0, y), sigma=1.0)
        scene.take(None, [far, rejected])
        await view.until("document.getElementById('announcer').textContent.includes('this is 50 m off')")
        assert "Track revised" not in await view.tab.locator("#announcer").inner_text()
        assert "Position rejected: this is 50 m off" in await view.text("log")
        assert await view.tab.evaluate("solepath.state.tracks.wearer") == track
        assert await view.tab.locator("#here-legend").is_visible()


async def test_reported_positions_are_marked_on_the_drawing(chromium: Browser) -> None:
    scene = scene_after(20.0)
    async with open_page(chromium, scene) as (view, _):
        await view.until(SETTLED)
        await place_of(view, (5.0, 5.0))
        picture = "document.getElementById('track').toDataURL()"
        before = await view.tab.evaluate(picture)
        t = scene.now
        scene.take(None, [PositionReported(t=t, known_at=t, site=Site.LEFT_FOOT, position=(5.0, 5.0), sigma=1.0)])
        await view.until("solepath.state.reports.length === 1")
        await view.until(f"(before) => {picture} !== before", before)


async def test_who_may_only_watch_sees_why_the_buttons_do_nothing(chromium: Browser) -> None:
    async with open_page(chromium, scene_after(10.0), Reports().take, token=False) as (view, _):
        await view.until("document.getElementById('here-note').innerText.includes('may watch only')")
        for name in ("Back where I started", "I am here"):
            assert await view.tab.get_by_role("button", name=name).is_disabled()
        assert await view.tab.evaluate(CONNECTED)


@pytest.mark.parametrize("source", ["recording", "demo"])
async def test_what_is_played_has_no_buttons_to_report_a_position(chromium: Browser, source: str) -> None:
    packets = PackedItems(walked(Route().stand(1.0).walk(3.0, 1.3).stop(1.0), cells=8))
    player = Player(packets, Session(poses=True, pressures=True), Scene("a walk", "default", source))
    async with open_page(chromium, player.scene, player.command) as (view, _):
        await view.tab.locator("#playback").wait_for(state="visible")
        assert await view.tab.locator("#here").is_hidden()


async def test_a_phone_has_room_for_the_buttons(chromium: Browser) -> None:
    async with open_page(chromium, scene_after(10.0), Reports().take, width=PHONE_WIDTH, height=740) as (view, _):
        await view.tab.get_by_role("button", name="I am here").click()
        await view.until(POINTING)
        assert await view.tab.locator("#here-cross").is_visible()
        assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= PHONE_WIDTH


async def test_a_page_without_a_connection_shows_that_nothing_was_reported(chromium: Browser) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(10.0), reports.take) as (view, page):
        await view.until(SETTLED)
        await page.__aexit__(None, None, None)
        await view.until("document.getElementById('connection').dataset.state !== 'open'")
        await view.tab.get_by_role("button", name="Back where I started").click()
        await view.until("document.getElementById('here-note').innerText.includes('Not reported')")
        assert reports == []
