"""Ramps, turning on the spot, walking backwards and sideways are walking and no stairs, with insoles and SensorTags.

This holds for the default speeds. With slow SensorTags the first second on a ramp, or of a walk, may be reported as
stairs (`RAMPS_AS_STAIRS`). Not asserted, because it fails: walking backwards at 0.8 to 1.0 m/s is reported as stairs
down for some wearers, most of the time. With slow SensorTags a turn on the spot may be reported as a ride."""

from __future__ import annotations

from collections import Counter
from functools import cache
from math import pi

import pytest
from soak import soaked

from solepath import Session, recipes
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.gait import Wearer
from solepath.events import ActivityChanged
from solepath.types import Activity, Site
from solepath.walk.timeline import Timeline
from solepath_lab.emulated.wearers import SUBJECTS

SLOPE = 1.0 / 12.0
UP = Route().stand(3.0).walk(5.0, 1.3).walk(25.0, slope=SLOPE).walk(3.0).stand(3.0)
DOWN = Route().stand(3.0).walk(5.0, 1.3).walk(25.0, slope=-SLOPE).walk(3.0).stand(3.0)
ON_THE_SPOT = (
    Route().stand(3.0).turn(pi).stand(1.0).turn(pi).stand(3.0).turn(-pi).turn(-pi).stand(3.0).turn(pi).stand(3.0)
)
BACKWARDS = Route().stand(3.0).walk(12.0, direction=pi).stand(3.0)
SIDEWAYS = Route().stand(3.0).walk(4.0, direction=0.5 * pi).stand(3.0).walk(4.0, direction=-0.5 * pi).stand(3.0)
EVERYTHING = (
    Route().stand(3.0).walk(8.0, 1.3).walk(4.0, direction=pi).walk(2.0, direction=0.5 * pi).walk(6.0).turn(pi)
    .walk(5.0, slope=-SLOPE).stand(3.0)
)  # fmt: skip
ROUTES = {
    "up": UP, "down": DOWN, "on the spot": ON_THE_SPOT, "backwards": BACKWARDS, "sideways": SIDEWAYS,
    "everything": EVERYTHING,
}  # fmt: skip
WEARERS = {1: Wearer(), 2: SUBJECTS[2], 3: SUBJECTS[3]}
"""Wearer of each seed: the default one, the smallest subject and the tallest one."""
RAMPS_AS_STAIRS = {("up", 1), ("up", 2), ("down", 1), ("everything", 1)}
"""Routes and seeds of slow SensorTags, whose accelerometers clip, on which a second or two are reported as stairs."""
OFTEN = ("up",)
MARKS = ((), pytest.mark.soak, pytest.mark.long)
"""Marks of what is always walked, of the other walks of the default wearer, and of other wearers."""
WALKED = [
    pytest.param(name, seed, is_tag, marks=MARKS[2 if seed > 1 else is_tag or name not in OFTEN])
    for name in ROUTES
    for seed in WEARERS
    for is_tag in (False, True)
]
"""Routes with their wearers: the default one walks what differs most from walking ahead, the soak everything."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)
MAX_STAIRS, MIN_WALKING, MOST_WALKING = 0.02, 0.9, 0.8
"""Largest share of the time reported as stairs, and least share of walking reported as walking, ahead and otherwise."""


@cache
def confusion(name: str, seed: int, is_tag: bool) -> Counter[tuple[Activity, Activity]]:
    """Return the number of tenths of a second for each true activity and the reported one.

    The last two seconds are left out."""
    tags = {site: CC2541(rate=20.0) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)} if is_tag else None
    walk = emulate(ROUTES[name], wearer=WEARERS[seed], devices=tags, seed=seed)
    session, timeline = Session(recipes.DEFAULT), Timeline()
    for event in [event for packet in walk.packets for event in session.feed(packet)] + session.finish():
        if isinstance(event, ActivityChanged):
            timeline.add(event)
    times = [0.1 * k for k in range(int(10.0 * (walk.truth.duration - 2.0)))]
    return Counter((walk.truth.activity(t), timeline.at(t)) for t in times)


@pytest.mark.parametrize(("name", "seed", "is_tag"), WALKED)
def test_other_ways_of_walking_are_no_stairs(
    request: pytest.FixtureRequest, name: str, seed: int, is_tag: bool
) -> None:
    if is_tag and (name, seed) in RAMPS_AS_STAIRS:
        request.applymarker(pytest.mark.xfail(reason="a second or two are reported as stairs", strict=True))
    found = confusion(name, seed, is_tag)
    assert sum(count for (_, reported), count in found.items() if reported in STAIRS) < MAX_STAIRS * found.total()


@pytest.mark.parametrize(("name", "seed", "is_tag"), [one for one in WALKED if one.values[0] in ("up", "down")])
def test_a_ramp_is_walking(name: str, seed: int, is_tag: bool) -> None:
    found = confusion(name, seed, is_tag)
    walked = sum(count for (true, _), count in found.items() if true is Activity.WALKING)
    assert found[Activity.WALKING, Activity.WALKING] >= MIN_WALKING * walked


@pytest.mark.parametrize(
    ("name", "seed", "is_tag"), [one for one in WALKED if one.values[0] in ("backwards", "sideways")]
)
def test_feet_that_turn_little_stride_all_the_same(name: str, seed: int, is_tag: bool) -> None:
    found = confusion(name, seed, is_tag)
    walked = sum(count for (true, _), count in found.items() if true is Activity.WALKING)
    assert found[Activity.WALKING, Activity.WALKING] >= MOST_WALKING * walked


@pytest.mark.parametrize("seed", [1, *soaked(2, 3)])
@pytest.mark.soak
def test_with_insoles_turning_on_the_spot_is_walking_or_standing(seed: int) -> None:
    reported = {reported for _, reported in confusion("on the spot", seed, False)}
    assert reported <= {Activity.UNKNOWN, Activity.STANDING, Activity.WALKING}
