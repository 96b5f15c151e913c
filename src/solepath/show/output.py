"""Writes events.jsonl, track.csv, strides.csv and gait_cycles.csv and, with a floor plan, places.csv.

events.jsonl is for programs, in SI units and radians. The tables are for people, with the unit of a column in its
header and angles in degrees. Times are on the recording's clock, written so that reading gives the same float again.
Positions are in m, world frame, with six digits after the point; places are in m, plan frame, with three."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from math import atan2, degrees, remainder, tau
from pathlib import Path
from typing import Any, TextIO

from attrs import define, field

from ..body.gait.means import as_found
from ..events import DefectFound, Event, Flaw, FootMoved, GaitCycleMeasured, LiveEvent, Placed, StrideTaken
from ..recording.errors import printable
from ..saving.files import os_errors_naming

EVENTS_FILE, TRACK_FILE, STRIDES_FILE, GAIT_CYCLES_FILE = "events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv"
PLACES_FILE, PLAN_FILE, RUN_FILE = "places.csv", "plan.svg", "run.json"
TRACK_COLUMNS = ("t_s", "foot", "x_m", "y_m", "z_m", "phase")
STRIDE_COLUMNS = (
    "foot", "t_start_s", "t_end_s", "x_m", "y_m", "z_m", "stride_length_m", "heading_change_deg", "height_change_m",
    "degraded", "missing", "longest_gap_s", "length_sigma_m", "flaws",
)  # fmt: skip
CYCLE_FIELDS = {
    "foot": "foot",
    "number": "number",
    "t_start_s": "t_start",
    "t_toe_off_s": "t_toe_off",
    "t_s": "t",
    "stride_time_s": "stride_time",
    "stance_time_s": "stance_time",
    "swing_time_s": "swing_time",
    "step_time_s": "step_time",
    "initial_double_support_s": "initial_double_support",
    "terminal_double_support_s": "terminal_double_support",
    "single_support_s": "single_support",
    "stance_share": "stance_share",
    "double_support_share": "double_support_share",
    "cadence_steps_per_min": "cadence",
    "stride_length_m": "stride_length",
    "speed_m_per_s": "speed",
    "clearance_m": "clearance",
    "toe_off_angle_deg": "toe_off_angle",
    "heel_strike_angle_deg": "heel_strike_angle",
    "turning_angle_deg": "turning_angle",
    "rise_m": "rise",
    "phase": "phase",
    "degraded": "degraded",
    "steady": "steady",
}
"""Columns of gait_cycles.csv with the fields of GaitCycleMeasured; an angle is written in degrees."""
CYCLE_COLUMNS = tuple(CYCLE_FIELDS)
PLACE_COLUMNS = (
    "t_s", "level", "room", "door", "x_m", "y_m", "z_m", "spread_m", "walking_direction_deg", "frame_heading_deg",
    "candidates", "weight",
)  # fmt: skip
DEFECT = Flaw.DEFECT.name.lower()
"""Flaw in strides.csv of the strides of a foot whose data cannot be right."""
FORMULA = re.compile(r"\s*[=+\-@\uff1d\uff0b\uff0d\uff20]")
"""Start of a text that programs for tables run as a formula: = + - @, also in full width."""
AMOUNT = re.compile(r"[+\-][\d.,][\w.,%/\u00b0 ]*([eE][+\-]\d+)?")
"""A number, and what it is a number of, as in -10 %: no formula."""
Cell = str | int | float | None
"""What a cell of a table may hold; None is left empty."""
MIN_DIRECTED_STRIDE = 0.3
"""Shortest stride that shows in which direction the wearer walks, m; chosen by hand."""


def table_writer(file: TextIO) -> Callable[[Iterable[object]], object]:
    """Return what writes a row of a .csv, with an apostrophe before a name that programs would run as a formula."""
    write = csv.writer(file, lineterminator="\n").writerow
    return lambda row: write([_plain(cell) if isinstance(cell, str) else cell for cell in row])


def write_table(path: Path, columns: Sequence[str], rows: Iterable[Iterable[Cell]]) -> None:
    """Write a whole .csv, with six digits after the point of a float; raise OSError when it cannot be written."""
    with path.open("w", encoding="utf-8", newline="") as file:
        write = table_writer(file)
        write(columns)
        for row in rows:
            write([f"{cell:.6f}" if isinstance(cell, float) else cell for cell in row])


def _plain(text: str) -> str:
    text = printable(text, len(text))
    return f"'{text}" if FORMULA.match(text) and not AMOUNT.fullmatch(text) else text


def _stride_row(event: StrideTaken) -> list[object]:
    lengths = (*event.position, event.length, degrees(event.heading_change), event.height_change)
    sureness = (event.missing, event.longest_gap, event.length_sigma)
    before, after = [[f"{value:.6f}" for value in values] for values in (lengths, sureness)]
    flaws = " ".join([flaw.name.lower() for flaw in event.flaws])
    return [event.foot, repr(event.t_start), repr(event.t_end), *before, int(event.degraded), *after, flaws]


def cycle_value(event: GaitCycleMeasured, column: str) -> Any:
    """Return what gait_cycles.csv has of a gait cycle in a column, an angle in degrees; None for what is not known."""
    value = getattr(event, CYCLE_FIELDS[column])
    return degrees(value) if column.endswith("_deg") and value is not None else value


def _cycle_row(event: GaitCycleMeasured) -> list[object]:
    """Return the row of a gait cycle; a value that is not known is left empty."""
    row = []
    for column in CYCLE_FIELDS:
        value = cycle_value(event, column)
        if isinstance(value, float):
            value = repr(value) if column.startswith("t_") else f"{value:.6f}"
        row.append(int(value) if isinstance(value, bool) else value)
    return row


def _place_row(event: Placed, stride: StrideTaken | None) -> list[object]:
    """Return the row of a place; the direction of the newest `stride` on the plan is that in which the wearer walks.

    The track's frame lies on the plan as the heaviest candidate says, so that the direction is the heading of the frame
    plus that of the stride in it."""
    heaviest = event.candidates[0]
    heading = direction = ""
    if heaviest.heading is not None:
        heading = f"{degrees(heaviest.heading):.2f}"
        if stride is not None and stride.length >= MIN_DIRECTED_STRIDE:
            x, y, _ = stride.displacement
            direction = f"{degrees(remainder(heaviest.heading + atan2(y, x), tau)):.2f}"
    names = [event.level, *[printable(name or "", 80) for name in (event.room, event.door)]]
    numbers = [f"{value:.3f}" for value in (*event.position, event.spread)]
    return [repr(event.t), *names, *numbers, direction, heading, len(event.candidates), f"{heaviest.weight:.4f}"]


@define
class TrackFiles:
    """The files that are written to `directory`, which is made when there is none.

    Files of an earlier run are replaced. A FootMoved is a row of track.csv, a final StrideTaken one of strides.csv, a
    GaitCycleMeasured one of gait_cycles.csv. A defect changes rows of the last two that were written before it. A
    Placed is a row of places.csv with its heaviest candidate and the number of candidates, and with the direction on
    the plan of the newest stride. Every event except a LiveEvent is a line of events.jsonl. `places` says that the
    session has a floor plan; without one there is no places.csv. `path_to_write` returns for the path of a file the
    path to write, such as a temporary file that is renamed later; None writes to the path itself. Every method raises
    OSError, naming the directory, when the files cannot be made or written."""

    directory: Path
    places: bool = False
    path_to_write: Callable[[Path], Path] | None = None
    _stack: ExitStack = field(factory=ExitStack, init=False)
    _events: TextIO = field(init=False)
    _track: TextIO = field(init=False)
    _strides: TextIO = field(init=False)
    _tables: dict[str, Callable[[Iterable[object]], object]] = field(factory=dict, init=False)
    """What writes a row of each table, by the names of their files."""
    _stride: StrideTaken | None = field(default=None, init=False)
    """Newest final stride."""
    _cycles: list[GaitCycleMeasured] = field(factory=list, init=False)
    """Gait cycles, which are written at the end: a defect may withhold what was measured before it was found."""

    def __attrs_post_init__(self) -> None:
        self.directory.mkdir(parents=True, exist_ok=True)
        self._events, self._track, self._strides = [self._open(one) for one in (EVENTS_FILE, TRACK_FILE, STRIDES_FILE)]
        self._track.write(",".join(TRACK_COLUMNS) + "\n")
        places = [(PLACES_FILE, PLACE_COLUMNS)] if self.places else []
        for name, columns in [(STRIDES_FILE, STRIDE_COLUMNS), (GAIT_CYCLES_FILE, CYCLE_COLUMNS), *places]:
            self._tables[name] = table_writer(self._strides if name == STRIDES_FILE else self._open(name))
            self._tables[name](columns)

    def _open(self, name: str) -> TextIO:
        path = (self.path_to_write or Path)(self.directory / name)
        return self._stack.enter_context(path.open("w+", encoding="utf-8", newline=""))

    def write(self, event: Event) -> None:
        """Write one event; an OSError names the directory."""
        with os_errors_naming(self.directory):
            self._write(event)

    def _write(self, event: Event) -> None:
        if isinstance(event, FootMoved):
            x, y, z = event.position
            self._track.write(f"{event.t!r},{event.foot.value},{x:.6f},{y:.6f},{z:.6f},{event.phase.value}\n")
        if isinstance(event, LiveEvent):
            return
        self._events.write(json.dumps(event.to_dict(), allow_nan=False) + "\n")
        if isinstance(event, StrideTaken) and event.final:
            self._stride = event
            self._tables[STRIDES_FILE](_stride_row(event))
        elif isinstance(event, GaitCycleMeasured):
            self._cycles.append(event)
        elif isinstance(event, DefectFound):
            self._cycles = [as_found(cycle, event) for cycle in self._cycles]
            if event.spoilt_foot is not None:
                self._withhold_strides(event.spoilt_foot.value)
        elif isinstance(event, Placed) and self.places:
            self._tables[PLACES_FILE](_place_row(event, self._stride))

    def _withhold_strides(self, foot: str) -> None:
        """Mark the strides of a foot whose data cannot be right that were written before that was found."""
        self._strides.seek(0)
        rows = [*csv.DictReader(self._strides)]
        wrong = [row for row in rows if row["foot"] == foot and DEFECT not in row["flaws"]]
        for row in wrong:
            row["degraded"], row["flaws"] = "1", f"{row['flaws']} {DEFECT}".strip()
        if wrong:
            self._strides.seek(0)
            self._strides.truncate()
            for cells in [STRIDE_COLUMNS, *[row.values() for row in rows]]:
                self._tables[STRIDES_FILE](cells)

    def close(self) -> None:
        """Write the gait cycles and close all files; an OSError names the directory."""
        with os_errors_naming(self.directory):
            for cycle in self._cycles:
                self._tables[GAIT_CYCLES_FILE](_cycle_row(cycle))
            self._cycles.clear()
            self._stack.close()
