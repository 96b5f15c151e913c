"""Whole emulated walks of 20 m with known velocity, and with zero velocity alone."""

from __future__ import annotations

from functools import cache

import pytest
from walks import run_session

from solepath import recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, FootFlat, HeelOff, HeelStrike, ToeOff
from solepath.types import Foot, Quat, Sample
from solepath.types.vector import normalise

ROUTE = Route().stand(2.0).walk(20.0, 1.3).stop(1.5)
SEEDS = (221, 222, 223)
LAYOUTS = Calibration(insoles={foot: InsoleCalibration(layout=layout(96, foot)) for foot in Foot})
CROOKED: Quat = normalise((0.6, -0.3, 0.5, 0.55))


@cache
def walker_of(seed: int) -> Walker:
    return Walker(ROUTE, seed=seed)


@cache
def samples(seed: int, foot: Foot, rate: float) -> tuple[Sample, ...]:
    """Return the samples of a foot from a sensor with the errors of a real chip."""
    return tuple(walker_of(seed).samples(foot, rate, LSM6DSOX, layout=layout(96, foot)))


def run(recipe: str, walk: tuple[Sample, ...]) -> list[Event]:
    return run_session(walk, recipes.by_name(recipe), calibration=LAYOUTS)


@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_events_of_the_foot_are_found_when_they_happen(rate: float) -> None:
    """Within two samples and the delay of the load; heel-strike and foot-flat are reported together."""
    near = 2.0 / rate + 0.04
    for foot in Foot:
        events, truth = run("kupt", samples(222, foot, rate)), walker_of(222).truth().feet[foot]
        for kind, true in (
            (HeelStrike, truth.heel_strikes),
            (ToeOff, truth.toe_offs),
            (FootFlat, truth.foot_flats),
            (HeelOff, truth.heel_offs),
        ):
            found = [event.t for event in events if isinstance(event, kind)]
            # a foot that has not swung yet does not know what it weighs, and the last step closes up at leisure
            assert [min(abs(t - s) for t in found) < near for s in true[1:-1]] == [True] * (len(true) - 2)
        strikes = [event for event in events if isinstance(event, HeelStrike)][1:]
        flats = {event.known_at for event in events if isinstance(event, FootFlat)}
        assert all(strike.known_at in flats for strike in strikes)
