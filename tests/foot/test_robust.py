"""Samples that no sensor ought to send, and insoles that are not what they were: a session goes on."""

from __future__ import annotations

from math import inf, isfinite, nan

import pytest
from attrs import evolve
from walks import samples

from solepath import Event, Foot, FootFlat, Layout, Sample, Session, Site, StrideTaken, recipes
from solepath.emulate.sensors.insoles import layout
from solepath.foot.pressure.guess import LayoutGuess
from solepath.foot.pressure.insole import InsoleLoads

QUATS = [
    (0.0, 0.0, 0.0, 0.0),
    (1e-200, 0.0, 0.0, 0.0),
    (nan, 0.0, 0.0, 0.0),
    (inf, 0.0, 0.0, 0.0),
    (1e300, 1.0, 0.0, 0.0),
]


def steps(events: list[Event], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]


@pytest.mark.parametrize("quat", QUATS, ids=str)
@pytest.mark.parametrize("recipe", ["default", "gyroscope", "walking-modes"])
def test_an_attitude_that_is_none_is_taken_for_none(recipe: str, quat: tuple[float, float, float, float]) -> None:
    told = [evolve(sample, quat=quat) for sample in samples()]
    session, plain = Session(recipes.by_name(recipe)), Session(recipes.by_name(recipe))
    assert session.feed(told) == plain.feed(samples())
    session.snapshot()


def test_an_attitude_of_any_length_is_the_same_attitude() -> None:
    ones = [evolve(sample, quat=(1.0, 0.0, 0.0, 0.0)) for sample in samples()]
    long = [evolve(sample, quat=(4.0, 0.0, 0.0, 0.0)) for sample in samples()]
    assert Session(recipes.by_name("gyroscope")).feed(ones) == Session(recipes.by_name("gyroscope")).feed(long)


def test_cells_below_zero_tell_no_layout_and_raise_nothing() -> None:
    guess = LayoutGuess(Foot.LEFT)
    shares = [0.0] * 20 + [0.9] * 60
    cells = (-100.0, -50.0, -90.0)
    assert all(guess.update(0.01 * k, cells, shares[k % 80]) is None for k in range(800))


@pytest.mark.parametrize("cells", [(10**400,), (None, 10**400), (10**400, nan), (-(10**400), 1.0)])
def test_numbers_that_no_float_holds_are_refused_or_missing_and_raise_nothing(cells: tuple[int, ...]) -> None:
    session = Session()
    for k in range(50):
        session.feed(Sample(0.01 * k, Site.LEFT_FOOT, (0.0, 0.0, 9.8), (0.0, 0.0, 0.0), cells))  # type: ignore[arg-type]
    session.snapshot()


def test_an_area_that_never_carries_anything_tells_nothing() -> None:
    sole = layout(24, Foot.LEFT)
    dead = {k for k, cell in enumerate(sole.cells) if cell.x < 0.33 * sole.length}
    insole = InsoleLoads()
    insole.wear(sole)
    loads = []
    for sample in samples():
        if sample.site is Site.LEFT_FOOT and sample.pressure:
            cells = tuple(0.0 if k in dead else value for k, value in enumerate(sample.pressure))
            loads.append(insole.update(sample.t, cells))
    known = [load for load in loads if load is not None]
    assert known and all(load.heel is None for load in known)
    assert any(load.forefoot is not None for load in known)


@pytest.mark.parametrize("recipe", ["kupt", "zupt", "kupt-dfpc"])
def test_nothing_is_known_before_it_happened_in_a_gap_either(recipe: str) -> None:
    for begin in (2.9, 3.4, 3.9, 4.4):
        told = [sample for sample in samples() if not begin < sample.t < begin + 0.5]
        for event in Session(recipes.by_name(recipe)).feed(told):
            assert event.known_at >= event.t
            assert isfinite(event.t)


def test_a_guessed_layout_is_forgotten_with_its_insole() -> None:
    session = Session(recipes.by_name("zupt"))
    told = [evolve(s, pressure=s.pressure and s.pressure[:20]) if s.t > 5.0 else s for s in samples()]
    session.feed(told)
    guessed: Layout | None = session.feet[Foot.LEFT].insole.layout
    assert guessed is None or len(guessed.cells) == 20


def test_a_walk_whose_left_heel_is_dead_goes_on_with_what_is_left() -> None:
    sole = layout(24, Foot.LEFT)
    dead = {k for k, cell in enumerate(sole.cells) if cell.x < 0.44 * sole.length}

    def broken(sample: Sample) -> Sample:
        if sample.site is not Site.LEFT_FOOT or sample.pressure is None:
            return sample
        return evolve(sample, pressure=tuple(0.0 if k in dead else v for k, v in enumerate(sample.pressure)))

    clean = steps(Session(recipes.by_name("zupt")).feed(samples()), Foot.LEFT)
    events = Session(recipes.by_name("zupt")).feed([broken(sample) for sample in samples()])
    assert len(steps(events, Foot.LEFT)) >= len(clean) - 1
    assert all(step.length < 2.5 for step in steps(events, Foot.LEFT))
    assert any(isinstance(event, FootFlat) and event.foot is Foot.LEFT for event in events)
