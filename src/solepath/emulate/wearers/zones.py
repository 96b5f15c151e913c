"""Zones of the sole, and the distribution of a zone's load over the cells of an insole.

Numbers without a source were chosen by hand for plausible pressure images and not swept."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Foot, Layout
from .curves import Array


@frozen(eq=False)
class Zone:
    """An elliptic zone of the sole, in shares of the sole's length and width."""

    x: float
    """Distance of the centre from the heel's end, as a share of the length."""
    y: float
    """Offset of the centre from the midline, as a share of the width; positive to the lateral side."""
    half_length: float
    """Half-axis along the foot, as a share of the length."""
    half_width: float
    """Half-axis across the foot, as a share of the width."""


HEEL = Zone(0.17, 0.0, 0.17, 0.34)
MIDFOOT = Zone(0.47, 0.14, 0.15, 0.20)
FOREFOOT = Zone(0.67, 0.00, 0.14, 0.48)
TOES = Zone(0.86, -0.16, 0.11, 0.34)


def cell_shares(
    layout: Layout,
    width: float,
    zone: Zone,
    ahead: Array,
    aside: Array,
    lateral_shift: Array,
    spread: Array | float = 1.0,
) -> Array:
    """Return the share of a zone's load on each cell at each instant, (N, cells).

    The sum of a row is one; when all cells are in the rear half of the sole, it is the share of the zone that lies on
    them. The pressure is 1 - r^2 for the distance r from the centre in half-axes, and zero outside the ellipse. When no
    cell lies in the ellipse, it is a Gaussian of r. The zone is moved by `ahead` (share of the length) and `aside`
    (share of the width, to the lateral side), and its half-axes are multiplied by `spread`. A `lateral_shift` s (m, to
    the left) weights the pressure by exp(s y / variance): a small shift moves the centre of the load by s, and no shift
    moves it out of the ellipse."""
    lateral_sign = 1.0 if layout.foot is Foot.LEFT else -1.0
    x = np.array([cell.x for cell in layout.cells]) / layout.length
    y = np.array([cell.y for cell in layout.cells]) * lateral_sign / width
    area = np.array([cell.area for cell in layout.cells])
    spread = np.broadcast_to(spread, ahead.shape)
    dx = (x - zone.x - ahead[:, None]) / (zone.half_length * spread[:, None])
    dy = (y - zone.y - aside[:, None]) / (zone.half_width * spread[:, None])
    r2 = dx * dx + dy * dy
    pressure = area * np.where(r2 < 1.0, 1.0 - r2, 0.0)
    if lateral_shift.any():
        # Weighted by this pressure, the mean of dy^2 over the ellipse is 1/6.
        tilt = 6.0 * lateral_sign / (zone.half_width * width * spread) * lateral_shift
        pressure *= np.exp(tilt[:, None] * dy) / _mean_tilt_factor(tilt)[:, None]
    if x.max() < 0.5:
        # The integral of 1 - r^2 over the whole ellipse, m^2.
        integral = 0.5 * np.pi * zone.half_length * layout.length * zone.half_width * width
        return np.asarray(pressure / (integral * spread * spread)[:, None])
    empty = ~pressure.any(axis=1)
    if empty.any():
        pressure[empty] = np.exp(-8.0 * (r2[empty] - r2[empty].min(axis=1, keepdims=True)))
    return np.asarray(pressure / pressure.sum(axis=1, keepdims=True))


def _mean_tilt_factor(tilt: Array) -> Array:
    """Return the mean of exp(tilt y) over a unit disc with the weight 1 - r^2: 8 I2(tilt) / tilt^2, by its series."""
    term = np.ones_like(tilt)
    total = term.copy()
    for k in range(1, 20):
        term = term * (0.25 * tilt * tilt) / (k * (k + 2))
        total += term
    return total
