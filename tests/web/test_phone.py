"""What the user of footstep-tracker has: a phone in the pocket that shows place and candidates on the plan."""

from __future__ import annotations

import asyncio
from functools import cache
from math import hypot
from pathlib import Path
from typing import Any

import pytest
from browsers import Browser, Window
from plain_tabs import OPEN_FILE, plain_tab
from plan_files import format_floorplan
from scripted_sensors import WALK_AT_ONCE, connect
from web_pages import WORDS, open_site, ready

from solepath.emulate.routes.ways import BuildingWalk, case_study
from solepath.emulate.walk import EmulatedWalk
from solepath.link.devices.cc2541 import PROFILE_20HZ
from solepath.show.web.serve import serving
from solepath_lab.reproduce.footstep.wearers import WearerJob

RECIPE = "footstep-tracker"
CHANNELS = [channel.name for channel in PROFILE_20HZ.channels if channel.name.count("-") == 0][:-1]
"""Channels that a tag sends by itself."""
LOST, NARROWED, DECIDED, LATE = 17.0, 26.0, 45.0, 60.0
"""Times of the walk, s: in front of the lift, on the corridors, after the walls have decided, and later."""
STATE = "({ recipe: solepath.state.recipe, place: solepath.state.place })"
NOTE = "solepath.track.note.innerText"
RECORDED = """computer.call('get', document.querySelector('#walks li').dataset.name)
    .then((file) => file.text())"""


@cache
def walk() -> tuple[BuildingWalk, EmulatedWalk]:
    """Return the walk of the paper's case study, with a CC2541 at 20 Hz in each worn shoe."""
    way = case_study()
    return way, WearerJob(901).walk(way.route)


def sent(until: float) -> int:
    """Return the number of packets of the walk up to a time, s, that the tags send by themselves."""
    return sum(one.channel in CHANNELS and one.t <= until for one in walk()[1].packets)


def recorded(text: str) -> int:
    """Return the number of such packets in a recording."""
    return sum(f'"{one}"' in row for row in text.splitlines() for one in CHANNELS)


def written_plan(folder: Path) -> Path:
    path = folder / "building.geojson"
    path.write_text(format_floorplan(walk()[0].building.plan))
    return path


async def go_on(view: Any, until: float) -> None:
    """Walk on to a time, s, which passes at once."""
    await view.evaluate(WALK_AT_ONCE, [until, CHANNELS])


async def shown(view: Window, t: float) -> Any:
    """Return what the page shows once it shows this time, s."""
    await view.until(f"solepath.state.t >= {t - 0.5}")
    return await view.tab.evaluate(STATE)


@pytest.mark.long
async def test_a_phone_shows_the_candidates_with_their_weights_until_one_is_left(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    way, emulated = walk()
    with serving(site) as url:
        async with open_site(chromium, url) as view:
            await view.tab.set_viewport_size({"width": 360, "height": 740})
            await view.tab.locator("#file").set_input_files([written_plan(tmp_path)])
            await view.until(f"{WORDS}.includes('floor plan is used from now on') && solepath.state.plan !== null")
            await view.tab.locator("#more").click()
            await view.tab.locator("#advanced summary").click()
            await view.tab.locator("#choose-recipe").select_option(RECIPE)
            await view.until(f"{WORDS}.includes('{RECIPE} is used from now on')")
            await connect(view, emulated.packets, PROFILE_20HZ)
            await go_on(view.tab, LOST)
            before = await shown(view, LOST)
            assert before["recipe"] == RECIPE and not before["place"]["decided"]
            assert {one["level"] for one in before["place"]["candidates"]} == {way.level}
            await go_on(view.tab, NARROWED)
            narrowed = await shown(view, NARROWED)
            candidates = narrowed["place"]["candidates"]
            assert 2 <= len(candidates) < len(before["place"]["candidates"])
            assert abs(sum(one["weight"] for one in candidates) - 1.0) < 0.01
            room, weight = narrowed["place"]["room"], round(100.0 * max(one["weight"] for one in candidates))
            sure = "Probably" if weight >= 50 else "Perhaps"
            others = "another place is" if len(candidates) == 2 else f"{len(candidates) - 1} other places are"
            words = f"{sure} ground floor, {room}, {weight} %; {others} possible."
            await view.until(f"{NOTE} === '{words}'")
            await check_pocket(view)
            decided = await shown(view, DECIDED)
            assert decided["place"]["decided"]
            await view.until("document.getElementById('where').innerText.startsWith('Ground floor, corridor')")
            [(level, x, y)] = way.places(emulated.walker, DECIDED)
            assert decided["place"]["level"] == level
            assert hypot(decided["place"]["position"][0] - x, decided["place"]["position"][1] - y) < 2.0
            await view.tab.locator("#end").click()
            await view.until("document.querySelectorAll('#walks li').length === 1")
            assert recorded(await view.tab.evaluate(RECORDED)) == sent(DECIDED)


async def check_pocket(view: Window) -> None:
    """In the pocket nothing is drawn, touches do nothing, and the walk goes on; who holds the button sees it."""
    await view.tab.locator("#pocket").click()
    frames = await view.tab.evaluate("solepath.messages")
    await go_on(view.tab, DECIDED)
    await view.tab.mouse.click(180, 300)
    for _ in range(4):  # a browser prevents two
        await view.tab.keyboard.press("Escape")
    await view.tab.locator("#uncover").click()  # too short
    await view.tab.evaluate("computer.call('save')")  # until all of that is computed
    assert await view.tab.evaluate("solepath.messages") == frames
    assert await view.tab.evaluate("document.getElementById('cover').open")
    await view.tab.locator("#uncover").hover()
    await view.tab.mouse.down()
    await view.until("!document.getElementById('cover').open")
    await view.tab.mouse.up()


@pytest.mark.long
async def test_a_walk_goes_on_while_the_page_is_hidden_and_after_it_was_frozen(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    text = written_plan(tmp_path).read_text()
    with serving(site) as url:
        async with plain_tab(chromium, url) as view:
            await ready(view)
            await view.evaluate(OPEN_FILE, ["building.geojson", text])
            await view.until("solepath.state.plan !== null")
            await view.evaluate(f"computer.call('choose', '{RECIPE}')")
            await view.until(f"document.getElementById('choose-recipe').value === '{RECIPE}'")
            await connect(view, walk()[1].packets, PROFILE_20HZ)
            await go_on(view, LOST)
            await view.until(f"solepath.state.t >= {LOST - 0.5}")
            await view.hide()
            drawn = await view.evaluate("solepath.messages")
            await go_on(view, NARROWED)
            await view.evaluate("computer.call('save')")  # the worker answers, so it computes
            assert await view.evaluate("solepath.messages") - drawn <= 1
            await view.show()
            await view.until(f"solepath.state.t >= {NARROWED - 0.5} && solepath.state.place.candidates.length > 1")
            await view.hide()
            await view.freeze()
            await go_on(view, LATE)
            await asyncio.sleep(1.0)
            assert await view.evaluate("solepath.state.t") < NARROWED + 1.0
            await view.show()
            await view.until(f"solepath.state.t >= {LATE - 0.5} && solepath.state.place.decided")
            await view.evaluate("document.getElementById('end').click()")
            await view.until("document.querySelectorAll('#walks li').length === 1")
            assert recorded(await view.evaluate(RECORDED)) == sent(LATE)
