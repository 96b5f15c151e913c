"""Numbers that look random and are the same on every platform.

Each row has four numbers from -1 to 1, evenly filled (the additive recurrence of Roberts 2018 in four dimensions:
multiples of the powers of 1 / 1.16730..., the root of x^5 = x + 1, less their whole part). Consecutive rows from a
start that `next_random` chooses give all directions alike, and other ones each time."""

from __future__ import annotations

ROWS = 1021
"""Number of rows: a prime, so that no regular selection of rows repeats early."""

_STEPS = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101)


def _row(k: int) -> tuple[float, float, float, float]:
    a, b, c, d = (2.0 * ((0.5 + k * step) % 1.0) - 1.0 for step in _STEPS)
    return (a, b, c, d)


NOISE = tuple([_row(k) for k in range(ROWS)])


def next_random(state: int) -> int:
    """Return the next of 2^31 - 2 numbers (Park and Miller 1988)."""
    return state * 16807 % 2147483647
