"""What one insole measures over a whole walk, and the frames that it makes of it."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Layout
from ...wire.insole import InsoleFrame, InsoleSample

HANDLING = 1e-3
"""s from a frame's last sample until the radio has it."""

Counts = np.ndarray[tuple[int, ...], np.dtype[np.int16]]


@frozen(eq=False)
class InsoleSignal:
    """Counts at `interval` ticks: `cells` (N, cells), `imu` (N, 6) and `quats` (N, 4) where sent, `full` (N) where a
    sensor was at its limit.

    Sample k is taken at `first` + k `step`, s in true time; `sequence` is that of frame 0, `ticks` those of sample 0.
    Frames have any number, also below 0 and beyond the walk's end: the wearer then stands as at its beginning or end,
    and the device counts on.
    """

    layout: Layout
    interval: int
    first: float
    step: float
    sequence: int
    ticks: int
    serial: int
    cells: Counts
    imu: Counts | None
    quats: Counts | None
    full: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    def frames(self, batch: int) -> int:
        """How many frames of `batch` samples the walk has."""
        return len(self.cells) // batch

    def frame(self, number: int, batch: int = 1) -> InsoleFrame:
        """The frame of this number when each has `batch` samples."""
        start = number * batch
        rows = [self._row(k) for k in range(start, start + batch)]
        return InsoleFrame(
            foot=self.layout.foot,
            layout=self.layout.id,
            sequence=(self.sequence + number) % 2**16,
            ticks=(self.ticks + start * self.interval) % 2**32,
            interval=self.interval,
            samples=tuple([self._sample(row) for row in rows]),
            saturated=any(bool(self.full[row]) for row in rows),
        )

    def taken(self, number: int, batch: int = 1) -> float:
        """When the first sample of a frame is taken, s."""
        return self.first + self.step * (number * batch)

    def ready(self, number: int, batch: int = 1) -> float:
        """When the radio has a frame, s."""
        return self.first + self.step * (number * batch + batch - 1) + HANDLING

    def _row(self, k: int) -> int:
        return min(max(k, 0), len(self.cells) - 1)

    def _sample(self, row: int) -> InsoleSample:
        return InsoleSample(
            tuple(self.cells[row].tolist()),
            None if self.imu is None else tuple(self.imu[row].tolist()),
            None if self.quats is None else tuple(self.quats[row].tolist()),
        )
