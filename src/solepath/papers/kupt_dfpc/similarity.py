"""Similarity of two strides (9), the coefficient of their lengths (11), and what both are computed from."""

from __future__ import annotations

from math import fsum, isfinite, sqrt

from ...events import StrideTaken

POINTS = 64
"""Number of instants at which two strides are compared."""
LEAST_LENGTH = 1e-6
"""Length below which a stride has no direction, m."""
LEAST_SPREAD = 1e-12
"""Sum of squared deviations, m^2, below which a path of the centre of pressure counts as constant."""


def resample_cop(taken: StrideTaken, foot_centre: float) -> tuple[float, ...]:
    """Return the centre of pressure along the foot (copY of (9)), m, at POINTS instants evenly spaced in time.

    Strides have unequal numbers of samples, but (9) needs equal numbers. So each stride is resampled from foot-flat to
    heel-strike. Until toe-off the values are those of `StrideFeatures.cop`, then they are `foot_centre`. The phase
    after heel-strike is left out. The result is empty for a stride without a path or a toe-off."""
    cop, start, toe_off = taken.features.cop, taken.t_start, taken.t_toe_off
    end = taken.t_end if taken.t_heel_strike is None else taken.t_heel_strike
    if not cop or toe_off is None or not start <= toe_off <= end or not end > start:
        return ()
    cop_x = [x for x, _ in cop]
    last = len(cop_x) - 1
    path = []
    for k in range(POINTS):
        t = start + (k + 0.5) / POINTS * (end - start)
        if t >= toe_off:
            path.append(foot_centre)
            continue
        index = (t - start) / (toe_off - start) * last
        i = min(int(index), last)
        next_x = cop_x[min(i + 1, last)]
        path.append(cop_x[i] + (index - i) * (next_x - cop_x[i]))
    return tuple(path)


def correlation(one: tuple[float, ...], other: tuple[float, ...]) -> float | None:
    """Return the similarity r (9) of two paths with equal numbers of points, 0 to 1.

    It is None if one path is constant or empty."""
    n = len(one)
    if n == 0 or n != len(other):
        return None
    one_mean, other_mean = fsum(one) / n, fsum(other) / n
    xs = [x - one_mean for x in one]
    ys = [y - other_mean for y in other]
    xx, yy = fsum([x * x for x in xs]), fsum([y * y for y in ys])
    if not (xx > LEAST_SPREAD and yy > LEAST_SPREAD):
        return None
    r = abs(fsum([x * y for x, y in zip(xs, ys, strict=True)])) / (sqrt(xx) * sqrt(yy))
    return min(r, 1.0) if isfinite(r) else None


def own_share(similarity: float | None, own_index: float, other_index: float) -> float:
    """Return the coefficient (11), Calicoef: the weight of a stride's own length in its calibrated length, 0 to 1."""
    if similarity is None or similarity <= 0.0:
        return 1.0
    sum_of_errors = other_index + similarity * own_index
    if sum_of_errors <= 0.0:
        return 1.0 / (1.0 + similarity)
    return other_index / sum_of_errors


def length_sigma(taken: StrideTaken) -> float:
    """Return the standard deviation of a stride's length, m."""
    xx, xy, _, yy, _, _ = taken.covariance
    (dx, dy, _), length = taken.displacement, taken.length
    if length <= LEAST_LENGTH:
        return sqrt(max(0.5 * (xx + yy), 0.0))
    return sqrt(max(dx * dx * xx + 2.0 * dx * dy * xy + dy * dy * yy, 0.0)) / length


def valid_index(index: float | None) -> float | None:
    """Return an error index, m/s; None if it is negative or not finite."""
    return None if index is None or not isfinite(index) or index < 0.0 else index
