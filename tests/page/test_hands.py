"""Tests how a recording is played by keys, and what the page says while it goes to another time."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
from browsers import Browser, Window
from shown import meanwhile, open_page, walked

from solepath import Session
from solepath.emulate.routes.route import Route
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.player.player_loop import play_on
from solepath.show.page.scene.scene import Playback, Scene

WALK = Route().stand(1.0).walk(16.0, 1.3).stop(2.0)
"""Walk of about 16 s."""


@asynccontextmanager
async def played(chromium: Browser, **given: Any) -> AsyncIterator[tuple[Window, Playback]]:
    """Yield a page that plays a recording of WALK, and its player's state; `given` goes to `open_page`."""
    packets = PackedItems(walked(WALK, cells=16))
    session = Session(poses=True, pressures=True, losses=True)
    player = Player(packets, session, Scene("a recording", "default", "recording"))
    async with (
        open_page(chromium, player.scene, player.command, **given) as (view, page),
        meanwhile(play_on(page, player, asyncio.Event())),
    ):
        await view.tab.locator("#playback").wait_for(state="visible")
        yield view, player.playback


@pytest.mark.long
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
