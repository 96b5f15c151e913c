"""Every recipe after a paper on one emulated walk of 20 m with a known truth."""

from __future__ import annotations

from functools import cache
from math import hypot

import pytest
from walks import both_feet, of, often, run_session

from solepath import Foot, StrideTaken, recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, FootFlat, HeelOff, HeelStrike, ToeOff

LAYOUTS = Calibration(insoles={foot: InsoleCalibration(layout=layout(24, foot)) for foot in Foot})
BOUNDS = {
    "kupt-dfpc": (0.01, 0.015), "kupt-dfpc-printed": (0.02, 0.03), "kupt": (0.01, 0.015), "zupt": (0.02, 0.03),
    "pressure-contour": (0.02, 0.03), "gyroscope": (0.02, 0.03), "walking-modes": (0.02, 0.03),
    "footstep-tracker": (0.03, 0.045), "shoe-sensing": (0.02, 0.03), "shoe-sensing-printed": (0.025, 0.035),
}  # fmt: skip
"""Share of the way, and root mean square of the strides, m, by which a recipe may be off. Of the others,
pressure-contour-printed and footstep-tracker-printed lose strides or way as printed."""
NEAR = {"kupt": 0.04, "pressure-contour": 0.1, "footstep-tracker": 0.06, "shoe-sensing": 0.09}
"""Largest distance of an event from the truth, s."""


@cache
def walker() -> Walker:
    return Walker(Route().stand(2.0).walk(20.0, 1.3).stop(2.0), seed=222)


@cache
def events_of(recipe: str) -> list[Event]:
    samples = both_feet(walker(), 100.0, LSM6DSOX, 24)
    return run_session(samples, recipes.by_name(recipe), calibration=LAYOUTS)


@pytest.mark.parametrize("recipe", often(BOUNDS))
def test_a_walk_of_20_m_has_its_strides_and_its_length(recipe: str) -> None:
    way, spread = BOUNDS[recipe]
    for foot in Foot:
        found = [one for one in of(StrideTaken, events_of(recipe)) if one.foot is foot]
        true = walker().truth().strides(foot)
        assert len(found) == len(true)
        errors = [a.length - b.length for a, b in zip(found, true, strict=True)][1:]
        assert sum(a.length for a in found) == pytest.approx(sum(b.length for b in true), rel=way)
        assert hypot(*errors) < spread * len(errors) ** 0.5


@pytest.mark.soak
def test_strides_with_known_velocity_are_nearer_to_the_truth_than_with_zero_velocity_alone() -> None:
    errors = {}
    for name in ("kupt", "zupt"):
        found, true = of(StrideTaken, events_of(name)), walker().truth()
        ends = {(foot, k): one for foot in Foot for k, one in enumerate(true.strides(foot), 1)}
        errors[name] = hypot(*[one.length - ends[one.foot, one.number].length for one in found if one.number > 2])
    assert errors["kupt"] < 0.9 * errors["zupt"]


@pytest.mark.parametrize("recipe", NEAR)
def test_events_of_the_foot_are_found_when_they_happen(recipe: str) -> None:
    for foot in Foot:
        truth = walker().truth().feet[foot]
        for kind, true in (
            (HeelStrike, truth.heel_strikes),
            (ToeOff, truth.toe_offs),
            (FootFlat, truth.foot_flats),
            (HeelOff, truth.heel_offs),
        ):
            found = [event.t for event in of(kind, events_of(recipe)) if event.foot is foot]
            # a foot that has not swung yet does not know what it weighs, and the last step closes up at leisure
            off = [min(abs(t - s) for t in found) for s in true[1:-1]]
            assert max(off) < NEAR[recipe]
