"""Rows of outcomes, which the tables of the terminal, the report and outcomes.csv share."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import asdict, evolve, frozen

from ...body.gait.means import GaitMeans
from ...events import Event, GaitCycleMeasured
from ...walk.walk import UNLIMITED_STRIDES
from ..tables.table import duration_text
from .mobility import MobilityOutcomes, unit_of
from .references import (
    SIX_MINUTE_CHANGE,
    UP_AND_GO_CHANGE,
    WALKING_SPEED_CHANGE,
    Person,
    Reference,
    SmallestChange,
    six_minute_reference,
    up_and_go_reference,
    walking_speed_reference,
)
from .spread import VARIABLE, IntervalEstimate, asymmetry, variability
from .walk_tests import SixMinuteWalk, TimedUpAndGo, is_measured

SIX_MINUTE_WALK, UP_AND_GO, WALK, MOBILITY = "six-minute walk", "timed up and go", "walk", "mobility"
OF_STRIDES = VARIABILITY, ASYMMETRY = "variability", "asymmetry"
"""Parts with an interval, of steady strides."""
LABELS = {
    "walkdur": "walking time", "wbsteps": "initial contacts", "turns": "turns", "wb": "walking bouts",
    "wbdur": "bout duration", "cadence": "cadence", "strdur": "stride duration", "ws": "walking speed",
    "strlen": "stride length", "all": "", "10": ", bouts > 10 s", "1030": ", bouts of 10 to 30 s",
    "30": ", bouts > 30 s", "60": ", bouts > 60 s", "sum": "", "avg": ", mean", "p90": ", 90th percentile",
    "var": ", CV",
}  # fmt: skip
"""Words for the parts of the names of mobility outcomes."""
MINUTE_NAME = "distance_minute_"
"""Beginning of the names of the distances of each minute, which a sentence has in place of the table."""
DIGITS = {"s": 2, "m": 2, "m/s": 2, "1/min": 1}
"""Digits after the point in tables by unit; a share is shown in percent with one digit."""
LARGE = 100.0
"""Size from which one digit is enough."""

REFERENCE_HEADERS = ["predicted", "lower limit of normal", "mean of a group", "95 % interval of that mean"]
"""Columns of references; a lower limit of normal and the interval of a mean are never in one."""

NamedValue = tuple[str, str, str, float | int | None]
"""Name, label, unit and value of an outcome."""


@frozen
class OutcomeRow:
    """One outcome with its interval and reference, where it has them; a share (no unit, a float) is 0.02 for 2 %."""

    part: str
    """Part of the outcomes that it belongs to."""
    name: str
    """Name of the outcome in outcomes.csv."""
    label: str
    """Name of the outcome in tables."""
    unit: str
    value: float | int | None
    interval: IntervalEstimate | None = None
    reference: Reference | None = None
    smallest_change: SmallestChange | None = None
    """The smallest change that matters; None where no publication gives one."""
    at_least: bool = False
    """True if the value lacks what was not measured."""
    extent: str = ""
    """What the value is of where that is not the whole test by both feet, such as "in 20 s of the six minutes"."""
    shortfalls: tuple[str, ...] = ()
    """Why the value is not that of a whole test, so that nothing is compared with it."""

    def shown(self, value: float | int | None) -> str:
        """Return a value of this outcome as a table shows it, without the unit."""
        if value is None or (not self.unit and isinstance(value, int)):
            return "-" if value is None else str(value)
        return f"{value if self.unit else 100.0 * value:z.{self.digits(value)}f}"

    @property
    def measured(self) -> str:
        """The value with its unit, and what it is of."""
        return f"{'at least ' * self.at_least}{self.shown(self.value)} {self.shown_unit}{self.extent}"

    def digits(self, value: float) -> int:
        """Return the number of digits after the point with which a table shows a value of this outcome."""
        return DIGITS[self.unit] if self.unit and abs(value) < LARGE else 1

    @property
    def cells(self) -> list[str]:
        """Cells of a table: label, value, unit, which is % for a share, and those of `REFERENCE_HEADERS`."""
        return [self.label, self.least + self.shown(self.value), self.shown_unit, *self.reference_cells]

    @property
    def least(self) -> str:
        """Sign before the value in a table: that it is at least so large, or nothing."""
        return ">= " if self.at_least else ""

    @property
    def shown_unit(self) -> str:
        """Unit in tables: % for a share."""
        return self.unit or ("" if isinstance(self.value, int) else "%")

    @property
    def interval_cells(self) -> list[str]:
        """Cells of a table: label, value, ends of the interval, strides, and strides that are needed."""
        one = self.interval
        known = (
            []
            if one is None
            else [f"{self.shown(one.low)} to {self.shown(one.high)}", str(one.strides), str(one.needed)]
        )
        return [self.label, self.shown(self.value), *known]

    @property
    def reference_cells(self) -> list[str]:
        """Cells of `REFERENCE_HEADERS`; empty where the reference has no such value."""
        cells = [""] * len(REFERENCE_HEADERS)
        if (one := self.reference) is not None:
            shown = f"{self.shown(one.value)} ({self.share_of_reference})"
            if one.lower_limit is not None:
                cells[:2] = [shown, self.shown(one.lower_limit)]
            else:
                interval = "" if one.interval is None else " to ".join([self.shown(end) for end in one.interval])
                cells[2:] = [shown, interval]
        return cells

    @property
    def share_of_reference(self) -> str:
        """The value in percent of the reference, such as "74 %"; "" without one."""
        one, value = self.reference, self.value
        return "" if one is None or value is None else f"{100.0 * value / one.value:.0f} %"


def six_minute_rows(walk: SixMinuteWalk, person: Person | None) -> list[OutcomeRow]:
    """Return the rows of a six-minute walk; the distance has a reference if the whole test was measured."""
    known = walk.measured or None
    unmeasured = None if walk.measured else walk.unmeasured_time
    long = {foot: t for foot, t in walk.alone_times.items() if not is_measured(t, walk.duration)}
    values: list[NamedValue] = [
        ("distance", "distance", "m", walk.distance),
        ("duration", "duration", "s", walk.duration),
        *[(f"distance_{foot}", f"distance of the {foot} foot", "m", d) for foot, d in walk.foot_distances.items()],
        ("unmeasured_time", "time in which no foot was measured", "s", unmeasured),
        *[(f"alone_{foot}_time", f"time of the {foot} foot alone", "s", t) for foot, t in long.items()],
        ("speed", "distance / duration", "m/s", known and walk.speed),
        ("cadence", "steps / duration", "1/min", known and walk.cadence),
        ("steps", "steps", "", known and walk.steps),
        *[(f"{MINUTE_NAME}{k}", f"distance in minute {k}", "m", d) for k, d in enumerate(walk.minutes, start=1)],
        ("distance_index", "change from minute 1 to 6", "", walk.distance_index),
        ("stops", "stops of more than 3 s", "", walk.stops),
        ("stopped_time", "time of these stops", "s", walk.stopped_time),
        ("about_turns", "turns about", "", walk.about_turns),
        ("degraded", "degraded strides", "", walk.degraded),
    ]  # fmt: skip
    shortfalls = [
        "" if walk.complete else "the recording ends before the six minutes do",
        "" if walk.measured else f"no foot was measured for {duration_text(walk.unmeasured_time)} of the six minutes",
    ]
    alone = [f"{duration_text(t)} of it by the {foot} foot alone" for foot, t in long.items()]
    extent = ", ".join(["" if walk.complete else f" in {duration_text(walk.duration)} of the six minutes", *alone])
    reference = None if person is None else six_minute_reference(person)
    first, *others = _rows(SIX_MINUTE_WALK, values, reference, SIX_MINUTE_CHANGE)
    first = evolve(first, at_least=not walk.measured, extent=extent, shortfalls=tuple(filter(None, shortfalls)))
    return [evolve(first, reference=None, smallest_change=None) if first.shortfalls else first, *others]


def up_and_go_rows(test: TimedUpAndGo, person: Person | None) -> list[OutcomeRow]:
    """Return the rows of a timed up and go; what strides say is left out where they may be missing."""
    known = test.measured or None
    values: list[NamedValue] = [
        ("duration", "total time", "s", test.duration),
        ("walking_time", "from the first toe-off to the last contact", "s", known and test.walking_time),
        ("steps", "steps", "", known and test.steps),
        ("distance", "distance", "m", known and test.distance),
    ]
    return _rows(UP_AND_GO, values, None if person is None else up_and_go_reference(person), UP_AND_GO_CHANGE)


def walk_rows(
    events: Sequence[Event], steps: int | None, distance: float | None, person: Person | None
) -> list[OutcomeRow]:
    """Return the rows of a walk at the usual pace, whose result is the speed of steady strides."""
    speed = steady_speed_row(events, person)
    values: list[NamedValue] = [
        ("speed", "speed of steady strides", speed.unit, speed.value),
        ("distance", "distance", "m", distance),
        ("steps", "steps", "", steps),
    ]
    return _rows(WALK, values, speed.reference, WALKING_SPEED_CHANGE)


def _rows(
    part: str, values: Sequence[NamedValue], reference: Reference | None, change: SmallestChange
) -> list[OutcomeRow]:
    """Return the rows of a walk test; reference and change are of the first one, the result of the test."""
    first, *others = [OutcomeRow(part, *value) for value in values]
    return [evolve(first, reference=reference, smallest_change=change), *others]


def mobility_rows(outcomes: MobilityOutcomes) -> list[OutcomeRow]:
    """Return the rows of mobility outcomes, by their names in Mobilise-D."""
    rows = []
    for name, value in asdict(outcomes).items():
        label = "".join([LABELS[part] for part in name.split("_")]).replace("bouts, bouts", "bouts")
        label = label.replace("bout duration, mean", "bout duration, median")
        rows.append(OutcomeRow(MOBILITY, name, label, unit_of(name), value))
    return rows


def steady_speed_row(events: Sequence[Event], person: Person | None) -> OutcomeRow:
    """Return the mean speed of steady strides as the gait table has it."""
    means = GaitMeans()
    for event in events:
        if isinstance(event, GaitCycleMeasured):
            means.add(event, UNLIMITED_STRIDES)
    walking = means.of(False)
    speed = None if walking is None or walking.both.speed is None else walking.both.speed.mean
    reference = None if person is None else walking_speed_reference(person)
    return OutcomeRow(MOBILITY, "steady_speed", "speed of steady strides, mean", "m/s", speed, reference=reference)


def stride_rows(events: Sequence[Event]) -> list[OutcomeRow]:
    """Return variability and asymmetry of steady strides (VARIABLE)."""
    rows: list[OutcomeRow] = []
    for part, estimate in ((VARIABILITY, variability), (ASYMMETRY, asymmetry)):
        for name in VARIABLE:
            one = estimate(events, name)
            rows.append(OutcomeRow(part, name, name.replace("_", " "), "", None if one is None else one.value, one))
    return rows
