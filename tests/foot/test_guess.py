"""Where cells are, learnt from how steps load them."""

from __future__ import annotations

from functools import cache

from attrs import evolve
from hypothesis import given
from hypothesis import strategies as st
from walks import samples

from solepath import Foot, Layout
from solepath.emulate.sensors.insoles import layout
from solepath.foot.pressure.guess import LayoutGuess
from solepath.foot.pressure.insole import InsoleLoads


@cache
def guessed(cells: int) -> Layout | None:
    """What is made of the left insole of a short walk that does not say where its cells are."""
    insole, guess = InsoleLoads(), LayoutGuess(Foot.LEFT)
    for sample in samples(cells=cells):
        if sample.site.foot is Foot.LEFT and sample.pressure:
            load = insole.update(sample.t, sample.pressure)
            found = None if load is None else guess.update(sample.t, insole.above_tare(load.cells), load.total)
            if found is not None:
                return found
    return None


def test_heel_and_forefoot_are_told_apart_after_two_stances() -> None:
    for cells in (24, 96):
        true, found = layout(cells, Foot.LEFT), guessed(cells)
        assert found is not None
        told = 0
        for cell, learnt in zip(true.cells, found.cells, strict=True):
            if learnt.x == 0.5 * found.length:
                continue  # it never carries load
            if cell.x < 0.25 * true.length:
                assert learnt.x < 0.45 * found.length, cell
            if cell.x > 0.75 * true.length:
                assert learnt.x > 0.55 * found.length, cell
            told += 1
        assert told > 0.7 * cells


def test_a_foot_that_stands_says_nothing_of_its_cells() -> None:
    guess = LayoutGuess(Foot.RIGHT)
    assert all(guess.update(0.01 * k, (5.0, 7.0, 3.0), 0.9) is None for k in range(1000))


@given(
    st.lists(
        st.tuples(
            st.floats(0.001, 0.5),
            st.lists(st.floats(0.0, 1e6), min_size=1, max_size=4),
            st.floats(0.0, 1.0),
        ),
        max_size=200,
    )
)
def test_any_loads_of_any_number_of_cells_are_borne(rows: list[tuple[float, list[float], float]]) -> None:
    guess, t = evolve(LayoutGuess(Foot.LEFT), stances=1, shortest=0.0), 0.0
    for dt, cells, share in rows:
        t += dt
        found = guess.update(t, tuple(cells), share)
        if found is not None:
            assert all(0.0 <= cell.x <= found.length for cell in found.cells)
