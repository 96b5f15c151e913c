"""Numbers and vectors as every room uses them."""

from __future__ import annotations

from math import copysign
from struct import pack, unpack

from hypothesis import given
from hypothesis import strategies as st

from solepath.types.vector import single


@given(st.floats(1e-37, 1e37), st.sampled_from([1.0, -1.0]))
def test_a_number_rounded_to_a_single_is_the_one_that_four_bytes_hold(x: float, sign: float) -> None:
    (held,) = unpack("<f", pack("<f", sign * x))
    assert single(sign * x) == held


def test_zero_stays_zero_as_it_is() -> None:
    assert single(0.0) == 0.0 and copysign(1.0, single(-0.0)) == copysign(1.0, -0.0)
