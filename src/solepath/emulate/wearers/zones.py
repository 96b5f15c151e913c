"""Zones of the sole, and the distribution of a zone's load over the cells of an insole."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Foot, Layout
from .curves import Array


@frozen(eq=False)
class Zone:
    """An elliptic zone of the sole, relative to the sole's length and width."""

    x: float
    """Centre from the heel's end, as a share of the length."""
    y: float
    """Centre to the lateral side, as a share of the width."""
    half_length: float
    """Half-axis along the foot, as a share of the length."""
    half_width: float
    """Half-axis across the foot, as a share of the width."""


HEEL = Zone(0.17, 0.0, 0.17, 0.34)
MIDFOOT = Zone(0.47, 0.14, 0.15, 0.20)
FOREFOOT = Zone(0.67, 0.00, 0.14, 0.48)
TOES = Zone(0.86, -0.16, 0.11, 0.34)


def pattern(layout: Layout, width: float, zone: Zone, ahead: Array, aside: Array, lean: Array) -> Array:
    """Return the share of a zone's load on each cell at each instant, (N, cells).

    The sum of a row is one; for cells under the heel alone it is the share of the zone above the cells. The pressure
    falls with the square of the distance and is zero outside the ellipse. When no cell lies in the ellipse, a Gaussian
    of the distance is used. A `lean` (m, to the left) weights the pressure by exp(lean y / variance): a small lean
    moves the centre by the lean, and no lean moves it over the edge."""
    lateral = 1.0 if layout.foot is Foot.LEFT else -1.0
    x = np.array([cell.x for cell in layout.cells]) / layout.length
    y = np.array([cell.y for cell in layout.cells]) * lateral / width
    area = np.array([cell.area for cell in layout.cells])
    dx = (x - zone.x - ahead[:, None]) / zone.half_length
    dy = (y - zone.y - aside[:, None]) / zone.half_width
    r2 = dx * dx + dy * dy
    spread = area * np.where(r2 < 1.0, 1.0 - r2, 0.0)
    if lean.any():
        # Over the ellipse the mean of dy^2 is 1/6 under this pressure.
        tilt = 6.0 * lateral / (zone.half_width * width) * lean
        spread *= np.exp(tilt[:, None] * dy) / _tilted(tilt)[:, None]
    if x.max() < 0.5:
        # 1 - r^2 over the whole ellipse, in m^2.
        whole = 0.5 * np.pi * zone.half_length * layout.length * zone.half_width * width
        return np.asarray(spread / whole)
    empty = ~spread.any(axis=1)
    if empty.any():
        spread[empty] = np.exp(-8.0 * (r2[empty] - r2[empty].min(axis=1, keepdims=True)))
    return np.asarray(spread / spread.sum(axis=1, keepdims=True))


def _tilted(tilt: Array) -> Array:
    """Return the mean of exp(tilt y) over a unit disc with the weight 1 - r^2: 8 I2(tilt) / tilt^2, by its series."""
    term = np.ones_like(tilt)
    total = term.copy()
    for k in range(1, 20):
        term = term * (0.25 * tilt * tilt) / (k * (k + 2))
        total += term
    return total
