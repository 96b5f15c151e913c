"""Tests that texts and descriptions of the page fit the same moment, to eyes and to a screen reader alike."""

from __future__ import annotations

from browsers import Browser
from shown import open_page, scene_after

from solepath import Disconnected
from solepath.types import SITE_OF_FOOT, Foot

FIGURES = ("cadence", "speed")
async def test_the_page_shows_no_walking_while_no_sensor_sends(chromium: Browser) -> None:
    scene = scene_after(12.0)
    async with open_page(chromium, scene) as (view, _):
        await view.until("document.getElementById('activity').textContent === 'Walking'")
        assert all([float(await view.text(name)) > 0.0 for name in FIGURES])
        await view.open_folds()
        rows = await view.tab.locator("#gait-rows tr").all_inner_texts()
        assert rows[0].split()[:3] == ["strides", *[str(n) for n in strides(scene.whole_message()[0]["frame"]["gait"])]]
        angle = next(row for row in rows if row.startswith("toe-off"))
        assert angle.rstrip().endswith("°"), "degrees, not a share of an angle"
        assert "settle with 15 and more strides of each foot" in await view.text("gait-note")
        for site in SITE_OF_FOOT.values():
            scene.take(None, [Disconnected(t=12.0, known_at=12.0, site=site)])
        scene.tick(15.0)
        await view.until("document.getElementById('activity').textContent === 'Not known, last: walking'")
        assert await view.text("since") in ("no data from any foot for 2 s", "no data from any foot for 3 s")
        assert [await view.text(name) for name in FIGURES] == ["–", "–"]
        assert int(await view.text("strides")) > 8, "what was walked is still known"
        await view.until("document.getElementById('announcer').textContent.includes('Not known, last: walking')")
        links = await view.text("links")
        assert "of packets lost" not in links and "lost" in links


def strides(gait: object) -> list[int]:
    assert isinstance(gait, dict)
    return [gait["strides"][foot.value] for foot in Foot]
