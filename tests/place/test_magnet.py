"""A magnet that comes beside the sensor of a shoe: the place on the plan and the activities go on as without it."""

from __future__ import annotations

from functools import cache
from math import atan2, pi, radians

import pytest
from attrs import evolve

from solepath import ActivityChanged, DefectFound, Event, LiftRidden, Placed, Session, Start
from solepath.emulate import Insole, sampled
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.ways import case_study
from solepath.emulate.sensors.magnetic_field import EARTH
from solepath.emulate.sensors.parts import AK8963
from solepath.emulate.walk import SampledWalk
from solepath.events import Defect
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Anchor
from solepath.types import SITE_OF_FOOT, Foot, Site, Vec3
from solepath.validate.place import is_near, is_on_floor
from solepath_lab.emulated.magnetic_field import DisturbedField

WAY = case_study()
CAME = 60.0
"""Time at which the magnet comes, s."""
NEAR_MAGNET, AT_SENSOR = (60e-6, 30e-6, 20e-6), (600e-6, 300e-6, 200e-6)
"""Flux density of a magnet some centimetres away, and of one that touches the sensor, T."""


@cache
def walk() -> SampledWalk:
    insoles = {SITE_OF_FOOT[foot]: Insole(cells=24, mag=AK8963) for foot in Foot}
    return sampled(WAY.route, insoles=insoles, field=DisturbedField(radians(20.0), seed=4), seed=3)


NORTHERN = evolve(BUILDING, anchor=Anchor(48.0, 11.0, atan2(EARTH[1], EARTH[0]) - 0.5 * pi))
"""The building with its north: the walk's first heading is the plan's x axis."""


@cache
def events(magnet: Vec3 | None, by_north: bool = False) -> list[Event]:
    """Return the events of a walk with a magnet at the left shoe, or without magnetometers.

    The first heading is given, or it is found `by_north` of the plan and the compass."""
    samples = []
    for sample in walk().samples:
        mag = None if magnet is None else sample.mag
        if mag is not None and magnet is not None and sample.site is Site.LEFT_FOOT and sample.t > CAME:
            mag = (mag[0] + magnet[0], mag[1] + magnet[1], mag[2] + magnet[2])
        samples.append(evolve(sample, mag=mag))
    start = None if by_north else Start(heading=WAY.start.heading)
    session = Session(floorplan=IndexedPlan(NORTHERN if by_north else BUILDING), start=start)
    return session.feed(samples) + session.finish()


def activities(found: list[Event]) -> list[tuple[str, float]]:
    """Return activities and rides with their times, as they were reported."""
    return [(str(event), event.t) for event in found if isinstance(event, ActivityChanged | LiftRidden)]


@pytest.mark.long
@pytest.mark.parametrize(("magnet", "by_north"), [(NEAR_MAGNET, True), (AT_SENSOR, False)])
def test_the_place_stays_right_and_the_activities_are_the_same(magnet: Vec3, by_north: bool) -> None:
    plain, disturbed = events(None), events(magnet, by_north)
    assert activities(plain) == activities(disturbed) != []
    late = [one for one in disturbed if isinstance(one, Placed) and one.t > CAME and is_on_floor(walk().truth, one.t)]
    assert len(late) > 50
    for one in late:
        ((level, x, y),) = WAY.places(walk().walker, one.t)
        assert any(is_near(candidate, level, x, y) for candidate in one.candidates)


@pytest.mark.long
def test_a_magnet_at_the_sensor_is_reported() -> None:
    found = [event for event in events(AT_SENSOR) if isinstance(event, DefectFound)]
    assert {event.defect for event in found} == {Defect.COMPASS} and not any(event.spoils for event in found)
