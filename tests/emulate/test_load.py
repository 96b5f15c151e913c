"""Body weight on the feet: its size, its share on each foot and each part of the sole, and its shift in a bend."""

from __future__ import annotations

from functools import cache
from math import copysign

import numpy as np
import pytest

from solepath.emulate import Route, emulate
from solepath.emulate.sensors.insoles import LOAD_PER_COUNT, layout
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Site
from solepath.types.vector import GRAVITY
from solepath.wire.insole_info import parse_info
from solepath_lab.emulated.boot import boot, heel_array

WEIGHT = 75.0 * GRAVITY
STRAIGHT = Route().stand(2.0).walk(20.0, 1.3).stop(2.0)
BOTH = pytest.mark.parametrize("foot", Foot)


@cache
def walker() -> Walker:
    return Walker(STRAIGHT, seed=11)


def stances(foot: Foot) -> list[tuple[float, float, float, float]]:
    """Return heel-strike, foot-flat, heel-off and toe-off, s, of every stance between two strides of a foot."""
    strides = walker().plan.strides[foot]
    return [(a.heel_strike, a.foot_flat, b.heel_off, b.toe_off) for a, b in zip(strides, strides[1:], strict=False)]


@BOTH
def test_a_standing_foot_bears_half_the_weight_and_a_stance_has_two_humps_and_a_trough(foot: Foot) -> None:
    loads = walker().loads
    assert loads.total(foot, np.linspace(0.1, 0.9, 9)) == pytest.approx(0.5 * WEIGHT, rel=0.01)
    for heel_strike, _, _, toe_off in stances(foot)[1:-1]:
        load = loads.total(foot, np.linspace(heel_strike, toe_off, 101)) / WEIGHT
        assert 1.05 < load[10:40].max() < 1.25 and 1.05 < load[60:90].max() < 1.25
        assert 0.7 < load[40:60].min() < 0.9


@BOTH
def test_the_load_shows_heel_strike_and_toe_off_within_a_sample(foot: Foot) -> None:
    t = np.arange(0.0, walker().duration, 0.01)
    contact = walker().loads.total(foot, t) > 20.0
    rises, falls = t[1:][contact[1:] & ~contact[:-1]], t[1:][~contact[1:] & contact[:-1]]
    strides = walker().plan.strides[foot]
    late = rises - [one.heel_strike for one in strides]
    early = [one.toe_off for one in strides] - falls
    # up to 10 ms until the next sample and a few until 20 N; starting and closing steps load and unload more slowly
    assert late.min() > 0.0 and late.max() <= 0.02 and late[:-1].max() <= 0.0151 and np.median(late) < 0.013
    assert early.min() > -0.01 and early.max() <= 0.02 and early[1:].max() <= 0.01


@BOTH
@pytest.mark.parametrize("count", [24, 96, 128])
def test_cells_lie_on_the_sole_mirrored_and_share_the_whole_load_from_heel_to_forefoot(foot: Foot, count: int) -> None:
    shape, other = layout(count, foot), layout(count, Foot.LEFT if foot is Foot.RIGHT else Foot.RIGHT)
    x = np.array([cell.x for cell in shape.cells]) / shape.length
    assert shape.id == count == len({(cell.x, cell.y) for cell in shape.cells}) and shape.scale == LOAD_PER_COUNT
    assert x.min() > 0.0 and x.max() < 1.0 and max(abs(cell.y) for cell in shape.cells) < 0.05
    assert [(one.x, one.y) for one in shape.cells] == [(one.x, -one.y) for one in other.cells]
    assert 0.010 < sum(cell.area for cell in shape.cells) < 0.020
    t = np.arange(0.0, walker().duration, 0.01)
    cells = walker().cell_loads(shape, t)
    assert cells.min() >= 0.0 and cells.max() < shape.full_scale
    assert cells.sum(axis=1) == pytest.approx(walker().loads.total(foot, t), abs=1e-9)
    if count == 96:
        for heel_strike, foot_flat, heel_off, toe_off in stances(foot):
            first, last = (
                walker().cell_loads(shape, np.linspace(a + 1e-6, b - 1e-6, 20))
                for a, b in ((heel_strike, foot_flat), (heel_off, toe_off))
            )
            assert first[:, x > 0.5].max() == 0.0 < last[:, x > 0.5].max()
            assert last[:, x < 0.33].max() == 0.0 < first[:, x < 0.33].max()


@pytest.mark.parametrize("count", [0, 7, 129])
def test_a_layout_of_too_many_or_too_few_cells_is_rejected(count: int) -> None:
    with pytest.raises(ValueError):
        layout(count, Foot.LEFT)


@BOTH
def test_the_load_moves_to_the_outside_of_a_bend_and_more_in_a_tight_one(foot: Foot) -> None:
    cells = layout(99, foot)
    y = np.array([cell.y for cell in cells.cells])

    def aside(radius: float) -> Array:
        """Return how far to the left the load is in each stance of a bend, to the left for a positive radius, m."""
        route = Route().stand(1.0).turn(copysign(8.0 / abs(radius), radius), abs(radius), 1.1).stop(2.0)
        one = Walker(route, seed=2)
        pairs = list(zip(one.plan.strides[foot], one.plan.strides[foot][1:], strict=False))[1:-2]
        stood = [one.cell_loads(cells, np.linspace(a.foot_flat, b.heel_off, 15)) for a, b in pairs]
        return np.array([(load @ y / load.sum(axis=1)).mean() for load in stood])

    wide, tight = aside(4.0), aside(2.0)
    assert tight.max() < wide.min() < wide.max() < -0.005 and tight.mean() == pytest.approx(-0.015, abs=0.003)
    wide, tight = aside(-4.0), aside(-2.0)
    assert tight.min() > wide.max() > wide.min() > 0.005
    assert not walker().loads.lateral_shifts[foot][:, 0].any()  # none on a straight walk


def test_a_heel_array_lies_under_the_heel_bears_what_is_above_it_and_loses_cells_as_the_load_goes_forward() -> None:
    """A sole of the boot in the paper: 24 cells on 82.3 x 45.1 mm, up to 140 kPa."""
    cells = heel_array(Foot.LEFT)
    assert len(cells.cells) == 24 and max(one.x for one in cells.cells) < 0.33 * cells.length
    assert sum(one.area for one in cells.cells) == pytest.approx(0.0823 * 0.0451)
    assert cells.full_scale / cells.cells[0].area == pytest.approx(140e3)
    t = np.arange(0.0, walker().duration, 0.01)
    heel = walker().loads.zone_shares(Foot.LEFT, t)[0] * walker().loads.total(Foot.LEFT, t)
    borne = walker().cell_loads(cells, t).sum(axis=1)
    assert borne[heel == 0.0].max() == 0.0
    share = borne[heel > 50.0] / heel[heel > 50.0]
    assert share.min() > 0.5 and share.max() < 0.97
    _, foot_flat, heel_off, _ = stances(Foot.LEFT)[1]
    loads = walker().cell_loads(cells, np.linspace(foot_flat + 0.02, heel_off - 0.02, 10))
    above = (loads / cells.cells[0].area > 20e3).sum(axis=1)
    assert above[0] == 24 and above[-1] < 12 and (np.diff(above) <= 0).all()


def test_an_insole_with_a_layout_reports_it_and_fits_only_its_foot() -> None:
    walk = emulate(STRAIGHT, devices={Site.LEFT_FOOT: boot(Foot.LEFT)}, seed=3)
    info = parse_info(next(p.data for p in walk.packets if p.channel == "insole/info"))
    assert info.pressure_scale == pytest.approx(heel_array(Foot.LEFT).scale, rel=1e-6)
    assert [cell.x for cell in info.cells] == pytest.approx([c.x for c in heel_array(Foot.LEFT).cells], abs=1e-4)
    with pytest.raises(ValueError, match="left foot"):
        emulate(STRAIGHT, devices={Site.RIGHT_FOOT: boot(Foot.LEFT)}, seed=3)
