"""Tests the plan of the page: names of rooms, outer walls, and how the view follows the wearer."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from browsers import Browser, Window
from shown import frame, open_page, scene_after, shown

from solepath.emulate.routes.building import BUILDING
from solepath.events import Candidate, Placed, WearerMoved
from solepath.floorplan.plan import Door, FloorPlan, Level, Wall, with_rooms
from solepath.show.page.messages import encode
from solepath.show.page.scene.scene import Scene
from solepath.show.page.scene.wearer import DECIDED_WEIGHT

FLAT = FloorPlan(
    "flat",
    (
        with_rooms(
            Level(
                "0",
                "ground floor",
                0,
                0.0,
                (
                    Wall((0.0, 0.0), (9.0, 0.0)),
                    Wall((9.0, 0.0), (9.0, 6.0)),
                    Wall((0.0, 6.0), (9.0, 6.0)),
                    Wall((0.0, 0.0), (0.0, 6.0)),
                    Wall((5.0, 0.0), (5.0, 4.0)),
                    Wall((0.0, 4.0), (9.0, 4.0)),
                ),
                (Door((2.0, 4.0), (2.9, 4.0)),),
            ),
            [
                (((0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0)), "Kitchen"),
                (((5.0, 0.0), (9.0, 0.0), (9.0, 4.0), (5.0, 4.0)), ""),
                (((0.0, 4.0), (9.0, 4.0), (9.0, 6.0), (0.0, 6.0)), "Hall"),
            ],
        ),
    ),
)
"""A plan of three rooms, one of them without a name; the first four walls are outer ones."""
PART = "solepath.track.shownPart"
LABELS = "JSON.parse(document.getElementById('track').dataset.labels ?? '[]')"
OUTER = """import('./outer.js').then(({ outerWalls }) => {
    const level = solepath.state.plan.levels[0];
    return outerWalls(level, [], [0, 0, 9, 6]);
})"""
ROOM = "(place) => import('./rooms.js').then(({ roomAt }) => roomAt(solepath.state.plan.levels[0], place))"
NAME = """([ring, name, scale, kind]) => import('./rooms.js').then(({ nameIn }) => {
    const found = nameIn(ring, name, scale, {}, kind);
    return found && [found.words, found.upright, ...found.at];
})"""


def placed(t: float, x: float, y: float, *others: tuple[float, float, float], level: str = "0") -> list[Any]:
    """Return the events of a wearer at (x, y), m, with other candidates (x, y, weight)."""
    weights = 1.0 - sum(weight for *_, weight in others)
    candidates = [Candidate(level, (a, b, 0.0), 0.0, weight, "stairs") for a, b, weight in ((x, y, weights), *others)]
    return [
        WearerMoved(t=t, known_at=t, position=(x, y, 0.0), covariance=(0.01,) * 6),
        Placed(t=t, known_at=t, level=level, position=(x, y, 0.0), spread=0.5, candidates=tuple(candidates)),
    ]


def along(x: float, y: float, count: int) -> list[Any]:
    """Return the events of a walk of `count` steps of 0.6 m from (x, y) to the north."""
    return [event for k in range(count) for event in placed(1.0 + 0.5 * k, x, y + 0.6 * k)]


def overlapping(labels: list[list[Any]]) -> list[tuple[str, str]]:
    """Return the pairs of labels, [words, x, y, width, height], that lie over each other."""
    return [
        (one[0], other[0])
        for i, one in enumerate(labels)
        for other in labels[:i]
        if one[1] < other[1] + other[3]
        and other[1] < one[1] + one[3]
        and one[2] < other[2] + other[4]
        and other[2] < one[2] + one[4]
    ]


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


def test_a_scene_has_the_names_of_the_rooms_in_their_order() -> None:
    level = json.loads(encode(Scene("a walk", "default", plan=FLAT).whole_message()[0]))["plan"]["levels"][0]
    assert level["room_names"] == ["Kitchen", "", "Hall"]
    assert len(level["rooms"]) == 3


def test_a_candidate_without_weight_does_not_make_a_place_undecided() -> None:
    assert frame(shown(placed(1.0, 2.0, 3.0, (9.0, 3.0, 0.001))))["place"]["decided"] is True
    other = (9.0, 3.0, 1.0 - DECIDED_WEIGHT + 0.001)
    assert frame(shown(placed(1.0, 2.0, 3.0, other)))["place"]["decided"] is False


async def test_rooms_have_names_and_outer_walls_are_found(chromium: Browser) -> None:
    scene = shown(along(2.0, 1.0, 4), Scene("a flat", "default", "live", plan=FLAT))
    async with open_page(chromium, scene) as (view, _):
        await view.until(f"{LABELS}.some(([words]) => words === 'Kitchen')")
        labels = await view.tab.evaluate(LABELS)
        assert {"Kitchen", "Hall"} <= {label[0] for label in labels}
        assert await view.tab.evaluate(OUTER) == [True, True, True, True, False, False]
        assert await view.tab.evaluate(ROOM, [1.0, 1.0]) == 0
        assert await view.tab.evaluate(ROOM, [6.0, 1.0]) == 1
        assert await view.tab.evaluate(ROOM, [20.0, 1.0]) == -1


async def test_a_name_is_where_it_fits_or_shorter_or_left_out(chromium: Browser) -> None:
    square = [[0, 0], [5, 0], [5, 4], [0, 4]]
    async with open_page(chromium, Scene("a flat", "default", "live", plan=FLAT)) as (view, _):

        async def name(ring: list[list[float]], words: str, scale: float) -> Any:
            return await view.tab.evaluate(NAME, [ring, words, scale, "room"])

        assert await name(square, "room 12", 20.0) == ["room 12", False, 2.5, 2.0]
        assert (await name(square, "room 12", 7.0))[0] == "12"
        assert (await name(square, "changing room", 15.0))[0] == "changing\nroom"
        assert await name(square, "Laboratory", 6.0) is None
        corridor = [[0, 0], [2, 0], [2, 30], [0, 30]]
        assert (await name(corridor, "corridor 3", 12.0))[:2] == ["corridor 3", True]
        angle = [[0, 0], [10, 0], [10, 2], [2, 2], [2, 10], [0, 10]]  # its middle is outside
        x, y = (await name(angle, "Store", 20.0))[2:]
        assert (0 < x < 10 and 0 < y < 2) or (0 < x < 2 and 0 < y < 10)


@pytest.mark.parametrize("width", [1280, 768, 360])
async def test_no_label_of_the_plan_lies_over_another(chromium: Browser, width: int) -> None:
    scene = shown(along(47.0, 20.0, 20), Scene("a building", "default", "live", plan=BUILDING))
    async with open_page(chromium, scene, width=width, height=800) as (view, _):
        for whole in (False, True):
            if whole:
                await view.tab.locator("#zoom-fit").click()
                await shows_all(view)
            else:
                await follows(view, 47.0, 31.4)
            await view.until("solepath.track.view.settled")
            await asyncio.sleep(1.1)  # labels are published once a second
            labels = await view.tab.evaluate(LABELS)
            assert len(labels) > 5
            assert not overlapping(labels)
            size = await view.tab.evaluate("[solepath.track.canvas.clientWidth, solepath.track.canvas.clientHeight]")
            for _, x, y, w, h in labels:
                assert x >= 0 and y >= 0 and x + w <= size[0] and y + h <= size[1]


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


async def test_candidates_beside_each_other_do_not_move_the_view(chromium: Browser) -> None:
    scene = shown(along(9.0, 20.0, 12), Scene("a building", "default", "live", plan=BUILDING))
    async with open_page(chromium, scene) as (view, _):
        await follows(view, 9.0, 26.6)
        for event in placed(8.0, 9.0, 27.2, (9.5, 28.5, 0.4)):
            scene.take(None, [event])
        await view.until("solepath.state.place.decided === false")
        await follows(view, 9.0, 27.2)


async def test_the_mark_goes_from_place_to_place(chromium: Browser) -> None:
    scene = shown(along(9.0, 20.0, 3), Scene("a building", "default", "live", plan=BUILDING))
    glide = """() => import('./following.js').then(({ Glide }) => {
        const glide = new Glide();
        glide.aim([0, 0], 1000);
        glide.aim([1, 0], 1500);
        const seen = [1500, 1750, 2000, 2400].map((now) => glide.at(now)[0]);
        glide.aim([9, 0], 2500);
        return [...seen, glide.at(2500)[0]];
    })"""
    async with open_page(chromium, scene) as (view, _):
        assert await view.tab.evaluate(glide) == [0, 0.5, 1, 1, 9]


async def test_each_foot_has_its_path_only_when_it_is_asked_for(chromium: Browser) -> None:
    blue = """() => {
        const { width, height } = solepath.track.canvas;
        const copy = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
        copy.drawImage(solepath.track.canvas, 0, 0);
        const { data } = copy.getImageData(0, 0, width, height);
        let count = 0;
        for (let k = 0; k < data.length; k += 4) count += data[k + 2] > data[k + 1] + 30;
        return count;
    }"""
    async with open_page(chromium, scene_after(20.0)) as (view, _):
        await view.until("Number(document.getElementById('track').dataset.points) > 20")
        await view.until("solepath.track.view.settled")
        assert await view.tab.evaluate(blue) < 5
        await view.tab.evaluate("solepath.track.feetShown = true; document.getElementById('zoom-fit').click()")
        await view.until("document.getElementById('track-note').innerText.startsWith('Each foot’s own path')")
        assert await view.tab.evaluate(blue) > 50
