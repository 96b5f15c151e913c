"""Tests the page of what a person is guided through: a shoe held in postures."""

from __future__ import annotations

from math import radians

import pytest
from browsers import Browser
from page_events import foot_moved
from shown import open_page, shown

from solepath import Foot
from solepath.show.page.guide import ShownPosture
from solepath.show.page.scene.scene import Scene


@pytest.mark.soak
async def test_the_page_shows_pitch_target_and_task_as_they_change(chromium: Browser) -> None:
    posture = ShownPosture(Foot.LEFT, "Stand flat.")
    scene = shown([foot_moved(1.0)], Scene("A shoe", "", guide=posture))
    async with open_page(chromium, scene) as (view, _):
        await view.until("document.getElementById('posture-task').innerText === 'Stand flat.'")
        assert await view.text("posture-words") == "Left foot: unsteady"
        posture.task, posture.target = "Raise the heel.", radians(22.0)
        posture.pitch, posture.lean, posture.still = radians(-23.44), radians(-7.2), True
        await view.until("document.getElementById('posture-task').innerText === 'Raise the heel.'")
        assert await view.text("posture-pitch") == "−23.4°"
        assert await view.text("posture-words") == "Left foot: steady, leans 7° sideways"
        target = await view.tab.locator("#posture-target").get_attribute("transform")
        assert target == "rotate(22.0 150,126)"
