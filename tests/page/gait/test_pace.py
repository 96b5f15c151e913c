"""Tests the clock of the page between two messages, in the browser's own engine but on a made-up clock."""

from __future__ import annotations

import pytest
from browsers import Browser
from shown import empty_scene, open_page

PLAY_SCRIPT = """async ([speed, real, paused]) => {
    const { Pace } = await import("/pace.js");
    const pace = new Pace();
    const state = { generation: 1, t: 0, playback: { state: "playing", speed, t: 0, seeking: null } };
    const ahead = [], back = [];
    let due = 0, t = 0, shown = 0;
    for (let now = 1; now < 9000; now += 1000 / 60) {
        const still = paused && now > 4000 && now < 4400;
        state.playback.state = still ? "paused" : "playing";
        t += still ? 0 : real / 60;
        if (now >= due) {
            state.t = t;
            pace.update(state, now);
            due += 1000 / 30;
        }
        const before = shown;
        shown = pace.at(state, now);
        if (now > 1000) ahead.push(shown - t), back.push(before - shown);
    }
    return { most: Math.max(...ahead), least: Math.min(...ahead), back: Math.max(...back) };
}"""
"""Script that plays a recording at a requested and a real speed; returns how far the display is ahead, s."""


@pytest.mark.parametrize("paused", [False, True])
async def test_what_scrolls_keeps_to_what_was_played_also_where_it_cannot_be_played_so_fast(
    chromium: Browser, paused: bool
) -> None:
    async with open_page(chromium, empty_scene()) as (view, _):
        for speed, real, off in ((1.0, 1.0, 0.05), (16.0, 16.0, 0.6), (16.0, 8.0, 0.3), (32.0, 2.5, 0.3)):
            played = await view.tab.evaluate(PLAY_SCRIPT, [speed, real, paused])
            assert -off < played["least"] and played["most"] < off
            assert played["back"] <= (0.1 if paused else 0.0)
