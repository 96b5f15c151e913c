"""Reads a truth: what a reference system measured of walks, as a table of one's own, of gaitmap or of mobgap.

    truth = read_truth("truth.csv")

A row is an event, a stride, or figures of a walk or of a part of it. The names of its columns say which; TIMES and
FIGURES have those that are known, and each other column is one by which results are grouped. Lists of gaitmap 2 and
mobgap 1 count samples from the start of a recording (gaitmap: "Common Datatypes"; mobgap: "Common Datatypes")."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from enum import Enum
from pathlib import Path

from attrs import evolve, fields, frozen

from ..recording import printable
from ..recording.mapping.words import foot_of_text
from ..recording.text_table import TableError, TableRow, read_rows
from ..recording.unpacking import content_name
from ..show.outcomes.mobility import MobilityOutcomes
from ..show.output import CYCLE_FIELDS
from ..types import Foot

EVENT_NAMES = {
    "heel-strike": "heelstrike hs ic initialcontact footstrike fs",
    "toe-off": "toeoff to tc fc fo terminalcontact finalcontact footoff",
    "foot-flat": "footflat ff",
    "heel-off": "heeloff ho",
}
"""Names of events in a truth, in lower case without what parts their words, by their names in walk.GAIT_EVENTS."""
EVENT_COLUMNS = {"pre_ic": "heel-strike", "ic": "heel-strike", "tc": "toe-off"}
"""Columns of gaitmap and mobgap with samples of events; min_vel, the middle of stance, is no event here."""
FOOT_COLUMNS = ("foot", "lr_label", "side", "sensor")
FIGURES = {
    **{column: column for column in CYCLE_FIELDS if re.search("^(?!t_).*_(s|m|deg|share|min)$", column)},
    "stride_length": "stride_length_m",
    "stride_time": "stride_time_s",
    "gait_velocity": "speed_m_per_s",
    "stance_time": "stance_time_s",
    "swing_time": "swing_time_s",
    "stride_duration_s": "stride_time_s",
    "duration_s": "stride_time_s",
    "length_m": "stride_length_m",
    "speed_mps": "speed_m_per_s",
    "walking_speed_mps": "speed_m_per_s",
    "cadence_spm": "cadence_steps_per_min",
}
"""Columns of gait_cycles.csv that a truth may have, by themselves and by their names in gaitmap and mobgap."""
DISTANCE = "distance_m"
"""Parameter of a walk that is no column of gait_cycles.csv and no mobility outcome: the mean of the feet's."""
PARAMETERS = {*FIGURES.values(), *[one.name for one in fields(MobilityOutcomes)], DISTANCE}
"""Parameters of a walk."""
PARAMETER_KINDS = f"there are columns of gait_cycles.csv, mobility outcomes such as ws_30_avg, and {DISTANCE}"
IDS = {"s_id", "wb_id", "gs_id", "gsd_id", "step_id", "ic_id", "n_strides", "n_steps", "n_turns", "min_vel"}
"""Columns of gaitmap and mobgap that are neither compared nor groups."""
TIMES = {"event", "t_s", "t_start_s", "t_end_s", "start", "end", "sampling_rate_hz", "offset_s"}
OWN = {
    "recording",
    "parameter",
    "value",
    "true",
    "found",
    "degraded",
    *TIMES,
    *FOOT_COLUMNS,
    *FIGURES,
    *EVENT_COLUMNS,
    *IDS,
}
"""Columns whose meaning is known; all others are groups."""
SHAPES = (
    "events (foot,event,t_s), strides (foot,t_start_s,t_end_s,stride_length_m), parameters (parameter,value), a stride "
    "list of gaitmap (s_id,start,end), or contacts or walking bouts of mobgap (ic,lr_label; wb_id,start,end)"
)


class Kind(Enum):
    """What a row of a truth is."""

    EVENT = "event"
    STRIDE = "stride"
    WALK = "walk"
    """Figures of a walk, or of the part of it between two times."""


@frozen
class TrueRow:
    """One event, stride or walk of a truth."""

    kind: Kind
    recording: str
    """Name of the recording; "" where the table names none."""
    foot: Foot | None
    groups: Mapping[str, str]
    """Values of all other columns."""
    from_start: bool
    """True if times are since the start of the recording; else they are on its clock."""
    t_start: float | None = None
    """Start of a stride, or of a part of a walk, s; None if it is not known."""
    t_end: float = 0.0
    """Its end, or the time of an event, s."""
    event: str = ""
    """Kind of an event, by its name in walk.GAIT_EVENTS."""
    values: Mapping[str, float] = {}
    """Figures by their names in gait_cycles.csv, with their units there."""

    def at(self, start: float) -> TrueRow:
        """Return the row with times on the clock of the recording, which starts at `start` s."""
        if not self.from_start:
            return self
        t_start = None if self.t_start is None else self.t_start + start
        return evolve(self, t_start=t_start, t_end=self.t_end + start, from_start=False)


def read_truth(path: Path | str, *, rate: float | None = None, offset: float = 0.0) -> list[TrueRow]:
    """Return the rows of a truth; raise TableError, naming what is missing, for a table that is none.

    `rate` is the number of samples a second that lists of gaitmap and mobgap count in, `offset` what is added to all
    times, s."""
    rows = [one for row in read_rows(path, ()) for one in _Reader(row, rate, offset).rows()]
    if not rows:
        raise TableError(f"{path}: has no row with a value")
    ends: dict[tuple[str, Foot | None, float], Mapping[str, float]] = {}
    for row in rows:
        if row.kind is Kind.STRIDE and ends.setdefault((row.recording, row.foot, row.t_end), row.values) != row.values:
            raise TableError(f"{path}: two strides with different values end at {row.t_end:.10g} s")
    return rows


def recording_name(path: Path | str) -> str:
    """Return the name of a recording: that of its file, without folder, ending and the word for a foot.

    It is the folder's name if nothing else is left: S01/left.csv and S01_left.csv are both of S01."""
    stem = Path(content_name(Path(path))).stem
    words = [word for word in re.split(r"[\s_.-]+", stem) if foot_of_text(word) is None]
    return stem if foot_named(path) is None else "_".join(filter(None, words)) or Path(path).parent.name


def foot_named(path: Path | str) -> Foot | None:
    """Return the foot that the name of a file says; None if it says none."""
    return foot_of_text(Path(content_name(Path(path))).stem)


@frozen
class _Reader:
    """Reads one row of a table."""

    row: TableRow
    rate: float | None
    offset: float

    def rows(self) -> Iterator[TrueRow]:
        """Yield what the row says."""
        columns, of_row = self.row.cells.keys(), self._of_row()
        # the duration of a bout is none of its strides
        named = [name for name in columns if name in FIGURES and not (name == "duration_s" and "wb_id" in columns)]
        figures = {FIGURES[name]: value for name in named if (value := self._number(name)) is not None}
        if {"event", "t_s"} <= columns:
            yield from self._event(of_row, self.row.cells["event"], self._time("t_s"))
        elif {"parameter", "value"} <= columns:
            if (value := self._number("value")) is not None:
                span = self._time("t_start_s"), self._time("t_end_s")
                yield self._part(of_row, *span, {self._parameter(): value})
        elif {"t_start_s", "t_end_s"} <= columns:
            yield from self._stride(of_row, self._time("t_start_s"), self._time("t_end_s"), figures)
        elif {"start", "end"} <= columns or "ic" in columns:
            yield from self._in_samples(of_row, figures)
        else:
            raise TableError(f"{self.row.where}: the columns are none of a truth; known are {SHAPES}")

    def _in_samples(self, of_row: TrueRow, figures: dict[str, float]) -> Iterator[TrueRow]:
        """Yield what a row of gaitmap or mobgap says, whose times are numbers of samples."""
        if (rate := self._number("sampling_rate_hz") or self.rate) is None:
            what = "its times count samples; --truth-rate, or a column sampling_rate_hz, says how many a second"
            raise TableError(f"{self.row.where}: {what}")
        times = {name: self._time(name, rate) for name in ("start", "end", *EVENT_COLUMNS)}
        t_start, t_end, ic = times["start"], times["end"], times["ic"]
        if "wb_id" in self.row.cells:
            yield self._part(of_row, t_start, t_end, figures)
            return
        for column, event in EVENT_COLUMNS.items():
            yield from self._event(of_row, event, times[column])
        if None not in (t_start, ic) and ic != t_start:
            # a stride of gaitmap between other events than contacts ends, as a gait cycle, with the contact in it
            t_start, t_end = times["pre_ic"], ic
        yield from self._stride(of_row, t_start, t_end, figures)

    def _event(self, of_row: TrueRow, name: str, t: float | None) -> Iterator[TrueRow]:
        key = re.sub(r"[\s_-]", "", name).lower()
        kind = next((event for event, names in EVENT_NAMES.items() if key in names.split()), None)
        if kind is None:
            what = f"there is no event {printable(name, 40)}; there are HeelStrike, FootFlat, HeelOff and ToeOff"
            raise TableError(f"{self.row.where}: {what}")
        if t is not None:
            yield evolve(of_row, event=kind, t_end=t)

    def _stride(
        self, of_row: TrueRow, t_start: float | None, t_end: float | None, figures: dict[str, float]
    ) -> Iterator[TrueRow]:
        if t_end is not None:
            self._check_order(t_start, t_end)
            time = {} if t_start is None else {"stride_time_s": t_end - t_start}
            yield evolve(of_row, kind=Kind.STRIDE, t_start=t_start, t_end=t_end, values=time | figures)

    def _check_order(self, t_start: float | None, t_end: float) -> None:
        if t_start is not None and t_start >= t_end:
            raise TableError(f"{self.row.where}: ends at {t_end:.10g} s, before it starts at {t_start:.10g} s")

    def _part(self, of_row: TrueRow, t_start: float | None, t_end: float | None, values: dict[str, float]) -> TrueRow:
        """Return the figures of the walk, or of the part of it between two times."""
        if t_start is None or t_end is None:
            return evolve(of_row, kind=Kind.WALK, values=values)
        self._check_order(t_start, t_end)
        return evolve(of_row, kind=Kind.WALK, values=values, t_start=t_start, t_end=t_end)

    def _parameter(self) -> str:
        given = self.row.cells["parameter"]
        if (name := FIGURES.get(given, given)) in PARAMETERS:
            return name
        raise TableError(f"{self.row.where}: there is no parameter {printable(name, 40)}; {PARAMETER_KINDS}")

    def _of_row(self) -> TrueRow:
        """Return what the row says besides its times and figures."""
        cells = self.row.cells
        foot = next((cells[name] for name in FOOT_COLUMNS if self.row.has(name)), "both")
        found = foot_of_text(foot)
        if found is None and foot.lower() != "both":
            raise TableError(f"{self.row.where}: a foot is left or right, not {printable(foot, 40)}")
        groups = {name: value for name, value in cells.items() if name not in OWN}
        from_start = {"t_s", "t_end_s"}.isdisjoint(cells)
        return TrueRow(Kind.EVENT, cells.get("recording", ""), found, groups, from_start)

    def _time(self, column: str, rate: float = 1.0) -> float | None:
        """Return the time in a column, s, `rate` numbers of it a second."""
        value = self._number(column)
        return None if value is None else value / rate + self.offset + (self._number("offset_s") or 0.0)

    def _number(self, column: str) -> float | None:
        return self.row.number(column) if self.row.has(column) else None
