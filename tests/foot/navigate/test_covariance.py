"""The straight-line covariance code gives the same results as the matrix form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.foot.navigate.covariance import (
    HEIGHT,
    Covariance,
    constrain_height,
    propagate,
    scale,
    squared_innovation,
    update,
)

BLOCKS = [(0, 0), (0, 3), (0, 6), (3, 3), (3, 6), (6, 6)]


def matrix_indices() -> list[tuple[int, int]]:
    """Return the matrix indices of the numbers of a Covariance, in order."""
    return [
        (row + i, column + j) for row, column in BLOCKS for i in range(3) for j in range(3) if row != column or j >= i
    ]


def to_covariance(matrix: np.ndarray) -> Covariance:
    return tuple(float(matrix[i, j]) for i, j in matrix_indices())


def to_matrix(covariance: Covariance) -> np.ndarray:
    matrix = np.zeros((9, 9))
    for value, (i, j) in zip(covariance, matrix_indices(), strict=True):
        matrix[i, j] = matrix[j, i] = value
    return matrix


def cross_matrix(v: np.ndarray) -> np.ndarray:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


@pytest.mark.parametrize("seed", range(2))
def test_propagation_is_f_p_ft_plus_q(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(9, 9))
    p, s, d, dt = root @ root.T, rng.normal(size=3), rng.normal(size=3), float(rng.uniform(0.001, 1))
    f = np.eye(9)
    f[:3, 3:6] = dt * np.eye(3)
    f[:3, 6:] = -cross_matrix(d)
    f[3:6, 6:] = -cross_matrix(s)
    q = np.diag([0.1] * 3 + [0.3] * 3 + [0.4] * 3)
    q[:3, 3:6] = q[3:6, :3] = 0.2 * np.eye(3)
    result = propagate(to_covariance(p), dt, tuple(s.tolist()), tuple(d.tolist()), 0.1, 0.2, 0.3, 0.4)
    np.testing.assert_allclose(to_matrix(result), f @ p @ f.T + q, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_the_velocity_update_is_the_kalman_update(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(9, 9))
    p, z, r = root @ root.T, rng.normal(size=3), 0.07
    h = np.zeros((3, 9))
    h[:, 3:6] = np.eye(3)
    innovation = h @ p @ h.T + r * np.eye(3)
    gain = p @ h.T @ np.linalg.inv(innovation)
    outcome = update(to_covariance(p), *z.tolist(), r, 1e9)
    assert outcome is not None
    np.testing.assert_allclose(to_matrix(outcome[0]), (np.eye(9) - gain @ h) @ p, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(outcome[1], gain @ z, rtol=1e-9, atol=1e-9)

    likelihood = float(z @ np.linalg.inv(innovation) @ z)
    assert update(to_covariance(p), *z.tolist(), r, likelihood * 0.999) is None
    assert update(to_covariance(p), *z.tolist(), r, likelihood * 1.001) is not None


@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0))
@settings(max_examples=30)
def test_a_height_known_from_elsewhere_leaves_a_covariance(seed: int, left: float) -> None:
    root = np.random.default_rng(seed).normal(size=(9, 9))
    p, d = root @ root.T, np.diag([1.0, 1.0, left**0.5, *[1.0] * 6])
    result = constrain_height(to_covariance(p), left)
    np.testing.assert_allclose(to_matrix(result), d @ p @ d, rtol=1e-9, atol=1e-12)
    assert result[HEIGHT] == pytest.approx(left * p[2, 2])


@pytest.mark.parametrize("seed", range(2))
def test_the_squared_innovation_is_that_of_the_matrix_form_and_of_the_gate(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(9, 9))
    covariance, innovation, r = to_covariance(root @ root.T), rng.normal(size=3), 0.1
    s = to_matrix(covariance)[3:6, 3:6] + r * np.eye(3)
    squared = squared_innovation(covariance, *innovation.tolist(), r)
    assert squared == pytest.approx(innovation @ np.linalg.solve(s, innovation))
    assert update(covariance, *innovation.tolist(), r, squared * 1.001) is not None
    assert update(covariance, *innovation.tolist(), r, squared * 0.999) is None
    assert to_matrix(scale(covariance, 3.0)) == pytest.approx(3.0 * to_matrix(covariance))
