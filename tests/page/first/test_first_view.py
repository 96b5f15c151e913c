"""Tests what the page shows first: what the wearer does and where, four figures, and what needs attention, in words."""

from __future__ import annotations

import pytest
from browsers import Browser
from shown import open_page, scene_after, square_walk

from solepath import CellFault, CellsFailed, Disconnected, FeetSwapped, Site
from solepath.show.page.player.playback import Playback

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT


def text_is(name: str, words: str) -> str:
    return f"document.getElementById('{name}').textContent === {words!r}"


@pytest.mark.soak
async def test_a_recording_at_its_end_is_shown_as_finished_with_the_means_of_the_whole_walk(chromium: Browser) -> None:
    scene = scene_after(1e9)
    end = square_walk()[-1][0].t
    scene.playback = Playback(0.0, end, end, "ended")
    total = scene.walk.gait.parameters
    assert total is not None and total.both.speed is not None
    async with open_page(chromium, scene) as (view, _):
        await view.until(text_is("activity", "Finished"))
        assert await view.text("where") == f"after {int(end)} s"
        assert await view.text("speed") == f"{total.both.speed.mean:.2f}"
        assert await view.text("speed-label") == "mean speed, m/s"


@pytest.mark.soak
async def test_what_needs_attention_is_at_the_top_the_worst_first(chromium: Browser) -> None:
    scene = scene_after(12.0)
    words = "document.getElementById('notice').innerText"
    async with open_page(chromium, scene) as (view, _):
        await view.until(f"{words} === 'Both sensors connected, no data lost'")
        assert not await view.tab.locator("#notice-all").is_visible()
        t = scene.now
        scene.take(None, [CellsFailed(t=t, known_at=t, site=RIGHT, fault=CellFault.DEAD, cells=(3,))])
        await view.until(f"{words}.startsWith('Right foot: cell 3 shows no load') && {words}.endsWith('Details')")
        scene.take(None, [FeetSwapped(t=t, known_at=t), Disconnected(t=t, known_at=t, site=LEFT)])
        await view.until(f"{words}.startsWith('Left foot: no data') && {words}.endsWith('3 messages')")
        await view.tab.locator("#notice-all").click()
        found = await view.tab.locator("#findings li").all_inner_texts()
        assert [one.partition(":")[0] for one in found] == ["Left foot", "The insoles may be swapped", "Right foot"]
        await view.until("document.getElementById('announcer').textContent.includes('The insoles may be swapped')")
