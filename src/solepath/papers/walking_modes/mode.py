"""How the wearer walks, told from where the load of a contact lay: straight on, round a wide or a tight bend, standing.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3, fig. 13 and table 2: fourteen of the 99 cells in seven regions,
F1 and F2 across the sole, L1 to L3 and R1, R2 along it, against a threshold `th`.

What the paper leaves open, and what is taken here:

- Fig. 13 as a picture is not to be had. A region is two points, given as shares of the insole (`POINTS`), and each
  point is the cell that lies nearest: so the regions exist on any insole of enough cells, not on 99 alone.
- Left and right. The text's example takes FL_PR1 > th for a right turn, table 2 for a left one. Tables 1 and 2 are
  mirror images of each other if L and R name the same anatomical side in both shoes, R the inner (medial) and L the
  outer (lateral) edge. Then table 2 says that in a left turn the load lies on the right edge of both feet, outward of
  the bend, which is what a centripetal force does. The table is followed.
- `th` has no value. Here a region counts as the mean load of its cells over the contact, as a multiple of that of all
  cells of the insole; so no unit and no weight enters.
- Speed. The load moves outward in a bend by a share of h v^2 / (r g), h the height of the centre of mass, and under
  it the pressure grows about exponentially from the inner to the outer edge. So the same bend leaves less of a mark
  at a slower pace, and `th` belongs to one speed (`PACE`): what a region bears beyond what it does on a straight way
  (`STRAIGHT_ON`) is brought to that speed, its logarithm by the square (`at_pace`). The paper has one pace.
- "Total pressure at the relevant positions" of standing still, 0.7 body weights, cannot stand on eight cells of two
  feet: it is taken over both insoles.
"""

from __future__ import annotations

from ...types import Foot, Layout, WalkingMode
from ...types.attrs import define, field

POINTS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "F1": ((0.66, 0.30), (0.71, -0.30)),
    "F2": ((0.40, -0.30), (0.40, 0.30)),
    "L1": ((0.66, 1.00), (0.71, 1.00)),
    "L2": ((0.61, 0.65), (0.71, 0.65)),
    "L3": ((0.13, 1.00), (0.18, 1.00)),
    "R1": ((0.61, -1.00), (0.71, -0.65)),
    "R2": ((0.71, -1.00), (0.82, -1.00)),
}
"""Fourteen points: share of the insole's length from the heel, and share of the way from the middle of the sole there
to its edge, outer (lateral) positive."""
TH = 2.1
"""`th`, times the mean cell. On the emulator's feet, whose load moves outward in a bend as physics has it, the regions'
shares in contacts of another mode end below and those of their own begin above it, at 1.1 m/s."""
LEAST = 1e-9
"""A mean cell below this is no load, whatever the unit."""
PACE = 1.1
"""m/s, of `TH`."""
STRAIGHT_ON = {"L1": 0.58, "L2": 1.55, "L3": 0.87, "R1": 1.52, "R2": 0.68}
"""The regions' shares on a straight way, times the mean cell: of the emulator's feet."""
SWING = 0.38
"""Share of a stride in which the foot is in the air, at that speed."""
SLOWEST, FASTEST = 0.7, 1.7
"""m/s: beyond these the shares are brought to `PACE` as from here, or the noise of a slow step would make a bend."""
LEAST_STEP = 0.15
"""L_w: a shorter step is dragging, not walking, m (table 2)."""
STANDING_WEIGHT = 0.7
"""Of the body's, on both feet together (table 2)."""
LINGERS = 1.5
"""A contact that lasts longer has no step in it, s: even at 0.5 m/s a stance is shorter."""

MOST = 1e3
"""No insole has a region that bears more, times the mean cell: that is how many cells there are."""
SHORTEST_SOLE, LONGEST_SOLE = 0.05, 1.0
"""m; what is told to be outside of this is no insole's length."""

TURNS = {
    (Foot.LEFT, "inner", "wide"): WalkingMode.LEFT_WIDE,
    (Foot.LEFT, "inner", "tight"): WalkingMode.LEFT_TIGHT,
    (Foot.LEFT, "outer", "wide"): WalkingMode.RIGHT_WIDE,
    (Foot.LEFT, "outer", "tight"): WalkingMode.RIGHT_TIGHT,
    (Foot.RIGHT, "inner", "wide"): WalkingMode.RIGHT_WIDE,
    (Foot.RIGHT, "inner", "tight"): WalkingMode.RIGHT_TIGHT,
    (Foot.RIGHT, "outer", "wide"): WalkingMode.LEFT_WIDE,
    (Foot.RIGHT, "outer", "tight"): WalkingMode.LEFT_TIGHT,
}
"""Table 2, by the foot, the edge that bears the load, and how far out it does."""


def regions(layout: Layout) -> dict[str, tuple[int, ...]]:
    """The cells of each region: of each point the nearest one, measured across by the width of the sole there.

    None at all where the cells do not tell left from right: fewer than there are regions, a layout that was guessed
    (foot/pressure/layout_guess.py), or places that are no insole's. Then nobody knows a mode but standing, and a
    touchdown is taken for one straight on, which most are."""
    if len(layout.cells) < len(POINTS) or not SHORTEST_SOLE <= layout.length <= LONGEST_SOLE:
        return {}
    if not all([abs(cell.x) <= LONGEST_SOLE and abs(cell.y) <= LONGEST_SOLE for cell in layout.cells]):
        return {}
    lateral = 1.0 if layout.foot is Foot.LEFT else -1.0
    cells = [(cell.x / layout.length, lateral * cell.y) for cell in layout.cells]
    found: dict[str, tuple[int, ...]] = {}
    for name, points in POINTS.items():
        chosen: list[int] = []
        for along, across in points:
            beside = sorted([(abs(x - along), y) for x, y in cells])[: max(4, len(cells) // 10)]
            low, high = min([y for _, y in beside]), max([y for _, y in beside])
            y = 0.5 * (low + high) + 0.5 * across * (high - low)
            rank = [((x - along) ** 2 * layout.length**2 + (cy - y) ** 2, k) for k, (x, cy) in enumerate(cells)]
            chosen.append(min(rank)[1])
        found[name] = tuple(sorted(set(chosen)))
    inner = max([cells[k][1] for name in ("R1", "R2") for k in found[name]])
    outer = min([cells[k][1] for name in ("L1", "L2", "L3") for k in found[name]])
    return found if outer > inner else {}


def at_pace(shares: dict[str, float], speed: float) -> dict[str, float]:
    """The shares of the edges as they would be at `PACE`, from those at `speed` m/s; F1 and F2 as they are."""
    k = (PACE / min(max(speed, SLOWEST), FASTEST)) ** 2
    return {
        name: STRAIGHT_ON[name] * (min(share, MOST) / STRAIGHT_ON[name]) ** k if name in STRAIGHT_ON else share
        for name, share in shares.items()
    }


def decide(foot: Foot, step: float, shares: dict[str, float], forward: float, th: float) -> WalkingMode | None:
    """The mode by table 2, from a contact of `foot` that a step of `step` m ended in; None: no rule applies.

    `shares`: of the regions of this foot, as multiples of the mean cell's, at `PACE`. `forward`: F1 of both feet less
    F2 of both. A tight bend goes before a wide one, and of two edges the one that is further beyond the threshold."""
    edges = (
        ("inner", "tight", shares["R2"]),
        ("outer", "tight", shares["L1"]),
        ("inner", "wide", shares["R1"]),
        ("outer", "wide", max(shares["L2"], shares["L3"])),
    )
    for radius in ("tight", "wide"):
        beyond = [(share, edge) for edge, of, share in edges if of == radius and share > th]
        if beyond and step > LEAST_STEP:
            return TURNS[foot, max(beyond)[1], radius]
    if step > LEAST_STEP and forward > th:
        return WalkingMode.STRAIGHT
    return None


@define
class Contact:
    """What the regions of one insole bore since the foot came down."""

    layout: Layout | None = field(default=None, init=False)
    """That the regions are of."""
    where: dict[str, tuple[int, ...]] = field(factory=dict, init=False)
    began: float | None = field(default=None, init=False)
    ended: float | None = field(default=None, init=False)
    swung: float | None = field(default=None, init=False)
    """How long the foot was in the air before it, s."""
    sums: dict[str, float] = field(factory=dict, init=False)
    total: float = field(default=0.0, init=False)
    lingers: bool = field(default=False, init=False)
    """It has lasted too long for a step."""
    forward: float = field(default=0.0, init=False)
    """F1 less F2 of the last contact."""
    newest: float = field(default=0.0, init=False)
    """Load on the whole insole, newest sample, unit of the samples."""

    def set_layout(self, layout: Layout | None) -> None:
        """The insole's layout, as far as it is known; nothing is told without one."""
        if layout is None or layout is self.layout:
            return
        if layout != self.layout:
            self.where = regions(layout)
            self.sums, self.total = dict.fromkeys(self.where, 0.0), 0.0
        self.layout = layout  # a saved one is another object, and to compare all cells takes long

    @property
    def blind(self) -> bool:
        """The cells do not tell left from right."""
        return self.layout is not None and not self.where

    def begin(self, t: float) -> None:
        """The foot came down."""
        self.swung = None if self.ended is None else t - self.ended
        self.began, self.total, self.lingers = t, 0.0, False
        self.sums = dict.fromkeys(self.where, 0.0)

    def add(self, cells: tuple[float, ...], total: float) -> None:
        """A sample of the foot on the ground."""
        if not self.where or self.layout is None or len(cells) != len(self.layout.cells):
            return
        self.total += total
        sums = self.sums
        for name, where in self.where.items():
            for k in where:
                sums[name] += cells[k]

    def lasted(self, t: float) -> float:
        """s."""
        return 0.0 if self.began is None else t - self.began

    def speed(self, step: float) -> float:
        """Of the walk, m/s, from the length of the stride that it ended, m; `PACE` where nobody knows."""
        return PACE if self.swung is None or self.swung <= 0.0 else SWING * step / self.swung

    def shares(self) -> dict[str, float] | None:
        """The mean cell of each region as a multiple of the insole's; None without load or layout."""
        if self.layout is None or not self.sums or (mean := self.total / len(self.layout.cells)) < LEAST:
            return None
        return {name: max(total, 0.0) / len(self.where[name]) / mean for name, total in self.sums.items()}
