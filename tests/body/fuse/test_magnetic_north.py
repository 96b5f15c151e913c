"""Magnetic north, as the magnetometers in both feet show it after some turns."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, radians, sin

import pytest
from attrs import evolve
from soak import longer

from solepath import Session
from solepath.emulate import Insole, sampled
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.magnetic_field import EARTH
from solepath.emulate.sensors.parts import AK8963
from solepath.events import StrideTaken
from solepath.types import SITE_OF_FOOT, Foot, Sample
from solepath_lab.emulated.magnetic_field import DisturbedField

TRUE = atan2(EARTH[1], EARTH[0])
"""Direction of the emulated field of the earth from the wearer's first heading, rad."""
Norths = list[tuple[float, float] | None]


@cache
def walked(seed: int) -> tuple[Sample, ...]:
    insoles = {SITE_OF_FOOT[foot]: Insole(cells=8, mag=AK8963) for foot in Foot}
    field = DisturbedField(radians(20.0), seed)
    return sampled(wandering(seed).route, insoles=insoles, field=field, seed=seed).samples


def norths(samples: tuple[Sample, ...]) -> Norths:
    """Return the direction of north and its standard deviation after each stride."""
    session, found = Session(), list[tuple[float, float] | None]()
    for sample in samples:
        if any(isinstance(event, StrideTaken) for event in session.feed(sample)) and session.position is not None:
            found.append(session.position.north)
    return found


def off(north: tuple[float, float]) -> float:
    return abs(atan2(sin(north[0] - TRUE), cos(north[0] - TRUE)))


@pytest.mark.parametrize("seed", [12, *longer(11, 13)])
@pytest.mark.long
def test_north_is_known_after_some_turns_within_three_standard_deviations(seed: int) -> None:
    found = norths(walked(seed))
    known = [north for north in found if north is not None]
    assert found[:20] == [None] * 20 and len(known) > 0.3 * len(found)
    assert all(off(north) < 3.0 * north[1] for north in known)
    assert known[-1][1] < radians(8.0) and off(known[-1]) < radians(12.0)


@pytest.mark.long
def test_a_magnetometer_with_a_mirrored_axis_shows_no_north() -> None:
    mirrored = tuple(
        sample if sample.mag is None else evolve(sample, mag=(sample.mag[0], -sample.mag[1], sample.mag[2]))
        for sample in walked(12)
    )
    assert set(norths(mirrored)) == {None}


@pytest.mark.soak
def test_without_a_magnetometer_there_is_no_north() -> None:
    assert set(norths(tuple(evolve(sample, mag=None) for sample in walked(12)[:6000]))) == {None}
