"""Failed pressure cells are reported and not used, and the walk goes on."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import inf, nan
from random import Random

import pytest
from attrs import evolve
from soak import soaked
from walks import LEFT, of, samples

from solepath import Session
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate import Walker
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import FULL_SCALE, layout
from solepath.events import (
    CellFault,
    CellsFailed,
    DefectFound,
    Event,
    InsoleNeverUnloads,
    Limitation,
    SampleRejected,
    StrideTaken,
)
from solepath.foot.pressure.cell_health import enclosed
from solepath.types import Cell, Foot, Layout, Sample

WALK = Route().stand(1.5).walk(20.0, 1.3).stop(1.0)
COUNTS = (24, 35, 96, 99)
Fault = Callable[[float, tuple[float, ...], int], tuple[float | None, ...]]
"""Function of time, cells and the index of the failing cell that returns the changed cells."""


@cache
def walk(cells: int = 96) -> tuple[Sample, ...]:
    """Return a walk of about 18 s at 50 Hz, with cells clipped like those of a device."""
    return tuple(
        evolve(s, pressure=tuple([min(value, FULL_SCALE) for value in s.pressure]))
        for s in samples(WALK, cells=cells, rate=50.0)
        if s.pressure is not None
    )


def calibration_of(cells: int = 96) -> Calibration:
    return Calibration({foot: InsoleCalibration(layout(cells, foot)) for foot in Foot})


@cache
def among_loading_cells(cells: int) -> int:
    """Return a cell of the forefoot with loading cells on all its sides."""
    foot_layout = layout(cells, Foot.LEFT)
    pressed = [s.pressure for s in walk(cells) if s.site is LEFT and s.pressure is not None]
    highest = [max(values) for values in zip(*pressed, strict=True)]
    loading = [value > 0.2 * max(highest) for value in highest]
    around = [i for i in range(cells) if loading[i] and enclosed(foot_layout, i, loading)[0]]
    return max(around, key=lambda i: (foot_layout.cells[i].x < 0.7 * foot_layout.length, highest[i]))


def run_walk(cells: int, fault: Fault | None = None, since: float = -inf) -> tuple[list[Event], list[Event]]:
    """Return the events about cells, and all others, of a walk in which a cell of the left insole fails."""
    session, cell_index = Session(calibration=calibration_of(cells)), among_loading_cells(cells)
    cell_events: list[Event] = []
    for sample in walk(cells):
        if fault is not None and sample.site is LEFT and sample.t >= since and sample.pressure is not None:
            sample = evolve(sample, pressure=fault(sample.t, sample.pressure, cell_index) or None)
        cell_events += session.feed(sample)
    kinds = CellsFailed | InsoleNeverUnloads
    return of(kinds, cell_events), [event for event in cell_events if not isinstance(event, kinds)]


@cache
def clean(cells: int = 96) -> list[StrideTaken]:
    """Return the strides of the same walk without a fault."""
    cell_events, rest = run_walk(cells)
    assert cell_events == []
    return of(StrideTaken, rest)


def fault_with_value(value: float | None) -> Fault:
    def fault(t: float, cells: tuple[float, ...], cell_index: int) -> tuple[float | None, ...]:
        return tuple([value if i == cell_index else cell for i, cell in enumerate(cells)])

    return fault


def flickering(t: float, cells: tuple[float, ...], cell_index: int) -> tuple[float | None, ...]:
    """Return a constant value and, now and then, the neighbouring count."""
    return fault_with_value(60.0 + (0.05 if int(t * 1000) % 3 else 0.0))(t, cells, cell_index)


FAULTS = (
    (CellFault.DEAD, fault_with_value(0.0)),
    (CellFault.STUCK, fault_with_value(60.0)),
    (CellFault.STUCK, flickering),
    (CellFault.SATURATED, fault_with_value(FULL_SCALE)),
    (CellFault.MISSING, fault_with_value(nan)),
    (CellFault.MISSING, fault_with_value(None)),
    (CellFault.MISSING, fault_with_value(-5e12)),
)


@pytest.mark.parametrize(
    ("kind", "fault", "cells"),
    [pytest.param(*one, cells, marks=[] if cells == 96 else [pytest.mark.soak]) for one in FAULTS for cells in COUNTS],
)
def test_a_failed_cell_is_reported_once_and_the_walk_goes_on(cells: int, kind: CellFault, fault: Fault) -> None:
    cell_events, rest = run_walk(cells, fault)
    (failed,) = cell_events
    assert isinstance(failed, CellsFailed)
    assert (failed.site, failed.fault, failed.cells) == (LEFT, kind, (among_loading_cells(cells),))
    assert failed.t < (1.1 if kind is CellFault.MISSING else 15.0)
    strides, clean_strides = of(StrideTaken, rest), clean(cells)
    assert len(strides) == len(clean_strides)
    assert sum(s.length for s in strides) == pytest.approx(sum(s.length for s in clean_strides), rel=0.01)
    assert of(SampleRejected, rest) == []


def test_several_cells_that_fail_together_are_reported_together() -> None:
    def two(t: float, cells: tuple[float, ...], cell_index: int) -> tuple[float | None, ...]:
        return fault_with_value(60.0)(t, cells, cell_index)[:-1] + (60.0,)

    cell_events, _ = run_walk(96, two)
    assert [event.cells for event in cell_events if isinstance(event, CellsFailed)] == [(among_loading_cells(96), 95)]


@pytest.mark.parametrize("count", [0, 97, *soaked(50, 95)])
def test_another_number_of_cells_is_reported_and_the_inertial_part_is_used(count: int) -> None:
    cell_events, rest = run_walk(96, lambda t, cells, cell_index: (*cells, 1.0)[:count], since=10.0)
    assert cell_events == [], "no cell has failed"
    (limitation,) = of(Limitation, rest)
    number = f"samples have {count} values of pressure cells, but the layout of the insole has 96"
    assert limitation.what == f"{number}: no pressure is used"
    assert limitation.t == pytest.approx(11.0, abs=0.1)
    assert len(of(StrideTaken, rest)) == len(clean())


def test_an_insole_that_never_unloads_is_reported_and_strides_come_from_the_inertial_sensor() -> None:
    (cell_events,), rest = run_walk(96, lambda t, cells, cell_index: tuple([value + 40.0 for value in cells]))
    assert isinstance(cell_events, InsoleNeverUnloads) and cell_events.site is LEFT
    assert 6.0 < cell_events.seconds < 16.0
    assert abs(len(of(StrideTaken, rest)) - len(clean())) <= 1


@pytest.mark.parametrize("value", [30.0, 0.0])
def test_an_insole_that_shows_one_value_for_ever_never_unloads_and_one_that_shows_nothing_is_dead(value: float) -> None:
    (cell_events,), rest = run_walk(24, lambda t, cells, cell_index: (value,) * 24)
    if value:
        assert isinstance(cell_events, InsoleNeverUnloads)
    else:
        assert isinstance(cell_events, CellsFailed) and (cell_events.fault, cell_events.cells) == (
            CellFault.DEAD,
            tuple(range(24)),
        )
    assert len(of(StrideTaken, rest)) == len(clean(24))


# --- any input ---


@pytest.mark.parametrize("bits", [24, 29])
def test_cells_of_a_fine_converter_cost_no_sample(bits: int) -> None:
    zero, step = 2.0 ** (bits - 1), 2.0 ** (bits - 12)
    _, others = run_walk(24, lambda _, cells, __: tuple([zero + 0.4 * step * value for value in cells]))
    assert not of(SampleRejected, others) and of(StrideTaken, others)


BREAKS = {
    "zero": lambda cells, held: (0.0,) * len(cells),
    "half the full scale": lambda cells, held: (0.5 * FULL_SCALE,) * len(cells),
    "full scale": lambda cells, held: (FULL_SCALE,) * len(cells),
    "the last values": lambda cells, held: held,
    "noise": lambda cells, held: tuple([20.0 + 0.1 * ((7 * i + int(1000 * held[0])) % 5) for i in range(len(cells))]),
}


@pytest.mark.parametrize("since", [10.0, 10.35, 10.7])
@pytest.mark.parametrize("kind", BREAKS)
def test_when_all_cells_fail_at_once_the_inertial_sensor_finds_the_strides(kind: str, since: float) -> None:
    held: list[tuple[float, ...]] = []

    def broken(t: float, cells: tuple[float, ...], cell_index: int) -> tuple[float | None, ...]:
        held.append(tuple([20.0 + value for value in cells]))
        return tuple(BREAKS[kind](cells, held[0]))

    session, events = Session(calibration=calibration_of(24)), list[Event]()
    for sample in walk(24):
        if sample.site is LEFT and sample.pressure is not None:
            raised = tuple([20.0 + value for value in sample.pressure])
            pressure = raised if sample.t < since else broken(sample.t, sample.pressure, 0)
            sample = evolve(sample, pressure=pressure)
        events += session.feed(sample)
    (failed,) = of(CellsFailed, events)
    assert (failed.fault, failed.cells, failed.site) == (CellFault.STUCK, tuple(range(24)), LEFT)
    assert since < failed.t < since + 4.0, "two strides or so"
    strides, clean_strides = of(StrideTaken, events), clean(24)
    assert 0 <= len(clean_strides) - len(strides) <= 2, "those before the fault is known"
    distance = sum(s.length for s in strides)
    assert distance == pytest.approx(sum(s.length for s in clean_strides), rel=0.02)
    assert of(DefectFound, events) == []


def test_cells_of_which_all_had_failed_are_used_again_when_they_load_again() -> None:
    events: list[Event] = []
    session, route = Session(calibration=calibration_of(24)), Route().stand(1.5).walk(50.0, 1.3).stop(1.0)
    for sample in samples(route, cells=24, rate=50.0):
        if sample.site is LEFT and 8.0 <= sample.t < 14.0:
            sample = evolve(sample, pressure=(25.0,) * 24)
        events += session.feed(sample)
    assert len(of(CellsFailed, events)) == 1
    late = [s for s in of(StrideTaken, events) if s.foot is Foot.LEFT and s.t > 30.0]
    assert late and all(s.features.contact_load is not None for s in late)


@pytest.mark.parametrize("noise", [0.0, 0.1])
@pytest.mark.parametrize("dead_cell", [None, 0, 2, 5])
def test_a_cell_of_a_sparse_sole_that_never_bears_load_is_named_though_it_has_few_neighbours(
    dead_cell: int | None, noise: float
) -> None:
    places = ((0.03, 0.0), (0.07, -0.02), (0.16, -0.03), (0.17, 0.0), (0.17, 0.03), (0.23, -0.02))
    sole = Layout(1, Foot.LEFT, tuple([Cell(x, y) for x, y in places]), length=0.26)
    session, events = Session(calibration=Calibration({Foot.LEFT: InsoleCalibration(sole)})), list[Event]()
    for number, sample in enumerate(Walker(WALK).samples(Foot.LEFT, 50.0, layout=sole)):
        dead_value = 20.0 + noise * (number % 2)
        pressure = tuple([dead_value if i == dead_cell else 20.0 + v for i, v in enumerate(sample.pressure or ())])
        events += session.feed(evolve(sample, pressure=pressure))
    named = [(event.fault, event.cells) for event in of(CellsFailed, events)]
    assert named == ([] if dead_cell is None else [(CellFault.DEAD, (dead_cell,))])


@pytest.mark.parametrize("seed", range(10))
def test_sound_cells_of_which_most_samples_are_lost_have_not_failed(seed: int) -> None:
    random = Random(seed)
    heard = [(t, t + random.uniform(0.02, 0.3)) for t in [0.9 * k + random.uniform(0.0, 0.5) for k in range(5, 25)]]
    session, events = Session(calibration=calibration_of(24)), list[Event]()
    for sample in walk(24):
        if sample.t < 4.5 or any(since <= sample.t < until for since, until in heard):
            events += session.feed(sample)
    assert of(CellsFailed, events) == []
