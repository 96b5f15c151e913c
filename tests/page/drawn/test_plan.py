"""Tests the plan of the page: how the view follows the wearer."""

from __future__ import annotations

from typing import Any

import pytest
from browsers import Browser, Window
from shown import open_page

from solepath.emulate.routes.building import BUILDING
from solepath.events import Candidate, Placed, WearerMoved
from solepath.show.page.scene.scene import Scene

PART = "solepath.track.shownPart"


def placed(
    t: float, x: float, y: float, *others: tuple[float, float, float], level: str = "0", z: float = 0.0
) -> list[Any]:
    """Return the events of a wearer at (x, y), m, with other candidates (x, y, weight)."""
    weights = 1.0 - sum(weight for *_, weight in others)
    candidates = [Candidate(level, (a, b, 0.0), 0.0, weight, "stairs") for a, b, weight in ((x, y, weights), *others)]
    return [
        WearerMoved(t=t, known_at=t, position=(x, y, z), covariance=(0.01,) * 6),
        Placed(t=t, known_at=t, level=level, position=(x, y, z), spread=0.5, candidates=tuple(candidates)),
    ]


def along(x: float, y: float, count: int) -> list[Any]:
    """Return the events of a walk of `count` steps of 0.6 m from (x, y) to the north."""
    return [event for k in range(count) for event in placed(1.0 + 0.5 * k, x, y + 0.6 * k)]


async def shows_all(view: Window) -> None:
    """Wait until the whole building is within the canvas."""
    await view.until(
        "(() => { const { x, y, scale } = solepath.track.shownPart; const { clientWidth: w, clientHeight: h } ="
        " solepath.track.canvas; return Math.abs(x - 28) < 1 && w > 56 * scale && h > 63 * scale; })()"
    )


async def follows(view: Window, x: float, y: float) -> None:
    """Wait until the view shows about 30 m around a place at least."""
    await view.until(
        "([x, y]) => { const part = solepath.track.shownPart; const { clientWidth: w, clientHeight: h } ="
        " solepath.track.canvas; const [a, b] = [part.middle[0] + (x - part.x) * part.scale, part.middle[1] -"
        " (y - part.y) * part.scale]; return a > 0 && a < w && b > 0 && b < h && w / part.scale < 60 &&"
        " solepath.track.following; }",
        [x, y],
    )


@pytest.mark.soak
async def test_the_view_follows_the_wearer_once_the_place_is_decided(chromium: Browser) -> None:
    scene = Scene("a building", "default", "live", plan=BUILDING)
    async with open_page(chromium, scene) as (view, _):
        for event in placed(1.0, 9.0, 20.0, (47.0, 20.0, 0.4)):
            scene.take(None, [event])
        await shows_all(view)
        for event in along(9.0, 20.0, 12):
            scene.take(None, [event])
        await follows(view, 9.0, 26.6)
        assert await view.tab.locator("#zoom-follow").get_attribute("aria-pressed") == "true"
        await view.tab.locator("#zoom-fit").click()
        await shows_all(view)
        await view.until("document.getElementById('zoom-follow').ariaPressed === 'false'")
        await view.tab.locator("#zoom-follow").click()
        await follows(view, 9.0, 26.6)
        before = await view.tab.evaluate(f"{PART}.scale")
        await view.tab.locator("#zoom-in").click()
        await view.until(f"(before) => {PART}.scale > 1.3 * before && solepath.track.following", before)
