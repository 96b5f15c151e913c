"""Patches of the sole, and how the load of one is spread over an insole's cells."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Foot, Layout
from .curves import Array


@frozen(eq=False)
class Zone:
    """A patch of the sole: centre (part of the sole's length; lateral, part of its width) and half-axes likewise."""

    x: float
    y: float
    half_length: float
    half_width: float


HEEL = Zone(0.17, 0.0, 0.17, 0.34)
MIDFOOT = Zone(0.47, 0.14, 0.15, 0.20)
FOREFOOT = Zone(0.67, 0.00, 0.14, 0.48)
TOES = Zone(0.86, -0.16, 0.11, 0.34)


def pattern(layout: Layout, width: float, zone: Zone, ahead: Array, aside: Array, lean: Array) -> Array:
    """How a zone's load is spread over the cells at each instant, (N, cells); rows add up to one, or to what of the
    zone lies over the cells when they are under the heel alone.

    The pressure falls off with the square of the distance and is zero outside the ellipse. The faint rest only decides
    when no cell at all lies in it. A `lean` (m, to the left) tilts it by exp(lean y / variance), which moves its centre
    by the lean as long as that is small, and never over the edge.
    """
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
    """The mean of exp(tilt y) over a unit disc under the weight 1 - r^2: 8 I2(tilt) / tilt^2, by its series."""
    term = np.ones_like(tilt)
    total = term.copy()
    for k in range(1, 20):
        term = term * (0.25 * tilt * tilt) / (k * (k + 2))
        total += term
    return total
