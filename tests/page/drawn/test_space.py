"""Tests the track in space: it is drawn as in the report, and only once there are heights to see."""

from __future__ import annotations

import pytest
from browsers import Browser
from shown import open_page, shown

from solepath.events import WearerMoved
from solepath.show.page.scene.scene import Scene
from solepath.show.report.figures.space import LEAST_RISE, project

PROJECT = "import('./space.js').then(({ project }) => project([3.2, -1.5, 2.4], 2))"


def moved(t: float, x: float, z: float) -> WearerMoved:
    return WearerMoved(t=t, known_at=t, position=(x, 0.3 * x, z), covariance=(0.01,) * 6)


@pytest.mark.soak
async def test_a_track_is_drawn_in_space_once_it_has_heights(chromium: Browser) -> None:
    scene = shown([moved(k, 0.7 * k, 0.05 * (k % 3)) for k in range(20)], Scene("a walk", "default", "live"))
    async with open_page(chromium, scene, width=360, height=740) as (view, _):
        await view.until("solepath.state.tracks.wearer.length === 20 && solepath.frames > 2")
        assert await view.tab.locator("#space-card").is_hidden()
        for k in range(1, 13):  # a flight of stairs
            scene.take(None, [moved(20.0 + k, 14.0 + 0.3 * k, LEAST_RISE * k / 10.0)])
        await view.until("Number(document.getElementById('space').dataset.points) === 32")
        words = await view.tab.locator("#space").get_attribute("aria-label")
        assert words == "The track in space, with heights from 0.0 to 1.2 m"
        place = await view.tab.evaluate(PROJECT)
        assert place == pytest.approx(project((3.2, -1.5, 2.4), 2.0), abs=1e-9), "as in the report"
