"""Agreement of what solepath found with what a reference system measured: pairs of values, bias, limits, ICC.

    truth = read_truth("truth.csv")
    comparison = compare_walks(truth, {"S01": session.feed(samples) + session.finish()})
    print(comparison.agreement)

Bias is the mean of the differences, found minus true. The 95 % limits of agreement are bias +- 1.96 times their
standard deviation (Bland & Altman 1986, Lancet 327; 1999, Stat. Methods Med. Res. 8). ICC is ICC(2,1) of Shrout &
Fleiss 1979, Psychol. Bull. 86, which is ICC(A,1) of McGraw & Wong 1996, Psychol. Methods 1: two-way random effects,
absolute agreement, single measurement. pingouin computes it (extra `validate`)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from attrs import frozen

from ..events import Event, GaitCycleMeasured
from ..show.outcomes.bouts import mean_of
from ..show.outcomes.clinic import OutcomeRequest
from ..show.outcomes.rows import MOBILITY
from ..show.output import CYCLE_FIELDS, cycle_value
from ..types import Foot
from ..types.extras import install_hint
from ..walk.walk import GAIT_EVENTS, Walk
from .comparison import STRIDE_TOLERANCE
from .matching import TOLERANCE, is_covered, pairs
from .truth_table import DISTANCE, Kind, TrueRow, recording_name

Key = TypeVar("Key", bound=Hashable)
Item = TypeVar("Item")
PairCells = dict[str, Any]
"""A value of the truth and what was found, by the columns of WalkComparison.pairs."""
LIMIT = 1.96
"""Standard deviations from the bias to a limit of agreement: 95 % of a normal distribution (Bland & Altman 1986)."""
MIN_PAIRS = 3
"""Least number of pairs with an ICC, and of recordings whose means are compared; chosen by hand."""
MAX_GROUPS = 20
"""Largest number of values of a column by which results are grouped; with more, it is a number or a comment."""
MOST_TIMES = 100.0
"""Number of times by which a truth that counts in s may be longer than its recording; chosen by hand."""
OTHER_UNITS = {
    "_m_per_s": {"km/h": 3.6, "cm/s": 100.0},
    "_per_min": {"strides a minute": 0.5},
    "_share": {"%": 100.0},
    "_deg": {"rad": 0.01745},
    "_s": {"ms": 1000.0},
    "_m": {"cm": 100.0, "mm": 1000.0},
}
"""Other units of parameters by the ends of their names, and how many of them are one."""
UNIT_RATIO = 1.4
"""Ratio up to which a truth in another unit may differ from what was found; chosen by hand."""
MEANS = "means of recordings"
"""What the rows of the means of each recording are by, in place of a column."""
EVENT_PARAMETERS = {name: f"{name.replace('-', '_')}_s" for name in GAIT_EVENTS.values()}
"""Parameters that are times of events, such as heel_strike_s, by their names in GAIT_EVENTS."""
PAIR_COLUMNS = ["recording", "foot", "parameter", "true", "found", "degraded"]


class NoMatch(Exception):
    """Error for a truth that has nothing in common with what was found."""


@frozen(eq=False)
class WalkComparison:
    """All values of a truth with what was found, as data frames of pandas."""

    pairs: Any
    """One row for each value: recording, foot, parameter (named as in gait_cycles.csv; of events as in heel_strike_s),
    true and found value (missing where only the other side has one), `degraded` (a stride that solepath says is wrong:
    it is in no figure), and the other columns of the truth."""

    @classmethod
    def of(cls, cells: Iterable[PairCells]) -> WalkComparison:
        """Return the comparison of these pairs."""
        return cls(_frame(cells).astype({"true": float, "found": float, "degraded": bool}))

    @property
    def agreement(self) -> Any:
        """One row for each parameter.

        n, bias, limits (lower, upper), ICC with its 95 % confidence interval, standard deviation of the differences
        (sd), numbers of values that only the truth has (not_found), that only solepath has within the time that the
        truth covers (extra), and of degraded strides, and F1: 2 x matched / (true + found)."""
        return _frame([{"parameter": name, **agreement_of(found)} for name, found in self.parts])

    @property
    def groups(self) -> Any:
        """The same by foot, by each other column of the truth, and of the means of recordings."""
        columns = ["by", "group", *self.agreement.columns]
        return _frame([row for name, found in self.parts for row in _group_rows(name, found)], columns)

    @property
    def unit_warnings(self) -> list[str]:
        """Sentences on parameters whose truth seems to be in another unit, by the median ratio to what was found."""
        sentences = []
        for name, found in self.parts:
            both = usable(found)
            ratio = (both.true / both.found).median()
            units = next((units for end, units in OTHER_UNITS.items() if name.endswith(end)), {})
            for unit, factor in units.items():
                if UNIT_RATIO > ratio / factor > 1.0 / UNIT_RATIO:
                    sentences.append(f"{name}: the truth is {ratio:.3g} times what was found: is it in {unit}?")
        return sentences

    @property
    def parts(self) -> Any:
        """Names of the parameters with their pairs."""
        return self.pairs.groupby("parameter", sort=False)


def _frame(rows: Iterable[PairCells], columns: Sequence[str] | None = None) -> Any:
    import pandas

    return pandas.DataFrame(rows, columns=columns)


def by_key(items: Iterable[Item], key: Callable[[Item], Key]) -> dict[Key, list[Item]]:
    """Return the items of each key, in the order in which keys first come."""
    found = defaultdict[Key, list[Item]](list)
    for item in items:
        found[key(item)].append(item)
    return dict(found)


def compare_walks(
    truth: Sequence[TrueRow], walks: Mapping[str, Iterable[Event]], *, tolerance: float | None = None
) -> WalkComparison:
    """Compare the events of sessions, by the names of their recordings, with the rows of a truth.

    `tolerance` is the largest time between what is matched, s; None for 250 ms of events and 400 ms of the ends of
    strides. ImportError without the extra `validate`, NoMatch if nothing in the truth is of these walks."""
    try:
        import pingouin  # noqa: F401
    except ImportError:
        raise ImportError(f"the ICC needs pingouin: {install_hint('validate')}") from None
    cells: list[PairCells] = []
    for name, rows in rows_by_walk(truth, [*walks]).items():
        walk = Walk.of(walks[name])
        start, _ = walk.sample_span or walk.event_span or (0.0, 0.0)
        cells += compare_walk(rows, walk, name, start=start, tolerance=tolerance)
    return WalkComparison.of(cells)


def rows_by_walk(truth: Sequence[TrueRow], names: Sequence[str]) -> dict[str, list[TrueRow]]:
    """Return the rows of each recording of these names that the truth has; raise NoMatch if it has none of them."""
    if len(names) == 1 and not any([row.recording for row in truth]):
        return {names[0]: [*truth]}
    known = {recording_name(name): name for name in names}
    rows = by_key(truth, lambda row: known.get(row.recording) or known.get(recording_name(row.recording), ""))
    found = {name: rows[name] for name in names if name in rows}
    if not found:
        there = ", ".join(dict.fromkeys([row.recording or "none" for row in truth]))
        raise NoMatch(f"the truth's recordings ({there[:200]}) are none of {', '.join(known)[:200]}")
    return found


def compare_walk(
    rows: Sequence[TrueRow], walk: Walk, name: str, *, start: float, tolerance: float | None = None
) -> list[PairCells]:
    """Return the pairs of one walk, which keeps all, and the rows of its truth; the recording starts at `start` s."""
    pairing = _Pairing(walk, name, tolerance)
    parts = by_key([row.at(start) for row in rows], lambda row: (row.kind, row.event, row.foot))
    makers = {Kind.WALK: pairing.figures}
    found = [cells for key, part in parts.items() for cells in makers.get(key[0], pairing.matched)(part)]
    if all([None in (cells["true"], cells["found"]) for cells in found]):
        raise NoMatch(
            f"{name}: nothing of the truth matches{_why([one for part in parts.values() for one in part], walk)}"
        )
    return found


def _why(rows: Sequence[TrueRow], walk: Walk) -> str:
    """Return that truth and recording are of different feet, or which times they have; "" if one has none."""
    true, found = {row.foot for row in rows}, {*walk.known_feet}
    if None not in true and found and not true & found:
        [theirs], [ours] = true, found
        return f": it is of the {theirs} foot, the recording of the {ours} one; --foot says otherwise"
    times = [row.t_end for row in rows if row.kind is not Kind.WALK]
    if not times or walk.event_span is None:
        return ""
    spans = (min(times), max(times)), walk.event_span
    (first, last), (start, end) = spans
    here, there = [f"{first:.1f} to {last:.1f} s" for first, last in spans]
    advice = "--offset, or a column offset_s, is added to the truth's"
    if last - first > MOST_TIMES * (end - start):
        advice = "are the truth's in ms?"
    elif start < last and first < end:
        advice = f"are left and right swapped, or the clocks apart by less than a stride ({advice})?"
    return f": its times are {here}, the recording's {there}; {advice}"


@frozen
class _Pairing:
    """Makes the pairs of one walk."""

    walk: Walk
    recording: str
    tolerance: float | None

    def matched(self, rows: Sequence[TrueRow]) -> Iterator[PairCells]:
        """Yield the pairs of events of one kind, or of the figures of strides, of a foot."""
        by_time = {row.t_end: row for row in rows}  # a contact may be in two strides of the truth
        true, event = sorted(by_time), rows[0].event
        tolerance = self.tolerance or (TOLERANCE if event else STRIDE_TOLERANCE)
        cycles = sorted(self._cycles(rows[0]), key=lambda cycle: cycle.t)
        found, middles = [one.t for one in cycles], [0.5 * (one.t_start + one.t) for one in cycles]
        spans = [(row.t_end if row.t_start is None else row.t_start, row.t_end) for row in rows]
        if event:
            found = middles = sorted([t for foot in self._feet(rows[0]) for t in self.walk.times[foot][event]])
            spans = [(true[0] - tolerance, true[-1] + tolerance)]
        by_true = dict(pairs(true, found, tolerance))
        matches: list[tuple[float | None, int | None]] = [(t, by_true.get(i)) for i, t in enumerate(true)]
        extra = sorted({*range(len(found))} - {*by_true.values()})
        matches += [(None, j) for j in extra if is_covered(middles[j], spans, 0.0)]
        for t, j in matches:
            row = by_time[_nearest(true, found[j or 0]) if t is None else t]
            values = {EVENT_PARAMETERS[event]: row.t_end} if event else row.values
            for name, value in values.items():
                measured = None if j is None else found[j] if event else cycle_value(cycles[j], name)
                degraded = j is not None and not event and cycles[j].degraded
                yield self._cells(row, name, None if t is None else value, measured, degraded)

    def figures(self, rows: Sequence[TrueRow]) -> Iterator[PairCells]:
        """Yield the pairs of figures of the walk, or of parts of it."""
        for row in rows:
            for name, value in row.values.items():
                yield self._cells(row, name, value, self._figure(row, name))

    def _figure(self, row: TrueRow, name: str) -> float | None:
        if name == DISTANCE:
            return mean_of([self.walk.feet[foot].distance for foot in self._feet(row) if foot in self.walk.feet])
        if name not in CYCLE_FIELDS:
            outcomes = OutcomeRequest(outcomes=True).results(self.walk).part(MOBILITY)
            return next((one.value for one in outcomes if one.name == name), None)
        cycles = [cycle for cycle in self._cycles(row) if not cycle.degraded]
        if row.t_start is None:
            cycles = [cycle for cycle in cycles if cycle.steady]
        else:
            span, tolerance = [(row.t_start, row.t_end)], self.tolerance or TOLERANCE
            cycles = [one for one in cycles if all([is_covered(t, span, tolerance) for t in (one.t_start, one.t)])]
        return mean_of([cycle_value(cycle, name) for cycle in cycles])

    def _feet(self, row: TrueRow) -> Sequence[Foot]:
        return [*Foot] if row.foot is None else [row.foot]

    def _cycles(self, row: TrueRow) -> list[GaitCycleMeasured]:
        return [cycle for foot in self._feet(row) for cycle in self.walk.cycles[foot]]

    def _cells(
        self, row: TrueRow, name: str, true: float | None, found: float | None, degraded: bool = False
    ) -> PairCells:
        values = (self.recording, row.foot and row.foot.value, name, true, found, degraded)
        return {**dict(zip(PAIR_COLUMNS, values, strict=True)), **row.groups}


def _nearest(times: Sequence[float], t: float) -> float:
    return min(times, key=lambda one: abs(one - t))


def usable(found: Any) -> Any:
    """Return the pairs that count: with both values, and not of a degraded stride."""
    return found[~found.degraded].dropna(subset=["true", "found"])


def agreement_of(found: Any) -> PairCells:
    """Return the agreement of the pairs of a parameter, by the columns of WalkComparison.agreement."""
    both = usable(found)
    differences, n = both.found - both.true, len(both)
    bias, sd, degraded = differences.mean(), differences.std(), len(found.dropna(subset=["true", "found"])) - n
    not_found, extra = int(found.found.isna().sum()), int(found.true.isna().sum())
    has_icc = n >= MIN_PAIRS and found.parameter.iloc[0] not in EVENT_PARAMETERS.values()
    matched = 2 * (n + degraded)
    return {
        "n": n,
        "bias": bias,
        "lower": bias - LIMIT * sd,
        "upper": bias + LIMIT * sd,
        **(intraclass_correlation(both) if has_icc else dict.fromkeys(("icc", "icc_lower", "icc_upper"))),
        "sd": sd,
        "not_found": not_found,
        "extra": extra,
        "degraded": degraded,
        "f1": matched / (matched + not_found + extra),
    }


def _group_rows(parameter: str, found: Any) -> Iterator[PairCells]:
    """Yield the agreement by foot, by each other column, and of the means of recordings."""
    for by in ["foot", *[name for name in found.columns if name not in PAIR_COLUMNS]]:
        parts = [*found.groupby(by, sort=False)]
        if 1 < len(parts) <= MAX_GROUPS:
            yield from [{"by": by, "group": of, "parameter": parameter, **agreement_of(part)} for of, part in parts]
    both = usable(found)
    means = (
        both.groupby("recording", as_index=False)[["true", "found"]].mean().assign(parameter=parameter, degraded=False)
    )
    if parameter not in EVENT_PARAMETERS.values() and MIN_PAIRS <= len(means) < len(both):
        yield {"by": MEANS, "group": "", "parameter": parameter, **agreement_of(means)}


def intraclass_correlation(both: Any) -> dict[str, float]:
    """Return ICC(2,1) of the columns true and found, and the ends of its 95 % confidence interval."""
    import pingouin

    ratings = both.reset_index(drop=True).reset_index().melt("index", ["true", "found"])
    row = pingouin.intraclass_corr(ratings, "index", "variable", "value").set_index("Type").loc["ICC(A,1)"]
    return dict(zip(("icc", "icc_lower", "icc_upper"), (row["ICC"], *row["CI95"]), strict=True))
