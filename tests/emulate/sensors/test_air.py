"""The air of a building: weather, gusts and doors reach every barometer alike, and change nothing else."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.air import STILL_AIR, Air, PressureStep
from solepath.emulate.sensors.parts import BMP280
from solepath.emulate.sensors.sensors import read_barometer
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import emulate
from solepath.types import SITE_OF_FOOT, Foot

ROUTE = Route().stand(2.0).walk(10.0).stop(2.0)
T = np.arange(0.0, 3600.0, 0.5)


def test_a_falling_pressure_falls_by_its_rate() -> None:
    """Very rapidly: 6 hPa in three hours."""
    assert Air(trend=-600.0 / 10800.0).at(np.array([0.0, 3600.0, 10800.0])) == pytest.approx([0.0, -200.0, -600.0])


def test_a_door_that_opens_and_closes_leaves_the_pressure_as_it_was() -> None:
    air = Air(steps=(PressureStep(10.0, -12.0, lasting=3.0),))
    assert air.at(np.array([9.9, 10.25, 11.0, 12.9, 13.6, 60.0])) == pytest.approx([0.0, -6.0, -12.0, -12.0, 0.0, 0.0])


def test_a_pressurised_stairwell_keeps_its_pressure() -> None:
    air = Air(steps=(PressureStep(5.0, 50.0), PressureStep(20.0, -50.0)))
    assert air.at(np.array([0.0, 5.5, 19.0, 30.0])) == pytest.approx([0.0, 50.0, 50.0, 0.0])


def test_gusts_have_their_size_and_forget_the_past_within_half_a_minute() -> None:
    found = np.array([Air(gusts=6.0, seed=seed).at(T) for seed in range(40)])
    found -= found.mean(axis=1, keepdims=True)
    assert float(np.sqrt(np.mean(found**2))) == pytest.approx(6.0, rel=0.05)
    shares = [float(np.mean(found[:, k:] * found[:, :-k])) / 36.0 for k in (2, 10, 80)]  # 1, 5 and 40 s
    assert shares[0] > 0.75 and shares[1] == pytest.approx(np.exp(-1.0), abs=0.1) and abs(shares[2]) < 0.1


def test_gusts_are_the_same_at_whatever_times_they_are_read() -> None:
    air = Air(gusts=6.0, seed=3)
    assert air.at(T)[::7] == pytest.approx(air.at(T[::7]))


def test_still_air_changes_no_reading_and_wind_adds_to_each() -> None:
    air = Air(trend=0.01, gusts=4.0, seed=2)
    height, t = np.zeros(60), np.arange(60.0)
    plain, still, windy = (
        read_barometer(height, t, BMP280, np.random.default_rng(4), *one) for one in ((), (STILL_AIR,), (air,))
    )
    assert plain.tolist() == still.tolist()
    assert windy - plain == pytest.approx(air.at(t))


@pytest.mark.parametrize("tag", [CC2541(rate=20.0), CC2650(rate=20.0)], ids=["CC2541", "CC2650"])
def test_only_barometers_notice_the_air(tag: CC2541 | CC2650) -> None:
    devices = {SITE_OF_FOOT[foot]: tag for foot in Foot}
    plain, windy = (emulate(ROUTE, devices=devices, air=air, seed=2).packets for air in (STILL_AIR, Air(trend=2.0)))
    changed = {one.channel for one, other in zip(plain, windy, strict=True) if one != other}
    assert len(changed) == 1 and "barometer" in changed.pop()


def test_both_barometers_see_a_door_at_once() -> None:
    """A reading of either foot from before the door and one from after it differ by the step."""
    devices = {SITE_OF_FOOT[foot]: CC2650(rate=20.0) for foot in Foot}
    door = Air(steps=(PressureStep(5.0, 30.0),))
    plain, stepped = (emulate(ROUTE, devices=devices, air=air, seed=2).packets for air in (STILL_AIR, door))
    first = {
        one.site: one.t for one, other in reversed(list(zip(plain, stepped, strict=True))) if one.data != other.data
    }
    assert len(first) == 2 and all(5.0 < t < 6.6 for t in first.values())


@pytest.mark.parametrize(
    "numbers", [(nan, 5.0, 0.5, inf), (2.0, inf, 0.5, inf), (2.0, 5.0, 0.0, inf), (2.0, 5.0, 0.5, 0.4)]
)
def test_a_door_that_takes_no_time_or_never_opens_fully_is_none(numbers: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="pressure step"):
        PressureStep(*numbers)


@pytest.mark.parametrize(("trend", "gusts"), [(nan, 0.0), (0.0, -1.0), (0.0, inf)])
def test_weather_is_finite(trend: float, gusts: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        Air(trend, gusts)
