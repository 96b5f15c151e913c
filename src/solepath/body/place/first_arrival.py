"""The first arrival of a wearer whose place was unknown, from which rows start again with more headings.

Rows of all exits and all headings are many, and few of them have the true heading, so that the true one may have only
rows whose stretch is wrong. The walls of the first metres exclude most headings. Therefore, some strides later, many
rows start once more from all exits, follow the track since then, and those that the walls leave are kept. At most
`MOST_ROWS` are alive at a time, only while this takes place; afterwards their number is what the recipe keeps."""

from __future__ import annotations

from ...types.attrs import define, evolve
from .connectors.level_changes import LevelReached

STRIDES = (6, 12, 18)
"""Numbers of strides of both feet after the arrival at which rows start again: about 4, 8 and 12 m of walking.

The positions of the track that are kept reach back to the arrival until then (`MAX_TRACK_POSITIONS`)."""
MOST_ROWS = 1500
"""Number of rows that start again, over all exits: at most some 6 degrees apart in a building of two stairs and lifts.

With 260, the number that is kept, one of 25 emulated walks loses its place at the first turn."""


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
