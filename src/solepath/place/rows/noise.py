"""Quasi-random numbers that are equal on every platform.

Each entry of the table has four numbers, evenly distributed from -1 to 1: the additive recurrence of Roberts 2018 in
four dimensions. They are fractional parts of multiples of the powers of 1 / 1.16730..., where 1.16730... is the root of
x^5 = x + 1. Consecutive entries cover all directions evenly; `next_random` chooses the first one."""

from __future__ import annotations

NOISE_ENTRIES = 1021
"""Number of entries: a prime, so that no regular selection of entries repeats early."""

_STEPS = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101)


def _entry(k: int) -> tuple[float, float, float, float]:
    a, b, c, d = (2.0 * ((0.5 + k * step) % 1.0) - 1.0 for step in _STEPS)
    return (a, b, c, d)


NOISE_TABLE = tuple([_entry(k) for k in range(NOISE_ENTRIES)])
"""Table of quasi-random numbers; each entry has four numbers from -1 to 1."""


def next_random(state: int) -> int:
    """Return the next of 2^31 - 2 pseudo-random numbers (Park and Miller 1988)."""
    return state * 16807 % 2147483647
