"""Tests the page in a real browser, fed with the events of emulated walks."""

from __future__ import annotations

import json
from contextlib import AsyncExitStack

import pytest
from attrs import evolve
from browsers import UNREACHABLE, Browser, window
from shown import CONNECTED, frame, open_page, packets_between, scene_after, show

from solepath import Candidate, Connected, LinkTrouble, Placed, Session, Site, WearerMoved
from solepath.emulate import Route, Walker
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.sensors.insoles import layout
from solepath.show.page.messages import encode
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page
from solepath.types import Foot

PHONE_WIDTH = 360  # px
CANVASES = ("sole-left", "sole-right", "track", "ribbon")
PICTURES = "names => names.map((name) => document.getElementById(name).toDataURL())"


async def test_a_walk_is_drawn_while_it_goes_on_and_its_figures_are_those_of_the_session(chromium: Browser) -> None:
    scene = scene_after(6.0, "Ward 3, corridor")
    async with open_page(chromium, scene) as (view, _):
        assert await view.text("title") == "Ward 3, corridor" and "Ward 3, corridor" in await view.tab.title()
        assert await view.tab.locator("#recipe").text_content() == "default"
        await view.until("Number(document.getElementById('track').dataset.points) > 0")
        before = await view.tab.evaluate(PICTURES, CANVASES)
        await show(scene, packets_between(6.0, 12.0), speed=4.0)
        expected = frame(scene)
        await view.until("t => solepath.state.t === t", expected["t"])
        strides = max(counts.strides for counts in scene.walk.feet.values())
        await view.until(f"document.getElementById('strides').textContent === '{strides}'")
        assert all(now != old for now, old in zip(await view.tab.evaluate(PICTURES, CANVASES), before, strict=True))
        assert await view.text("activity") == "Walking"
        assert float(await view.text("speed")) == pytest.approx(expected["pace"]["speed"], abs=0.005)
        assert float(await view.text("cadence")) == pytest.approx(expected["pace"]["cadence"], abs=0.5)
        tracks = json.loads(encode(scene.whole_message()))["tracks"]
        assert await view.tab.evaluate("solepath.state.tracks") == tracks and len(tracks["left"]) > 5
        for foot in Foot:
            force = f"parseFloat(document.getElementById('force-{foot.value}').textContent)"
            await view.until(f"Math.abs({force} - {expected['feet'][foot.value]['force']}) <= 1")
            words = await view.tab.locator(f"#sole-{foot.value}").get_attribute("aria-label")
            assert words is not None and words.startswith(f"{foot.value.capitalize()} sole: ") and " newton" in words


async def test_cells_alone_show_the_cadence_and_neither_strides_nor_a_distance(chromium: Browser) -> None:
    session, scene = Session(poses=True, pressures=True, losses=True), Scene("cells alone", "default", "recording")
    walker = Walker(Route().stand(2.0).walk(15.0).stop(2.0), seed=3)
    for sample in walker.samples(Foot.LEFT, 50.0, layout=layout(24, Foot.LEFT))[:600]:
        sample = evolve(sample, acc=None, gyro=None)
        scene.take(sample, session.feed(sample))
    async with open_page(chromium, scene) as (view, _):
        await view.until("document.getElementById('cadence').textContent !== '–'")
        assert await view.tab.evaluate("document.getElementById('figures').dataset.known") == "true"
        assert [await view.text(name) for name in ("strides", "distance", "speed")] == ["–"] * 3


@pytest.mark.soak
async def test_a_plan_shows_the_wearer_once_the_place_is_decided_and_drops_wrong_candidates(chromium: Browser) -> None:
    ground, upper = (level.id for level in BUILDING.levels[:2])

    def place(t: float, x: float, level: str, *others: float) -> Placed:
        """Return a place whose likeliest candidate is at `x`, with another one of less weight."""
        weights = (0.6, 0.4) if others else (1.0,)
        candidates = [
            Candidate(level, (at, 5.0, 0.0), 0.0, weight, "stairs")
            for at, weight in zip((x, *others), weights, strict=True)
        ]
        return Placed(t=t, known_at=t, level=level, position=(x, 5.0, 0.0), spread=1.0, candidates=tuple(candidates))

    scene = Scene("a building", "default", "live", plan=BUILDING)
    async with open_page(chromium, scene) as (view, _):
        seen = "document.getElementById('track').dataset"
        note = "document.getElementById('track-note').innerText"
        await view.until(f"{seen}.view === 'track' && {note}.startsWith('Where on the plan is not known yet')")
        for k in range(4):
            t, walked = 1.0 + k, 0.8 * k
            scene.take(None, [WearerMoved(t=t, known_at=t, position=(walked, 0.0, 0.0), covariance=(0.01,) * 6)])
            scene.take(None, [place(t, 5.0 + walked, ground, 25.0 + walked)])
        await view.until(f"{seen}.view === 'plan' && {seen}.points === '0' && {seen}.since === '0'")
        name = BUILDING.levels[0].name or ground
        await view.until(f"{note} === 'Probably {name}, 60 %; another place is possible.'")
        scene.take(None, [place(5.0, 27.4, ground)])
        await view.until(f"{seen}.points === '1' && document.getElementById('track-note').hidden")
        await view.until("document.getElementById('track').ariaLabel.includes('The wearer is on')")
        scene.take(None, [evolve(place(6.0, 27.5, upper), room="<b>room 12</b>")])
        await view.until(
            f"{seen}.level === '{upper}' && document.getElementById('track').ariaLabel.includes(', <b>room 12</b>')"
        )


@pytest.mark.soak
async def test_the_page_says_that_the_program_has_ended_and_reconnects_on_request_to_another_one(
    chromium: Browser,
) -> None:
    token, offline = "the same as before", "document.getElementById('offline').innerText.includes('has ended')"
    async with AsyncExitStack() as stack:
        async with Page(scene_after(20.0, "before"), port=0, token=token) as first:
            view = await stack.enter_async_context(window(chromium, first.url))
            await view.until(f"{CONNECTED} && document.getElementById('activity').textContent === 'Walking'")
        await view.until(f"{offline} && document.getElementById('activity').textContent === 'Finished'")
        async with Page(scene_after(12.0, "after"), port=first.port, token=token):
            await view.tab.locator("#retry").click()
            await view.until(f"{CONNECTED} && document.getElementById('title').textContent === 'after'")
            await view.tab.locator("#offline").wait_for(state="hidden")
        assert all(UNREACHABLE.search(description) for description in view.complaints), view.complaints


async def test_device_names_are_shown_as_text(chromium: Browser) -> None:
    hostile = "<img src=x onerror=\"document.title='broken'\"><script>document.title='broken'</script>"
    scene = scene_after(6.0, hostile)
    name, site = hostile.ljust(248, "W"), Site.LEFT_FOOT  # as long as a device can have one
    scene.take(None, [Connected(t=6.0, known_at=6.0, site=site, device="F0:5E:00:00:00:01", name=name, signal=-50)])
    scene.take(None, [LinkTrouble(t=6.0, known_at=6.0, site=site, what="W" * 300)])
    async with open_page(chromium, scene, width=PHONE_WIDTH) as (view, _):
        assert await view.text("title") == hostile
        await view.until("document.getElementById('links').textContent.includes('onerror')")
        assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= PHONE_WIDTH
        assert await view.tab.locator("main img, main script, header img, header script").count() == 0
        assert await view.tab.title() != "broken"
