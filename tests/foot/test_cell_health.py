"""Failed pressure cells are reported and not used, and the walk goes on."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import inf, nan

import pytest
from attrs import evolve
from walks import LEFT, of, samples

from solepath import Session
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import FULL_SCALE, layout
from solepath.events import CellFault, CellsFailed, Event, InsoleNeverUnloads, SampleRejected, StrideTaken
from solepath.foot.pressure.cell_health import CellHealth
from solepath.foot.pressure.cells import CellSpan, enclosed
from solepath.types import Cell, Foot, Layout, Phase, Sample

WALK = Route().stand(1.5).walk(30.0, 1.3).stop(1.0)
COUNTS = (24, 35, 96, 99)
Fault = Callable[[float, tuple[float, ...], int], tuple[float | None, ...]]
"""Function of time, cells and the index of the failing cell that returns the changed cells."""


@cache
def walk(cells: int = 96) -> tuple[Sample, ...]:
    """Return a walk of about 26 s at 50 Hz, with cells clipped like those of a device."""
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


@pytest.mark.parametrize("cells", [8, *COUNTS])
def test_working_cells_cause_no_events(cells: int) -> None:
    for foot_layout in (True, False):
        health = CellHealth(LEFT)
        shape = layout(cells, Foot.LEFT) if foot_layout else None
        for sample in walk(cells):
            if sample.site is LEFT and sample.pressure is not None:
                assert health.update(sample.t, sample.t, sample.pressure, Phase.SWING, sample.gyro, shape) == []
                assert health.usable(sample.pressure) is sample.pressure


FAULTS = (
    (CellFault.DEAD, fault_with_value(0.0)),
    (CellFault.STUCK, fault_with_value(60.0)),
    (CellFault.STUCK, flickering),
    (CellFault.SATURATED, fault_with_value(FULL_SCALE)),
    (CellFault.MISSING, fault_with_value(nan)),
    (CellFault.MISSING, fault_with_value(None)),
)


@pytest.mark.parametrize(
    ("kind", "fault", "cells"),
    [
        pytest.param(*one, cells, marks=[] if cells == 96 or k % 3 == 0 else [pytest.mark.soak])
        for k, one in enumerate(FAULTS)
        for cells in COUNTS
    ],
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


@pytest.mark.parametrize("cells", COUNTS)
def test_a_cell_that_fails_during_a_walk_is_reported_within_three_windows(cells: int) -> None:
    cell_events, _ = run_walk(cells, fault_with_value(0.0), since=13.0)
    assert [(event.fault, event.cells) for event in cell_events if isinstance(event, CellsFailed)] == [
        (CellFault.DEAD, (among_loading_cells(cells),))
    ]
    assert 13.0 + 4.0 < cell_events[0].t < 13.0 + 14.0


def test_several_cells_that_fail_together_are_reported_together() -> None:
    def two(t: float, cells: tuple[float, ...], cell_index: int) -> tuple[float | None, ...]:
        return fault_with_value(60.0)(t, cells, cell_index)[:-1] + (60.0,)

    cell_events, _ = run_walk(96, two)
    assert [event.cells for event in cell_events if isinstance(event, CellsFailed)] == [(among_loading_cells(96), 95)]


def test_a_cell_that_loads_again_is_used_again() -> None:
    cell_index = among_loading_cells(96)
    health = CellHealth(LEFT)
    shape = layout(96, Foot.LEFT)
    used = {}
    for sample in walk():
        if sample.site is not LEFT or sample.pressure is None:
            continue
        cells = sample.pressure if sample.t > 13.0 else fault_with_value(60.0)(sample.t, sample.pressure, cell_index)
        health.update(sample.t, sample.t, cells, Phase.SWING, sample.gyro, shape)
        used[sample.t] = cell_index not in health.excluded
    assert used[min(used)]
    assert not used[12.5]
    assert used[max(used)]


@pytest.mark.parametrize("count", [0, 50, 95, 97])
def test_another_number_of_cells_is_reported_and_the_inertial_part_is_used(count: int) -> None:
    cell_events, rest = run_walk(96, lambda t, cells, cell_index: (*cells, 1.0)[:count], since=10.0)
    (failed,) = cell_events
    assert isinstance(failed, CellsFailed)
    assert failed.fault is CellFault.MISSING
    assert failed.cells == (tuple(range(count, 96)) or (96,))
    assert failed.t == pytest.approx(11.0, abs=0.1)
    assert len(of(StrideTaken, rest)) == len(clean())


def test_one_sample_of_another_length_is_neither_used_nor_reported() -> None:
    cell_events, _ = run_walk(96, lambda t, cells, cell_index: cells[:9] if 10.0 <= t < 10.02 else cells)
    assert cell_events == []
    health = CellHealth(LEFT)
    health.update(0.0, 0.0, (1.0,) * 8, Phase.STATIONARY)
    health.update(0.1, 0.1, (1.0,) * 7, Phase.STATIONARY)
    assert health.usable((1.0,) * 7) == ()
    assert health.usable((1.0,) * 8) == (1.0,) * 8


def test_without_a_layout_another_number_of_cells_is_another_insole_after_a_second() -> None:
    health = CellHealth(LEFT)
    cell_events = [event for k in range(10) for event in health.update(0.1 * k, 0.1 * k, (1.0,) * 8, Phase.STATIONARY)]
    cell_events += [
        event for k in range(10, 40) for event in health.update(0.1 * k, 0.1 * k, (1.0,) * 6, Phase.STATIONARY)
    ]
    assert [(event.fault, event.cells) for event in cell_events if isinstance(event, CellsFailed)] == [
        (CellFault.MISSING, (6, 7))
    ]
    assert health.usable((1.0,) * 6) == (1.0,) * 6


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


def test_a_wearer_who_stands_on_one_spot_has_no_stuck_cells() -> None:
    health = CellHealth(LEFT)
    shape = layout(96, Foot.LEFT)
    cells = tuple([float(i % 7) for i in range(96)])
    still = (0.0, 0.0, 0.01)
    assert [e for k in range(3000) for e in health.update(k / 50, k / 50, cells, Phase.STATIONARY, still, shape)] == []


def grid(side: int) -> Layout:
    return Layout(1, Foot.LEFT, tuple(Cell(0.01 * i, 0.01 * j) for i in range(side) for j in range(side)), 0.3)


def test_a_cell_is_enclosed_when_cells_on_all_its_sides_load() -> None:
    foot_layout = grid(3)
    assert foot_layout.spacing == pytest.approx(0.01)
    loading = [True] * 9
    assert enclosed(foot_layout, 4, loading) == (True, True)
    assert enclosed(foot_layout, 3, loading) == (False, True)  # at the rim
    assert enclosed(foot_layout, 4, [False] * 9) == (False, False)
    assert enclosed(foot_layout, 4, [True] * 3 + [False] * 6) == (False, True)
    assert Layout(1, Foot.LEFT, (Cell(0.0, 0.0),), 0.3).spacing == 0.0


# --- any input ---


def test_cells_that_have_failed_leave_nothing_in_the_sum() -> None:
    span = CellSpan()
    span.add((0.0, 0.1, 100.7, 0.3, 0.0), [1, 2, 3])
    assert (span.low, span.high) == (0.0, 0.0)
