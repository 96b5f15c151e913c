"""Tests what is seen and reached on the page in the eight states of page_states.py, in three widths and both themes."""

from __future__ import annotations

import pytest
from browsers import Browser
from measures import NARROWEST, OPEN_ALL, SCREENS, SCRIPT, THEMES, axe_faults, key_faults, tab_faults, text_faults
from page_states import STATES

REDRAWN = """async () => {
    for (let k = 0; k < 20; k++) await new Promise(requestAnimationFrame);
}"""
"""Waits until the page is drawn again in another size or theme, which takes some frames."""
NOTE = "document.getElementById('track-note').innerText"
AREA = "document.querySelector('.track .legend .of-track').checkVisibility()"
SEEN = {
    "check-failed": f"{NOTE}.startsWith('Not to be trusted') && !{AREA} && solepath.track.drawn.wearer === 0",
    "lost-link": f"{NOTE}.startsWith('Right foot only') && {AREA} && solepath.state.phases.left.at(-1)[1] === null",
    "lift": "solepath.track.labels.placed.some(([words]) => words === 'lift B') &&"
    " document.getElementById('height').ariaLabel.includes('now 0.0 m in the heights of the plan')",
}
"""What holds in a state beyond its layout."""
OPERATED = ("plan", "finished")
"""States with all controls that there are."""


QUICK = ((360, "dark"), (1280, "light"))
"""Screens of the state that is tested most."""
ALL = tuple((width, theme) for width in SCREENS | NARROWEST for theme in THEMES)


@pytest.mark.parametrize(
    ("name", "screens"),
    [
        pytest.param("plan", QUICK[:1], marks=pytest.mark.soak),
        pytest.param("plan", QUICK, marks=pytest.mark.long),
        *(pytest.param(name, ALL, marks=pytest.mark.long) for name in STATES),
    ],
)
async def test_all_is_readable_reached_by_keys_and_without_violation_by_axe(
    chromium: Browser, name: str, screens: tuple[tuple[int, str], ...]
) -> None:
    pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    found: dict[str, list[str]] = {}
    async with STATES[name].open(chromium, script=SCRIPT) as view:
        await view.until(SEEN.get(name, "true"))
        await view.tab.evaluate("measured.read()")
        for width, theme in screens:
            await view.tab.set_viewport_size({"width": width, "height": (SCREENS | NARROWEST)[width]})
            await view.tab.emulate_media(color_scheme=theme)
            await view.tab.evaluate(REDRAWN)
            found[f"{width} {theme}"] = await text_faults(view)
            if (width, theme) in QUICK:
                found[f"{width} {theme}, by axe and by Tab"] = await axe_faults(view) + await tab_faults(view)
        if len(screens) > 1:
            await view.tab.evaluate(OPEN_ALL)
            await view.tab.evaluate("document.getElementById('notice-list').showPopover()")
            found["all is open"] = await axe_faults(view)
            await view.tab.evaluate("document.getElementById('notice-list').hidePopover()")
        if name in OPERATED and screens is ALL:
            found["keys"] = await key_faults(view)
    assert {where: faults for where, faults in found.items() if faults} == {}
