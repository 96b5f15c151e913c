"""Tests the track in space: it is drawn as in the report, and only once there are heights to see."""

from __future__ import annotations

import re
from typing import Any
from xml.etree.ElementTree import Element

from browsers import Browser
from shown import open_page, shown

from solepath.events import WearerMoved
from solepath.show.page.scene.scene import Scene
from solepath.show.report.figures.space import LEAST_RISE, project, space_figure

PROJECT = "import('./space.js').then(({ project }) => project([3.2, -1.5, 2.4], 2))"
COLOURED = """() => {
    const { width, height } = document.getElementById('space');
    const { data } = document.getElementById('space').getContext('2d').getImageData(0, 0, width, height);
    let count = 0;
    for (let k = 3; k < data.length; k += 4) count += data[k] > 0;
    return count;
}"""


def moved(t: float, x: float, z: float) -> WearerMoved:
    return WearerMoved(t=t, known_at=t, position=(x, 0.3 * x, z), covariance=(0.01,) * 6)


def reported_note(scene: Scene) -> str:
    """Return what the report says below its picture of the wearer's track."""
    parent = Element("main")
    track = [moved(t or 0.0, x or 0.0, z or 0.0) for t, x, _, z in scene.wearer.track.points]
    assert space_figure(parent, track)
    return " ".join(parent.itertext())


def numbers(words: str) -> tuple[str | Any, ...]:
    found = re.search(r"A square of the floor is (\S+) m wide.*Heights are drawn (\S+) times", words)
    assert found is not None, words
    return found.groups()


async def test_a_track_is_drawn_in_space_once_it_has_heights(chromium: Browser) -> None:
    scene = shown([moved(k, 0.7 * k, 0.05 * (k % 3)) for k in range(20)], Scene("a walk", "default", "live"))
    async with open_page(chromium, scene, width=360, height=740) as (view, _):
        await view.until("solepath.state.tracks.wearer.length === 20 && solepath.frames > 2")
        card = view.tab.locator("#space-card")
        assert await card.is_hidden()
        for k in range(1, 13):  # a flight of stairs
            scene.take(None, [moved(20.0 + k, 14.0 + 0.3 * k, LEAST_RISE * k / 10.0)])
        await view.until("Number(document.getElementById('space').dataset.points) === 32")
        assert await card.is_visible()
        assert await view.tab.evaluate(COLOURED) > 1000
        words = await view.tab.locator("#space").get_attribute("aria-label")
        assert words == "The track in space, with heights from 0.0 to 1.2 m"
        assert numbers(await view.text("space-note")) == numbers(reported_note(scene)), (
            "square and factor are the report's"
        )
        u, v = await view.tab.evaluate(PROJECT)
        assert abs(u - project((3.2, -1.5, 2.4), 2.0)[0]) + abs(v - project((3.2, -1.5, 2.4), 2.0)[1]) < 1e-9
        for k in range(5):  # level again: the picture stays, since the track has been up
            scene.take(None, [moved(40.0 + k, 18.0 + 0.7 * k, 1.2)])
        await view.until("Number(document.getElementById('space').dataset.points) === 37")
