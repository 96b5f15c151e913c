"""Keeps the packets or samples of a recording compressed, with access in any order."""

from __future__ import annotations

import pickle
import zlib
from array import array
from collections.abc import Iterable

from ....types import Packet, Sample

CHUNK = 256
"""Items that are compressed together."""


class PackedItems:
    """A sequence to which items are added at the end, in the order in which a session takes them.

    A packet of an insole of 96 cells takes about 135 bytes in here, so that two feet at 100 Hz take about 100 MB an
    hour; a sample of such an insole takes about 260. Reading items one after the other costs some microseconds each."""

    __slots__ = ("_chunks", "_open", "_times", "_unpacked")

    def __init__(self, items: Iterable[Packet | Sample] = ()) -> None:
        self._chunks: list[bytes] = []
        self._open: list[Packet | Sample] = []
        self._times = array("d")
        self._unpacked: tuple[int, list[Packet | Sample]] = (-1, [])
        for item in items:
            self.append(item)

    def append(self, item: Packet | Sample) -> None:
        """Add one item at the end."""
        self._times.append(max(item.t, self._times[-1]) if self._times else item.t)
        self._open.append(item)
        if len(self._open) == CHUNK:
            # only this process reads the pickle
            self._chunks.append(zlib.compress(pickle.dumps(self._open, pickle.HIGHEST_PROTOCOL), 1))
            self._open = []

    def __len__(self) -> int:
        return len(self._times)

    def __getitem__(self, index: int) -> Packet | Sample:
        chunk, row = divmod(index, CHUNK)
        if chunk == len(self._chunks):
            return self._open[row]
        if self._unpacked[0] != chunk:
            self._unpacked = (chunk, pickle.loads(zlib.decompress(self._chunks[chunk])))
        return self._unpacked[1][row]

    def t(self, index: int) -> float:
        """Return the time at which the item at `index` is due, s.

        It is the item's own time, or the latest of those before it where a clock was set back, since nothing can be
        played before what came before it."""
        return self._times[index]

    @property
    def start(self) -> float:
        """Time of the first item, s; 0 when there are none."""
        return self._times[0] if self._times else 0.0

    @property
    def end(self) -> float:
        """Time of the last item, s; 0 when there are none."""
        return self._times[-1] if self._times else 0.0
