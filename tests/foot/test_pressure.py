"""Loads of the cells: tare, share of the full load, centre of pressure; and the estimated layout."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st
from one_foot import SOLE, TARE, above
from walks import LEFT, SHORT, insoles, of, samples

from solepath import Foot, FootFlat, HeelOff, HeelStrike, Layout, Sample, Session, StrideTaken, ToeOff
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.wearers.walker import Walker
from solepath.foot.pressure.insole import HIGHEST_DECAY, Extremes, InsoleLoads
from solepath.foot.pressure.layout_guess import LayoutGuess
from solepath.foot.stance.pressure import MaximumPressure, TwoArea
from solepath.foot.stance.stance import Load, Stance
from solepath.types import Phase


def used_insole(*frames: tuple[float, ...]) -> InsoleLoads:
    """Return an insole after some frames at 100 Hz."""
    insole = InsoleLoads()
    insole.set_layout(SOLE)
    for k, cells in enumerate(frames):
        insole.update(0.01 * k, cells)
    return insole


STRIDE_LOADS = (above(100, 100, 50, 150), above(0, 0, 0, 200), TARE, above(30, 30, 0, 0), above(100, 100, 50, 150))
"""Loads on the whole sole (400), on the forefoot, in the air, on the heel, on the whole sole again."""


def test_nothing_is_known_until_the_load_has_fallen_and_risen_again() -> None:
    insole = used_insole()
    loads = [insole.update(0.01 * k, cells) for k, cells in enumerate(STRIDE_LOADS)]
    assert [load is None for load in loads] == [True, True, True, True, False]


def test_a_load_that_only_falls_is_not_a_foot_in_the_air() -> None:
    """The weight moves to the other foot before the first step: the lowest load is then still a load."""
    insole = used_insole()
    for k in range(60):
        share = 1.0 - 0.01 * k
        assert insole.update(0.01 * k, above(*(share * part for part in (100, 100, 50, 150)))) is None


def test_the_load_is_a_share_of_the_wearers_own() -> None:
    insole = used_insole(*STRIDE_LOADS)
    full = insole.update(0.05, above(100, 100, 50, 150))
    half = insole.update(0.06, above(50, 50, 25, 75))
    air = insole.update(0.07, TARE)
    assert (full.total, half.total, air.total) == pytest.approx((1.0, 0.5, 0.0))
    assert (full.airborne, half.airborne, air.airborne) == (False, False, True)
    assert full.heel == pytest.approx(200 / 400) and full.forefoot == pytest.approx(150 / 400)
    assert half.heel == pytest.approx(0.25) and air.heel == air.forefoot == 0.0


def test_newtons_and_counts_serve_alike() -> None:
    insole_in_newtons, other = (
        used_insole(*STRIDE_LOADS),
        used_insole(*(tuple(4.7 * value for value in cells) for cells in STRIDE_LOADS)),
    )
    a, b = (
        insole_in_newtons.update(0.05, above(40, 10, 5, 60)),
        other.update(0.05, tuple(4.7 * v for v in above(40, 10, 5, 60))),
    )
    assert a is not None and b is not None
    assert b.cells == pytest.approx([4.7 * value for value in a.cells])
    assert (b.total, b.heel, b.forefoot) == pytest.approx((a.total, a.heel, a.forefoot))
    assert (b.airborne, b.centre) == (a.airborne, pytest.approx(a.centre))


def test_the_tare_is_what_the_cells_show_in_the_air() -> None:
    insole = used_insole(*STRIDE_LOADS, above(0, 0, 0, 60), TARE, above(90, 90, 20, 100))
    assert insole.centre_of_pressure(above(0, 0, 50, 0)) == pytest.approx((0.13, 0.0))
    assert insole.centre_of_pressure(TARE) is None


def test_the_centre_of_pressure_is_the_mean_place_of_the_load_above_tare() -> None:
    insole = used_insole(*STRIDE_LOADS, above(0, 0, 0, 60), TARE, above(90, 90, 20, 100))
    assert insole.centre_of_pressure(above(100, 0, 0, 0)) == pytest.approx((0.05, 0.01))
    assert insole.centre_of_pressure(above(50, 50, 0, 100)) == pytest.approx((0.125, 0.01))
    assert insole.centre_of_pressure(above(10, 10, 20, 40)) == pytest.approx(
        ((0.05 * 20 + 0.13 * 20 + 0.20 * 40) / 80, 0.02 * 40 / 80)
    )
    assert insole.centre_of_pressure(TARE) is None


def test_without_a_layout_there_is_a_load_but_no_place() -> None:
    insole = InsoleLoads()
    for k, cells in enumerate(STRIDE_LOADS):
        insole.update(0.01 * k, cells)
    load = insole.update(0.05, above(50, 50, 25, 75))
    assert load.total == pytest.approx(0.5) and load.heel is None and load.forefoot is None
    assert insole.centre_of_pressure(above(50, 50, 25, 75)) is None


def test_cells_that_do_not_match_the_layout_have_no_place_either() -> None:
    insole = used_insole(*STRIDE_LOADS)
    assert insole.update(0.05, (100.0, 200.0)).heel is None
    assert insole.centre_of_pressure((100.0, 200.0)) is None


def test_extremes_are_those_of_the_last_ten_seconds() -> None:
    extremes = Extremes()
    for k in range(2000):
        extremes.update(0.01 * k, 1000.0 if k == 100 else -5.0 if k == 150 else float(k % 7))
        if k == 900:
            assert (extremes.low, extremes.high) == (-5.0, 1000.0)
    assert (extremes.low, extremes.high) == (0.0, 6.0)
    assert len(extremes.lows) == 5


def test_an_insole_without_an_inertial_sensor_still_gives_the_phases() -> None:
    walker = Walker(Route().stand(1.0).walk(12.0, 1.3).stop(1.0), seed=2)
    shape = layout(96, Foot.LEFT)
    session = Session()
    events = session.feed(insoles(SHORT).packets[:1])  # INFO, so that the layout is known
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
    events = of(StrideTaken, Session().feed(insoles(SHORT).packets))
    paths = [stride.features.cop for stride in events[2:-2]]
    assert all(8 <= len(path) <= 32 for path in paths)
    for path in paths:
        assert path[0][0] < 0.09 and max(x for x, _ in path) > 0.20
        rising = [b[0] > a[0] - 0.003 for a, b in pairwise(path[:-3])]  # hardly any load is left at the very end
        assert all(rising)
        assert all(0.0 < x < 0.285 and abs(y) < 0.05 for x, y in path)
    assert all(stride.features.contact_load > 200.0 for stride in events[2:-2])


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


def test_a_standing_foot_gives_no_layout() -> None:
    guess = LayoutGuess(Foot.RIGHT)
    assert all(guess.update(0.01 * k, (5.0, 7.0, 3.0), 0.9) is None for k in range(1000))


@given(
    st.lists(
        st.tuples(
            st.floats(0.05, 0.5),
            st.lists(st.floats(0.0, 1e6), min_size=1, max_size=4),
            st.sampled_from([0.0, 1.0]) | st.floats(0.0, 1.0),
        ),
        max_size=200,
    )
)
def test_any_loads_of_any_number_of_cells_are_borne(rows: list[tuple[float, list[float], float]]) -> None:
    guess, t = LayoutGuess(Foot.LEFT), 0.0
    for dt, cells, share in rows:
        t += dt
        estimate = guess.update(t, tuple(cells), share)
        if estimate is not None:
            assert all(0.0 <= cell.x <= estimate.length for cell in estimate.cells)


ACC_REST, GYRO_REST = (0.0, 0.0, 9.81), (0.0, 0.0, 0.0)


def test_two_loaded_areas_are_a_flat_foot() -> None:
    def evidence(heel: float | None, forefoot: float | None, airborne: bool = False) -> Stance:
        return TwoArea().update(0.0, 0.01, ACC_REST, GYRO_REST, Load(0.5, heel, forefoot, airborne))

    assert evidence(0.3, 0.2) == Stance((0.0, 0.0, 0.0), 0.01, 0.2, Phase.STATIONARY)
    assert evidence(0.05, 0.9).hint is Phase.STATIONARY
    assert evidence(0.049, 0.9).sigma == inf and evidence(0.9, 0.0).sigma == inf
    assert evidence(0.0, 0.0, airborne=True).hint is Phase.SWING
    assert evidence(None, None).sigma == inf


def test_a_heavily_loaded_cell_is_a_foot_on_the_ground() -> None:
    def evidence(share: float, airborne: bool = False) -> Stance:
        detector = MaximumPressure()
        detector.update(0.0, 0.01, ACC_REST, GYRO_REST, Load(1.0, None, None, False, (4.0, 80.0 / HIGHEST_DECAY)))
        load = Load(0.5, None, None, airborne, (80.0 * share, 3.0))
        return detector.update(0.01, 0.01, ACC_REST, GYRO_REST, load)

    assert evidence(0.26).sigma == 0.05 and evidence(0.26).statistic == 0.26
    assert evidence(0.25).sigma == inf
    assert evidence(0.9, airborne=True) == Stance((0.0, 0.0, 0.0), inf, 0.9, Phase.SWING)
