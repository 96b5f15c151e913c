"""The wearer's mark and the area that holds the wearer move together on the track."""

from __future__ import annotations

from browsers import Browser
from shown import open_page, scene_after

from solepath import WearerMoved

SPY = """globalThis.drawn = [];
const { arc, ellipse } = Path2D.prototype;
let area = null;
Path2D.prototype.ellipse = function (x, y, ...others) { area = [x, y]; return ellipse.call(this, x, y, ...others); };
Path2D.prototype.arc = function (x, y, radius, ...others) {
    if (area !== null && radius === 9) drawn.push([...area, x, y]);
    return arc.call(this, x, y, radius, ...others);
};"""
"""Notes the middle of each area with that of the wearer's mark, whose radius is 9 px, drawn after it."""
STEPS = 40
"""Most places of the wearer; a slow browser draws few pictures of each way to the next."""


async def test_the_wearer_is_in_the_middle_of_the_area_while_both_glide_to_the_next_place(chromium: Browser) -> None:
    scene = scene_after(6.0)
    async with open_page(chromium, scene, script=SPY) as (view, _):
        for step in range(STEPS):
            t = scene.now + 0.5
            place = (4.0 + 0.2 * step, 0.1 * step, 0.0)
            scene.take(None, [WearerMoved(t=t, known_at=t, position=place, covariance=(1.0, 0.0, 0.0, 1.0, 0.0, 0.1))])
            await view.until("([t, count]) => solepath.state.t >= t - 0.01 && drawn.length > count", [t, step])
            drawn = await view.tab.evaluate("drawn")
            if len({(x, y) for _, _, x, y in drawn}) > step + 6:
                break  # more places were drawn than there are: the mark glides
    assert step < STEPS - 1
    assert all((x, y) == (mark_x, mark_y) for x, y, mark_x, mark_y in drawn)
