"""What surrounds a wearer, air, iron and the other foot: each reaches its own sensors, as large as it is set."""

from math import hypot, inf, nan, radians

import numpy as np
import pytest
from attrs import evolve

from solepath import Foot, Site
from solepath.emulate import CC2541, CC2650, Insole, Route, emulate, sampled
from solepath.emulate.sensors.air import STILL_AIR, Air, PressureStep
from solepath.emulate.sensors.magnetic_field import EARTH
from solepath.emulate.sensors.parts import AK8963
from solepath.types import SITE_OF_FOOT
from solepath_lab.emulated.magnetic_field import DisturbedField

ROUTE = Route().stand(2.0).walk(8.0, 1.3).stop(2.0)


def test_weather_falls_by_its_rate_a_door_opens_and_closes_and_a_stairwell_keeps_its_pressure() -> None:
    assert Air(trend=-600.0 / 10800.0).at(np.array([0.0, 3600.0, 10800.0])) == pytest.approx([0.0, -200.0, -600.0])
    door = Air(steps=(PressureStep(10.0, -12.0, lasting=3.0),))
    assert door.at(np.array([9.9, 10.25, 11.0, 12.9, 13.6, 60.0])) == pytest.approx([0.0, -6.0, -12.0, -12.0, 0.0, 0.0])
    stairwell = Air(steps=(PressureStep(5.0, 50.0), PressureStep(20.0, -50.0)))
    assert stairwell.at(np.array([0.0, 5.5, 19.0, 30.0])) == pytest.approx([0.0, 50.0, 50.0, 0.0])


def test_gusts_have_their_size_forget_the_past_and_do_not_depend_on_when_they_are_read() -> None:
    t = np.arange(0.0, 3600.0, 0.5)
    found = np.array([Air(gusts=6.0, seed=seed).at(t) for seed in range(40)])
    found -= found.mean(axis=1, keepdims=True)
    assert float(np.sqrt(np.mean(found**2))) == pytest.approx(6.0, rel=0.05)
    shares = [float(np.mean(found[:, k:] * found[:, :-k])) / 36.0 for k in (10, 80)]  # 5 and 40 s
    assert shares == pytest.approx([np.exp(-1.0), 0.0], abs=0.1)
    air = Air(gusts=6.0, seed=3)
    assert air.at(t)[::7] == pytest.approx(air.at(t[::7]))


@pytest.mark.parametrize("tag", [CC2541(rate=20.0), CC2650(rate=20.0)], ids=["CC2541", "CC2650"])
def test_only_barometers_notice_the_air_and_both_feet_a_door_at_once(tag: CC2541 | CC2650) -> None:
    devices, door = {SITE_OF_FOOT[foot]: tag for foot in Foot}, Air(steps=(PressureStep(5.0, 30.0),))
    plain, stepped = (emulate(ROUTE, devices=devices, air=air, seed=2).packets for air in (STILL_AIR, door))
    changed = [one for one, other in zip(plain, stepped, strict=True) if one != other]
    assert len({one.channel for one in changed}) == 1 and "barometer" in changed[0].channel
    first = {one.site: one.t for one in reversed(changed)}
    assert len(first) == 2 and all(5.0 < t < 6.6 for t in first.values())


@pytest.mark.parametrize("numbers", [(nan, 5.0, 0.5, inf), (2.0, 5.0, 0.0, inf), (2.0, 5.0, 0.5, 0.4)])
def test_a_door_that_takes_no_time_or_never_opens_fully_and_endless_weather_are_rejected(
    numbers: tuple[float, ...],
) -> None:
    with pytest.raises(ValueError, match="pressure step"):
        PressureStep(*numbers)
    with pytest.raises(ValueError, match="finite"):
        Air(0.0, inf)


def test_a_field_turns_a_compass_by_its_root_mean_square_and_in_few_places_by_far_more() -> None:
    places = np.random.default_rng(1).uniform(-200.0, 200.0, (8000, 2))
    hx, hy, _ = DisturbedField(radians(20.0), seed=3).at(places).T
    turned = np.arctan2(EARTH[0] * hy - EARTH[1] * hx, EARTH[0] * hx + EARTH[1] * hy)
    rms = np.sqrt(np.mean(turned**2))
    assert rms == pytest.approx(radians(20.0), rel=0.15)
    assert np.median(np.abs(turned)) < 0.6 * rms and np.quantile(np.abs(turned), 0.99) > 2.5 * rms
    field = DisturbedField(radians(20.0), seed=3, variation=0.0)
    here = field.at(places)[:, 1] - EARTH[1]

    def correlation(distance: float) -> float:
        return float(np.mean(here * (field.at(places + [distance, 0.0])[:, 1] - EARTH[1])) / np.mean(here * here))

    assert correlation(0.3) > 0.95 and 0.3 < correlation(4.0) < 0.7 and abs(correlation(60.0)) < 0.2


def test_a_standing_foot_measures_the_field_of_the_earth_and_a_magnetometer_changes_nothing_else() -> None:
    exact = evolve(AK8963, density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0)
    insole = Insole(cells=24, mag=exact)
    samples = sampled(ROUTE, insoles={Site.LEFT_FOOT: insole}, seed=2).samples
    assert hypot(*(samples[0].mag or ())) == pytest.approx(hypot(*EARTH), rel=1e-3)
    disturbed = sampled(ROUTE, insoles={Site.LEFT_FOOT: insole}, field=DisturbedField(radians(20.0)), seed=2).samples
    plain = sampled(ROUTE, insoles={Site.LEFT_FOOT: evolve(insole, mag=None)}, seed=2).samples
    assert [one.mag for one in disturbed] != [one.mag for one in samples]
    assert tuple(evolve(one, mag=None) for one in disturbed) == plain
