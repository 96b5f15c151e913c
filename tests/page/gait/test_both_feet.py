"""Tests what the page shows of both feet together: touchdowns and fused strides."""

from __future__ import annotations

from attrs import evolve
from browsers import Browser
from page_events import feed_session, foot_moved
from shown import frame, open_page, shown
from walks import insoles

from solepath import Foot, StrideFused
from solepath.emulate.routes.route import Route
from solepath.events import TouchedDown
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC
from solepath.show.page.body import Legs, LiveBody
from solepath.types import WalkingMode

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT


def test_a_touchdown_is_shown_with_its_walking_mode() -> None:
    assert frame(shown([foot_moved(1.0)]))["touchdown"] is None
    down = TouchedDown(
        t=1.2,
        known_at=1.2,
        final=False,
        foot=RIGHT,
        position=(0.61, -0.0704, 0.0),
        mode=WalkingMode.LEFT_WIDE,
        compensation=(0.0, 0.0, 0.0),
    )
    scene = shown([foot_moved(1.0), down])
    expected = {"t": 1.2, "foot": "right", "mode": "LEFT_WIDE", "position": [0.61, -0.07, 0.0]}
    assert frame(scene)["touchdown"] == expected
    assert not scene.observer.modes  # a touchdown that is not final may still be elsewhere


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


def test_a_fused_stride_is_shown_with_distance_similarity_and_error_index() -> None:
    scene = shown([foot_moved(1.0)])
    assert frame(scene)["fused"] is None
    shown([FUSED], scene)
    assert frame(scene)["fused"] == {
        "t": 9.0,
        "foot": "left",
        "length": 1.32,
        "similarity": 0.877,
        "error_index": 0.0123,
        "share": 0.5,
        "chosen": "right",
        "distance": 8.46,
    }


def test_an_abnormal_stride_without_a_partner_has_neither_similarity_nor_error_index() -> None:
    content = frame(shown([evolve(FUSED, similarity=None, error_index=None)]))["fused"]
    assert (content["similarity"], content["error_index"], content["length"]) == (None, None, 1.32)


def test_the_fused_distance_of_a_walk_is_that_of_its_last_fused_stride() -> None:
    _, events = feed_session(insoles(Route().stand(1.5).walk(8.0, 1.3).stop(1.0)).packets, recipe=KUPT_DFPC)
    last = [event for event in events if isinstance(event, StrideFused)][-1]
    content = frame(shown(events))["fused"]
    assert (content["distance"], content["chosen"]) == (round(last.distance, 2), last.chosen.value)
    assert content["distance"] > 6.0


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


def test_the_body_is_seen_from_the_right_whichever_way_the_wearer_faces() -> None:
    assert frame(shown([evolve(DOWN, legs=None)]))["body"] is None
    assert frame(shown([DOWN]))["body"] == {
        "t": 1.2,
        "left": [[0.0, 0.0], [-0.15, -0.42], [-0.3, -0.83], [-0.15, -0.91]],
        "right": [[0.0, 0.0], [0.15, -0.42], [0.3, -0.83], [0.45, -0.91]],
    }


def test_legs_between_touchdowns_are_those_of_the_session_ten_times_a_second() -> None:
    read_at: list[float] = []

    def legs() -> Legs | None:
        read_at.append(scene.now)
        rods = (standing(0.08, 0.1 * scene.now), standing(-0.08, -0.1 * scene.now))
        return (scene.now, rods) if scene.now < 9.0 else None

    scene = shown([foot_moved(1.0), DOWN])
    scene.body = LiveBody(legs)
    shown_at = []
    for k in range(60):
        scene.tick(2.0 + 0.03 * k)
        shown_at.append(frame(scene)["body"]["t"])
    assert shown_at[0] == 2.0 and 14 <= len(set(shown_at)) == len(read_at) <= 18
    assert frame(scene)["body"]["left"][2] == [round(0.1 * read_at[-1], 3), -0.83]
    scene.tick(9.5)
    assert frame(scene)["body"]["t"] == DOWN.t  # an attitude is not known: the last touchdown


def test_feet_that_point_straight_down_show_no_body() -> None:
    hanging = ((0.0, 0.0, 0.0), (0.0, 0.0, -0.42), (0.0, 0.0, -0.83), (0.0, 0.0, -0.98))
    assert frame(shown([evolve(DOWN, legs=(hanging, hanging))]))["body"] is None


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
