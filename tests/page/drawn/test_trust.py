"""Tests what drawings show of wrong or missing data of a foot, and of heights before the first known place."""

from __future__ import annotations

from browsers import Browser
from page_states import STATES

AREA = "!document.querySelector('.track .legend .of-track').hidden"
HEIGHTS = """async () => {
    const { onPlanHeights } = await import('./heights.js');
    const heights = onPlanHeights(solepath.state.tracks.wearer, solepath.state.places).map((point) => point[3]);
    return [Math.min(...heights), Math.max(...heights)];
}"""
NOTE = "document.getElementById('track-note').innerText"


async def test_a_track_from_wrong_data_has_no_area_and_a_note(chromium: Browser) -> None:
    async with STATES["check-failed"].open(chromium) as view:
        await view.until(f"{NOTE}.startsWith('Not to be trusted')")
        assert not await view.tab.evaluate(AREA)
        assert await view.tab.evaluate("solepath.track.drawn.wearer") == 0, "no solid line"


async def test_a_lost_foot_ends_its_phases_and_leaves_a_dashed_area(chromium: Browser) -> None:
    async with STATES["lost-link"].open(chromium) as view:
        await view.until(f"{NOTE}.startsWith('Right foot only')")
        assert await view.tab.evaluate(AREA)
        last = await view.tab.evaluate("solepath.state.phases.left.at(-1)")
        assert last[1] == "" and 30.8 < last[0] <= 31.05, "from the last sample on nothing is known"


async def test_a_lift_has_its_name_beside_the_mark_and_heights_have_the_zero_of_the_plan(chromium: Browser) -> None:
    async with STATES["lift"].open(chromium) as view:
        await view.until("document.getElementById('track').dataset.labels.includes('lift B')")
        assert await view.tab.evaluate("document.getElementById('track-note').hidden"), "the words above say it"
        spoken = "document.getElementById('{}').ariaLabel"
        await view.until(spoken.format("height") + ".includes('now 0.0 m in the heights of the plan')")
        lowest, highest = await view.tab.evaluate(HEIGHTS)
        assert abs(lowest) < 0.2 and 3.0 < highest < 3.4, "the ride down from the upper floor is in it"
