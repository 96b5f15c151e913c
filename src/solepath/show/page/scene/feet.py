"""Holds what a page shows of one foot: phase, position, cells, and recent phases.

Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from base64 import b64encode
from math import inf
from typing import Any

from ....events import FootMoved, FootPressed, StrideTaken
from ....foot.phase import EVENT_OF_PHASE
from ....types import Layout, Phase, Vec3
from ....types.attrs import state, stateful
from ....walk.walk import FootCounts
from ..messages import members, plain
from .bending import Bend, bent
from .lists import GrowingList, TrackPoint, add_position, new_track

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


@stateful
class FootScene:
    """The state of one foot on a page, from events alone.

    The track has one point at the first live position and one at the end of each stride, since live positions within a
    stride may still drift."""

    has_data: bool = False
    phase: Phase | None = None
    phases: GrowingList[tuple[float, str | None]] = state(factory=lambda: GrowingList(MAX_PHASES))
    """Start of each recent phase, s, and its name; None for a time in which the foot sends nothing."""
    position: Vec3 | None = None
    track: GrowingList[TrackPoint] = state(factory=new_track)
    lag: tuple[float, float] = (0.0, 0.0)
    """Correction by a reported position that the foot's own events have only after its next stride, m, world frame."""
    lag_ends: bool = False
    """True after that stride: the live position of its last sample is the last one without the correction."""
    layout: Layout | None = None
    pressed: FootPressed | None = None
    """Newest values of the cells; None while there are none."""
    peak: float = 0.0
    """Value of the brightest colour, in the unit of the cells: the highest so far, at least MIN_PEAK_SHARE."""

    def add_position(self, event: FootMoved) -> None:
        """Add a live position."""
        self.position = self._corrected(event.position)
        if self.lag_ends:
            self.lag, self.lag_ends = (0.0, 0.0), False
        self.start_phase(event.t, event.phase)
        if not self.track.items:
            add_position(self.track, event.t, self.position)

    def add_pressure(self, event: FootPressed) -> None:
        """Add the cells of one sample."""
        self.pressed, self.has_data = event, True
        self.peak = max(self.peak, *event.values, 0.0)

    def start_phase(self, t: float, phase: Phase | None) -> None:
        """Start a phase at `t`, s, if it is another; None means that the foot sends nothing."""
        self.has_data = self.has_data or phase is not None
        if phase is self.phase:
            return
        self.phase = phase
        phases = self.phases.items
        t = max(round(t, 3), phases[-1][0] if phases else -inf)  # an event may be dated before the last reported phase
        self.phases.add((t, None if phase is None else phase.value))
        phases = self.phases.items
        while len(phases) > 1 and phases[1][0] <= t - PHASE_HISTORY:
            del phases[0]

    def add_stride(self, event: StrideTaken) -> None:
        """Add a stride that ended."""
        if event.final:
            add_position(self.track, event.t, self._corrected(event.position))
            self.lag_ends = True

    def _corrected(self, position: Vec3) -> Vec3:
        return (position[0] + self.lag[0], position[1] + self.lag[1], position[2])

    def revise(self, bend: Bend, by: tuple[float, float]) -> None:
        """Bend the track, and move the foot by `by`, m, until it has that correction itself."""
        self.track.replace(bent(self.track.items, bend))
        self.lag = (self.lag[0] + by[0], self.lag[1] + by[1])
        if self.position is not None:
            x, y, z = self.position
            self.position = (x + by[0], y + by[1], z)

    def set_layout(self, layout: Layout) -> bool:
        """Set the positions of the cells; return whether they are new."""
        if layout == self.layout:
            return False
        self.layout = layout
        self.peak = MIN_PEAK_SHARE * layout.full_scale
        return True

    def phase_started_after(self, t: float) -> bool:
        """Return whether the present phase, or the silence of the foot, started after `t`, s."""
        phases = self.phases.items
        return bool(phases) and phases[-1][0] > t

    def mark_silent(self, t: float) -> None:
        """Mark the phase as unknown from `t`, s, on."""
        self.start_phase(t, None)
        self.pressed = None

    def frame(self, counts: FootCounts) -> dict[str, Any] | None:
        """Return the foot's member of "feet" of a frame; None before it has data."""
        if not self.has_data:
            return None
        pressed = self.pressed
        return {
            **members(self, "phase", "position", "peak"),
            "cells": None if pressed is None else self._encode_cells(pressed.values),
            "force": None if pressed is None else plain(pressed.force, 1),
            "centre": None if pressed is None else plain(pressed.centre, 4),
            **members(counts, "strides", "distance", distance=2),
        }

    def _encode_cells(self, cells: tuple[float, ...]) -> str:
        """Return one byte for each cell as base64: 0 for no load, 255 for `peak`."""
        scale = 255.0 / self.peak if self.peak > 0.0 else 0.0
        shades = [int(min(255.0, value * scale) + 0.5) if value > 0.0 else 0 for value in cells]
        return b64encode(bytes(shades)).decode()

    def layout_message(self, newtons: bool) -> dict[str, Any] | None:
        """Return the foot's member of "layouts" of a scene; `newtons` says that a calibration gives the cells in N."""
        layout = self.layout
        if layout is None:
            return None
        return {
            "length": plain(layout.length, 4),
            "cells": [[round(cell.x, 4), round(cell.y, 4), round(cell.area, 7)] for cell in layout.cells],
            "unit": "N" if newtons or layout.scale is not None else "counts",
        }
