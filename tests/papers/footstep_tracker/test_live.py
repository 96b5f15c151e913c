"""The live position of the recipe footstep-tracker follows the foot, wherever on the floor it is."""

from __future__ import annotations

from math import dist, radians

from solepath import Foot, Session, recipes
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.events import FootMoved


def test_far_from_both_axes_the_live_position_goes_on_without_a_jump() -> None:
    route = Route().stand(2).walk(6.0, 1.2).turn(radians(90)).walk(8.0, 1.2).stop(1)
    session = Session(recipes.by_name("footstep-tracker"), poses=True)
    events = session.feed(Walker(route, seed=4).samples(Foot.LEFT, 100.0, LSM6DSOX))
    places = [event.position[:2] for event in events if isinstance(event, FootMoved)]
    assert dist(places[-1], (6.0, 8.0)) < 2.5
    assert max(dist(a, b) for a, b in zip(places, places[1:], strict=False)) < 0.5
