"""How much of a stride with a gap is corrected towards the wearer's usual stride."""

from __future__ import annotations

from math import pi, sqrt

import pytest

from solepath.foot.template import STRAIGHT_SHARE, correction_share


def test_a_usual_stride_is_corrected_by_the_gain_of_the_filter_times_the_probability_that_it_is_usual() -> None:
    gap_sigma, sigma, span = 0.3, 0.1, 2.0
    usual = STRAIGHT_SHARE / sqrt(2.0 * pi * (gap_sigma**2 + sigma**2))
    probability = usual / (usual + (1.0 - STRAIGHT_SHARE) / span)
    gain = gap_sigma**2 / (gap_sigma**2 + sigma**2)
    assert correction_share(0.0, gap_sigma, sigma, span, 1) == pytest.approx(gain * probability)


def test_the_further_a_stride_is_from_usual_the_less_is_corrected() -> None:
    shares = [correction_share(square, 0.3, 0.1, 2.0, 2) for square in (0.0, 0.1, 0.5, 2.0)]
    assert shares == sorted(shares, reverse=True) and shares[0] > 0.5 and shares[-1] < 1e-3
