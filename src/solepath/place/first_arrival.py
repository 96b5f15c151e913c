"""The first arrival of a wearer whose place was unknown, from which rows start again with more headings.

Rows of all exits and all headings are many, and few of them have the true heading, so that the true one may have only
rows whose stretch is wrong. The walls of the first metres exclude most headings. Therefore, some strides later, many
rows start once more from all exits, follow the track since then, and those that the walls leave are kept. At most
`MOST_ROWS` are alive at a time, only while this takes place; afterwards their number is what the recipe keeps."""

from __future__ import annotations

from ..types.attrs import define, evolve
from .connectors.level_changes import LevelReached

STRIDES = (8, 16)
"""Numbers of strides of both feet after the arrival at which rows start again: about 5 and 10 m of walking.

The positions of the track that are kept reach back to the arrival until then (`MAX_TRACK_POSITIONS`)."""
MOST_ROWS = 600
"""Number of rows that start again, over all exits.

When no rows start again, one of 25 emulated walks loses its place at the first turn. That walk keeps it with 300, 600
and 1500 rows, and with three times instead of two. 600 rows take some 40 ms of a processor at the first of `STRIDES`,
80 ms at the second."""


@define
class FirstArrival:
    """An arrival whose exits are not decided yet."""

    arrived: LevelReached
    strides: int = 0
    """Number of strides since then."""

    def count_stride(self) -> bool:
        """Count a stride, and return whether rows start again at it."""
        self.strides += 1
        return self.strides in STRIDES

    def reverse(self) -> None:
        """Take the other direction, up or down."""
        self.arrived = evolve(self.arrived, up=not self.arrived.up)

    @property
    def is_over(self) -> bool:
        """Return whether rows start no more."""
        return self.strides >= STRIDES[-1]
