"""Height of the wearer: lifts, air pressure, weather and doors."""

from __future__ import annotations

from collections.abc import Container
from functools import cache
from math import exp, sin

import pytest
from attrs import evolve
from views import told
from walks import samples

from solepath import ClockReset, Foot, LiftRidden, Sample, Session, Site, StrideTaken, recipes
from solepath.body.altitude import SCALE_HEIGHT, STANDARD_PRESSURE, Altitude
from solepath.body.part import HeightShift, Replacement
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import SampledWalk, sampled
from solepath.recipes import Recipe

RIDE = 6.4
LIFT = Route().stand(2.0).walk(3.0).lift(RIDE, speed=1.2).walk(3.0).stop(1.0)
FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)


@cache
def lift() -> SampledWalk:
    return sampled(LIFT, insoles={site: Insole(cells=24) for site in FEET}, seed=101)


def pressure(height: float) -> float:
    return STANDARD_PRESSURE * exp(-height / SCALE_HEIGHT)


def breathing(walk: SampledWalk, drift: float = 0.0) -> list[Sample]:
    """Return the samples with a good barometer at the foot, read once a second; `drift`: its error, m per second."""
    read: dict[Site, float] = {}
    heights_found = []
    for sample in walk.samples:
        if sample.t - read.get(sample.site, -9.0) >= 1.0:
            read[sample.site] = sample.t
            z = float(walk.truth.pose(foot_of(sample), sample.t).position.flat[2])
            sample = evolve(sample, air_pressure=pressure(z + drift * sample.t + 0.1 * sin(77.0 * sample.t)))
        heights_found.append(sample)
    return heights_found


def foot_of(sample: Sample) -> Foot:
    return Foot.LEFT if sample.site is Site.LEFT_FOOT else Foot.RIGHT


def heights(items: list[Sample], recipe: Recipe = recipes.DEFAULT) -> tuple[list[float], list[LiftRidden]]:
    """Return the height of the wearer with every sample, m, and the rides that were reported."""
    session = Session(recipe)
    heights_found, rides = [], []
    for sample in items:
        rides += [event for event in session.feed(sample) if isinstance(event, LiftRidden)]
        heights_found.append(height(session))
    rides += [event for event in session.finish() if isinstance(event, LiftRidden)]
    return [*heights_found, height(session)], rides


def height(session: Session) -> float:
    return 0.0 if session.position is None else session.position.position[2]


def test_after_a_lift_the_wearer_is_as_much_higher_as_it_rode() -> None:
    assert height(ridden()) == pytest.approx(RIDE, abs=0.1 * RIDE)


def test_with_a_barometer_the_height_after_a_lift_is_within_30_cm() -> None:
    heights_found, (ride,) = heights(breathing(lift(), drift=0.01))
    assert ride.height == pytest.approx(RIDE, abs=0.3)
    assert heights_found[-1] == pytest.approx(RIDE, abs=0.3)


IN_THE_LIFT = (9.0, 11.7, 15.0, 16.5)
"""Times after the lift of `LIFT` has started, and one just after it has stopped, s."""


def ride_with_new_clock(
    t: float, *resets: Site, read: Container[Site] = FEET, off: float = 0.0
) -> tuple[float, LiftRidden]:
    """Return the height at the end, m, and the ride, when the clocks of some feet restart at `t`, s.

    Only the feet in `read` have a barometer; `off`: error of those of the feet that restart, from then on, m."""
    session, rides, waiting = Session(), list[LiftRidden](), list(resets)
    for sample in breathing(lift()):
        if sample.t >= t and sample.site in resets and sample.air_pressure is not None:
            sample = evolve(sample, air_pressure=sample.air_pressure * exp(-off / SCALE_HEIGHT))
        while waiting and sample.t >= t:
            site = waiting.pop(0)
            session._state.report(site, ClockReset(t=sample.t, known_at=sample.t, site=site, restarted=True))
        fed_sample = sample if sample.site in read else evolve(sample, air_pressure=None)
        rides += [event for event in session.feed(fed_sample) if isinstance(event, LiftRidden)]
    rides += [event for event in session.finish() if isinstance(event, LiftRidden)]
    (ride,) = rides
    return height(session), ride


@pytest.mark.parametrize("site", FEET[:1])
@pytest.mark.parametrize("t", IN_THE_LIFT[1:3])
def test_a_clock_of_one_foot_that_restarts_in_a_lift_leaves_the_height_of_the_ride(t: float, site: Site) -> None:
    above, ride = ride_with_new_clock(t, site)
    assert ride.height == pytest.approx(RIDE, abs=0.15) and above == pytest.approx(RIDE, abs=0.15)


@cache
def ridden() -> Session:
    """Return a session that was fed the ride without air pressure."""
    session = Session()
    session.feed(list(lift().samples))
    session.finish()
    return session


def test_a_lift_leaves_the_tracks_of_the_feet_as_they_are() -> None:
    session = ridden()
    assert all([abs(foot.position[2]) < 0.3 for foot in session.feet.values()])
    assert session.position is not None and session.position.covariance[5] > 0.01


def ride(height: float | None, lasted: float, up: bool = True) -> LiftRidden:
    return LiftRidden(t=100.0 + lasted, known_at=110.0 + lasted, t_start=100.0, up=up, height=height)


@pytest.mark.parametrize(
    ("height", "lasted", "strides"),
    [(0.6, 3.0, 0), (40.0, 5.0, 0), (3.0, 40.0, 0), (6.0, 8.0, 4), (-6.0, 8.0, 0), (None, 8.0, 0)],
)
def test_without_air_an_implausible_ride_has_no_height(height: float | None, lasted: float, strides: int) -> None:
    altitude = Altitude()
    step = next(event for event in Session().feed(samples(cells=0)) if isinstance(event, StrideTaken))
    for k in range(strides):
        told(altitude, evolve(step, t_start=101.0 + k, t_end=102.0 + k, t=102.0 + k))
    reported = ride(height, lasted)
    assert told(altitude, reported) == [Replacement(reported, evolve(reported, height=None)), HeightShift(0.0, 0.0)]


def test_a_plausible_lift_ride_is_trusted_without_air_pressure() -> None:
    altitude = Altitude()
    instead, height = told(altitude, ride(6.0, 8.0))
    assert instead == Replacement(ride(6.0, 8.0), ride(6.0, 8.0))
    assert isinstance(height, HeightShift) and height.above == 6.0
