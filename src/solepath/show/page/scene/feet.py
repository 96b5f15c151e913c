"""One foot as a page shows it: phase, place, pressed cells, and what it did of late."""

from __future__ import annotations

from base64 import b64encode
from math import inf
from typing import Any

from attrs import define, field

from ....events import FootMoved, FootPressed, StrideTaken
from ....types import Foot, Layout, Phase, Vec3
from ...observer import FootCounts
from ..messages import rounded, rounded_all
from .lists import Recent, WalkedTrack

PHASES_KEPT = 20.0
"""s of phases that are kept."""
MOST_PHASES = 500
"""More than anybody's foot goes through in that time."""
MIN_PEAK_SHARE = 0.002
"""Share of a cell's full scale that the brightest colour stands for at least: what an unloaded sole shows is noise."""


@define
class FootScene:
    """Everything from events. The track has a point for where the foot was first seen and one for each step's end: live
    positions between two steps may still drift."""

    foot: Foot
    has_data: bool = field(default=False, init=False)
    phase: Phase | None = field(default=None, init=False)
    phases: Recent[tuple[float, str | None]] = field(factory=lambda: Recent(MOST_PHASES), init=False)
    """Beginning of each phase of late, s, and its name; None for a time in which the foot is not heard."""
    position: Vec3 | None = field(default=None, init=False)
    track: WalkedTrack = field(factory=WalkedTrack, init=False)
    layout: Layout | None = field(default=None, init=False)
    cells: tuple[float, ...] | None = field(default=None, init=False)
    """The newest values; None while there are none."""
    force: float = field(default=0.0, init=False)
    centre: tuple[float, float] | None = field(default=None, init=False)
    peak: float = field(default=0.0, init=False)
    """What the brightest colour stands for: the highest value so far."""
    _shades: tuple[tuple[float, ...] | None, float, str | None] = field(default=(None, 0.0, None), init=False)
    """Cells and peak, and what they were last shown as."""

    def add_position(self, event: FootMoved) -> None:
        """A live position."""
        self.position = event.position
        if event.phase is not self.phase:
            self.start_phase(event.t, event.phase)
        if not self.track.count:
            self.track.add_position(event.t, event.position)

    def add_pressure(self, event: FootPressed) -> None:
        """Cells of one sample."""
        values = event.values
        self.cells, self.force, self.centre = values, event.force, event.centre
        self.has_data = True
        largest = max(values, default=0.0)
        if self.peak < largest < inf:
            self.peak = largest

    def start_phase(self, t: float, phase: Phase | None) -> None:
        """From `t` s on the foot does this; None: it is not heard."""
        self.has_data = self.has_data or phase is not None
        if phase is self.phase:
            return
        self.phase = phase
        phases, t = self.phases, round(t, 3)
        if phases.items and t < phases.items[-1][0]:
            t = phases.items[-1][0]  # one that was dated back behind what was said before
        phases.add((t, None if phase is None else phase.value))
        while len(phases.items) > 1 and phases.items[1][0] <= t - PHASES_KEPT:
            phases.items.popleft()

    def add_stride(self, event: StrideTaken) -> None:
        """A step ended."""
        if event.final:
            self.track.add_position(event.t, event.position)

    def set_layout(self, layout: Layout) -> bool:
        """Where the cells are; whether that is new."""
        if layout == self.layout:
            return False
        self.layout = layout
        self.peak = max(MIN_PEAK_SHARE * layout.full_scale, 0.0) if layout.full_scale < inf else 0.0
        return True

    def phase_started_after(self, t: float) -> bool:
        """Whether what it does now, or that it is not heard, began after `t` s."""
        phases = self.phases.items
        return bool(phases) and phases[-1][0] > t

    def mark_silent(self, t: float) -> None:
        """What it does now is not known."""
        self.start_phase(t, None)
        self.cells = self.centre = None

    def frame(self, rate: float, counts: FootCounts) -> dict[str, Any] | None:
        """As "feet" of a frame; None before it was heard of. `rate`: samples a second."""
        if not self.has_data:
            return None
        cells = self.cells
        return {
            "phase": None if self.phase is None else self.phase.value,
            "position": None if self.position is None else rounded_all(self.position),
            "cells": self._colours(),
            "peak": rounded(self.peak),
            "force": None if cells is None else rounded(self.force, 1),
            "centre": None if self.centre is None or cells is None else rounded_all(self.centre, 4),
            "rate": rate,
            "steps": counts.strides,
            "distance": rounded(counts.distance, 2),
        }

    def _colours(self) -> str | None:
        """One byte a cell, 255 for the highest value so far, as base64."""
        cells, peak = self.cells, self.peak
        if cells is None:
            return None
        if self._shades[0] is not cells or self._shades[1] != peak:
            scale = 255.0 / peak if peak > 0.0 else 0.0
            shades = bytes([int(min(255.0, value * scale) + 0.5) if value > 0.0 else 0 for value in cells])
            self._shades = (cells, peak, b64encode(shades).decode())
        return self._shades[2]

    def layout_message(self, newtons: bool) -> dict[str, Any] | None:
        """As "layouts" of a scene. `newtons`: a calibration turns counts into N."""
        layout = self.layout
        if layout is None:
            return None
        return {
            "length": rounded(layout.length, 4),
            "cells": [[rounded(cell.x, 4), rounded(cell.y, 4), rounded(cell.area, 7)] for cell in layout.cells],
            "unit": "N" if newtons or layout.scale is not None else "counts",
            "full": None if newtons and layout.scale is None else rounded(layout.full_scale),
        }
