"""Steepness of a stride, as angle per metre.

Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1 and table 1.

theta' = theta / |H|: the inclination theta of a step divided by its horizontal length H. The paper's definition
contradicts its table 1 in two points:
- theta is given as arccos(Z / |S|), the angle from the vertical. That is 90 degrees on level ground, where table 1 has
  an average of 3.9 degrees.
- With H as the length of a stride, 0.60 m along and 0.32 m up (section 4.2.4, fig. 28), theta' is 47 degrees per metre,
  where table 1 has 107.9 upstairs and -89.5 downstairs.

Both points agree with the table when theta is the angle from the horizontal, positive upwards, and H is the length of
one tread, half a stride ("we can regard alternating feet once as one step"; a tread is 0.30 m by 0.16 m). Then theta
is atan(0.32 / 0.60), 28.1 degrees, and theta' is 93.6 degrees per metre. Its size lies between those of both
averages, and differs from each by at most 0.4 of its standard deviation."""

from __future__ import annotations

from math import atan2, radians

from ...body.activity.flights import LEAST_RISE

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

_MIN_GROUND = 1e-3
"""Least horizontal length by which an angle is divided, m."""


def angle_per_metre(ground: float, height: float) -> float:
    """Return theta' of a stride, rad/m, with horizontal length `ground`, m, and height change `height`, m."""
    return atan2(height, ground) / max(0.5 * ground, _MIN_GROUND)


def steepness(ground: float, height: float) -> int:
    """Return 1 for a stride upstairs, -1 downstairs, 0 on the level; arguments as for `angle_per_metre`."""
    # a foot that hardly moves always has a large angle per metre, which the paper does not mention
    if -LEAST_RISE < height < LEAST_RISE:
        return 0
    angle = angle_per_metre(ground, height)
    return 1 if angle > UPSTAIRS_THRESHOLD else -1 if angle < DOWNSTAIRS_THRESHOLD else 0
