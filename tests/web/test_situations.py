"""The site says of itself what is and nothing else, in each situation, with insoles in Chromium's Bluetooth stack."""

from __future__ import annotations

import json
from contextlib import aclosing
from pathlib import Path

import pytest
from browsers import Browser, Window
from measures import NEXT_FRAME, SCREENS, SCRIPT, axe_faults, shifts, tab_faults
from situations import SAID, situations

TEXT = "['.top', '#site', '.hero'].map((one) => document.querySelector(one).innerText).join(' ')"
LEVEL = "document.getElementById('notice').dataset.level"
BUTTONS = """[...document.querySelectorAll('.site-buttons [data-in]')]
    .filter((one) => one.checkVisibility()).map((one) => one.textContent)"""
IS_FIRST = """['activity', 'speed', 'distance', 'track']
    .every((one) => document.getElementById(one).getBoundingClientRect().bottom <= innerHeight)"""
TEXT_FAULTS = """[...measured.overlapping(), ...measured.cut(), ...measured.shortened(), ...measured.wide()]
    .filter((words) => !words.endsWith('in #title'))"""
"""Texts that cannot be read; the name of a walk may be as long as its file's, and ends in an ellipsis."""
CHOICES = {
    "no-bluetooth": ["Demonstration", "Open a file"],
    "choosing": ["Connect a sensor", "Demonstration"],
    "refused": ["Connect a sensor", "Demonstration"],
    "connecting": ["Connect a sensor", "End the walk"],
    "connected": ["Connect a sensor", "End the walk"],
    "walking": ["Pocket", "End the walk"],
    "lost": ["Pocket", "End the walk"],
    "resumed": ["Connect a sensor", "End the walk"],
    "finished": ["Report", "Connect a sensor"],
    "computing": [],
    "playing": ["Report"],
    "paused": ["Report"],
    "failed": [],
}
"""What a person may do in each situation, before the sheet is opened."""


async def faults_of(name: str, view: Window) -> dict[str, object]:
    """Return what is wrong with a situation that is shown."""
    text = " ".join((await view.tab.evaluate(TEXT)).split())
    said = [one for one, words in SAID.items() if words in text]
    faults: dict[str, object] = {"said": said} if said != [name] else {}
    level = await view.tab.evaluate(LEVEL)
    if level != ("bad" if name == "lost" else "quiet"):
        faults["level"] = level
    if (buttons := await view.tab.evaluate(BUTTONS)) != CHOICES[name]:
        faults["buttons"] = buttons
    if name in ("walking", "lost", "playing", "finished") and not await view.tab.evaluate(IS_FIRST):
        faults["first screen"] = "status, two figures and the track are not all on it"
    for width, height in SCREENS.items():
        await view.tab.set_viewport_size({"width": width, "height": height})
        await view.tab.evaluate(NEXT_FRAME)
        faults |= {f"text, {width} px": one} if (one := await view.tab.evaluate(TEXT_FAULTS)) else {}
    await view.tab.set_viewport_size({"width": 390, "height": 844})
    await view.tab.evaluate(NEXT_FRAME)
    if name != "failed":  # what has stopped is dimmed
        faults |= {"axe": one} if (one := await axe_faults(view)) else {}
        faults |= {"tab": one} if (one := await tab_faults(view)) else {}
    faults |= {"moved": one} if (one := await shifts(view)) else {}
    await view.tab.evaluate("measured.shifts.length = 0")
    return faults


@pytest.mark.soak
async def test_each_situation_has_its_own_words_and_those_of_no_other(chromium: Browser, site: Path) -> None:
    async with aclosing(situations(chromium, site, width=390, height=844, script=SCRIPT)) as shown:
        found = {name: faults async for name, view in shown if (faults := await faults_of(name, view))}
    assert found == {}, json.dumps(found, indent=1)
