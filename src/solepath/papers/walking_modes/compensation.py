"""Compensation epsilon_P of a touchdown, by foot and walking mode.

After Gong et al. 2023 (Sensors 23, 5417), equation (8) and table 1. The paper leaves two points open:

- The unit of table 1. Its header says mm. But values of 0.16 to 1.8 mm would move the end of a side of 4 m, which takes
  six or seven steps, by less than 5 mm, whereas by table 4 method IV is better than III by up to 15 cm there.
  Centimetres have the right order of magnitude. Table 4, too, is headed mm, but has metres (0.17 at corner C, 4.0 m).
- The axes of table 1. y points in the direction of walking, and x to the right, so that x, y and up are right
  handed."""

from __future__ import annotations

from ...types import Foot, Vec2, Vec3, WalkingMode

Compensation = dict[Foot, dict[WalkingMode, Vec2]]
"""Compensation (forward, left), m, by the foot that comes down and the mode."""

_CM = 0.01
TABLE_1: Compensation = {
    foot: {mode: (y * _CM, -x * _CM) for mode, (x, y) in row.items()}
    for foot, row in {
        Foot.LEFT: {
            WalkingMode.STRAIGHT: (0.34, 0.55),
            WalkingMode.LEFT_WIDE: (0.19, 0.27),
            WalkingMode.LEFT_TIGHT: (0.35, 0.97),
            WalkingMode.RIGHT_WIDE: (-0.94, -0.52),
            WalkingMode.RIGHT_TIGHT: (-1.28, -1.73),
        },
        Foot.RIGHT: {
            WalkingMode.STRAIGHT: (-0.23, 0.62),
            WalkingMode.LEFT_WIDE: (0.97, -0.48),
            WalkingMode.LEFT_TIGHT: (1.25, -1.8),
            WalkingMode.RIGHT_WIDE: (-0.16, 0.24),
            WalkingMode.RIGHT_TIGHT: (-0.34, 1.02),
        },
    }.items()
}
"""Table 1, (x, y) in cm, converted to (forward, left) in m.

It holds for the paper's wearers and sensors; `solepath calibrate modes` measures the compensation of another wearer."""


def compensation_of(table: Compensation, foot: Foot, mode: WalkingMode) -> Vec2:
    """Return the compensation (forward, left) of `foot` in `mode`, m; zero if the table has no such row."""
    return table.get(foot, {}).get(mode, (0.0, 0.0))


def epsilon_p(table: Compensation, foot: Foot, mode: WalkingMode, direction: Vec2) -> Vec3:
    """Return epsilon_P of (8), world frame, m; `direction` is the unit vector of walking, world frame."""
    (c, s), (forward, left) = direction, compensation_of(table, foot, mode)
    return (forward * c - left * s, forward * s + left * c, 0.0)


def merge_own(table: Compensation, own: Compensation) -> Compensation:
    """Return the table, with those values replaced for which a wearer has `own` values."""
    return {foot: {**table.get(foot, {}), **own.get(foot, {})} for foot in Foot}
