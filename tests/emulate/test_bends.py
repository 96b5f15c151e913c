"""In a bend the load moves to the outside under both feet, more the tighter it is; a straight walk is as it was."""

from hashlib import sha256
from math import copysign, radians

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole, boot
from solepath.emulate.sensors.insoles import heel_array, layout
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.gait import SETTLING, Wearer
from solepath.emulate.wearers.load import TAKEN
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Layout, Site
from solepath.types.vector import GRAVITY
from solepath.wire.insole_info import parse_info

STRAIGHT = Route().stand(1.0).walk(6.0, 1.3).stop(1.0)


def bend(radius: float, speed: float = 1.1, wearer: Wearer | None = None) -> Walker:
    """12 m around a bend, to the left when `radius` is positive."""
    return Walker(
        Route().stand(1.0).turn(copysign(12.0 / abs(radius), radius), abs(radius), speed).stop(2.0), wearer, seed=2
    )


def places(walker: Walker, cells: Layout) -> Array:
    """Mean place of the load across a foot, of every stance in full walk, m to the left."""
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
    wide, tight = places(bend(4.0), cells), places(bend(2.0), cells)
    assert tight.max() < wide.min() < wide.max() < -0.005  # in a left turn to the right edge
    assert tight.mean() == pytest.approx(-0.015, abs=0.003)
    wide, tight = places(bend(-4.0), cells), places(bend(-2.0), cells)
    assert tight.min() > wide.max() > wide.min() > 0.005


@pytest.mark.parametrize("foot", list(Foot))
def test_the_load_moves_by_the_stated_share_of_the_inclination(foot: Foot) -> None:
    walker = bend(8.0)  # a little, so that no edge is in the way
    stride = walker.plan.strides[foot][5]
    asked = -TAKEN * walker.wearer.centre_height * stride.pace**2 / (8.0 * GRAVITY)
    assert stride.pace == pytest.approx(1.1, rel=0.08) and stride.curvature == pytest.approx(1 / 8)
    assert walker.loads.lean(foot, np.array([stride.foot_flat]))[0] == pytest.approx(asked)
    straight = Walker(Route().stand(1.0).walk(12.0, 1.1).stop(2.0), seed=2)
    cells = layout(128, foot)
    moved = places(walker, cells).mean() - places(straight, cells).mean()
    assert moved == pytest.approx(asked, rel=0.15)


@pytest.mark.parametrize("foot", list(Foot))
def test_leaning_changes_neither_the_weight_nor_where_it_is_along_the_foot(foot: Foot) -> None:
    walker, cells = bend(2.0), layout(96, foot)
    t = np.arange(0.0, walker.duration, 0.01)
    upright = evolve(walker.loads, leans={foot: np.zeros_like(table) for foot, table in walker.loads.leans.items()})
    plain = upright.cells(cells, walker.wearer.shoe.width, walker.motions[foot], t)
    leaning = walker.cell_loads(cells, t)
    assert leaning.min() >= 0.0
    assert leaning.sum(axis=1) == pytest.approx(plain.sum(axis=1), abs=1e-9)
    x = np.array([cell.x for cell in cells.cells])
    on = plain.sum(axis=1) > 10.0
    along, before = ((load[on] @ x) / load[on].sum(axis=1) for load in (leaning, plain))
    assert np.abs(along - before).max() < 0.012


def test_who_stands_after_a_bend_stands_upright() -> None:
    walker = bend(2.0)
    for foot in Foot:
        last = max(s.heel_strike for f in Foot for s in walker.plan.strides[f])
        t = np.linspace(last + SETTLING + 1e-6, walker.duration, 10)
        assert (walker.loads.lean(foot, t) == 0.0).all()
        early = walker.loads.lean(foot, np.linspace(0.0, 0.9, 5))
        assert (early == 0.0).all()


def test_the_lean_needs_speed() -> None:
    slow, fast = (bend(2.0, speed).loads.lean(Foot.LEFT, np.array([5.0]))[0] for speed in (0.7, 1.2))
    assert fast / slow == pytest.approx((1.2 / 0.7) ** 2, rel=0.2)


def test_loads_of_a_straight_walk_are_bit_for_bit_those_of_one_who_never_leans() -> None:
    walker = Walker(STRAIGHT, seed=3)
    t = np.arange(0.0, walker.duration, 0.01)
    for foot in Foot:
        cells = layout(96, foot)
        assert not walker.loads.leans[foot][:, 0].any()
        upright = evolve(walker.loads, leans={foot: np.zeros_like(walker.loads.leans[foot])})
        plain = upright.cells(cells, walker.wearer.shoe.width, walker.motions[foot], t)
        assert np.array_equal(walker.cell_loads(cells, t), plain)


def test_steps_differ_in_where_they_press_when_the_wearer_is_said_to() -> None:
    wearer = Wearer(load_variation=0.003)
    walker = Walker(Route().stand(1.0).walk(60.0, 1.2).stop(1.0), wearer, seed=4)
    assert places(walker, layout(99, Foot.LEFT)).std() == pytest.approx(0.003, rel=0.35)
    assert Walker(walker.route, wearer, seed=4).loads.leans[Foot.LEFT].tolist() == (
        walker.loads.leans[Foot.LEFT].tolist()
    )


PINNED = {
    "insoles": "6ad48412cbcc602c8524e7f6d52a266bd8301774f0aa95bb1cc38ad8273b77df",
    "insoles of all kinds": "e282c8097f75dd32073d97f9a532cbeb20aa6391eb8b221a47dba3b83c658400",
    "tags": "5c850a91b7cb5e0c24423e1f4bcaa0df9f96cd7462aadbaab6f37f956fca9af1",
}
"""What the bytes of STRAIGHT were before anybody leaned."""


def test_the_bytes_of_a_straight_walk_are_what_they_were() -> None:
    left, right = Site.LEFT_FOOT, Site.RIGHT_FOOT
    worn = {
        "insoles": {left: Insole(), right: Insole()},
        "insoles of all kinds": {left: Insole(cells=24, rate=50, quaternion=True), right: Insole(cells=35, batch=4)},
        "tags": {left: CC2650(), right: CC2541()},
    }
    for name, devices in worn.items():
        packets = emulate(STRAIGHT, devices=devices, seed=3).packets
        assert sha256(b"".join(packet.data for packet in packets)).hexdigest() == PINNED[name], name


def test_a_heel_array_has_its_cells_under_the_heel_and_a_range_of_140_kilopascal() -> None:
    for foot in Foot:
        cells = heel_array(foot)
        x, y = (np.array(axis) for axis in zip(*((cell.x, cell.y) for cell in cells.cells), strict=True))
        assert len(cells.cells) == 24
        assert x.max() - x.min() == pytest.approx(0.0823 * 5 / 6) and y.max() - y.min() == pytest.approx(0.0451 * 3 / 4)
        assert x.min() > 0.0 and x.max() < 0.33 * cells.length and y.mean() == pytest.approx(0.0)
        assert cells.full_scale / cells.cells[0].area == pytest.approx(140e3)
        assert sum(cell.area for cell in cells.cells) == pytest.approx(0.0823 * 0.0451)


@pytest.mark.parametrize("walker", [Walker(STRAIGHT, seed=3), bend(2.0)], ids=["straight", "bend"])
def test_a_heel_array_bears_what_lies_over_it_and_no_more(walker: Walker) -> None:
    foot = Foot.LEFT
    t = np.arange(0.0, walker.duration, 0.01)
    array, heel = walker.cell_loads(heel_array(foot), t).sum(axis=1), walker.loads.shares(foot, t)[0]
    on_heel = heel * walker.loads.total(foot, t)
    assert (array <= on_heel + 1e-9).all()
    struck = on_heel > 50.0
    share = array[struck] / on_heel[struck]
    assert share.min() > 0.5 and share.max() < 0.97
    assert array[on_heel == 0.0].max() == 0.0


def test_the_contour_of_a_heel_shrinks_as_the_load_goes_forward() -> None:
    walker = Walker(STRAIGHT, seed=3)
    cells = heel_array(Foot.LEFT)
    one, two = walker.plan.strides[Foot.LEFT][1:3]
    loads = walker.cell_loads(cells, np.linspace(one.foot_flat + 0.02, two.heel_off - 0.02, 10))
    above = (loads / cells.cells[0].area > 20e3).sum(axis=1)
    assert above[0] == 24 and above[-1] < 12 and (np.diff(above) <= 0).all()


def test_an_insole_with_a_layout_says_it_in_its_info_and_is_worn_on_that_foot_alone() -> None:
    walk = emulate(STRAIGHT, devices={Site.LEFT_FOOT: boot(Foot.LEFT)}, seed=3)
    info = parse_info(next(p.data for p in walk.packets if p.channel == "insole/info"))
    assert info.pressure_scale == pytest.approx(heel_array(Foot.LEFT).scale, rel=1e-6)
    assert [cell.x for cell in info.cells] == pytest.approx([c.x for c in heel_array(Foot.LEFT).cells], abs=1e-4)
    with pytest.raises(ValueError, match="left foot"):
        emulate(STRAIGHT, devices={Site.RIGHT_FOOT: boot(Foot.LEFT)}, seed=3)


def test_a_bend_is_a_turn_of_the_route_and_a_pivot_is_none() -> None:
    walker = Walker(Route().stand(1.0).walk(3.0, 1.2).turn(radians(90), 2.0).walk(3.0).turn(radians(90)).stop(1.0))
    curvatures = {round(s.curvature, 6) for foot in Foot for s in walker.plan.strides[foot]}
    assert curvatures == {0.0, 0.5}
