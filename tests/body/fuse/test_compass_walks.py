"""A compass in emulated walks of whole sessions: samples or packets in, the heading held."""

from __future__ import annotations

from functools import cache
from math import pi, radians
from typing import Any

import pytest
from attrs import evolve

from solepath import DefectFound, Session
from solepath.body.fuse.both_feet import BothFeet
from solepath.body.fuse.common_error import HEADING
from solepath.body.fuse.compass import Compass
from solepath.emulate import Insole, Route, sampled
from solepath.emulate.sensors.parts import AK8963
from solepath.emulate.walk import SampledWalk
from solepath.types import Site
from solepath_lab.emulated.magnetic_field import DisturbedField

FIELD = DisturbedField(radians(20.0), seed=4)
FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)


@cache
def arcs() -> SampledWalk:
    """Return a walk of 250 m over arcs to both sides, with a magnetometer in both insoles."""
    route = Route(speed=1.3).stand(2.0).walk(3.0)
    for angle in (pi, -1.5 * pi, pi, -pi, 1.2 * pi):
        route = route.turn(angle, 14.0)
    insoles = {site: Insole(cells=24, mag=AK8963) for site in FEET}
    return sampled(route.stop(2.0), insoles=insoles, field=FIELD, seed=3)


def track_of(session: Session) -> BothFeet:
    return next(part for part in session._state.parts if isinstance(part, BothFeet))


@pytest.mark.long
def test_a_compass_makes_the_heading_of_arcs_more_certain_and_is_saved_with_the_session() -> None:
    samples = list(arcs().samples)
    plain, with_compass = Session(), Session()
    plain.feed([evolve(sample, mag=None) for sample in samples])
    half = len(samples) // 2
    events = with_compass.feed(samples[:half])
    restored = Session.unpack(with_compass.pack())
    again: Any = Session.restore(with_compass.snapshot())
    rest = with_compass.feed(samples[half:])
    assert restored.feed(samples[half:]) == rest == again.feed(samples[half:])
    assert not [event for event in events + rest if isinstance(event, DefectFound)]
    compass = track_of(with_compass).compass
    assert isinstance(compass, Compass) and compass.trust.is_proven
    sigma, without = (track_of(one).common.covariance[HEADING][HEADING] ** 0.5 for one in (with_compass, plain))
    assert sigma < 0.8 * without


@pytest.mark.long
def test_a_wrong_unit_is_reported_once_for_each_foot_and_as_nothing_else() -> None:
    samples = [
        sample if sample.mag is None else evolve(sample, mag=tuple(1e6 * m for m in sample.mag))
        for sample in arcs().samples
    ]
    found = [event for event in Session().feed(samples) if isinstance(event, DefectFound)]
    assert [event.site for event in found] in (list(FEET), list(reversed(FEET)))
    assert all("give tesla" in event.what for event in found)
