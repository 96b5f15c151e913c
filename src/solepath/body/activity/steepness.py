"""Steepness of a stride, as angle per metre.

Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1 and table 1.

theta' = theta / |H|: the inclination theta of a step divided by its horizontal length H. The paper's definition
contradicts its table 1 in two points:
- theta is given as arccos(Z / |S|), the angle from the vertical. That is 90 degrees on level ground, where table 1 has
  an average of 3.9 degrees.
- With H as the length of a stride, 0.60 m along and 0.32 m up (section 4.2.4, fig. 28), theta' is 47 degrees per metre,
  where table 1 has 107.9 upstairs and -89.5 downstairs.

Both points agree with the table when theta is the angle from the horizontal, positive upwards, and H is the length of
one tread, half a stride ("we can regard alternating feet once as one step"; a tread is 0.30 m by 0.16 m). Then theta is
atan(0.32 / 0.60), 28.1 degrees, and theta' is 93.6 degrees per metre. Its size lies between those of both averages, and
differs from each by at most 0.4 of its standard deviation."""

from __future__ import annotations

from math import atan2, radians

LEVEL_ANGLE = radians(3.935)
"""Average angle per metre of table 1 on level ground, rad/m."""
UPSTAIRS_ANGLE = radians(107.904)
"""Average angle per metre of table 1 upstairs, rad/m."""
DOWNSTAIRS_ANGLE = radians(-89.464)
"""Average angle per metre of table 1 downstairs, rad/m."""

UPSTAIRS_THRESHOLD = 0.5 * (LEVEL_ANGLE + UPSTAIRS_ANGLE)
"""Threshold of stairs upwards: 55.9 degrees/m, half way between the averages.

The paper: "by using a threshold of the average theta'"."""
DOWNSTAIRS_THRESHOLD = 0.5 * (LEVEL_ANGLE + DOWNSTAIRS_ANGLE)
"""Threshold of stairs downwards: -42.8 degrees/m, half way between the averages."""

LEAST_RISE = 0.08
"""Least height change of a stair stride, m: half of a riser.

A foot that hardly moves always has a large angle per metre, which the paper does not mention."""
HIGHEST_RISE = 0.88
"""Largest height change of a stair stride, m: four risers of 0.22 m, for a wearer who takes two treads at a time.

The Building Regulations 2010, Approved Document K (2013), table 1.1, allow no higher riser."""
HIGHEST_DEGRADED_RISE = 0.6
"""Largest height change of a stair stride in which samples are missing, m.

A stride of one tread at a time gains 0.44 m; a third of that is added for the gap. Above that limit, a stride of two
treads at a time cannot be distinguished from a height that has drifted."""
_MIN_GROUND = 1e-3
"""Least horizontal length by which an angle is divided, m."""


def angle_per_metre(ground: float, height: float) -> float:
    """Return theta' of a stride, rad/m, with horizontal length `ground`, m, and height change `height`, m."""
    return atan2(height, ground) / max(0.5 * ground, _MIN_GROUND)


def steepness(ground: float, height: float) -> int:
    """Return 1 for a stride upstairs, -1 downstairs, 0 on the level; arguments as for `angle_per_metre`."""
    if -LEAST_RISE < height < LEAST_RISE:
        return 0
    angle = angle_per_metre(ground, height)
    return 1 if angle > UPSTAIRS_THRESHOLD else -1 if angle < DOWNSTAIRS_THRESHOLD else 0


def is_stair_rise(height: float, degraded: bool = False) -> bool:
    """Return whether a stride on stairs can have the height change `height`, m; otherwise its angle means nothing."""
    return abs(height) <= (HIGHEST_DEGRADED_RISE if degraded else HIGHEST_RISE)
