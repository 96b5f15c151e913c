"""Layouts of the pressure cells of insoles."""

from __future__ import annotations

from functools import cached_property, lru_cache, partial
from itertools import repeat
from math import atan2, dist
from struct import pack

from .attrs import field, frozen, limited, limits
from .records import Floats, Foot

MAX_FULL_SCALE = 1e9
"""Largest full scale of a cell, N or counts; a converter with 24 bits has 1.7e7."""
NEIGHBOUR_DISTANCE = 1.7
"""Largest distance of a neighbour, as a multiple of the usual distance between cells; chosen by hand."""


@frozen
class Cell:
    """A pressure cell of an insole.

    The foot frame has x to the toe, y to the left, and its origin at the heel's rear end on the insole's midline."""

    x: float = field(metadata=limits(-1.0, 1.0, "m"))
    """Position of the centre along the foot's x axis, to the toe, m."""
    y: float = field(metadata=limits(-1.0, 1.0, "m"))
    """Position of the centre along the foot's y axis, to the left, m."""
    area: float = limited(1e-4, 0.0, 1.0, "m^2")
    """Area of the cell, m^2."""


@frozen
class Layout:
    """The pressure cells of one insole, in the order in which samples have them."""

    id: int
    """Number by which the device names the layout."""
    foot: Foot
    """Foot that wears the insole."""
    cells: tuple[Cell, ...]
    """Cells in the order in which samples have them."""
    length: float = field(metadata=limits(0.01, 1.0, "m"))
    """Distance from heel to toe, m."""
    scale: float | None = limited(None, 1e-9, 1e6, "N")
    """Force of one transmitted count, N: 1.0 when the device sends newtons, None when it is unknown, so that loads are
    in counts."""
    full_scale: float = limited(4095.0, 1e-6, MAX_FULL_SCALE)
    """Largest value that a cell can report, in the unit of the samples (N or counts)."""

    @cached_property
    def xs(self) -> Floats:
        """Position of each cell along the foot's x axis, to the toe, m."""
        return tuple([cell.x for cell in self.cells])

    @cached_property
    def ys(self) -> Floats:
        """Position of each cell along the foot's y axis, to the left, m."""
        return tuple([cell.y for cell in self.cells])

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """For each cell, the indices of its neighbours, in the order of their directions."""
        if len(self.cells) < 2:
            return ((),) * len(self.cells)
        positions = [*zip(self.xs, self.ys, strict=True)]
        nearest = sorted([sorted(map(dist, repeat(a), positions))[1] for a in positions])  # [0] is the cell itself
        farthest = NEIGHBOUR_DISTANCE * nearest[len(nearest) // 2]
        near = [
            [j for j, one in enumerate(map(dist, repeat(a), positions)) if one <= farthest and j != i]
            for i, a in enumerate(positions)
        ]
        return tuple([tuple(sorted(js, key=partial(self.direction, i))) for i, js in enumerate(near)])

    def direction(self, i: int, j: int) -> float:
        """Return the direction from cell `i` to cell `j`, rad from x, -pi to pi."""
        return atan2(self.ys[j] - self.ys[i], self.xs[j] - self.xs[i])


def shared(layout: Layout) -> Layout:
    """Return one object for all layouts that are equal bit for bit.

    It saves memory, because all wearers of one kind of insole then share one object."""
    numbers = [layout.length, layout.full_scale, 0.0 if layout.scale is None else layout.scale]
    for cell in layout.cells:
        numbers += (cell.x, cell.y, cell.area)
    # -0.0 and 0.0 are equal, but their bits differ
    bits = pack(f"<{len(numbers)}d", *numbers)
    return _intern(_Bits((layout.id, layout.foot, layout.scale is None, bits), layout))


@frozen
class _Bits:
    key: tuple[int, Foot, bool, bytes]
    layout: Layout = field(eq=False)


@lru_cache(maxsize=256)
def _intern(bits: _Bits) -> Layout:
    return bits.layout
