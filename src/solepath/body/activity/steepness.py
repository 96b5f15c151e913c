"""Steepness of a stride, as angle per metre.

Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1 and table 1.

theta' = theta / |H|: the inclination of a step, for each metre that it goes along the ground. The paper's own words for
theta are arccos(Z / |S|), the angle from the vertical, which is 90 degrees on the level, where table 1 has an average
of 3.9 degrees; and with H the ground covered by a stride its 0.60 m and 0.32 m (section 4.2.4, fig. 28) make 47 degrees
a metre where table 1 has 107.9 and -89.5. Both fit when theta is the angle from the horizontal, positive upwards, and H
that of one tread, half of the stride of a foot ("we can regard alternating feet once as one step"; a tread is 0.30 m by
0.16 m): atan(0.32 / 0.60) is 28.1 degrees, and 93.6 degrees a metre lie between both averages, within 0.4 of their
standard deviations."""

from __future__ import annotations

from math import atan2, radians

PLANE = radians(3.935)
"""Average angle per metre of table 1 on the level, rad/m."""
UPSTAIRS = radians(107.904)
"""Average angle per metre of table 1 upstairs, rad/m."""
DOWNSTAIRS = radians(-89.464)
"""Average angle per metre of table 1 downstairs, rad/m."""

UP_FROM = 0.5 * (PLANE + UPSTAIRS)
"""Threshold of stairs upwards: 55.9 degrees/m, half way between the averages.

The paper: "by using a threshold of the average theta'"."""
DOWN_FROM = 0.5 * (PLANE + DOWNSTAIRS)
"""Threshold of stairs downwards: -42.8 degrees/m, half way between the averages."""

LEAST_RISE = 0.08
"""Least height difference of a stair stride, m: half of a riser.

The angle of a foot that hardly moves is large in any case; the paper does not mention such feet."""
HIGHEST_RISE = 0.88
"""Largest height difference of a stair stride, m: two treads with the highest risers, 0.22 m.

These are the highest that The Building Regulations 2010, Approved Document K (2013), table 1.1, allow."""
HIGHEST_DEGRADED_RISE = 0.6
"""Largest height difference of a stair stride in which samples are missing, m.

It is one tread at a time, 0.44 m, and a third of that for the gap: two treads and a height that has drifted look alike.
"""
_LEAST_GROUND = 1e-3
"""Least length along the ground that divides an angle, m."""


def angle_per_metre(ground: float, height: float) -> float:
    """Return theta' of a stride of one foot, rad/m: `ground` covered along the horizontal and `height` gained, m."""
    return atan2(height, ground) / max(0.5 * ground, _LEAST_GROUND)


def steepness(ground: float, height: float) -> int:
    """Return 1 for a stride upstairs, -1 downstairs, 0 on the level; arguments as for `angle_per_metre`."""
    if -LEAST_RISE < height < LEAST_RISE:
        return 0
    angle = angle_per_metre(ground, height)
    return 1 if angle > UP_FROM else -1 if angle < DOWN_FROM else 0


def is_stair_rise(height: float, degraded: bool = False) -> bool:
    """Return whether a stride of stairs can gain `height`, m, so that its angle means anything."""
    return abs(height) <= (HIGHEST_DEGRADED_RISE if degraded else HIGHEST_RISE)
