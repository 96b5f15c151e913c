"""Sums over cells are rounded after each cell, and so the same on every Python; `sum` is not so from 3.12 on."""

from __future__ import annotations

from collections.abc import Iterable
from math import fsum
from operator import mul

from walks import insoles, of

from solepath import FootPressed, LayoutKnown, Session


def test_force_and_centre_of_pressure_are_sums_from_the_first_cell_to_the_last() -> None:
    session = Session(pressures=True)
    events = session.feed(insoles().packets)
    layouts = {event.layout.foot: event.layout for event in of(LayoutKnown, events)}
    differing = 0
    for event in of(FootPressed, events):
        assert event.force == rounded_sum(event.values)
        if event.centre is not None:
            for found, places in zip(event.centre, (layouts[event.foot].xs, layouts[event.foot].ys), strict=True):
                products = [*map(mul, places, event.values)]
                assert found == rounded_sum(products) / event.force
                differing += found != fsum(products) / event.force
    assert differing > 10, "this walk shows the difference"


def rounded_sum(values: Iterable[float]) -> float:
    """Return the sum rounded after each value, as `sum` gives it before Python 3.12."""
    total = 0.0
    for value in values:
        total += value
    return total
