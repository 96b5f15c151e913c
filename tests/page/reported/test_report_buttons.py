"""Tests the buttons of the page with which a person reports where the wearer is."""

from __future__ import annotations

import asyncio
import json
from math import hypot
from typing import Any

import pytest
from browsers import Browser, Window
from shown import open_page, scene_after, scene_on_plan

from solepath import Site
from solepath.emulate.routes.building import BUILDING
from solepath.events import PositionRejected, PositionReported, TrackNode, TrackRevised
from solepath.show.page.live_commands import position_of
from solepath.show.page.messages import Command
from solepath.wire.receiver import PositionFrame

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


@pytest.mark.long
async def test_a_click_on_the_plan_reports_a_place_on_the_level_that_is_shown_and_one_on_the_track_in_its_frame(
    chromium: Browser,
) -> None:
    reports = Reports()
    level = BUILDING.levels[1]
    async with open_page(chromium, scene_on_plan(20.0), reports.take) as (view, _):
        here = view.tab.get_by_role("button", name="I am here")
        await view.until("document.getElementById('track').dataset.view === 'plan'")
        await view.tab.get_by_role("button", name=level.name or level.id, exact=True).click()
        await click(view, (10.0, 3.0))  # without the mode a click reports nothing
        await here.click()
        await view.until(POINTING)
        await click(view, (10.0, 3.0), by=(40.0, 10.0))
        assert await view.tab.evaluate(POINTING), "the drawing was moved, and the place is still to be chosen"
        await click(view, (10.0, 3.0))
        position = await reports.next()
        assert near((10.0, 3.0), position) and position.level == level.id and 1.0 <= position.sigma < 1.5
        await view.tab.locator("#show-track").click()
        await view.until("document.getElementById('track').dataset.view === 'track'")
        await here.click()
        await click(view, (2.0, 0.0))
        position = await reports.next()
        assert near((2.0, 0.0), position) and position.level == ""
        assert reports == []


@pytest.mark.long
async def test_without_a_mouse_the_place_below_the_cross_is_reported_and_escape_reports_nothing(
    chromium: Browser,
) -> None:
    reports = Reports()
    async with open_page(chromium, scene_after(20.0), reports.take) as (view, page):
        await view.until(SETTLED)
        await view.tab.locator("#here-place").focus()
        for key in ("Enter", "Escape", "Enter"):
            await view.tab.keyboard.press(key)
            await view.until(f"{POINTING} === {json.dumps(key == 'Enter')}")
        await view.until("document.getElementById('announcer').textContent.includes('below the cross')")
        for key in ("ArrowRight", "ArrowUp", "Tab"):
            await view.tab.keyboard.press(key)
        await place_of(view, (0.0, 0.0))
        part = await view.tab.evaluate("solepath.track.shownPart")
        await view.tab.keyboard.press("Enter")
        assert near((part["x"], part["y"]), await reports.next())
        start = view.tab.get_by_role("button", name="Back where I started")
        await start.click()
        assert await reports.next() == PositionFrame(None, 1.0)
        await page.__aexit__(None, None, None)
        await view.until("document.getElementById('connection').dataset.state !== 'open'")
        await start.click()
        await view.until("document.getElementById('here-note').innerText.includes('Not reported')")
        assert reports == []
        view.complaints.clear()  # the browser tries again, and nobody is there


@pytest.mark.soak
async def test_a_revision_and_a_rejection_are_shown_and_announced_once(chromium: Browser) -> None:
    scene = scene_after(20.0)
    assert scene.wearer.moved is not None
    (x, y, _), t = scene.wearer.moved.position, scene.now + 0.1
    announced = "document.getElementById('announcer').textContent"

    def reported(at: float, distance: float) -> PositionReported:
        return PositionReported(t=at, known_at=at, site=Site.LEFT_FOOT, position=(x + distance, y), sigma=1.0)

    async with open_page(chromium, scene, Reports().take, token=False) as (view, _):
        await view.until(SETTLED)
        nodes = (TrackNode(1.0, 0.0, 0.0), TrackNode(t, x + 3.2, y))
        scene.take(None, [reported(t, 3.0), TrackRevised(t=t, known_at=t, by=(3.2, 0.0), turn=0.07, nodes=nodes)])
        await view.until(f"{announced}.includes('Track revised: moved by 3.2 m, turned by 4 degrees')")
        track = await view.tab.evaluate("solepath.state.tracks.wearer")
        assert track[-1][1:3] == [round(x + 3.2, 3), round(y, 3)]
        assert await view.tab.evaluate("solepath.state.reports") == [
            [round(t, 3), None, round(x + 3.0, 3), round(y, 3), True]
        ]
        after = t + 1.0
        rejected = PositionRejected(t=after, known_at=after, distance=50.0, sigma=1.0, what="this is 50 m off")
        scene.take(None, [reported(after, 50.0), rejected])
        await view.until(f"{announced}.includes('this is 50 m off') && !{announced}.includes('Track revised')")
        assert await view.tab.evaluate("solepath.state.tracks.wearer") == track
        assert await view.tab.get_by_role("button", name="I am here").is_disabled(), "who has no token only watches"
