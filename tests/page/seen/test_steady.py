"""Tests that nothing on the page jumps while it runs: a sum of layout shifts of 0, on a desktop and on a phone."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from attrs import frozen
from browsers import Browser, window
from measures import SCREENS, SCRIPT, shifts
from page_states import broken_walk, building_walk, reversed_walk
from shown import CONNECTED, PacketEvents, open_page, show

from solepath.emulate.routes.building import BUILDING
from solepath.floorplan.plan import FloorPlan
from solepath.show.page.scene.scene import Scene

SPEED = 6.0
"""Multiple of real time in which the walks are shown."""


@frozen
class Part:
    """A walk from its start to the time `until`, s."""

    walk: Callable[[], tuple[PacketEvents, ...]]
    until: float
    plan: FloorPlan | None = None


PARTS = {
    "from the start over the first figures to a lost link": Part(broken_walk, 36.0),
    "with what a check finds": Part(reversed_walk, 14.0),
    "on a plan, from many places to few": Part(building_walk, 28.0, BUILDING),
}


@pytest.mark.soak
@pytest.mark.parametrize("name", PARTS)
async def test_nothing_jumps_during_a_walk(chromium: Browser, name: str) -> None:
    part = PARTS[name]
    scene, walk = Scene("Live", "default", "live", plan=part.plan), part.walk()
    wide, narrow = max(SCREENS), min(SCREENS)
    async with (
        open_page(chromium, scene, lambda command: None, script=SCRIPT, width=wide, height=SCREENS[wide]) as (
            desk,
            page,
        ),
        window(chromium, page.url, script=SCRIPT, width=narrow, height=SCREENS[narrow]) as phone,
    ):
        await phone.until(CONNECTED)
        await show(scene, walk, SPEED, part.until)
        await phone.until(f"solepath.state.t >= {part.until - 1.0}")
        assert {"desk": await shifts(desk), "phone": await shifts(phone)} == {"desk": [], "phone": []}
