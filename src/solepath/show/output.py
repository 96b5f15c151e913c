"""Writes events.jsonl, track.csv, strides.csv and gait_cycles.csv and, with a floor plan, places.csv.

events.jsonl is for programs, in SI units and radians. The tables are for people, with the unit of a column in its
header and angles in degrees. Times are on the recording's clock, written so that reading gives the same float again.
Positions are in m, world frame, with six digits after the point; places are in m, plan frame, with three."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from math import atan2, degrees, remainder, tau
from pathlib import Path
from typing import Any, TextIO

from attrs import define, field

from ..events import Event, FootMoved, GaitCycleMeasured, LiveEvent, Placed, StrideTaken
from ..recording.errors import printable

EVENTS_FILE, TRACK_FILE, STRIDES_FILE, GAIT_CYCLES_FILE = "events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv"
PLACES_FILE, PLAN_FILE = "places.csv", "plan.svg"
TRACK_COLUMNS = ("t_s", "foot", "x_m", "y_m", "z_m", "phase")
STRIDE_COLUMNS = (
    "foot", "t_start_s", "t_end_s", "x_m", "y_m", "z_m", "stride_length_m", "heading_change_deg", "height_change_m",
    "degraded", "missing", "longest_gap_s", "length_sigma_m", "flaws",
)  # fmt: skip
CYCLE_TIME_FIELDS = ("t_start", "t_toe_off", "t")
CYCLE_MEASURE_FIELDS = (
    ("stride_time", "s"),
    ("stance_time", "s"),
    ("swing_time", "s"),
    ("step_time", "s"),
    ("initial_double_support", "s"),
    ("terminal_double_support", "s"),
    ("single_support", "s"),
    ("stance_share", ""),
    ("double_support_share", ""),
    ("cadence", "steps_per_min"),
    ("stride_length", "m"),
    ("speed", "m_per_s"),
    ("clearance", "m"),
    ("toe_off_angle", "deg"),
    ("heel_strike_angle", "deg"),
    ("turning_angle", "deg"),
    ("rise", "m"),
    ("phase", ""),
)
"""Fields of GaitCycleMeasured with the unit in which each is written; a share has no unit."""
CYCLE_COLUMNS = (
    "foot",
    "number",
    *[f"{name}_s" for name in CYCLE_TIME_FIELDS],
    *[f"{name}_{unit}" if unit else name for name, unit in CYCLE_MEASURE_FIELDS],
    "degraded",
    "steady",
)
PLACE_COLUMNS = (
    "t_s",
    "level",
    "room",
    "door",
    "x_m",
    "y_m",
    "z_m",
    "spread_m",
    "walking_direction_deg",
    "frame_heading_deg",
    "candidates",
    "weight",
)
MIN_DIRECTED_STRIDE = 0.3
"""Shortest stride that shows in which direction the wearer walks, m; chosen by hand."""


def _stride_row(event: StrideTaken) -> list[str]:
    x, y, z = event.position
    lengths = (x, y, z, event.length, degrees(event.heading_change), event.height_change)
    numbers = [f"{value:.6f}" for value in lengths]
    sureness = [f"{value:.6f}" for value in (event.missing, event.longest_gap, event.length_sigma)]
    flaws = " ".join([flaw.name.lower() for flaw in event.flaws])
    row = [event.foot.value, repr(event.t_start), repr(event.t_end), *numbers]
    return [*row, str(int(event.degraded)), *sureness, flaws]


def _cycle_row(event: GaitCycleMeasured) -> list[str]:
    """Return the row of a gait cycle; a value that is not known is left empty."""
    times = [repr(getattr(event, name)) for name in CYCLE_TIME_FIELDS]
    measures = [_measure(getattr(event, name), unit) for name, unit in CYCLE_MEASURE_FIELDS]
    return [event.foot.value, str(event.number), *times, *measures, str(int(event.degraded)), str(int(event.steady))]


def _measure(value: float | None, unit: str) -> str:
    if value is None:
        return ""
    return f"{degrees(value) if unit == 'deg' else value:.6f}"


def _place_row(event: Placed, stride: StrideTaken | None) -> list[str]:
    """Return the row of a place; the direction of the newest `stride` on the plan is that in which the wearer walks.

    The track's frame lies on the plan as the heaviest candidate says, so that the direction is the heading of the frame
    plus that of the stride in it."""
    heaviest = event.candidates[0]
    numbers = [f"{value:.3f}" for value in (*event.position, event.spread)]
    heading = direction = ""
    if heaviest.heading is not None:
        heading = f"{degrees(heaviest.heading):.2f}"
        if stride is not None and stride.length >= MIN_DIRECTED_STRIDE:
            x, y, _ = stride.displacement
            direction = f"{degrees(remainder(heaviest.heading + atan2(y, x), tau)):.2f}"
    shares = [direction, heading, str(len(event.candidates)), f"{heaviest.weight:.4f}"]
    return [
        repr(event.t),
        event.level,
        printable(event.room or "", 80),
        printable(event.door or "", 80),
        *numbers,
        *shares,
    ]


@contextmanager
def os_errors_naming(path: Path) -> Iterator[None]:
    """Name `path` in every OSError within the context; the system does not name the file when the disk is full."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None


@define
class TrackFiles:
    """The files that are written to `directory`, which is made when there is none.

    Files of an earlier run are replaced. A FootMoved is a row of track.csv, a final StrideTaken one of strides.csv, a
    GaitCycleMeasured one of gait_cycles.csv. A Placed is a row of places.csv with its heaviest candidate and the number
    of candidates, and with the direction on the plan of the newest stride. Every event except a LiveEvent is a line of
    events.jsonl. `places` says that the session has a floor plan; without one there is no places.csv. `path_to_write`
    returns for the path of a file the path to write, such as a temporary file that is renamed later; None writes to the
    path itself. Every method raises OSError, naming the directory, when the files cannot be made or written."""

    directory: Path
    places: bool = False
    path_to_write: Callable[[Path], Path] | None = None
    _stack: ExitStack = field(factory=ExitStack, init=False)
    _events: TextIO = field(init=False)
    _track: TextIO = field(init=False)
    _strides: Any = field(init=False)
    _cycles: Any = field(init=False)
    _places: Any = field(default=None, init=False)
    _stride: StrideTaken | None = field(default=None, init=False)
    """Newest final stride."""

    def __attrs_post_init__(self) -> None:
        self.directory.mkdir(parents=True, exist_ok=True)
        self._events, self._track = self._open(EVENTS_FILE), self._open(TRACK_FILE)
        self._track.write(",".join(TRACK_COLUMNS) + "\n")
        self._strides = self._table(STRIDES_FILE, STRIDE_COLUMNS)
        self._cycles = self._table(GAIT_CYCLES_FILE, CYCLE_COLUMNS)
        if self.places:
            self._places = self._table(PLACES_FILE, PLACE_COLUMNS)

    def _open(self, name: str) -> TextIO:
        path = self.directory / name
        if self.path_to_write is not None:
            path = self.path_to_write(path)
        return self._stack.enter_context(path.open("w", encoding="utf-8", newline=""))

    def _table(self, name: str, columns: tuple[str, ...]) -> Any:
        table = csv.writer(self._open(name), lineterminator="\n")
        table.writerow(columns)
        return table

    def write(self, event: Event) -> None:
        """Write one event; an OSError names the directory."""
        try:
            self._write(event)
        except OSError as error:  # the same as `os_errors_naming`, which would be slow for each event
            raise OSError(error.errno, error.strerror, str(self.directory)) from None

    def _write(self, event: Event) -> None:
        if isinstance(event, FootMoved):
            x, y, z = event.position
            self._track.write(f"{event.t!r},{event.foot.value},{x:.6f},{y:.6f},{z:.6f},{event.phase.value}\n")
        if isinstance(event, LiveEvent):
            return
        self._events.write(json.dumps(event.to_dict(), allow_nan=False) + "\n")
        if isinstance(event, StrideTaken) and event.final:
            self._stride = event
            self._strides.writerow(_stride_row(event))
        elif isinstance(event, GaitCycleMeasured):
            self._cycles.writerow(_cycle_row(event))
        elif isinstance(event, Placed) and self._places is not None:
            self._places.writerow(_place_row(event, self._stride))

    def close(self) -> None:
        """Close all files; an OSError names the directory."""
        with os_errors_naming(self.directory):
            self._stack.close()
