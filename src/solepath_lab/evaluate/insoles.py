"""Positions of the pressure cells of recorded insoles, which the recordings themselves do not contain.

Positions are in m, x to the toe and y to the left, from the rear end of the heel on the midline (as in types.Cell)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from solepath.calibration import Calibration, InsoleCalibration
from solepath.recording import RecordingError
from solepath.types import Cell, Foot, Layout

from ..descriptions import KNOWN, read_description

SWITCH_LAYOUT = 2
"""Layout number of marpino_heel_toe, whose first cell is a switch below the toe and the second one below the heel."""


def switches() -> Calibration:
    """Return the calibration of marpino_heel_toe: a toe switch and a heel switch on an insole of 0.26 m."""
    cells = (Cell(0.20, 0.0), Cell(0.03, 0.0))
    return _calibration({foot: Layout(SWITCH_LAYOUT, foot, cells, 0.26) for foot in Foot})


def force_sensors(length: float = 0.26) -> Calibration:
    """Return the calibration of gaitpdb_vgrf: eight force sensors on a sole of `length` m."""
    unit = length / 2000.0
    layouts = {}
    for foot in Foot:
        side = 1.0 if foot is Foot.LEFT else -1.0
        cells = tuple([Cell((y + 1000) * unit, -(x + 500) * side * unit) for x, y in KNOWN["gaitpdb_vgrf"]["sensors"]])
        layouts[foot] = Layout(len(cells), foot, cells, length, scale=1.0, full_scale=10_000.0)
    return _calibration(layouts)


def smart_insole(path: Path) -> Calibration:
    """Return the calibration of smart_insole_35 from the entry cell_xy_mm of the dataset.json beside `path`.

    In cell_xy_mm y is smallest at the toes, the wide end with the slanted row of cells, and x is smallest at the big
    toe. Seen from above with y downwards that is a right foot. Raise RecordingError when the file has no cells."""
    about = path.parent / "dataset.json"
    try:
        cell_positions: Sequence[tuple[float, float]] = read_description(about)["cell_xy_mm"]
        rear = max(y for _, y in cell_positions) + MARGIN
        front = min(y for _, y in cell_positions) - MARGIN
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise RecordingError(about, "does not say where the cells are") from error
    layouts = {}
    for foot in Foot:
        side = 1.0 if foot is Foot.RIGHT else -1.0
        cells = tuple([Cell(1e-3 * (rear - y), -1e-3 * side * (x - MIDLINE)) for x, y in cell_positions])
        layouts[foot] = Layout(len(cells), foot, cells, 1e-3 * (rear - front))
    return _calibration(layouts)


MARGIN = 15.0
"""Distance from the outermost cells to the insole's ends, mm (assumed: half the distance between their rows)."""
MIDLINE = -8.0
"""Coordinate x of the insole's midline in cell_xy_mm, mm: the middle of the rows of cells."""


def _calibration(layouts: dict[Foot, Layout]) -> Calibration:
    return Calibration(insoles={foot: InsoleCalibration(layout) for foot, layout in layouts.items()})
