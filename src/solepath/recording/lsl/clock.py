"""Difference between the clock of a session and that of the lab streaming layer."""

from __future__ import annotations

from collections.abc import Callable

from pylsl import local_clock

READINGS = 20
"""Number of readings of both clocks, of which the one that took least time counts; each takes some microseconds."""


def clock_offset(clock: Callable[[], float]) -> float:
    """Return the time to add to a time of `clock`, s, so that it is one of the lab streaming layer's local clock.

    For live sensors `clock` is that of the packets' arrivals, the `time` of the event loop. The error is at most half
    of the time that one reading of both clocks took."""
    best, offset = float("inf"), 0.0
    for _ in range(READINGS):
        before = clock()
        there = local_clock()
        after = clock()
        if after - before < best:
            best, offset = after - before, there - 0.5 * (before + after)
    return offset
