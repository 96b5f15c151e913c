"""The stored swing of a clipped gyroscope stays short, and keeps its whole duration."""

from __future__ import annotations

from math import fsum

import pytest

from solepath.foot.navigate.clipping import MOST_ROWS, SwingSamples
from solepath.types.vector import IDENTITY


@pytest.mark.parametrize("count", [MOST_ROWS - 1, MOST_ROWS, MOST_ROWS + 1, 5 * MOST_ROWS])
def test_a_swing_of_any_number_of_samples_is_kept_in_few_rows_that_last_as_long(count: int) -> None:
    swing = SwingSamples()
    for k in range(count):
        swing.add_sample(0.0025, (0.0, 8.0 + 0.01 * k, 0.0), (0.0, 8.0, 0.0), (0.0, 0.0, 9.8), IDENTITY)
    assert len(swing.rows) <= MOST_ROWS
    assert fsum(row[0] for row in swing.rows) == pytest.approx(0.0025 * count)
