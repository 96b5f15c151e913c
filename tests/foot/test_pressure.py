"""Loads of the cells: tare, share of the full load, centre of pressure; and the estimated layout."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import pytest
from attrs import evolve
from walks import LEFT, RIGHT, SHORT, insoles, of, samples

from solepath import (
    Foot,
    FootFlat,
    FootPressed,
    HeelOff,
    HeelStrike,
    Layout,
    Sample,
    Session,
    StrideTaken,
    ToeOff,
    recipes,
)
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.wearers.walker import Walker
from solepath.foot.pressure.insole import InsoleLoads, LayoutGuess


def test_an_insole_without_an_inertial_sensor_still_gives_the_phases() -> None:
    walker = Walker(Route().stand(1.0).walk(12.0, 1.3).stop(1.0), seed=2)
    shape = layout(96, Foot.LEFT)
    session = Session()
    events = session.feed(insoles(cells=96).packets[:1])  # INFO, so that the layout is known
    pressed = [
        Sample(s.t, LEFT, pressure=s.pressure) for s in walker.samples(Foot.LEFT, 100.0, layout=shape) if s.t > 0.1
    ]
    events += session.feed(pressed)
    truth = walker.truth().feet[Foot.LEFT]
    for kind, true, first in (
        (HeelStrike, truth.heel_strikes, 1),
        (ToeOff, truth.toe_offs, 1),
        (FootFlat, truth.foot_flats, 1),
        (HeelOff, truth.heel_offs, 1),
    ):
        estimate = [event.t for event in of(kind, events)]
        for t in true[first:]:
            assert min(abs(t - other) for other in estimate) < 0.12, kind
        assert len(estimate) <= len(true) + 1


def test_the_first_toe_off_of_a_walk_is_when_the_toe_leaves_the_ground() -> None:
    walk = insoles(SHORT)
    events = Session().feed(walk.packets)
    for foot in Foot:
        (first, *_) = (event.t for event in of(ToeOff, events) if event.foot is foot)
        assert first == pytest.approx(walk.truth.feet[foot].toe_offs[0], abs=0.06)
        assert len([event for event in of(HeelOff, events) if event.foot is foot]) == len(
            walk.truth.feet[foot].heel_offs
        )


def test_the_path_of_the_centre_of_pressure_runs_from_heel_to_toe() -> None:
    strides = of(StrideTaken, Session().feed(insoles(SHORT).packets))
    events = [stride for stride in strides if stride.number > 1][:-2]
    paths = [stride.features.cop for stride in events]
    assert all(8 <= len(path) <= 32 for path in paths)
    for path in paths:
        assert path[0][0] < 0.09 and max(x for x, _ in path) > 0.20
        rising = [b[0] > a[0] - 0.003 for a, b in pairwise(path[:-3])]  # hardly any load is left at the very end
        assert all(rising)
        assert all(0.0 < x < 0.285 and abs(y) < 0.05 for x, y in path)
    assert all(stride.features.contact_load > 200.0 for stride in events)


@cache
def estimate_layout(cells: int) -> Layout | None:
    """Return the estimated layout of the left insole of a short walk whose layout is unknown."""
    insole, guess = InsoleLoads(), LayoutGuess(Foot.LEFT)
    for sample in samples(cells=cells):
        if sample.site.foot is Foot.LEFT and sample.pressure:
            load = insole.update(sample.t, sample.pressure)
            estimate = None if load is None else guess.update(sample.t, insole.above_tare(load.cells), load.total)
            if estimate is not None:
                return estimate
    return None


def test_heel_and_forefoot_are_distinguished_after_two_stances() -> None:
    for cells in (24, 96):
        true, estimate = layout(cells, Foot.LEFT), estimate_layout(cells)
        assert estimate is not None
        placed = 0
        for cell, learnt in zip(true.cells, estimate.cells, strict=True):
            if learnt.x == 0.5 * estimate.length:
                continue  # it never bears load
            if cell.x < 0.25 * true.length:
                assert learnt.x < 0.45 * estimate.length, cell
            if cell.x > 0.75 * true.length:
                assert learnt.x > 0.55 * estimate.length, cell
            placed += 1
        assert placed > 0.7 * cells


def test_where_the_cells_of_another_insole_are_is_learnt_anew() -> None:
    """Nobody says where the cells of either are; the second one has more of them."""
    session = Session(recipes.by_name("kupt-dfpc"), pressures=True)
    for count, address, later in ((24, "C0:FF:EE:00:00:01", 0.0), (35, "C0:FF:EE:00:00:02", 60.0)):
        for site in (LEFT, RIGHT):
            session.bind(site, address)
        worn = [evolve(one, t=one.t + later, known_at=one.t + later) for one in samples(cells=count)]
        events = session.feed(worn)
        assert {len(event.values) for event in of(FootPressed, events)} == {count}
        assert len(of(StrideTaken, events)) >= 6
        for tracker in session.feet.values():
            learnt = tracker.sole.insole.layout
            assert tracker.sole.layout_estimated and learnt is not None and len(learnt.cells) == count
