"""What `track` writes: events.jsonl, track.csv, strides.csv and gait_cycles.csv, with a floor plan also places.csv.

Times are the recording's own, written so that reading gives the same float again; places in m to the micrometre.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from contextlib import ExitStack
from enum import Enum
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Any, TextIO

import attrs
from attrs import define, field

from ..events import Event, FootMoved, GaitCycleMeasured, LiveEvent, Placed, StrideTaken
from ..events.fleet import FleetEvent
from ..types import Site

EVENTS, TRACK, STEPS, GAIT = "events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv"
PLACES, PLAN = "places.csv", "plan.svg"
TRACK_COLUMNS = ("t", "foot", "x", "y", "z", "phase")
STEP_COLUMNS = (
    "foot", "t_start", "t_end", "x", "y", "z", "stride_length", "heading_change", "height_change", "degraded",
)  # fmt: skip
GAIT_TIMES = ("t_start", "t_toe_off", "t")
GAIT_MEASURES = (
    "stride_time", "stance_time", "swing_time", "step_time", "initial_double_support", "terminal_double_support",
    "single_support", "stance_share", "double_support_share", "cadence", "stride_length", "step_length", "step_width",
    "speed", "clearance", "toe_off_angle", "heel_strike_angle", "turning_angle", "rise", "phase",
)  # fmt: skip
GAIT_COLUMNS = ("foot", "number", *GAIT_TIMES, *GAIT_MEASURES, "degraded", "steady")
PLACE_COLUMNS = ("t", "level", "x", "y", "z", "spread", "heading", "candidates", "weight")
FIRST_KEYS = ("t", "known_at", "final", "foot")


def plain(value: Any) -> Any:
    """`value` as JSON knows it: records as objects, enums by what they are called, tuples as lists, bytes as hex, and
    null for a number that is none."""
    match value:
        case Enum():
            return plain(value.value)
        case float():
            return value if isfinite(value) else None
        case bytes():
            return value.hex()
        case tuple() | list():
            return [plain(item) for item in value]
        case dict():
            return {str(plain(key)): plain(item) for key, item in value.items()}
        case _ if attrs.has(type(value)):
            return {a.name: plain(getattr(value, a.name)) for a in attrs.fields(type(value))}
        case _:
            return value


def event_record(event: Event | FleetEvent) -> dict[str, Any]:
    """One event as a JSON object: its class's name, its times, its foot where it has one, then its own fields.

    An event of the link has a site; where that is a foot, the foot is told too."""
    fields = plain(event)
    site = getattr(event, "site", None)
    if isinstance(site, Site) and site.foot is not None:
        fields.setdefault("foot", site.foot.value)
    first = {key: fields.pop(key) for key in FIRST_KEYS if key in fields}
    return {"event": type(event).__name__, **first, **fields}


def _place_row(event: Placed) -> list[str]:
    first = event.candidates[0]
    numbers = [f"{v:.3f}" for v in (*event.position, event.spread)]
    heading = "" if first.heading is None else f"{first.heading:.4f}"
    return [repr(event.t), event.level, *numbers, heading, str(len(event.candidates)), f"{first.weight:.4f}"]


def _gait_row(event: GaitCycleMeasured) -> list[str]:
    """What could not be told is left empty."""
    times = [repr(getattr(event, name)) for name in GAIT_TIMES]
    values = [getattr(event, name) for name in GAIT_MEASURES]
    measures = ["" if value is None else f"{value:.6f}" for value in values]
    return [event.foot.value, str(event.number), *times, *measures, str(int(event.degraded)), str(int(event.steady))]


@define
class TrackFiles:
    """The files in `directory`, which is made when there is none. Files of an earlier run are replaced.

    A FootMoved is a row of track.csv, a final StrideTaken one of strides.csv, a GaitCycleMeasured one of
    gait_cycles.csv, a Placed one of places.csv (its heaviest candidate's, and how many there are), and every event but
    the live ones (LiveEvent) a line of events.jsonl. `places`: of a session with a floor plan; without one there is no
    places.csv. `beside`: where to write what is to be a file's, in place of the file itself, as one that is renamed in
    the end. OSError, naming the directory, when they cannot be made or written (the disk is full).
    """

    directory: Path
    places: bool = False
    beside: Callable[[Path], Path] | None = None
    _stack: ExitStack = field(factory=ExitStack, init=False)
    _events: TextIO = field(init=False)
    _track: TextIO = field(init=False)
    _steps: Any = field(init=False)
    _gait: Any = field(init=False)
    _places: Any = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self.directory.mkdir(parents=True, exist_ok=True)
        self._events, self._track, steps = (self._open(name) for name in (EVENTS, TRACK, STEPS))
        self._track.write(",".join(TRACK_COLUMNS) + "\n")
        self._steps = csv.writer(steps, lineterminator="\n")
        self._steps.writerow(STEP_COLUMNS)
        self._gait = csv.writer(self._open(GAIT), lineterminator="\n")
        self._gait.writerow(GAIT_COLUMNS)
        if self.places:
            self._places = csv.writer(self._open(PLACES), lineterminator="\n")
            self._places.writerow(PLACE_COLUMNS)

    def _open(self, name: str) -> TextIO:
        path = self.directory / name
        if self.beside is not None:
            path = self.beside(path)
        return self._stack.enter_context(path.open("w", encoding="utf-8", newline=""))

    def write(self, event: Event) -> None:
        try:
            self._write(event)
        except OSError as error:
            raise self._named(error) from None

    def _named(self, error: OSError) -> OSError:
        return OSError(error.errno, error.strerror, str(self.directory))

    def _write(self, event: Event) -> None:
        if isinstance(event, FootMoved):
            x, y, z = event.position
            self._track.write(f"{event.t!r},{event.foot.value},{x:.6f},{y:.6f},{z:.6f},{event.phase.value}\n")
        if isinstance(event, LiveEvent):
            return
        self._events.write(json.dumps(event_record(event), allow_nan=False) + "\n")
        if isinstance(event, StrideTaken) and event.final:
            x, y, z = event.position
            lengths = (x, y, z, event.length, event.heading_change, event.height_change)
            row = [event.foot.value, repr(event.t_start), repr(event.t_end), *(f"{v:.6f}" for v in lengths)]
            self._steps.writerow([*row, int(event.degraded)])
        elif isinstance(event, GaitCycleMeasured):
            self._gait.writerow(_gait_row(event))
        elif isinstance(event, Placed) and self._places is not None:
            self._places.writerow(_place_row(event))

    def close(self) -> None:
        try:
            self._stack.close()
        except OSError as error:
            raise self._named(error) from None

    def __enter__(self) -> TrackFiles:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
