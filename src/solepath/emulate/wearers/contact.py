"""Contact of a sole with the ground, in which it may differ from a rigid sole that rolls without slip.

The heel slides and sinks for `impact_time` after contact, until sole and heel pad have stopped it. Under the weight of
a walking body a sole may bend elsewhere and more sharply than in a posture that is held by hand, so the forefoot arc of
a walking shoe is shifted (`pivot_shift`) and rounder or sharper (`radius_ratio`); the heel arc is shifted likewise
(`heel_shift`), because the heel is compressed. Before toe-off the forefoot, which bears little by then, may slide back
(`toe_slip`)."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from .curves import Array, Rng

MAX_IMPACT_SHARE = 0.8
"""Largest impact time, as a share of the time from heel-strike to foot-flat."""
TOE_SLIP: Array = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
"""Course s^5 of the slip in push-off: nine tenths of it come in the last third, when the load falls."""


@frozen
class GroundContact:
    """The contact of a sole with the ground; the default is rigid and does not slip at push-off."""

    pivot_shift: float = 0.0
    """Forward shift of the forefoot arc of the walking shoe from that of the static postures, m."""
    radius_ratio: float = 1.0
    """Radius of the walking shoe's forefoot arc as a ratio to that of the static postures."""
    heel_shift: float = 0.0
    """Forward shift of the heel arc of the walking shoe from that of the static postures, m."""
    impact_time: float = 0.014
    """Time that the sole and the heel pad take to stop the heel, s."""
    toe_slip: float = 0.0
    """Distance by which the forefoot slides back before toe-off, m."""

    def draw(self, rng: Rng) -> GroundContact:
        """Return the contact of one stride, which may differ from this one."""
        return self


RIGID = GroundContact()
"""A rigid sole that does not slip at push-off."""


def slip_at_toe_off(slip: Array, push_off_time: float) -> tuple[Array, Array, Array]:
    """Return displacement, m, velocity, m/s, and acceleration, m/s^2, of the forefoot at the end of `TOE_SLIP`.

    `slip` is the whole displacement, m, in a push-off of `push_off_time` s."""
    return slip, 5.0 / push_off_time * slip, 20.0 / push_off_time**2 * slip


def impact_displacement(speed: float, impact_time: float) -> Array:
    """Return the displacement of the heel, m, from where it would be if it rolled without slip, during the impact.

    It is the integral of v (1 - (10 s^3 - 15 s^4 + 6 s^5)) that ends at 0, with the speed v at contact and the share s
    of the impact time, s; the deceleration is a pulse, proportional to 30 s^2 (1 - s)^2."""
    return -speed * impact_time * np.array([0.5, -1.0, 0.0, 0.0, 2.5, -3.0, 1.0, 0.0])
