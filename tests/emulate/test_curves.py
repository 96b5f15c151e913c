"""The polynomials that motions are made of."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.emulate.wearers.curves import BUMP, DEGREE, EVEN_OUT, constant, evaluate, join, part

values = st.floats(-10.0, 10.0)
ends = st.tuples(values, values, values)


@settings(deadline=None)
@given(ends, ends, st.floats(0.05, 2.0))
def test_a_join_has_the_value_velocity_and_acceleration_asked_for_at_both_ends(
    start: tuple[float, float, float], end: tuple[float, float, float], duration: float
) -> None:
    curve = join(start, end, duration)
    for s, wanted in ((0.0, start), (1.0, end)):
        found = [float(evaluate(curve, s, order)) / duration**order for order in range(3)]
        assert found == pytest.approx(wanted, abs=1e-6, rel=1e-6)


@settings(deadline=None)
@given(st.lists(values, min_size=DEGREE + 1, max_size=DEGREE + 1), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_a_part_of_a_curve_is_the_curve(factors: list[float], start: float, end: float) -> None:
    curve, s = np.array(factors), np.linspace(0.0, 1.0, 7)
    assert evaluate(part(curve, start, end), s) == pytest.approx(evaluate(curve, start + (end - start) * s), abs=1e-6)


@settings(deadline=None)
@given(st.lists(values, min_size=DEGREE + 1, max_size=DEGREE + 1))
def test_values_and_slopes_are_those_of_numpy(factors: list[float]) -> None:
    curve, s = np.array(factors), np.linspace(-0.5, 1.5, 9)
    for order in range(3):
        expected = np.polynomial.Polynomial(curve).deriv(order)(s) if order else np.polynomial.Polynomial(curve)(s)
        assert evaluate(curve, s, order) == pytest.approx(expected, abs=1e-6, rel=1e-9)


@pytest.mark.parametrize("shape", [BUMP, EVEN_OUT])
def test_what_is_added_in_between_changes_nothing_at_the_ends(shape: np.ndarray) -> None:
    for s in (0.0, 1.0):
        assert [float(evaluate(shape, s, order)) for order in range(3)] == pytest.approx([0.0] * 3, abs=1e-9)
    assert float(evaluate(BUMP, 0.5)) == pytest.approx(1.0)
    assert evaluate(constant(3.5), np.array([0.1, 0.9])).tolist() == [3.5, 3.5]
