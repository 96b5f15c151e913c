"""Walking mode by the loaded regions of a contact: straight ahead, around a wide or a tight bend, standing.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3, fig. 13 and table 2: fourteen of the 99 cells in seven regions,
F1 and F2 across the sole, L1 to L3 and R1, R2 along it, are compared with a threshold `th`. The paper leaves these
points open:

- Regions. The picture of fig. 13 is not available. A region is two points, given as shares of the insole
  (`REGION_POINTS`). For each point the nearest cell is used, so an insole need not have 99 cells.
- Left and right. FL_PR1 > th means a right turn in the text's example, but a left turn in table 2. Tables 1 and 2 are
  mirror images of each other if R is the inner (medial) edge and L the outer (lateral) edge of either shoe. Then by
  table 2 the load in a left turn lies on the right edge of both feet, away from the centre of the bend, as it must for
  a centripetal force. The table is followed.
- Threshold. The paper prints no value of `th`, and no figure from which it could be read. Here the load of a region is
  the mean over its cells and the contact, divided by the mean over all cells of the insole. So it depends on neither
  unit nor weight, but the number itself, `MODE_THRESHOLD`, was fitted to emulated feet.
- Step. Table 2 compares `Step` with L_w in standing and straight walking only. Here a bend needs a step longer than L_w
  too, because by the text L_w is there to "filter out the situation of walk dragging along the ground".
- Standing. "Total pressure at the relevant positions" of 0.7 body weights is impossible on eight cells of two feet. The
  total over both insoles is used.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from ...types import Foot, Layout, Vec2, WalkingMode

REGION_POINTS: dict[str, tuple[Vec2, Vec2]] = {
    "F1": ((0.66, 0.30), (0.71, -0.30)),
    "F2": ((0.40, -0.30), (0.40, 0.30)),
    "L1": ((0.66, 1.00), (0.71, 1.00)),
    "L2": ((0.61, 0.65), (0.71, 0.65)),
    "L3": ((0.13, 1.00), (0.18, 1.00)),
    "R1": ((0.61, -1.00), (0.71, -0.65)),
    "R2": ((0.71, -1.00), (0.82, -1.00)),
}
"""Two points of each region: share of the insole's length from the heel's end, and share of the sole's half width.

The second share is measured from the middle of the sole, outer (lateral) side positive."""
MODE_THRESHOLD = 2.1
"""Threshold `th`, as a multiple of the mean cell's load; fitted to the emulator, not taken from the paper.

On emulated feet whose load moves outward in a bend at 1.1 m/s (`LoadLaw.OUTWARD`) it separates the loads of a region in
contacts of its own mode from those in contacts of all other modes. It is right for that law only."""
LEAST_STEP_LENGTH = 0.15
"""Length L_w of a foot's stride, the paper's step, below which it is not walking but dragging, m (table 2)."""
STANDING_WEIGHT = 0.7
"""Load of both feet in standing, as a share of the body's weight (table 2)."""
SHORTEST_SOLE, LONGEST_SOLE = 0.05, 1.0
"""Lengths of the shortest and the longest insole, m; a layout of another length is rejected."""


def regions(layout: Layout) -> dict[str, tuple[int, ...]]:
    """Return the indices of each region's cells, the nearest to its points.

    The result is empty if the cells do not show left and right: there are fewer cells than regions, or the layout was
    guessed (foot/pressure/insole.py) or has impossible places. Then only standing can be recognised, and a
    touchdown is treated as one of straight walking, which is the most frequent."""
    if len(layout.cells) < len(REGION_POINTS) or not SHORTEST_SOLE <= layout.length <= LONGEST_SOLE:
        return {}
    if max([max(abs(cell.x), abs(cell.y)) for cell in layout.cells]) > LONGEST_SOLE:
        return {}
    lateral = 1.0 if layout.foot is Foot.LEFT else -1.0
    cells = [(cell.x / layout.length, lateral * cell.y) for cell in layout.cells]

    def nearest(along: float, across: float) -> int:
        row = sorted([(abs(x - along), y) for x, y in cells])[: max(4, len(cells) // 10)]
        low, high = min([y for _, y in row]), max([y for _, y in row])
        y = 0.5 * (low + high) + 0.5 * across * (high - low)
        return min([((x - along) ** 2 * layout.length**2 + (cy - y) ** 2, k) for k, (x, cy) in enumerate(cells)])[1]

    cells_of = {
        name: tuple(sorted({nearest(along, across) for along, across in points}))
        for name, points in REGION_POINTS.items()
    }
    inner = max([cells[k][1] for name in ("R1", "R2") for k in cells_of[name]])
    outer = min([cells[k][1] for name in ("L1", "L2", "L3") for k in cells_of[name]])
    return cells_of if outer > inner else {}


def decide(foot: Foot, step: float, shares: dict[str, float], forward: float) -> WalkingMode | None:
    """Return the mode by table 2 of a contact of `foot` after a stride of `step` m, or None if no rule applies.

    `shares` are the loads of this foot's regions, as multiples of the mean cell's load. `forward` is F1 of both feet
    minus F2 of both feet. A tight bend has priority over a wide one, and of two edges that with the larger load: on the
    inner edge it is a bend to the foot's own side."""
    if step <= LEAST_STEP_LENGTH:
        return None
    own, other = ("LEFT", "RIGHT") if foot is Foot.LEFT else ("RIGHT", "LEFT")
    outer = max(shares["L2"], shares["L3"])
    for radius, loads in (
        ("TIGHT", ((shares["R2"], own), (shares["L1"], other))),
        ("WIDE", ((shares["R1"], own), (outer, other))),
    ):
        load, side = max(loads)
        if load > MODE_THRESHOLD:
            return WalkingMode[f"{side}_{radius}"]
    return WalkingMode.STRAIGHT if forward > MODE_THRESHOLD else None
