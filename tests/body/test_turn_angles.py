"""A turn is as large as the wearer turned: each stride and pivot of a foot counts once, whenever it becomes known."""

from __future__ import annotations

from math import degrees, fsum, pi, radians, remainder

import pytest
from soak import longer

from solepath import Foot, Session, TurnMade, recipes
from solepath.emulate import Route, Walker

TOLERANCE = 6.0
"""Largest error of a turn by emulated feet without sensor errors, degrees."""
STARTS = {
    "standing": Route().stand(2.5),
    "walking": Route().stand(2.5).walk(6.0, 1.1),
    "after a halt": Route().stand(2.5).walk(6.0, 1.1).stand(3.0),
}
"""What the wearer does before the turn."""


CASES = [("default", start) for start in STARTS] + [("footstep-tracker", "walking")]
"""Recipes and starts; footstep-tracker sees a first step from standing too late to know how the foot stood before."""


@pytest.mark.parametrize(("recipe", "start"), CASES)
@pytest.mark.parametrize("angle", [-90, 180, *longer(-150, 60)])
def test_a_turn_on_the_spot_is_as_large_as_it_was(start: str, angle: int, recipe: str) -> None:
    route = STARTS[start].turn(radians(angle)).walk(6.0, 1.1).stop(3.0)
    walker = Walker(route, seed=5)
    samples = sorted([one for foot in Foot for one in walker.samples(foot, 100.0)], key=lambda one: one.t)
    session = Session(recipes.by_name(recipe))
    events = session.feed(samples) + session.finish()
    turned = fsum([event.angle for event in events if isinstance(event, TurnMade)])
    assert abs(degrees(remainder(turned - radians(angle), 2.0 * pi))) < TOLERANCE
