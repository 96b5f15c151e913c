"""Contradictory and extreme input: large intervals, extreme numbers, dead areas, gaps."""

from __future__ import annotations

import json
from functools import cache
from math import hypot, inf, isfinite, nan, radians

import pytest
from attrs import evolve
from walks import samples

from solepath import (
    ClockReset,
    Event,
    Foot,
    FootFlat,
    FootMoved,
    Layout,
    Packet,
    PacketRejected,
    Sample,
    SampleGap,
    Session,
    Site,
    StreamStale,
    StrideTaken,
    recipes,
)
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.emulate import CC2650, Route, emulate
from solepath.emulate.sensors.insoles import layout
from solepath.foot.pressure.insole import InsoleLoads
from solepath.foot.pressure.layout_guess import LayoutGuess

LEFT = Site.LEFT_FOOT


def still(t: float, rate: float = 0.0) -> Sample:
    return Sample(t, LEFT, (0.0, 0.0, 9.81), (0.0, rate, 0.0))


@pytest.mark.parametrize(("rate", "wait"), [(18.0, 0.5), (35.0, 0.2), (35.0, 0.3), (80.0, 0.1), (95.0, 0.24)])
def test_however_far_a_foot_turns_between_two_samples_its_position_is_a_number(rate: float, wait: float) -> None:
    session = Session(poses=True)
    events = session.feed([still(0.01 * k) for k in range(100)])
    events += session.feed([still(1.0 + 0.01 * k, rate) for k in range(5)])
    events += session.feed(still(1.04 + wait, rate))
    events += session.feed([still(1.05 + wait + 0.01 * k) for k in range(300)])
    moved = [event for event in events if isinstance(event, FootMoved)]
    assert all(isfinite(x) for event in moved for x in (*event.position, *event.velocity))
    json.dumps(session.snapshot(), allow_nan=False)


def test_a_first_wait_of_seconds_does_not_hide_the_gaps_after_it() -> None:
    session = Session()
    events = session.feed([still(0.0), *(still(2.0 + 0.01 * k) for k in range(60)), still(4.1)])
    assert [round(event.duration, 2) for event in events if isinstance(event, SampleGap)] == [2.0, 1.51]


def test_a_snapshot_does_not_depend_on_the_first_site() -> None:
    walk = emulate(Route().stand(1).walk(4, 1.2).stop(1), seed=3)
    session = Session()
    session.feed([packet for packet in walk.packets[:400] if packet.site is Site.RIGHT_FOOT])
    session.feed([packet for packet in walk.packets[:400] if packet.site is LEFT])
    text = json.dumps(session.snapshot(), sort_keys=True)
    restored = Session.restore(json.loads(text))
    stale, other = session.advance(1e4), restored.advance(1e4)
    assert stale == other and len([event for event in stale if isinstance(event, StreamStale)]) == 2
    assert restored.position == session.position


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("first", [Route().stand(2).turn(radians(90)), Route().stand(2).turn(radians(90), radius=2.0)])
def test_final_strides_are_all_in_one_frame(first: Route, seed: int) -> None:
    walk = emulate(first.walk(6, 1.2).stop(2), seed=seed)
    session = Session(recipes.DEFAULT.exchanged(TrackPart, MeanOfFeet()))  # no foot is moved by the other
    strides_of = [event for event in session.feed(walk.packets) if isinstance(event, StrideTaken)]
    for foot in Foot:
        strides = [stride for stride in strides_of if stride.foot is foot]
        assert len(strides) >= 5
        for before, after in zip(strides, strides[1:], strict=False):
            (x, y, _), (u, v, _), (dx, dy, _) = after.position, before.position, after.displacement
            assert hypot(x - u - dx, y - v - dy) < 0.06  # shift of a standing foot


def test_a_session_has_its_own_copy_of_the_recipe() -> None:
    session = Session()
    session.recipe.detector.past_low = 7.0
    assert session.recipe.detector.past_low != 7.0
    assert recipes.DEFAULT.detector.past_low != 7.0


def test_a_packet_that_cannot_be_used_does_not_set_the_clock_back() -> None:
    walk = emulate(Route().stand(3), devices={LEFT: CC2650()}, seed=1)
    session = Session()
    session.feed(walk.packets)
    late = Packet(0.5, LEFT, "cc2650/movement", bytes(18))
    for _ in range(19):
        session.feed(late)
    before = session.snapshot()
    (event,) = session.feed(Packet(0.5, LEFT, "toaster/crumbs", b""))
    assert isinstance(event, PacketRejected) and session.snapshot() == before
    assert any(isinstance(event, ClockReset) for event in session.feed(late))


QUATS = [
    (0.0, 0.0, 0.0, 0.0),
    (1e-200, 0.0, 0.0, 0.0),
    (nan, 0.0, 0.0, 0.0),
    (inf, 0.0, 0.0, 0.0),
    (1e300, 1.0, 0.0, 0.0),
]


def strides_of(events: list[Event], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]


@pytest.mark.parametrize("quat", QUATS, ids=str)
@pytest.mark.parametrize("recipe", ["default", "gyroscope", "walking-modes"])
def test_an_invalid_attitude_counts_as_none(recipe: str, quat: tuple[float, float, float, float]) -> None:
    changed = [evolve(sample, quat=quat) for sample in samples()]
    session = Session(recipes.by_name(recipe))
    assert session.feed(changed) == without_attitude(recipe)
    session.snapshot()


@cache
def without_attitude(recipe: str) -> list[Event]:
    return Session(recipes.by_name(recipe)).feed(samples())


def test_an_attitude_of_any_length_is_the_same_attitude() -> None:
    ones = [evolve(sample, quat=(1.0, 0.0, 0.0, 0.0)) for sample in samples()]
    long = [evolve(sample, quat=(4.0, 0.0, 0.0, 0.0)) for sample in samples()]
    assert Session(recipes.by_name("gyroscope")).feed(ones) == Session(recipes.by_name("gyroscope")).feed(long)


def test_cells_below_zero_give_no_layout_and_raise_nothing() -> None:
    guess = LayoutGuess(Foot.LEFT)
    shares = [0.0] * 20 + [0.9] * 60
    cells = (-100.0, -50.0, -90.0)
    assert all(guess.update(0.01 * k, cells, shares[k % 80]) is None for k in range(800))


@pytest.mark.parametrize("cells", [(10**400,), (None, 10**400), (10**400, nan), (-(10**400), 1.0)])
def test_numbers_too_large_for_a_float_are_rejected_or_missing_and_raise_nothing(cells: tuple[int, ...]) -> None:
    session = Session()
    for k in range(50):
        session.feed(Sample(0.01 * k, Site.LEFT_FOOT, (0.0, 0.0, 9.8), (0.0, 0.0, 0.0), cells))  # type: ignore[arg-type]
    session.snapshot()


def test_an_area_that_never_bears_load_has_no_load() -> None:
    sole = layout(24, Foot.LEFT)
    dead = {k for k, cell in enumerate(sole.cells) if cell.x < 0.33 * sole.length}
    insole = InsoleLoads()
    insole.set_layout(sole)
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
    for start in (2.9, 3.4, 3.9, 4.4):
        changed = [sample for sample in samples() if not start < sample.t < start + 0.5]
        for event in Session(recipes.by_name(recipe)).feed(changed):
            assert event.known_at >= event.t
            assert isfinite(event.t)


def test_a_guessed_layout_is_forgotten_with_its_insole() -> None:
    session = Session(recipes.by_name("zupt"))
    changed = [evolve(s, pressure=s.pressure and s.pressure[:20]) if s.t > 5.0 else s for s in samples()]
    session.feed(changed)
    guessed: Layout | None = session.feet[Foot.LEFT].sole.insole.layout
    assert guessed is None or len(guessed.cells) == 20


def test_a_walk_whose_left_heel_is_dead_goes_on_with_what_is_left() -> None:
    sole = layout(24, Foot.LEFT)
    dead = {k for k, cell in enumerate(sole.cells) if cell.x < 0.44 * sole.length}

    def broken(sample: Sample) -> Sample:
        if sample.site is not Site.LEFT_FOOT or sample.pressure is None:
            return sample
        return evolve(sample, pressure=tuple(0.0 if k in dead else v for k, v in enumerate(sample.pressure)))

    clean = strides_of(Session(recipes.by_name("zupt")).feed(samples()), Foot.LEFT)
    events = Session(recipes.by_name("zupt")).feed([broken(sample) for sample in samples()])
    assert len(strides_of(events, Foot.LEFT)) >= len(clean) - 1
    assert all(stride.length < 2.5 for stride in strides_of(events, Foot.LEFT))
    assert any(isinstance(event, FootFlat) and event.foot is Foot.LEFT for event in events)
