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
- Threshold. `th` has no value. Here the load of a region is the mean over its cells and the contact, divided by the
  mean over all cells of the insole. So it depends on neither unit nor weight.
- Speed. In a bend the load moves outward in proportion to h v^2 / (r g), with h the height of the centre of mass, and
  the pressure grows about exponentially from the inner to the outer edge. So a bend has less effect at a lower speed,
  but the paper has one speed. Here `th` holds for `REFERENCE_SPEED`. The logarithm of a region's load relative to that
  of straight walking (`STRAIGHT_SHARES`) is proportional to v^2, and is converted to that speed
  (`at_reference_speed`).
- Step. Table 2 compares `Step` with L_w in standing and straight walking only. Here a bend needs a step longer than L_w
  too, because by the text L_w is there to "filter out the situation of walk dragging along the ground".
- Standing. "Total pressure at the relevant positions" of 0.7 body weights is impossible on eight cells of two feet. The
  total over both insoles is used.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from ...types import Foot, Layout, WalkingMode
from ...types.attrs import define, field

REGION_POINTS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
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
"""Threshold `th`, as a multiple of the mean cell's load, for 1.1 m/s.

On the emulator's feet, whose load moves outward in a bend by the equation above, it separates the loads of a region in
contacts of its own mode from those in contacts of all other modes."""
LEAST_MEAN = 1e-9
"""Mean load of a cell below which the insole counts as unloaded, in any unit."""
REFERENCE_SPEED = 1.1
"""Walking speed for which `MODE_THRESHOLD` holds, m/s."""
STRAIGHT_SHARES = {"L1": 0.58, "L2": 1.55, "L3": 0.87, "R1": 1.52, "R2": 0.68}
"""Loads of the regions in straight walking, as multiples of the mean cell's load, from the emulator's feet."""
SWING_SHARE = 0.38
"""Share of a stride in which the foot is in the air, at `REFERENCE_SPEED`."""
SLOWEST_SPEED, FASTEST_SPEED = 0.7, 1.7
"""Limits of the speed that is used for the conversion to `REFERENCE_SPEED`, m/s.

Without the lower limit the noise of a slow step would look like a bend."""
LEAST_STEP_LENGTH = 0.15
"""Length L_w of a foot's stride, the paper's step, below which it is not walking but dragging, m (table 2)."""
STANDING_WEIGHT = 0.7
"""Load of both feet in standing, as a share of the body's weight (table 2)."""
LONGEST_CONTACT = 1.5
"""Longest contact in walking, s: even at 0.5 m/s a stance is shorter."""

LARGEST_SHARE = 1e3
"""Largest share of a region, as a multiple of the mean cell's load: the number of cells of the largest insole."""
SHORTEST_SOLE, LONGEST_SOLE = 0.05, 1.0
"""Lengths of the shortest and the longest insole, m; a layout of another length is rejected."""

TURN_MODES = {
    (Foot.LEFT, "inner", "wide"): WalkingMode.LEFT_WIDE,
    (Foot.LEFT, "inner", "tight"): WalkingMode.LEFT_TIGHT,
    (Foot.LEFT, "outer", "wide"): WalkingMode.RIGHT_WIDE,
    (Foot.LEFT, "outer", "tight"): WalkingMode.RIGHT_TIGHT,
    (Foot.RIGHT, "inner", "wide"): WalkingMode.RIGHT_WIDE,
    (Foot.RIGHT, "inner", "tight"): WalkingMode.RIGHT_TIGHT,
    (Foot.RIGHT, "outer", "wide"): WalkingMode.LEFT_WIDE,
    (Foot.RIGHT, "outer", "tight"): WalkingMode.LEFT_TIGHT,
}
"""Walking mode by the foot, the loaded edge and the radius of the bend (table 2)."""


def regions(layout: Layout) -> dict[str, tuple[int, ...]]:
    """Return the indices of each region's cells, the nearest to its points.

    The result is empty if the cells do not show left and right: there are fewer cells than regions, or the layout was
    guessed (foot/pressure/insole.py) or has impossible places. Then only standing can be recognised, and a
    touchdown is treated as one of straight walking, which is the most frequent."""
    if len(layout.cells) < len(REGION_POINTS) or not SHORTEST_SOLE <= layout.length <= LONGEST_SOLE:
        return {}
    if not all([abs(cell.x) <= LONGEST_SOLE and abs(cell.y) <= LONGEST_SOLE for cell in layout.cells]):
        return {}
    lateral = 1.0 if layout.foot is Foot.LEFT else -1.0
    cells = [(cell.x / layout.length, lateral * cell.y) for cell in layout.cells]
    cells_of: dict[str, tuple[int, ...]] = {}
    for name, points in REGION_POINTS.items():
        region_indices: list[int] = []
        for along, across in points:
            nearest = sorted([(abs(x - along), y) for x, y in cells])[: max(4, len(cells) // 10)]
            low, high = min([y for _, y in nearest]), max([y for _, y in nearest])
            y = 0.5 * (low + high) + 0.5 * across * (high - low)
            rank = [((x - along) ** 2 * layout.length**2 + (cy - y) ** 2, k) for k, (x, cy) in enumerate(cells)]
            region_indices.append(min(rank)[1])
        cells_of[name] = tuple(sorted(set(region_indices)))
    inner = max([cells[k][1] for name in ("R1", "R2") for k in cells_of[name]])
    outer = min([cells[k][1] for name in ("L1", "L2", "L3") for k in cells_of[name]])
    return cells_of if outer > inner else {}


def at_reference_speed(shares: dict[str, float], speed: float) -> dict[str, float]:
    """Return the loads of the regions converted from `speed`, m/s, to `REFERENCE_SPEED`; F1 and F2 stay as they are."""
    k = (REFERENCE_SPEED / min(max(speed, SLOWEST_SPEED), FASTEST_SPEED)) ** 2
    return {
        name: STRAIGHT_SHARES[name] * (min(share, LARGEST_SHARE) / STRAIGHT_SHARES[name]) ** k
        if name in STRAIGHT_SHARES
        else share
        for name, share in shares.items()
    }


def decide(foot: Foot, step: float, shares: dict[str, float], forward: float, th: float) -> WalkingMode | None:
    """Return the mode by table 2 of a contact of `foot` after a stride of `step` m, or None if no rule applies.

    `shares` are the loads of this foot's regions, as multiples of the mean cell's load, at `REFERENCE_SPEED`. `forward`
    is F1 of both feet minus F2 of both feet. A tight bend has priority over a wide one, and of two edges that with the
    larger load."""
    edges = (
        ("inner", "tight", shares["R2"]),
        ("outer", "tight", shares["L1"]),
        ("inner", "wide", shares["R1"]),
        ("outer", "wide", max(shares["L2"], shares["L3"])),
    )
    for radius in ("tight", "wide"):
        candidates = [(share, edge) for edge, edge_radius, share in edges if edge_radius == radius and share > th]
        if candidates and step > LEAST_STEP_LENGTH:
            return TURN_MODES[foot, max(candidates)[1], radius]
    if step > LEAST_STEP_LENGTH and forward > th:
        return WalkingMode.STRAIGHT
    return None


@define
class Contact:
    """The load on the regions of one insole since the foot came down."""

    layout: Layout | None = field(default=None, init=False)
    """Layout from which the regions were computed."""
    region_cells: dict[str, tuple[int, ...]] = field(factory=dict, init=False)
    """Indices of the cells, by region."""
    t_start: float | None = field(default=None, init=False)
    """Start of the contact, s."""
    t_end: float | None = field(default=None, init=False)
    """End of the previous contact, s."""
    swing_time: float | None = field(default=None, init=False)
    """Time in the air before the contact, s."""
    sums: dict[str, float] = field(factory=dict, init=False)
    """Sum of the loads in this contact, by region, unit of the samples."""
    total: float = field(default=0.0, init=False)
    """Sum of the loads of all cells in this contact, unit of the samples."""
    too_long: bool = field(default=False, init=False)
    """Flag: the contact has lasted longer than any in walking."""
    forward: float = field(default=0.0, init=False)
    """Load of F1 minus load of F2 in the last contact, as multiples of the mean cell's load."""
    last_load: float = field(default=0.0, init=False)
    """Load on the whole insole in the newest sample, unit of the samples."""

    def set_layout(self, layout: Layout | None) -> None:
        """Set the insole's layout, if it is known; without one there are no modes."""
        if layout is None or layout is self.layout:
            return
        if layout != self.layout:
            self.region_cells = regions(layout)
            self.sums, self.total = dict.fromkeys(self.region_cells, 0.0), 0.0
        self.layout = layout  # so that the next comparison is one of identity, which is faster

    @property
    def blind(self) -> bool:
        """Flag: the cells do not show left and right."""
        return self.layout is not None and not self.region_cells

    def start(self, t: float) -> None:
        self.swing_time = None if self.t_end is None else t - self.t_end
        self.t_start, self.total, self.too_long = t, 0.0, False
        self.sums = dict.fromkeys(self.region_cells, 0.0)

    def add(self, cells: tuple[float, ...], total: float) -> None:
        """Add one sample of the foot on the ground."""
        if not self.region_cells or self.layout is None or len(cells) != len(self.layout.cells):
            return
        self.total += total
        sums = self.sums
        for name, indices in self.region_cells.items():
            for k in indices:
                sums[name] += cells[k]

    def duration(self, t: float) -> float:
        """Return the duration of the contact, s."""
        return 0.0 if self.t_start is None else t - self.t_start

    def speed(self, step: float) -> float:
        """Return the walking speed, m/s, from the length `step` of the last stride, m; `REFERENCE_SPEED` if unknown."""
        return (
            REFERENCE_SPEED
            if self.swing_time is None or self.swing_time <= 0.0
            else SWING_SHARE * step / self.swing_time
        )

    def shares(self) -> dict[str, float] | None:
        """Return the mean load of each region's cells over that of all cells; None without load or layout."""
        if self.layout is None or not self.sums or (mean := self.total / len(self.layout.cells)) < LEAST_MEAN:
            return None
        return {name: max(total, 0.0) / len(self.region_cells[name]) / mean for name, total in self.sums.items()}
