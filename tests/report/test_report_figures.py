"""Tests the report's drawings: positions, counts and labels."""

from __future__ import annotations

import pytest
from attrs import evolve
from reported_walks import events_of
from walks import of

from solepath import FootPressed, GaitCycleMeasured
from solepath.types import Cell, Foot, Layout
from solepath.walk.soles import STATIONS, SoleLoads


def add_second(sole: SoleLoads, start: float, heel: float) -> None:
    """Add 1 s of samples at 100 Hz; the load goes from heel to toe within the first 0.6 s."""
    for k in range(100):
        share = min(k / 60.0, 1.0)
        load = heel if k <= 60 else 0.0
        values = (load * (1.0 - share), load * share)
        centre = (0.05 + 0.15 * share, 0.0) if load else None
        t = start + 0.01 * k
        sole.add_sample(FootPressed(t=t, known_at=t, foot=Foot.LEFT, values=values, force=load, centre=centre))


def walked_sole() -> SoleLoads:
    sole = SoleLoads(Layout(1, Foot.LEFT, (Cell(0.05, 0.0), Cell(0.2, 0.0)), 0.25, 1.0))
    walked = next(iter(of(GaitCycleMeasured, events_of("walk"))))
    for k in range(4):
        add_second(sole, 1.0 * k, 100.0)
        if k:
            sole.add_cycle(evolve(walked, t_start=1.0 * k, t_toe_off=k + 0.6, degraded=False))
    return sole


def test_loads_of_a_contact_are_means_and_peaks_of_each_cell_and_the_centre_goes_from_heel_to_toe() -> None:
    sole = walked_sole()
    assert sole.contacts == 3 and sole.unit == "N" and sole.drawable_layout
    assert [one / 3 for one in sole.mean_sums] == pytest.approx([50.0, 50.0], rel=0.02)
    assert [one / 3 for one in sole.peak_sums] == pytest.approx([100.0, 100.0], rel=0.02)
    assert [one / 3 for one in sole.force_sums] == pytest.approx([100.0] * STATIONS)
    path = sole.mean_path
    assert len(path) == STATIONS
    assert path[0] == pytest.approx((0.05, 0.0), abs=0.004) and path[-1] == pytest.approx((0.2, 0.0), abs=0.004)
    assert [x for x, _ in path] == sorted([x for x, _ in path])
