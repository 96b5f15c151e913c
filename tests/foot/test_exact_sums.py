"""Sums are exact, and so the same on every Python: that of `sum` is rounded otherwise before Python 3.12."""

from __future__ import annotations

from math import fsum
from operator import mul

from walks import insoles, of

from solepath import FootPressed, LayoutKnown, Session


def test_force_and_centre_of_pressure_are_exact_sums() -> None:
    session = Session(pressures=True)
    events = session.feed(insoles().packets)
    layouts = {event.layout.foot: event.layout for event in of(LayoutKnown, events)}
    differing = 0
    for event in of(FootPressed, events):
        assert event.force == fsum(event.values)
        if event.centre is not None:
            for found, places in zip(event.centre, (layouts[event.foot].xs, layouts[event.foot].ys), strict=True):
                products = [*map(mul, places, event.values)]
                assert found == fsum(products) / event.force
                differing += found != rounded_sum(products) / event.force
    assert differing > 10, "this walk shows the difference"


def rounded_sum(values: list[float]) -> float:
    """Return the sum rounded after each value, as `sum` does before Python 3.12."""
    total = 0.0
    for value in values:
        total += value
    return total
