"""Whole emulated walks of 20 m with known velocity, and with zero velocity alone."""

from __future__ import annotations

import json
from functools import cache
from math import hypot

import numpy as np
import pytest
from attrs import evolve
from walks import run_session

from solepath import recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, FootFlat, HeelOff, HeelStrike, StrideTaken, ToeOff
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Quat, Sample
from solepath.types.vector import normalise, rotate

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


def strides_in(events: list[Event]) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken)]


@cache
def stride_errors(recipe: str, rate: float) -> tuple[list[float], list[float]]:
    """Return the errors, m, of all stride lengths but the first two, and of the distance of each walk and foot."""
    errors, distances = [], []
    for seed in SEEDS:
        for foot in Foot:
            found, true = strides_in(run(recipe, samples(seed, foot, rate))), walker_of(seed).truth().strides(foot)
            assert len(found) == len(true)
            errors += [a.length - b.length for a, b in zip(found[2:], true[2:], strict=True)]
            distances.append(sum(a.length for a in found) - sum(b.length for b in true))
    return errors, distances


@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_strides_with_known_velocity_are_nearer_to_the_truth_than_with_zero_velocity_alone(rate: float) -> None:
    known, zero = (np.array(stride_errors(recipe, rate)[0]) for recipe in ("kupt", "zupt"))
    assert np.sqrt(np.mean(known**2)) < np.sqrt(np.mean(zero**2))
    assert known.std() < 0.85 * zero.std()
    assert abs(known.mean()) < 0.015


@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_a_walk_of_20_m_is_20_m_long(rate: float) -> None:
    _, distances = stride_errors("kupt", rate)
    assert np.abs(distances).max() < 0.6
    assert abs(np.mean(distances)) < 0.25


@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_all_but_the_first_steps_have_an_error_index(rate: float) -> None:
    for foot in Foot:
        found = strides_in(run("kupt", samples(221, foot, rate)))
        assert all(step.features.error_index is not None for step in found[2:])
        assert found[0].features.error_index is None
        assert all(step.features.error_index is None for step in strides_in(run("zupt", samples(221, foot, rate))))


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


def test_how_the_sensor_is_mounted_makes_no_difference() -> None:
    foot, rate = Foot.RIGHT, 100.0
    plain = samples(223, foot, rate)
    turned = tuple(
        [evolve(s, acc=rotate(CROOKED, s.acc), gyro=rotate(CROOKED, s.gyro)) for s in plain if s.acc and s.gyro]
    )
    lengths = [[step.length for step in strides_in(run("kupt", walk))] for walk in (plain, turned)]
    indices = [[step.features.error_index for step in strides_in(run("kupt", walk))][2:] for walk in (plain, turned)]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-6)
    assert indices[0] == pytest.approx(indices[1], abs=1e-6)


def test_both_feet_walk_the_same_way_at_once() -> None:
    both = sorted((s for foot in Foot for s in samples(221, foot, 30.0)), key=lambda s: s.t)
    session = Session(recipes.by_name("kupt"), calibration=LAYOUTS)
    session.feed(both)
    ends = [hypot(*session.feet[foot].position[:2]) for foot in Foot]
    assert ends == pytest.approx([20.0, 20.0], abs=0.6)


@pytest.mark.parametrize("t", [2.3, 4.03, 4.27, 4.42, 4.61, 4.74])
def test_a_session_saved_in_mid_step_goes_on_to_the_same_bits(t: float) -> None:
    """In push-off, swing, landing and stance, wherever these moments fall."""
    walk = samples(222, Foot.LEFT, 100.0)
    cut = next(k for k, sample in enumerate(walk) if sample.t > t)
    session = Session(recipes.by_name("kupt"), calibration=LAYOUTS, poses=True)
    session.feed(walk[:cut])
    saved = json.loads(json.dumps(session.snapshot(), allow_nan=False))
    assert Session.restore(saved).feed(walk[cut:]) == session.feed(walk[cut:])


def test_pressure_that_comes_at_half_the_rate_makes_the_same_steps() -> None:
    walk = samples(221, Foot.LEFT, 100.0)
    thinned = tuple([s if k % 2 == 0 else evolve(s, pressure=None) for k, s in enumerate(walk)])
    whole, half = strides_in(run("kupt", walk)), strides_in(run("kupt", thinned))
    assert len(whole) == len(half)
    assert [s.length for s in whole] == pytest.approx([s.length for s in half], abs=0.08)


def test_after_a_long_stand_on_both_feet_the_next_steps_are_found() -> None:
    """For half a minute half of the weight is the least load that there was."""
    route = Route().stand(2.0).walk(6.0, 1.3).stop(30.0).walk(6.0, 1.3).stop(1.5)
    two = Walker(route, seed=224)
    for foot in Foot:
        walk = two.samples(foot, 50.0, LSM6DSOX, layout=layout(96, foot))
        found, true = strides_in(run("kupt", tuple(walk))), two.truth().strides(foot)
        assert len(found) == len(true)
        assert sum(step.length for step in found) == pytest.approx(sum(s.length for s in true), abs=0.5)


def test_a_foot_without_pressure_has_no_use_for_this_recipe() -> None:
    bare = [evolve(sample, pressure=None) for sample in samples(221, Foot.LEFT, 30.0)]
    assert all(sample.site is SITE_OF_FOOT[Foot.LEFT] for sample in bare)
    assert not strides_in(run("kupt", tuple(bare)))


def test_when_the_clock_restarts_the_next_steps_are_found() -> None:
    """As when a device restarts: the same walk again, at earlier times."""
    walk = samples(221, Foot.LEFT, 100.0)
    late = [evolve(sample, t=sample.t + 1000.0) for sample in walk]
    session = Session(recipes.by_name("kupt"), calibration=LAYOUTS)
    first = strides_in(session.feed(late))
    session.feet[Foot.LEFT].reset()
    again = strides_in(session.feed(walk))
    # where the first step began is a matter of the old clock
    assert [step.length for step in again] == pytest.approx([step.length for step in first[1:]], abs=0.05)
    # the direction of the toes is still known
    assert all(step.features.error_index is not None for step in again)


def test_a_session_can_be_saved_at_any_sample_of_its_first_steps() -> None:
    """Before the load is known, and as it becomes known in the first landing."""
    session = Session(recipes.by_name("kupt"), calibration=LAYOUTS)
    for sample in samples(222, Foot.LEFT, 30.0)[:120]:
        session.feed(sample)
        json.dumps(session.snapshot(), allow_nan=False)


def test_insoles_without_a_layout_make_no_step_longer_than_the_wearers() -> None:
    """Without areas, before the order of loading has shown where the cells are, the foot still stands."""
    walk = samples(223, Foot.RIGHT, 100.0)
    found, true = strides_in(run_session(walk, recipes.by_name("kupt"))), walker_of(223).truth().strides(Foot.RIGHT)
    assert len(found) == len(true)
    assert sum(step.length for step in found) == pytest.approx(sum(step.length for step in true), abs=0.6)
    assert max(step.length for step in found) < 1.2 * max(step.length for step in true)
