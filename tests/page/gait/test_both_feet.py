"""Tests what the page shows of both feet together: touchdowns and fused strides."""

from __future__ import annotations

import pytest
from browsers import Browser
from page_events import foot_moved
from shown import open_page, shown

from solepath import Foot, StrideFused
from solepath.events import TouchedDown
from solepath.types import WalkingMode

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT


FUSED = StrideFused(
    t=9.0,
    known_at=9.1,
    foot=LEFT,
    number=6,
    stride_length=1.3204,
    own_length=1.31,
    similarity=0.87654,
    error_index=0.01234,
    coefficient=0.5,
    chosen=RIGHT,
    distance=8.456,
    position=(8.4, 0.0, 0.0),
)


def standing(y: float, ahead: float) -> tuple[tuple[float, float, float], ...]:
    """Return the rods of a leg at `y` whose ankle is `ahead` of the hips; the wearer faces +y."""
    return ((-y, 0.0, 0.0), (-y, 0.5 * ahead, -0.42), (-y, ahead, -0.83), (-y, ahead + 0.15, -0.91))


DOWN = TouchedDown(
    t=1.2,
    known_at=1.2,
    foot=RIGHT,
    position=(0.6, 0.0, 0.0),
    mode=WalkingMode.STRAIGHT,
    compensation=(0.0, 0.0, 0.0),
    legs=(standing(0.08, -0.3), standing(-0.08, 0.3)),
)


@pytest.mark.soak
async def test_the_page_draws_the_legs_and_names_the_figures_of_the_fused_stride(chromium: Browser) -> None:
    scene = shown([foot_moved(1.0)])
    async with open_page(chromium, scene) as (view, _):
        assert not await view.tab.locator("#body-figure").is_visible()
        assert not await view.tab.locator("#fused").is_visible()
        shown([DOWN, FUSED], scene)
        await view.until("document.getElementById('fused').innerText.length > 0")
        assert await view.text("fused") == (
            "Both feet: 8.46 m by the right foot; last stride, left, 1.32 m: similarity 0.88, error index 0.012 m/s, "
            "own share 0.50"
        )
        assert await view.text("body-words") == "Legs at the last touchdown, from the right: feet 60 cm apart"
        right = await view.tab.locator("#body-right").get_attribute("points")
        assert right == "0.0,23.0 15.0,65.0 30.0,106.0 45.0,114.0"
