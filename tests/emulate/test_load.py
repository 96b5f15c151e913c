"""Body weight on the feet: how much, on which foot, under which part of the sole."""

import numpy as np
import pytest

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import SCALE, layout
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath.types.vector import GRAVITY

T = np.arange(0.0, 22.0, 0.002)


@pytest.fixture(scope="module")
def walker() -> Walker:
    return Walker(Route().stand(2.0).walk(20.0, 1.3).stop(2.0), seed=11)


def spans(walker: Walker, foot: Foot) -> list[tuple[float, float, float, float]]:
    """Heel-strike, foot-flat, heel-off and toe-off of every stance between two steps."""
    strides = walker.plan.strides[foot]
    return [(a.heel_strike, a.foot_flat, b.heel_off, b.toe_off) for a, b in zip(strides, strides[1:], strict=False)]


def test_standing_feet_carry_half_the_weight_each(walker: Walker) -> None:
    t = np.concatenate([np.linspace(0.1, 1.9, 20), walker.duration - np.linspace(0.1, 1.5, 20)])
    for foot in Foot:
        assert walker.loads.total(foot, t) == pytest.approx(0.5 * 75.0 * GRAVITY, rel=0.01)


def test_both_feet_together_carry_the_weight_over_every_step(walker: Walker) -> None:
    weight = 75.0 * GRAVITY
    together = walker.loads.total(Foot.LEFT, T) + walker.loads.total(Foot.RIGHT, T)
    assert together == pytest.approx(walker.loads.body(T), rel=1e-12)
    assert 0.7 * weight < together.min() and together.max() < 1.3 * weight
    for strike, _, _, off in spans(walker, Foot.LEFT)[1:-1]:
        whole = (strike <= T) & (off > T)
        assert together[whole].mean() == pytest.approx(weight, rel=0.06)
    assert together.mean() == pytest.approx(weight, rel=0.01)


def test_a_stance_has_two_humps_over_the_weight_and_a_trough_below(walker: Walker) -> None:
    weight = 75.0 * GRAVITY
    for strike, _, _, off in spans(walker, Foot.RIGHT)[1:-1]:
        load = walker.loads.total(Foot.RIGHT, np.linspace(strike, off, 101))
        first, trough, second = load[10:40].max(), load[40:60].min(), load[60:90].max()
        assert 1.05 * weight < first < 1.25 * weight
        assert 1.05 * weight < second < 1.25 * weight
        assert 0.7 * weight < trough < 0.9 * weight


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_tells_heel_strike_and_toe_off_within_a_sample(walker: Walker, foot: Foot) -> None:
    t = np.arange(0.0, walker.duration, 0.01)
    on = walker.loads.total(foot, t) > 20.0
    rises, falls = t[1:][on[1:] & ~on[:-1]], t[1:][~on[1:] & on[:-1]]
    strides = walker.plan.strides[foot]
    assert len(rises) == len(falls) == len(strides)
    # Up to 10 ms until the next sample and a few until 20 N; starting and closing steps load and unload more slowly.
    late = rises - [s.heel_strike for s in strides]
    early = [s.toe_off for s in strides] - falls
    assert late.min() > 0.0 and late.max() <= 0.02 and np.median(late) < 0.013
    assert early.min() > -0.01 and early.max() <= 0.02 and np.median(np.abs(early)) < 0.01
    assert late[:-1].max() <= 0.0151 and early[1:].max() <= 0.01


def test_nothing_presses_in_swing(walker: Walker) -> None:
    shape = layout(96, Foot.LEFT)
    for stride in walker.plan.strides[Foot.LEFT]:
        t = np.linspace(stride.toe_off + 1e-9, stride.heel_strike - 1e-9, 20)
        assert walker.cell_loads(shape, t).max() == 0.0


@pytest.mark.parametrize("count", [24, 35, 96, 99])
@pytest.mark.parametrize("foot", list(Foot))
def test_the_cells_share_the_whole_load(walker: Walker, foot: Foot, count: int) -> None:
    shape = layout(count, foot)
    cells = walker.cell_loads(shape, T)
    assert cells.min() >= 0.0
    assert cells.sum(axis=1) == pytest.approx(walker.loads.total(foot, T), abs=1e-9)
    assert cells.max() < shape.full_scale


def areas(walker: Walker, foot: Foot, t: Array) -> tuple[Array, Array]:
    """Load on the rear third and on the front half of a 96-cell insole."""
    shape = layout(96, foot)
    cells = walker.cell_loads(shape, t)
    x = np.array([cell.x for cell in shape.cells]) / shape.length
    return cells[:, x < 0.33].sum(axis=1), cells[:, x > 0.5].sum(axis=1)


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_goes_from_heel_to_forefoot_with_the_events(walker: Walker, foot: Foot) -> None:
    for strike, flat, lift, off in spans(walker, foot):
        rear, front = areas(walker, foot, np.linspace(strike + 1e-6, flat - 1e-6, 20))
        assert front.max() == 0.0 and rear.max() > 100.0
        rear, front = areas(walker, foot, np.array([flat + 0.02, lift - 0.02]))
        assert (rear > 10.0).all() and (front > 10.0).all()
        rear, front = areas(walker, foot, np.linspace(lift + 1e-6, off - 1e-6, 20))
        assert rear.max() == 0.0 and front.max() > 100.0


@pytest.mark.parametrize("foot", list(Foot))
def test_the_centre_of_pressure_moves_forward_and_ends_under_the_big_toe(walker: Walker, foot: Foot) -> None:
    shape = layout(99, foot)
    places = np.array([(cell.x, cell.y) for cell in shape.cells])
    for strike, _, _, off in spans(walker, foot)[1:-1]:
        cells = walker.cell_loads(shape, np.linspace(strike + 0.01, off - 0.01, 60))
        x, y = (cells @ places / cells.sum(axis=1, keepdims=True)).T
        assert np.diff(x).min() > -0.001
        assert x[0] < 0.06 and x[-1] > 0.22
        medial = -1.0 if foot is Foot.LEFT else 1.0
        assert y[-1] * medial > 0.004


@pytest.mark.parametrize("count", [8, 24, 35, 96, 99, 128])
def test_a_layout_has_its_cells_on_the_sole_and_mirrored_for_the_other_foot(count: int) -> None:
    left, right = layout(count, Foot.LEFT), layout(count, Foot.RIGHT)
    assert len(left.cells) == count == left.id
    for one, other in zip(left.cells, right.cells, strict=True):
        assert 0.0 < one.x < left.length and abs(one.y) < 0.05
        assert (one.x, one.y) == (other.x, -other.y)
    assert len({(cell.x, cell.y) for cell in left.cells}) == count
    surface = sum(cell.area for cell in left.cells)
    assert 0.010 < surface < 0.020  # a sole of about 200 cm^2, four fifths of it under cells
    assert left.scale == SCALE


def test_a_layout_of_too_many_or_too_few_cells_is_refused() -> None:
    for count in (0, 7, 129):
        with pytest.raises(ValueError):
            layout(count, Foot.LEFT)
