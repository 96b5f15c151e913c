"""Holds what a page shows of one foot: phase, position, cells, and recent phases.

Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from base64 import b64encode
from math import inf
from typing import Any

from attrs import define, field

from ....events import FootMoved, FootPressed, StrideTaken
from ....foot.phase import EVENT_OF_PHASE
from ....types import Foot, Layout, Phase, Vec3
from ....types.attrs import NOT_SAVED
from ....walk.walk import FootCounts
from ..messages import rounded, rounded_all
from .bending import Bend
from .lists import RecentItems, WalkedTrack

PHASE_HISTORY = 20.0
"""Time for which phases are kept, s."""
MAX_PHASES = 500
"""Largest number of phases that are kept; a foot has fewer in PHASE_HISTORY."""
MIN_PEAK_SHARE = 0.002
"""Least value of the brightest colour, as a share of a cell's full scale: noise of an unloaded sole stays dark."""

NO_COUNTS = FootCounts()
"""Counts of a foot without any event."""
PHASE_OF_EVENT: dict[type, Phase] = {event: phase for phase, event in EVENT_OF_PHASE.items()}
"""Phase that starts with each gait event."""


@define
class FootScene:
    """The state of one foot on a page, from events alone.

    The track has one point at the first live position and one at the end of each stride, since live positions within a
    stride may still drift."""

    foot: Foot
    has_data: bool = field(default=False, init=False)
    phase: Phase | None = field(default=None, init=False)
    phases: RecentItems[tuple[float, str | None]] = field(factory=lambda: RecentItems(MAX_PHASES), init=False)
    """Start of each recent phase, s, and its name; None for a time in which the foot sends nothing."""
    position: Vec3 | None = field(default=None, init=False)
    track: WalkedTrack = field(factory=WalkedTrack, init=False)
    lag: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Correction by a reported position that the foot's own events have only after its next stride, m, world frame."""
    lag_ends: bool = field(default=False, init=False)
    """True after that stride: the live position of its last sample is the last one without the correction."""
    layout: Layout | None = field(default=None, init=False)
    cells: tuple[float, ...] | None = field(default=None, init=False)
    """Newest values of the cells; None while there are none."""
    force: float = field(default=0.0, init=False)
    centre: tuple[float, float] | None = field(default=None, init=False)
    peak: float = field(default=0.0, init=False)
    """Value of the brightest colour, in the unit of the cells: the highest so far, at least MIN_PEAK_SHARE."""
    _encoded_cells: tuple[tuple[float, ...] | None, float, str | None] = field(
        default=(None, 0.0, None), init=False, metadata=NOT_SAVED
    )
    """The cells and the peak that were encoded last, and their text."""

    def add_position(self, event: FootMoved) -> None:
        """Add a live position."""
        self.position = self._corrected(event.position)
        if self.lag_ends:
            self.lag, self.lag_ends = (0.0, 0.0), False
        if event.phase is not self.phase:
            self.start_phase(event.t, event.phase)
        if not self.track.count:
            self.track.add_position(event.t, self.position)

    def add_pressure(self, event: FootPressed) -> None:
        """Add the cells of one sample."""
        values = event.values
        self.cells, self.force, self.centre = values, event.force, event.centre
        self.has_data = True
        largest = max(values, default=0.0)
        if self.peak < largest < inf:
            self.peak = largest

    def start_phase(self, t: float, phase: Phase | None) -> None:
        """Start a phase at `t`, s; None means that the foot sends nothing."""
        self.has_data = self.has_data or phase is not None
        if phase is self.phase:
            return
        self.phase = phase
        phases, t = self.phases, round(t, 3)
        if phases.items and t < phases.items[-1][0]:
            t = phases.items[-1][0]  # the event is dated before the last reported phase
        phases.add((t, None if phase is None else phase.value))
        while len(phases.items) > 1 and phases.items[1][0] <= t - PHASE_HISTORY:
            phases.items.popleft()

    def add_stride(self, event: StrideTaken) -> None:
        """Add a stride that ended."""
        if event.final:
            self.track.add_position(event.t, self._corrected(event.position))
            self.lag_ends = True

    def _corrected(self, position: Vec3) -> Vec3:
        return (position[0] + self.lag[0], position[1] + self.lag[1], position[2])

    def revise(self, bend: Bend, by: tuple[float, float]) -> None:
        """Bend the track, and move the foot by `by`, m, until it has that correction itself."""
        self.track.replace(bend.apply(self.track.points))
        self.lag = (self.lag[0] + by[0], self.lag[1] + by[1])
        if self.position is not None:
            x, y, z = self.position
            self.position = (x + by[0], y + by[1], z)

    def set_layout(self, layout: Layout) -> bool:
        """Set the positions of the cells; return whether they are new."""
        if layout == self.layout:
            return False
        self.layout = layout
        self.peak = max(MIN_PEAK_SHARE * layout.full_scale, 0.0) if layout.full_scale < inf else 0.0
        return True

    def phase_started_after(self, t: float) -> bool:
        """Return whether the present phase, or the silence of the foot, started after `t`, s."""
        phases = self.phases.items
        return bool(phases) and phases[-1][0] > t

    def mark_silent(self, t: float) -> None:
        """Mark the phase as unknown from `t`, s, on."""
        self.start_phase(t, None)
        self.cells = self.centre = None

    def frame(self, rate: float, counts: FootCounts) -> dict[str, Any] | None:
        """Return the foot's member of "feet" of a frame; None before it has data. `rate` is in samples a second."""
        if not self.has_data:
            return None
        cells = self.cells
        return {
            "phase": None if self.phase is None else self.phase.value,
            "position": None if self.position is None else rounded_all(self.position),
            "cells": self._encode_cells(),
            "peak": rounded(self.peak),
            "force": None if cells is None else rounded(self.force, 1),
            "centre": None if self.centre is None or cells is None else rounded_all(self.centre, 4),
            "rate": rate,
            "strides": counts.strides,
            "distance": rounded(counts.distance, 2),
        }

    def _encode_cells(self) -> str | None:
        """Return one byte for each cell as base64: 0 for no load, 255 for `peak`."""
        cells, peak = self.cells, self.peak
        if cells is None:
            return None
        if self._encoded_cells[0] is not cells or self._encoded_cells[1] != peak:
            scale = 255.0 / peak if peak > 0.0 else 0.0
            shades = bytes([int(min(255.0, value * scale) + 0.5) if value > 0.0 else 0 for value in cells])
            self._encoded_cells = (cells, peak, b64encode(shades).decode())
        return self._encoded_cells[2]

    def layout_message(self, newtons: bool) -> dict[str, Any] | None:
        """Return the foot's member of "layouts" of a scene; `newtons` says that a calibration gives the cells in N."""
        layout = self.layout
        if layout is None:
            return None
        return {
            "length": rounded(layout.length, 4),
            "cells": [[rounded(cell.x, 4), rounded(cell.y, 4), rounded(cell.area, 7)] for cell in layout.cells],
            "unit": "N" if newtons or layout.scale is not None else "counts",
            "full": None if newtons and layout.scale is None else rounded(layout.full_scale),
        }
