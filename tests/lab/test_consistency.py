"""The statistic of the covariance is that of its definition, whatever the first heading of the track."""

from __future__ import annotations

import numpy as np
import pytest

from solepath_lab.measures.consistency import SURVEY_ERROR, consistency, consistency_at_end


def test_errors_as_large_as_their_covariance_have_a_mean_of_1_and_a_median_of_069() -> None:
    rng = np.random.default_rng(1)
    covariance = np.array([[4.0, 1.5], [1.5, 1.0]])
    found = [consistency(error, covariance) for error in rng.multivariate_normal((0.0, 0.0), covariance, 4000)]
    nees, held = np.array(found).T
    assert np.mean(nees) == pytest.approx(1.0, abs=0.05)
    assert np.median(nees) == pytest.approx(np.log(2.0), abs=0.05)
    assert np.mean(held) == pytest.approx(0.95, abs=0.01)


@pytest.mark.parametrize("heading", [0.0, -2.5])
def test_the_first_metres_align_the_track_and_their_error_counts(heading: float) -> None:
    """A straight walk of 40 m whose error at 10 m and at the end is that of its covariance."""
    rng = np.random.default_rng(2)
    surveyed = np.array([[float(x), 0.0] for x in range(41)])
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s], [s, c]])
    found = []
    for _ in range(1000):
        places = surveyed.copy()
        places[10:, 1] += rng.normal(0.0, 0.1)
        places[40, 1] += rng.normal(0.0, 0.5)
        places[40, 0] += rng.normal(0.0, 0.2)
        local = [np.diag([0.04, 0.26]) if k == 40 else np.diag([0.01, 0.01 - 2.0 * SURVEY_ERROR**2]) for k in range(41)]
        covariances = np.array([[p[0, 0], p[0, 1], p[1, 1]] for p in (turn @ one @ turn.T for one in local)])
        found.append(consistency_at_end(places @ turn.T, covariances, surveyed)["nees_end"])
    # the error at 10 m moves the end by 40 m / 10 m - 1 of it: less than both counted as independent
    assert 0.8 < np.mean(found) < 1.05
