"""The emulated magnetic field of a building, and what a magnetometer on a shoe measures of it."""

from __future__ import annotations

from math import hypot, radians

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate import CC2650, Insole, Route, emulate, sampled
from solepath.emulate.sensors.magnetic_field import EARTH, UNDISTURBED, MagneticField
from solepath.emulate.sensors.parts import AK8963
from solepath.emulate.wearers.curves import Array
from solepath.types import Foot, Site

ROUTE = Route().stand(2.0).walk(6.0, 1.3).stop(2.0)


def turns(field: MagneticField, places: Array) -> Array:
    """Return by how much the field at each place is turned about the vertical, rad."""
    x, y, _ = EARTH
    hx, hy, _ = field.at(places).T
    return np.asarray(np.arctan2(x * hy - y * hx, x * hx + y * hy))


@pytest.mark.parametrize("degrees", [12.0, 30.0])
def test_the_disturbance_turns_a_compass_by_its_root_mean_square_and_in_few_places_by_far_more(degrees: float) -> None:
    rng = np.random.default_rng(1)
    turned = turns(MagneticField(radians(degrees), seed=3), rng.uniform(-200.0, 200.0, (8000, 2)))
    rms = np.sqrt(np.mean(turned**2))
    assert rms == pytest.approx(radians(degrees), rel=0.15)
    assert np.median(np.abs(turned)) < 0.6 * rms and np.quantile(np.abs(turned), 0.99) > 2.5 * rms


def test_the_disturbance_is_alike_within_a_stride_and_another_one_in_the_next_hall() -> None:
    field, rng = MagneticField(radians(20.0), seed=3, variation=0.0), np.random.default_rng(2)
    places = rng.uniform(-200.0, 200.0, (4000, 2))

    def correlation(distance: float) -> float:
        here, there = (field.at(one)[:, 1] - EARTH[1] for one in (places, places + [distance, 0.0]))
        return float(np.mean(here * there) / np.mean(here * here))

    assert correlation(0.3) > 0.95
    assert 0.3 < correlation(4.0) < 0.7, "the small part is gone, the large one is left"
    assert abs(correlation(60.0)) < 0.2


def test_without_its_variation_the_disturbance_is_a_gradient() -> None:
    field, step = MagneticField(radians(20.0), seed=5, variation=0.0), 1e-3
    places = np.random.default_rng(3).uniform(-50.0, 50.0, (200, 2))
    along_x, along_y = (field.at(places + step * np.eye(2)[k]) - field.at(places) for k in range(2))
    curl = along_x[:, 1] - along_y[:, 0]
    assert np.max(np.abs(curl)) < 0.02 * np.max(np.abs(along_x[:, 1]))


def test_a_magnetometer_in_an_insole_changes_nothing_else() -> None:
    insoles = {site: Insole(cells=24, mag=AK8963) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    plain = {site: Insole(cells=24) for site in insoles}
    with_mag = sampled(ROUTE, insoles=insoles, field=MagneticField(radians(20.0)), seed=2).samples
    assert all(one.mag is not None for one in with_mag)
    assert tuple(evolve(one, mag=None) for one in with_mag) == sampled(ROUTE, insoles=plain, seed=2).samples


def test_a_standing_foot_measures_the_field_of_the_earth_and_the_iron_of_its_shoe() -> None:
    exact = evolve(AK8963, density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0)
    iron = evolve(exact, bias=10e-6)
    strengths = []
    for chip in (exact, iron):
        insoles = {Site.LEFT_FOOT: Insole(cells=24, mag=chip)}
        first = sampled(ROUTE, insoles=insoles, seed=2).samples[0]
        assert first.mag is not None
        strengths.append(hypot(*first.mag))
    assert strengths[0] == pytest.approx(hypot(*EARTH), rel=1e-3)
    assert abs(strengths[1] - strengths[0]) > 1e-6


def test_a_sensortag_walks_through_the_same_field() -> None:
    devices = {Site.LEFT_FOOT: CC2650(rate=100.0)}
    undisturbed, disturbed = (
        [packet.data for packet in emulate(ROUTE, devices=devices, field=field, seed=2).packets
         if packet.channel == "cc2650/movement"]
        for field in (UNDISTURBED, MagneticField(radians(30.0)))
    )  # fmt: skip
    assert len(undisturbed) == len(disturbed)
    assert {data[:12] for data in undisturbed} == {data[:12] for data in disturbed}, "rates and forces are the same"
    assert undisturbed != disturbed
    assert Foot.LEFT in emulate(ROUTE, devices=devices, seed=2).truth.feet
