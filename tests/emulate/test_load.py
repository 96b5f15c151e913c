"""Body weight on the feet: its size, its share on each foot and each part of the sole, and its shift in a bend."""

from math import copysign

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import boot
from solepath.emulate.sensors.insoles import LOAD_PER_COUNT, heel_array, layout
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.soles.heel_pad import HeelPad
from solepath.emulate.wearers.walker import Walker
from solepath.types import Cell, Foot, Layout, Site
from solepath.types.vector import GRAVITY
from solepath.wire.insole_info import parse_info

T = np.arange(0.0, 22.0, 0.002)


@pytest.fixture(scope="module")
def walker() -> Walker:
    return Walker(Route().stand(2.0).walk(20.0, 1.3).stop(2.0), seed=11)


def stance_times(walker: Walker, foot: Foot) -> list[tuple[float, float, float, float]]:
    """Return heel-strike, foot-flat, heel-off and toe-off, s, of every stance between two strides of a foot."""
    strides = walker.plan.strides[foot]
    return [(a.heel_strike, a.foot_flat, b.heel_off, b.toe_off) for a, b in zip(strides, strides[1:], strict=False)]


def test_standing_feet_bear_half_the_weight_each(walker: Walker) -> None:
    t = np.concatenate([np.linspace(0.1, 1.9, 20), walker.duration - np.linspace(0.1, 1.5, 20)])
    for foot in Foot:
        assert walker.loads.total(foot, t) == pytest.approx(0.5 * 75.0 * GRAVITY, rel=0.01)


def test_both_feet_together_bear_the_weight_over_every_step(walker: Walker) -> None:
    weight = 75.0 * GRAVITY
    together = walker.loads.total(Foot.LEFT, T) + walker.loads.total(Foot.RIGHT, T)
    assert together == pytest.approx(walker.loads.body(T), rel=1e-12)
    assert 0.7 * weight < together.min() and together.max() < 1.3 * weight
    for heel_strike, _, _, toe_off in stance_times(walker, Foot.LEFT)[1:-1]:
        whole = (heel_strike <= T) & (toe_off > T)
        assert together[whole].mean() == pytest.approx(weight, rel=0.06)
    assert together.mean() == pytest.approx(weight, rel=0.01)


def test_a_stance_has_two_humps_over_the_weight_and_a_trough_below(walker: Walker) -> None:
    weight = 75.0 * GRAVITY
    for heel_strike, _, _, toe_off in stance_times(walker, Foot.RIGHT)[1:-1]:
        load = walker.loads.total(Foot.RIGHT, np.linspace(heel_strike, toe_off, 101))
        first, trough, second = load[10:40].max(), load[40:60].min(), load[60:90].max()
        assert 1.05 * weight < first < 1.25 * weight
        assert 1.05 * weight < second < 1.25 * weight
        assert 0.7 * weight < trough < 0.9 * weight


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_shows_heel_strike_and_toe_off_within_a_sample(walker: Walker, foot: Foot) -> None:
    t = np.arange(0.0, walker.duration, 0.01)
    in_contact = walker.loads.total(foot, t) > 20.0
    rises, falls = t[1:][in_contact[1:] & ~in_contact[:-1]], t[1:][~in_contact[1:] & in_contact[:-1]]
    strides = walker.plan.strides[foot]
    assert len(rises) == len(falls) == len(strides)
    # Up to 10 ms until the next sample and a few until 20 N; starting and closing steps load and unload more slowly.
    late = rises - [s.heel_strike for s in strides]
    early = [s.toe_off for s in strides] - falls
    assert late.min() > 0.0 and late.max() <= 0.02 and np.median(late) < 0.013
    assert early.min() > -0.01 and early.max() <= 0.02 and np.median(np.abs(early)) < 0.01
    assert late[:-1].max() <= 0.0151 and early[1:].max() <= 0.01


@pytest.mark.parametrize("count", [24, 35, 96, 99])
@pytest.mark.parametrize("foot", list(Foot))
def test_the_cells_share_the_whole_load(walker: Walker, foot: Foot, count: int) -> None:
    shape = layout(count, foot)
    cells = walker.cell_loads(shape, T)
    assert cells.min() >= 0.0
    assert cells.sum(axis=1) == pytest.approx(walker.loads.total(foot, T), abs=1e-9)
    assert cells.max() < shape.full_scale


def rear_and_front_loads(walker: Walker, foot: Foot, t: Array) -> tuple[Array, Array]:
    """Return the loads on the rear third and on the front half of an insole of 96 cells, N."""
    shape = layout(96, foot)
    cells = walker.cell_loads(shape, t)
    x = np.array([cell.x for cell in shape.cells]) / shape.length
    return cells[:, x < 0.33].sum(axis=1), cells[:, x > 0.5].sum(axis=1)


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_goes_from_heel_to_forefoot_with_the_events(walker: Walker, foot: Foot) -> None:
    for heel_strike, foot_flat, heel_off, toe_off in stance_times(walker, foot):
        rear, front = rear_and_front_loads(walker, foot, np.linspace(heel_strike + 1e-6, foot_flat - 1e-6, 20))
        assert front.max() == 0.0 and rear.max() > 100.0
        rear, front = rear_and_front_loads(walker, foot, np.array([foot_flat + 0.02, heel_off - 0.02]))
        assert (rear > 10.0).all() and (front > 10.0).all()
        rear, front = rear_and_front_loads(walker, foot, np.linspace(heel_off + 1e-6, toe_off - 1e-6, 20))
        assert rear.max() == 0.0 and front.max() > 100.0


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
    assert left.scale == LOAD_PER_COUNT


def test_a_layout_of_too_many_or_too_few_cells_is_rejected() -> None:
    for count in (0, 7, 129):
        with pytest.raises(ValueError):
            layout(count, Foot.LEFT)


STRAIGHT = Route().stand(1.0).walk(6.0, 1.3).stop(1.0)


def bend(radius: float, speed: float = 1.1, wearer: Wearer | None = None) -> Walker:
    """Return a walker on 12 m of a bend, which is to the left when `radius` is positive."""
    return Walker(
        Route().stand(1.0).turn(copysign(12.0 / abs(radius), radius), abs(radius), speed).stop(2.0), wearer, seed=2
    )


def lateral_load_positions(walker: Walker, cells: Layout) -> Array:
    """Return the mean lateral position of the load in every stance of a full walk, m to the left."""
    y = np.array([cell.y for cell in cells.cells])
    found = []
    strides = walker.plan.strides[cells.foot]
    for one, two in zip(strides[2:-2], strides[3:-1], strict=True):
        loads = walker.cell_loads(cells, np.linspace(one.foot_flat, two.heel_off, 15))
        found.append(float((loads @ y / loads.sum(axis=1)).mean()))
    return np.array(found)


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_moves_to_the_outside_of_a_bend_and_more_in_a_tight_one(foot: Foot) -> None:
    cells = layout(99, foot)
    wide, tight = lateral_load_positions(bend(4.0), cells), lateral_load_positions(bend(2.0), cells)
    assert tight.max() < wide.min() < wide.max() < -0.005  # in a left turn to the right edge
    assert tight.mean() == pytest.approx(-0.015, abs=0.003)
    wide, tight = lateral_load_positions(bend(-4.0), cells), lateral_load_positions(bend(-2.0), cells)
    assert tight.min() > wide.max() > wide.min() > 0.005


@pytest.mark.parametrize("foot", list(Foot))
def test_leaning_changes_neither_the_weight_nor_where_it_is_along_the_foot(foot: Foot) -> None:
    walker, cells = bend(2.0), layout(96, foot)
    t = np.arange(0.0, walker.duration, 0.01)
    upright = evolve(
        walker.loads, lateral_shifts={foot: np.zeros_like(table) for foot, table in walker.loads.lateral_shifts.items()}
    )
    plain = upright.cells(cells, walker.wearer.shoe.width, walker.motions[foot], t)
    leaning = walker.cell_loads(cells, t)
    assert leaning.min() >= 0.0
    assert leaning.sum(axis=1) == pytest.approx(plain.sum(axis=1), abs=1e-9)
    x = np.array([cell.x for cell in cells.cells])
    in_contact = plain.sum(axis=1) > 10.0
    along, before = ((load[in_contact] @ x) / load[in_contact].sum(axis=1) for load in (leaning, plain))
    assert np.abs(along - before).max() < 0.012


def test_loads_of_a_straight_walk_are_bit_for_bit_those_of_one_who_never_leans() -> None:
    walker = Walker(STRAIGHT, seed=3)
    t = np.arange(0.0, walker.duration, 0.01)
    for foot in Foot:
        cells = layout(96, foot)
        assert not walker.loads.lateral_shifts[foot][:, 0].any()
        upright = evolve(walker.loads, lateral_shifts={foot: np.zeros_like(walker.loads.lateral_shifts[foot])})
        plain = upright.cells(cells, walker.wearer.shoe.width, walker.motions[foot], t)
        assert np.array_equal(walker.cell_loads(cells, t), plain)


def test_a_heel_array_has_its_cells_under_the_heel_and_a_range_of_140_kilopascal() -> None:
    for foot in Foot:
        cells = heel_array(foot)
        x, y = (np.array(axis) for axis in zip(*((cell.x, cell.y) for cell in cells.cells), strict=True))
        assert len(cells.cells) == 24
        assert x.max() - x.min() == pytest.approx(0.0823 * 5 / 6) and y.max() - y.min() == pytest.approx(0.0451 * 3 / 4)
        assert x.min() > 0.0 and x.max() < 0.33 * cells.length and y.mean() == pytest.approx(0.0)
        assert cells.full_scale / cells.cells[0].area == pytest.approx(140e3)
        assert sum(cell.area for cell in cells.cells) == pytest.approx(0.0823 * 0.0451)


@pytest.mark.parametrize("way", ["straight", "bend"])
def test_a_heel_array_bears_only_the_load_above_it(way: str) -> None:
    walker = Walker(STRAIGHT, seed=3) if way == "straight" else bend(2.0)
    foot = Foot.LEFT
    t = np.arange(0.0, walker.duration, 0.01)
    array, heel = walker.cell_loads(heel_array(foot), t).sum(axis=1), walker.loads.zone_shares(foot, t)[0]
    on_heel = heel * walker.loads.total(foot, t)
    assert (array <= on_heel + 1e-9).all()
    loaded = on_heel > 50.0
    share = array[loaded] / on_heel[loaded]
    assert share.min() > 0.5 and share.max() < 0.97
    assert array[on_heel == 0.0].max() == 0.0


def test_the_contour_of_a_heel_shrinks_as_the_load_goes_forward() -> None:
    walker = Walker(STRAIGHT, seed=3)
    cells = heel_array(Foot.LEFT)
    one, two = walker.plan.strides[Foot.LEFT][1:3]
    loads = walker.cell_loads(cells, np.linspace(one.foot_flat + 0.02, two.heel_off - 0.02, 10))
    above = (loads / cells.cells[0].area > 20e3).sum(axis=1)
    assert above[0] == 24 and above[-1] < 12 and (np.diff(above) <= 0).all()


def test_an_insole_with_a_layout_reports_it_in_info_and_fits_only_that_foot() -> None:
    walk = emulate(STRAIGHT, devices={Site.LEFT_FOOT: boot(Foot.LEFT)}, seed=3)
    info = parse_info(next(p.data for p in walk.packets if p.channel == "insole/info"))
    assert info.pressure_scale == pytest.approx(heel_array(Foot.LEFT).scale, rel=1e-6)
    assert [cell.x for cell in info.cells] == pytest.approx([c.x for c in heel_array(Foot.LEFT).cells], abs=1e-4)
    with pytest.raises(ValueError, match="left foot"):
        emulate(STRAIGHT, devices={Site.RIGHT_FOOT: boot(Foot.LEFT)}, seed=3)


def heel_patch(walker: Walker, t: Array) -> tuple[Array, Array]:
    """Return the length of the loaded part of a left heel and its middle, m, by many narrow cells along the foot."""
    cells = tuple(Cell(0.0005 + 0.001 * k, 0.0, 1e-6) for k in range(90))  # the midfoot begins at 91 mm
    loads = walker.cell_loads(Layout(90, Foot.LEFT, cells, 0.285), t)
    loaded = loads > 0.0
    return loaded.sum(axis=1) * 0.001, (loaded * np.array([cell.x for cell in cells])).sum(axis=1) / loaded.sum(axis=1)


def test_the_patch_under_a_heel_with_a_pad_grows_with_the_fourth_root_of_the_load_up_to_the_shoe() -> None:
    wearer = Wearer(pad=HeelPad(fore_aft_share=0.0, roll=0.0))
    walker, fixed = Walker(STRAIGHT, wearer, seed=3), Walker(STRAIGHT, seed=3)
    one, two = walker.plan.strides[Foot.LEFT][1:3]
    t = np.linspace(one.foot_flat + 0.02, two.heel_off - 0.04, 20)
    load = walker.loads.zone_shares(Foot.LEFT, t)[0] * walker.loads.total(Foot.LEFT, t) / walker.loads.weight
    length, _ = heel_patch(walker, t)
    half = 0.17 * 0.285  # m, of the zone, whose middle is as far from the heel's end
    spread = half * np.clip(load**0.25, 0.35, 1.0)
    assert length == pytest.approx(np.minimum(half + spread, 0.090) - (half - spread), abs=0.002)
    assert length[0] > 1.1 * length[-1]
    assert heel_patch(fixed, t)[0] == pytest.approx(0.090, abs=0.001)
    assert (walker.loads.total(Foot.LEFT, t) == fixed.loads.total(Foot.LEFT, t)).all()


@pytest.mark.parametrize("pad", [HeelPad(roll=0.0), HeelPad(fore_aft_share=0.0)], ids=["it yields", "it rolls"])
def test_the_patch_moves_by_millimetres_under_a_heel_at_rest(pad: HeelPad) -> None:
    walker = Walker(STRAIGHT, Wearer(pad=pad), seed=3)
    one, two = walker.plan.strides[Foot.LEFT][1:3]
    t = np.linspace(one.foot_flat + 0.15, two.heel_off - 0.04, 40)  # the patch lies within the cells from then on
    shift = walker.loads.pad_shift(Foot.LEFT, walker.loads.zone_shares(Foot.LEFT, t)[0], t)
    assert 0.0005 < np.ptp(shift) < 0.005
    assert np.abs(np.diff(shift) / np.diff(t)).max() > 0.004, "faster than the paper's threshold for a heel that moves"
    _, middle = heel_patch(walker, t)
    assert middle - middle[0] == pytest.approx(shift - shift[0], abs=0.0011)


def test_a_pad_of_half_the_stiffness_yields_twice_as_far() -> None:
    t = np.linspace(4.0, 6.0, 100)
    softer, stiffer = (
        Walker(STRAIGHT, Wearer(pad=HeelPad(shear_stiffness=stiffness, roll=0.0)), seed=3).loads
        for stiffness in (20e3, 40e3)
    )
    heel = softer.zone_shares(Foot.LEFT, t)[0]
    shift = stiffer.pad_shift(Foot.LEFT, heel, t)
    assert np.ptp(shift) > 0.001
    assert softer.pad_shift(Foot.LEFT, heel, t) == pytest.approx(2.0 * shift)


def test_a_foot_turns_in_its_stances_as_much_as_its_wearer_lets_it() -> None:
    for rest_pitch in (4e-4, 0.01):
        walker = Walker(STRAIGHT, Wearer(rest_pitch=rest_pitch), seed=3)
        stances = stance_times(walker, Foot.LEFT)[1:-1]
        pitches = [walker.motions[Foot.LEFT].pitch(np.linspace(flat, off, 50)) for _, flat, off, _ in stances]
        assert 0.5 * rest_pitch < np.abs(pitches).max() <= rest_pitch
