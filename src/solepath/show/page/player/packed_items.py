"""Keeps the packets or samples of a recording compressed, with access in any order."""

from __future__ import annotations

import pickle
import zlib
from array import array
from collections.abc import Iterable

from ....types import Packet, Sample

CHUNK_SIZE = 256
"""Number of items that are compressed together, chosen by hand; an item is a packet or a sample."""


class PackedItems:
    """A compressed sequence of items, in the order in which they are fed to a session; items are added at the end.

    A packet of an insole of 96 cells takes about 135 bytes, a sample of it about 260; an hour of packets of two such
    insoles at 100 Hz takes about 100 MB. Reading items in order takes some microseconds each."""

    __slots__ = ("_chunks", "_uncompressed", "_times", "_cached_chunk")

    def __init__(self, items: Iterable[Packet | Sample] = ()) -> None:
        self._chunks: list[bytes] = []
        self._uncompressed: list[Packet | Sample] = []
        self._times = array("d")
        self._cached_chunk: tuple[int, list[Packet | Sample]] = (-1, [])
        for item in items:
            self.append(item)

    def append(self, item: Packet | Sample) -> None:
        """Add one item at the end."""
        self._times.append(max(item.t, self._times[-1]) if self._times else item.t)
        self._uncompressed.append(item)
        if len(self._uncompressed) == CHUNK_SIZE:
            # only this process reads the pickle
            self._chunks.append(zlib.compress(pickle.dumps(self._uncompressed, pickle.HIGHEST_PROTOCOL), 1))
            self._uncompressed = []

    def __len__(self) -> int:
        return len(self._times)

    def __getitem__(self, index: int) -> Packet | Sample:
        chunk, offset = divmod(index, CHUNK_SIZE)
        if chunk == len(self._chunks):
            return self._uncompressed[offset]
        if self._cached_chunk[0] != chunk:
            self._cached_chunk = (chunk, pickle.loads(zlib.decompress(self._chunks[chunk])))
        return self._cached_chunk[1][offset]

    def t(self, index: int) -> float:
        """Return the time at which the item at `index` is due, s.

        It is the largest time of all items up to this one, so that times never fall where a clock was set back."""
        return self._times[index]

    @property
    def start(self) -> float:
        """Time of the first item, s; 0 when there are none."""
        return self._times[0] if self._times else 0.0

    @property
    def end(self) -> float:
        """Time of the last item, s; 0 when there are none."""
        return self._times[-1] if self._times else 0.0
