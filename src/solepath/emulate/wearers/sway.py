"""The sway of a foot that stands: small slow turns, which a gyroscope cannot tell from its bias.

On recordings of standing wearers the angular rate of a foot, averaged over half a second, differs from its mean by 6 to
10 degrees a minute about the vertical, and by 12 to 17 about the other axes (`pyshoe_vicon`, `openshoe_loops`,
`gumushane_gcp`, `felius_2min_walk`, `hugadb`, `ipol_10m_uturn`). Angles with a standard deviation of 0.14 degrees
that are reached about once a second give such rates, with half of it for yaw."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .curves import Array, Rng, constant, join

SHORTEST_STANDING = 1.0
"""Shortest time of standing in which a foot sways, s; a stance in walking is shorter."""
SHORTEST_TURN, LONGEST_TURN = 0.3, 1.5
"""Shortest and longest time from one angle to the next, s."""
YAW_SHARE = 0.5
"""Ratio of the sway about the vertical to that about the other axes, no unit."""


def sway_pieces(
    t_start: float, first: float, last: float, end: float, sigma: float, rng: Rng
) -> Iterator[tuple[float, float, list[Array]]]:
    """Yield the pieces of a foot that stands from `t_start` to `end`, s, and sways from `first` to `last`, s.

    A piece has its start and end, s, and the curves of pitch, yaw and roll, rad. Pitch and roll have a standard
    deviation of `sigma`; all are 0 at `first` and `last`, and yaw is relative to the foot's own."""
    still = [constant(0.0)] * 3
    if t_start < first:
        yield t_start, first, still
    t, angles = first, np.zeros(3)
    while t < last:
        stop = t + float(rng.uniform(SHORTEST_TURN, LONGEST_TURN))
        targets = sigma * np.array((1.0, YAW_SHARE, 1.0)) * rng.standard_normal(3)
        if stop > last - SHORTEST_TURN:
            stop, targets = last, np.zeros(3)
        ends = zip(angles.tolist(), targets.tolist(), strict=True)
        yield t, stop, [join((a, 0.0, 0.0), (b, 0.0, 0.0), stop - t) for a, b in ends]
        t, angles = stop, targets
    if last < end:
        yield last, end, still
