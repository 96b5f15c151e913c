"""What `solepath demo` walks: a route of its own, straight on, or a way through the emulated building; a bad radio."""

from __future__ import annotations

from math import pi

from attrs import evolve

from .radio import Radio
from .routes.route import Route

RADIO = Radio(loss=0.03, duplicate=0.005, corrupt=0.005, latency=0.015, jitter=0.030)
"""A busy 2.4 GHz band: 3 in 100 notifications never arrive, the others 15 to 45 ms late."""

ROUTE = (
    Route()
    .stand(3.0)
    .walk(9.0, speed=1.3)
    .turn(pi / 2, radius=1.5)
    .walk(4.0)
    .turn(pi / 2, radius=1.5)
    .walk(6.0, speed=1.1)
    .stop(2.0)
    .turn(-pi / 2)
    .walk(5.0, speed=1.2)
    .turn(-pi / 2, radius=1.0)
    .walk(10.0, speed=1.4)
    .stop(2.0)
)
"""About 40 m: a U, a halt, a turn on the spot, and away again."""

WAY = 8
"""Of the ways through the emulated building: down by one of four lifts, 130 m along corridors, and up the stairs."""


def straight(distance: float) -> Route:
    """Stand, walk so many m straight on, stand."""
    return Route().stand(3.0).walk(distance, speed=1.3).stop(2.0)


def radio(loss: float | None = None, jitter: float | None = None) -> Radio:
    """RADIO with another share of lost packets or another jitter in s; None leaves it as it is."""
    return evolve(RADIO, loss=RADIO.loss if loss is None else loss, jitter=RADIO.jitter if jitter is None else jitter)
