"""A walk there and back shows how the heading of each foot drifts, and every recipe takes it off."""

from functools import cache
from math import pi

import numpy as np
import pytest
from soak import soaked

from solepath import recipes
from solepath.calibration import Calibration, CalibrationError, HeadingCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import sampled
from solepath.events import StrideTaken
from solepath.session import Session
from solepath.session.heading_walk import HeadingFit, heading_calibration, heading_walk
from solepath.types import Foot, Sample, Site
from solepath.types.attrs import evolve
from solepath_lab.emulated.heading_walks import calibration_samples, insoles_of, wearer_of

SEED = 101
"""A wearer whose heading drifts by some degrees a minute."""


@cache
def calibration_walk() -> tuple[Sample, ...]:
    return tuple(calibration_samples(SEED))


@cache
def fits_of_walk() -> list[HeadingFit]:
    return heading_walk(calibration_walk())


def learnt() -> Calibration:
    return heading_calibration(fits_of_walk())


@cache
def walk_of(route: Route, seed: int = SEED) -> tuple[Sample, ...]:
    return sampled(route, wearer=wearer_of(seed), insoles=insoles_of(seed), seed=seed).samples


def there_and_back(stand: float, legs: int, length: float, end: float = 3.0) -> Route:
    route = Route().stand(stand)
    for leg in range(legs):
        route = route.turn(pi if leg % 2 else -pi, 0.6).walk(length, 1.3) if leg else route.walk(length, 1.3)
    return route.stop(end)


@pytest.mark.long
def test_the_walk_explains_most_of_what_its_legs_are_apart() -> None:
    fits = fits_of_walk()
    assert [fit.foot for fit in fits] == list(Foot)
    for fit in fits:
        assert fit.legs == 10 and 90.0 < fit.duration < 180.0
        assert fit.after < 0.2 * fit.before and fit.after < np.radians(0.8)
        assert 2e-4 < fit.heading.drift_sigma < 1e-3 and fit.heading.turning_sigma < 0.004


@pytest.mark.parametrize("name", ["default", *soaked("kupt-dfpc", "footstep-tracker-printed")])
def test_recipes_that_follow_the_heading_in_different_ways_all_take_the_drift_off(name: str) -> None:
    """By as much in every stride as the calibration says, here a whole degree."""
    heading = HeadingCalibration(np.radians(1.0), 0.0, 1e-3, 1e-3)
    calibration = Calibration(headings=dict.fromkeys(Foot, heading))
    samples = walk_of(Route().stand(3.0).walk(16.0, 1.2).stop(2.0))
    turned = []
    least = 0.3 if name == "footstep-tracker-printed" else 1.0  # from liftoff to landing is half of a stride or less
    for one in (Calibration(), calibration):
        session = Session(recipes.by_name(name), calibration=one)
        strides = [e for sample in samples for e in session.feed(sample) if isinstance(e, StrideTaken)]
        turned.append([stride.heading_change for stride in strides if stride.length > least])
    assert len(turned[0]) == len(turned[1]) > 8
    more = np.degrees(np.array(turned[1]) - np.array(turned[0]))
    assert np.median(more) == pytest.approx(1.0, abs=0.15)


@pytest.mark.long
def test_turns_to_one_side_only_do_not_separate_turns_from_strides() -> None:
    route = Route().stand(5.0)
    for leg in range(8):
        route = route.turn(pi, 0.6).walk(7.5, 1.3) if leg else route.walk(7.5, 1.3)
    with pytest.raises(CalibrationError, match="left foot: .* one side only.*right foot: .* one side only"):
        heading_walk(walk_of(route.stop(3.0)))


@pytest.mark.parametrize(
    ("route", "reason"),
    [
        (Route().stand(3.0).walk(40.0).stop(2.0), "1 straight legs"),
        (Route().stand(3.0).walk(8.0).turn(0.5 * pi, 1.0).walk(8.0).turn(0.5 * pi, 1.0).walk(8.0)
         .turn(0.5 * pi, 1.0).walk(8.0).turn(0.5 * pi, 1.0).walk(8.0).stop(2.0), "there and back"),
        (Route().stand(10.0), "no strides"),
    ],
)  # fmt: skip
def test_another_walk_is_no_calibration_for_a_stated_reason(route: Route, reason: str) -> None:
    with pytest.raises(CalibrationError, match=reason):
        heading_walk(walk_of(route))


@pytest.mark.long
def test_a_rest_after_the_walk_takes_off_what_a_wandering_bias_has_turned() -> None:
    """The bias of the left foot grows by 0.03 degrees/s from the first rest to the last one."""
    samples = [one for one in walk_of(there_and_back(15.0, 6, 10.0, 15.0)) if one.site is Site.LEFT_FOOT]
    start, end = 15.0, samples[-1].t - 15.0
    growth = np.radians(0.03)

    def grown(one: Sample) -> Sample:
        if one.gyro is None:
            return one
        x, y, z = one.gyro
        return evolve(one, gyro=(x, y, z + growth * min(1.0, max(0.0, (one.t - start) / (end - start)))))

    wandered = [grown(one) for one in samples]
    steady, moved = (heading_walk(one)[0].heading for one in (samples, wandered))
    assert abs(moved.drift - steady.drift) < 0.3 * 0.5 * growth * 1.1
