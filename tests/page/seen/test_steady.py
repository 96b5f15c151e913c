"""Tests that nothing on the page jumps while it runs: a sum of layout shifts of 0, on a desktop and on a phone."""

from __future__ import annotations

import pytest
from browsers import Browser, window
from measures import SCREENS, SCRIPT, shifts
from page_states import broken_walk
from shown import CONNECTED, open_page, show

from solepath.show.page.scene.scene import Scene

SPEED, UNTIL = 6.0, 36.0
"""Multiple of real time in which the walk is shown, and its end, s."""


@pytest.mark.long
async def test_nothing_jumps_from_the_first_figures_to_a_lost_link(chromium: Browser) -> None:
    scene, wide, narrow = Scene("Live", "default", "live"), max(SCREENS), min(SCREENS)
    async with (
        open_page(chromium, scene, script=SCRIPT, width=wide, height=SCREENS[wide]) as (desk, page),
        window(chromium, page.url, script=SCRIPT, width=narrow, height=SCREENS[narrow]) as phone,
    ):
        await phone.until(CONNECTED)
        await show(scene, broken_walk(), SPEED, UNTIL)
        await phone.until(f"solepath.state.t >= {UNTIL - 1.0}")
        assert {"desk": await shifts(desk), "phone": await shifts(phone)} == {"desk": [], "phone": []}
