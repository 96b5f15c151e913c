"""Stairs that are climbed slowly, from tread to tread with a rest on each, are stairs with a flight and no lift."""

from __future__ import annotations

from itertools import pairwise

import pytest
from soak import soaked
from walks import of

from solepath import Activity, ActivityChanged, FlightClimbed, Foot, LiftRidden, Session
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath_lab.emulated.other_motions import in_order

CASES = [(speed, up, seed) for speed in (0.2, 0.22, 0.25) for up in (True, False) for seed in (1, 2, 5)]
QUICK = [(0.2, True, 1), (0.22, False, 5)]
RISERS = 11
LIFTS = (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)


@pytest.mark.parametrize("case", [*QUICK, *soaked(*[case for case in CASES if case not in QUICK])])
def test_slow_stairs_are_a_flight_and_neither_they_nor_the_standing_after_them_are_a_lift(
    case: tuple[float, bool, int],
) -> None:
    speed, up, seed = case
    route = Route().stand(3.0).walk(5.0, 1.0).stairs(RISERS, up=up, speed=speed).walk(5.0).stop(20.0)
    walker, session = Walker(route, None, seed), Session()
    samples = in_order([walker.samples(foot, 100.0, LSM6DSOX) for foot in Foot])
    events = session.feed(samples) + session.finish()
    final = [event for event in of(ActivityChanged, events) if event.final]
    assert of(LiftRidden, events) == [] and not any(event.activity in LIFTS for event in final)
    assert final[-1].activity is Activity.STANDING
    assert all(before.t < after.t for before, after in pairwise(final))
    flights = of(FlightClimbed, events)
    # on the slowest way down, a foot that is set down twice may part the flight
    assert flights and all(flight.up is up for flight in flights)
    assert len(flights) == 1 or (speed, up) == (0.2, False)
