"""Tests the page of what a person is guided through: a shoe held in postures, a walk that calibrates toe-out."""

from __future__ import annotations

from collections import deque
from collections.abc import AsyncIterator
from math import degrees, radians
from pathlib import Path

from browsers import Browser
from page_events import foot_moved
from shown import frame, open_page, shown

from solepath import Foot, Packet
from solepath.cli.calibrate.toe_out_live import GuidedWalk
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.recording import PacketWriter
from solepath.show.page.posture import ShownPosture
from solepath.show.page.scene.scene import Scene
from solepath.show.page.toe_out import ShownFoot, ShownToeOut
from solepath.types import SITE_OF_FOOT

TOE_OUT = radians(8.0)
"""Toe-out of the emulated wearer, rad."""


def test_a_session_that_measures_no_shoe_shows_no_posture() -> None:
    assert frame(shown([foot_moved(1.0)]))["posture"] is None


async def test_the_page_shows_pitch_target_and_task_as_they_change(chromium: Browser) -> None:
    posture = ShownPosture(Foot.LEFT, "Stand flat.")
    scene = shown([foot_moved(1.0)], Scene("A shoe", "", guide=posture))
    async with open_page(chromium, scene) as (view, _):
        await view.until("document.getElementById('posture-task').innerText === 'Stand flat.'")
        target = view.tab.locator("#posture-target")
        assert await view.text("posture-pitch") == "–°"
        assert await view.text("posture-words") == "Left foot: unsteady"
        assert await target.get_attribute("visibility") == "hidden"
        for card, visible in (("posture", True), ("links", True), ("soles", False), ("track", False)):
            assert await view.tab.locator(f".card.{card}").is_visible() == visible, card
        posture.task, posture.target = "Raise the heel.", radians(22.0)
        posture.pitch, posture.lean, posture.is_still = radians(-23.44), radians(-7.2), True
        await view.until("document.getElementById('posture-task').innerText === 'Raise the heel.'")
        assert await view.text("posture-pitch") == "−23.4°"
        assert await view.text("posture-words") == "Left foot: steady, leans 7° sideways"
        assert await view.tab.locator("#posture-shoe").get_attribute("transform") == "rotate(-23.4 150,126)"
        assert await target.get_attribute("transform") == "rotate(22.0 150,126)"
        assert await target.get_attribute("visibility") == "visible"


async def test_the_page_shows_the_walk_that_calibrates_toe_out_step_by_step(chromium: Browser, tmp_path: Path) -> None:
    route = Route().stand(4.0).walk(20.0, 1.2).stop(2.0)
    tags = {site: CC2541(rate=20.0, mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    packets = deque(emulate(route, wearer=Wearer(toe_out=TOE_OUT), devices=tags, seed=1).packets)
    walk = GuidedWalk(PacketWriter(tmp_path / "walk.jsonl"), tuple(Foot), ShownToeOut("Stand still.", 20.0))

    async def walk_until(t: float) -> None:
        async def coming() -> AsyncIterator[Packet]:
            while packets and packets[0].t < t:
                yield packets.popleft()

        await walk.receive(coming())
        walk.line()

    notes = "[...document.querySelectorAll('.foot-note')].map((one) => one.textContent)"
    async with open_page(chromium, walk.scene, width=360, height=740) as (view, _):
        await view.until("document.getElementById('toe-out-task').innerText === 'Stand still.'")
        walk.line()
        await view.until(f"{notes}.every((words) => words === 'not learnt: its sensor does not send yet')")
        for card, visible in (("guide", True), ("links", True), ("soles", False), ("track", False)):
            assert await view.tab.locator(f".card.{card}:not(.posture)").is_visible() == visible, card
        await walk_until(8.0)
        walk.shown.task = "Walk straight ahead."
        await view.until("document.getElementById('toe-out-task').innerText === 'Walk straight ahead.'")
        await view.until(f"{notes}.every((words) => words === 'not learnt: 5 strides are needed')")
        await walk_until(30.0)
        await view.until(f"{notes}.every((words) => words === 'enough to be learnt')")
        angles = await view.tab.locator(".foot-angle").all_inner_texts()
        for words in angles:
            angle, sigma = (float(one) for one in words.replace("°", "").split(" ± "))
            assert abs(angle - degrees(TOE_OUT)) < 3.0 and 1.0 < sigma < 3.0, words
        walked, of = (await view.text("toe-out-words")).split(" of ")
        assert of == "20.0 m" and abs(float(walked.removesuffix(" m")) - 20.0) < 1.5
    walk.writer.close()


async def test_a_walk_that_bends_shows_why_nothing_is_learnt(chromium: Browser) -> None:
    foot = ShownFoot(Foot.LEFT, 9, 11.0, why="the left foot turns by 1.2 rad: is the walk straight?")
    scene = Scene("A walk", "", guide=ShownToeOut("Walk.", None, (foot,)))
    async with open_page(chromium, scene) as (view, _):
        await view.until("document.querySelector('.foot-note')?.innerText.includes('turns by 1.2 rad')")
        assert await view.tab.locator(".foot-angle").inner_text() == "–"
        assert await view.tab.locator("#toe-out-done").is_hidden()
