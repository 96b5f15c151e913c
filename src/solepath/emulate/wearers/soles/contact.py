"""Contact of a worn sole with the ground, in which it differs from a rigid sole that rolls without slip.

The method of Chen et al. 2019 (papers/kupt_dfpc/) measures a shoe in static postures and takes it for rigid. A worn
sole differs in four ways:

- Under the weight of a walking body it bends elsewhere and more sharply than in a posture that is held by hand, so the
  forefoot arc of a walking shoe is shifted (`pivot_shift`) and rounder or sharper (`radius_ratio`). It also differs
  from stride to stride.
- The heel arc is shifted likewise (`heel_shift`), because the heel is compressed.
- The heel slides and sinks for `impact_time` after contact, until sole and heel pad have stopped it.
- Before toe-off the forefoot, which bears little by then, slides back (`toe_slip`).

In biomechanics slides of 1 to 2 cm just after heel contact and at push-off are called microslips; the walker does not
notice slides of less than 2 to 3 cm (Perkins 1978, ASTM STP 649; Leamon and Li 1990, Ergonomics 33)."""

from __future__ import annotations

import numpy as np
from attrs import evolve, frozen

from ..curves import Array, Rng

MAX_IMPACT_SHARE = 0.8
"""Largest impact time, as a share of the time from heel-strike to foot-flat."""
TOE_SLIP: Array = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
"""Course s^5 of the slip in push-off: nine tenths of it come in the last third, when the load falls."""
MAX_SPREAD = 2.0
"""Largest deviation of one stride from the mean, in standard deviations."""


@frozen
class GroundContact:
    """The contact of a sole with the ground; the default is rigid and does not slip at push-off."""

    pivot_shift: float = 0.0
    """Forward shift of the forefoot arc of the walking shoe from that of the static postures, m."""
    pivot_variation: float = 0.0
    """Standard deviation of that shift between strides, m."""
    radius_ratio: float = 1.0
    """Radius of the walking shoe's forefoot arc as a ratio to that of the static postures."""
    heel_shift: float = 0.0
    """Forward shift of the heel arc of the walking shoe from that of the static postures, m."""
    impact_time: float = 0.014
    """Time that the sole and the heel pad take to stop the heel, s."""
    impact_variation: float = 0.0
    """Standard deviation of that time between strides, as a ratio to it."""
    toe_slip: float = 0.0
    """Mean distance by which the forefoot slides back before toe-off, m."""
    toe_slip_variation: float = 0.0
    """Standard deviation of that distance between strides, m; a foot never slides forwards."""

    def draw(self, rng: Rng) -> StrideContact:
        """Return the contact of one stride."""
        pivot, impact, slip = (float(x) for x in rng.standard_normal(3).clip(-MAX_SPREAD, MAX_SPREAD))
        return StrideContact(
            pivot_shift=self.pivot_shift + self.pivot_variation * pivot,
            impact_time=self.impact_time * (1.0 + self.impact_variation * impact),
            toe_slip=max(0.0, self.toe_slip + self.toe_slip_variation * slip),
        )


@frozen
class StrideContact:
    """The contact of the sole in one stride (`GroundContact`)."""

    pivot_shift: float
    """Forward shift of the forefoot arc, m."""
    impact_time: float
    """Time that the sole and the heel pad take to stop the heel, s."""
    toe_slip: float
    """Distance by which the forefoot slides back before toe-off, m."""


RIGID = GroundContact()
"""A rigid sole that does not slip at push-off."""

WORN = GroundContact(
    pivot_variation=0.003,
    radius_ratio=0.8,
    impact_time=0.032,
    impact_variation=0.25,
    toe_slip=0.004,
    toe_slip_variation=0.004,
)
"""A worn sole on a dry floor.

The impact takes 14 to 50 ms, which are two standard deviations, so the heel slides by 3 to 10 mm at 1.3 m/s; the toe
slides by up to 12 mm. These are microslips in the sense of this module. The sharper bend and the variation of the pivot
are assumed: a posture that is held by hand bears a part of the body's weight."""


SLIPPING = evolve(WORN, toe_slip=0.02, toe_slip_variation=0.008)
"""The worn sole, whose toe slides by 2 cm on average."""


def slip_at_toe_off(slip: Array, push_off_time: float) -> tuple[Array, Array, Array]:
    """Return displacement, m, velocity, m/s, and acceleration, m/s^2, of the forefoot at the end of `TOE_SLIP`.

    `slip` is the whole displacement, m, in a push-off of `push_off_time` s."""
    return slip, 5.0 / push_off_time * slip, 20.0 / push_off_time**2 * slip


def impact_displacement(speed: float, impact_time: float) -> Array:
    """Return the displacement of the heel, m, from where it would be if it rolled without slip, during the impact.

    It is the integral of v (1 - (10 s^3 - 15 s^4 + 6 s^5)) that ends at 0, with the speed v at contact and the share s
    of the impact time, s; the deceleration is a pulse, proportional to 30 s^2 (1 - s)^2."""
    return -speed * impact_time * np.array([0.5, -1.0, 0.0, 0.0, 2.5, -3.0, 1.0, 0.0])
