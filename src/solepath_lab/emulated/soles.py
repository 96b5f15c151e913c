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

from attrs import evolve, frozen

from solepath.emulate.wearers.contact import GroundContact
from solepath.emulate.wearers.curves import Rng

MAX_SPREAD = 2.0
"""Largest deviation of one stride from the mean, in standard deviations."""


@frozen(kw_only=True)
class VariedContact(GroundContact):
    """The contact of a sole with the ground that differs from stride to stride."""

    pivot_variation: float = 0.0
    """Standard deviation of `pivot_shift` between strides, m."""
    impact_variation: float = 0.0
    """Standard deviation of `impact_time` between strides, as a ratio to it."""
    toe_slip_variation: float = 0.0
    """Standard deviation of `toe_slip` between strides, m; a foot never slides forwards."""

    def draw(self, rng: Rng) -> GroundContact:
        """Return the contact of one stride."""
        pivot, impact, slip = (float(x) for x in rng.standard_normal(3).clip(-MAX_SPREAD, MAX_SPREAD))
        return evolve(
            self,
            pivot_shift=self.pivot_shift + self.pivot_variation * pivot,
            impact_time=self.impact_time * (1.0 + self.impact_variation * impact),
            toe_slip=max(0.0, self.toe_slip + self.toe_slip_variation * slip),
        )


WORN = VariedContact(
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
