"""A format of a known program or device: how its files are recognised, and the mapping with which they are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from attrs import frozen

from ..mapping.mapping import TableMapping


@frozen
class TableHeader:
    """The start of a table: its names, the lines above them, and the cells of a line of units below them."""

    path: Path
    names: tuple[str, ...]
    preamble: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    line: int = 0
    """Number of the line with the names; 0 for a table without them."""

    def starts(self, *texts: str) -> bool:
        """Return whether a line before the names starts with one of these texts."""
        return any(line.lstrip('"').startswith(texts) for line in self.preamble)

    def find(self, *names: str) -> bool:
        """Return whether there are columns with all these names."""
        return set(names) <= set(self.names)


@frozen
class Export:
    """A known format of tables."""

    name: str
    """Name of the format for --format."""
    device: str
    """Device or program that writes it."""
    mapping: Callable[[TableHeader], TableMapping]
    """Function that returns the mapping of a file of this format.

    ValueError for a file that lacks what is needed, with a sentence."""
    is_own: Callable[[TableHeader], bool]
    """Function that returns whether the start of a file is of this format."""
    tag: Callable[[TableHeader], str] = lambda header: ""
    """Function that returns the name that the user gave the device, which may hold a foot; "" without one."""
    flaws: Callable[[TableHeader], tuple[str, ...]] = lambda header: ()
    """Function that returns what the start of a file says about its worth, in sentences."""
    lacking: str = ""
    """Action that gives a file with what `mapping` needs."""
