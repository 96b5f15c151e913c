"""How steep a stride is, as angle per metre: Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809,
2016), section 3.4.1 and table 1.

theta' = theta / |H|: the inclination of a step, for each metre that it goes along the ground. The paper's own words for
theta are arccos(Z / |S|), the angle from the vertical, which is 90 degrees on the level, where table 1 has an average
of 3.9 degrees; and with H the ground covered by a stride its 0.60 m and 0.32 m (section 4.2.4, fig. 28) make 47 degrees
a metre where table 1 has 107.9 and -89.5. Both fit when theta is the angle from the horizontal, positive upwards, and H
that of one tread, half of the stride of a foot ("we can regard alternating feet once as one step"; a tread is 0.30 m by
0.16 m): atan(0.32 / 0.60) is 28.1 degrees, and 93.6 degrees a metre lie between both averages, within 0.4 of their
standard deviations.
"""

from __future__ import annotations

from math import atan2, radians

PLANE = radians(3.935)
"""Averages of table 1, rad/m."""
UPSTAIRS = radians(107.904)
DOWNSTAIRS = radians(-89.464)

UP_FROM = 0.5 * (PLANE + UPSTAIRS)
"""Half way between the averages: 55.9 degrees/m; "by using a threshold of the average theta'"."""
DOWN_FROM = 0.5 * (PLANE + DOWNSTAIRS)
"""-42.8 degrees/m."""

LEAST_RISE = 0.08
"""A foot that comes down less than this above or below where it stood has not taken a stair, m; half of a riser. The
angle of a foot that hardly goes anywhere is large whatever it does; the paper does not say what becomes of it."""
HIGHEST_RISE = 0.88
"""No stride of stairs rises more, m: two treads at a time, and the highest risers that The Building Regulations 2010,
Approved Document K (2013), table 1.1, allow, 0.22 m."""
HIGHEST_DEGRADED = 0.6
"""Nor is one believed to rise more when samples were missing within it: one tread at a time, 0.44 m, and a third of
that for what the gap has done, m. Nobody can tell two treads from a height that has drifted."""
_LEAST_GROUND = 1e-3
"""m."""


def angle_per_metre(ground: float, height: float) -> float:
    """theta' of a stride of one foot, rad/m: `ground` covered along the horizontal and `height` gained, m."""
    return atan2(height, ground) / max(0.5 * ground, _LEAST_GROUND)


def steepness(ground: float, height: float) -> int:
    """1 for a stride upstairs, -1 downstairs, 0 on the level; arguments as for `angle_per_metre`."""
    if -LEAST_RISE < height < LEAST_RISE:
        return 0
    angle = angle_per_metre(ground, height)
    return 1 if angle > UP_FROM else -1 if angle < DOWN_FROM else 0


def of_stairs(height: float, degraded: bool = False) -> bool:
    """Whether stairs have strides that gain `height`, m, so that the angle of one means anything."""
    return abs(height) <= (HIGHEST_DEGRADED if degraded else HIGHEST_RISE)
