"""Agreement of what solepath found with what a reference system measured: pairs of values, bias, limits, ICC.

    truth = read_truth("truth.csv")
    comparison = compare_walks(truth, {"S01": session.feed(samples) + session.finish()})

Bias is the mean of the differences, found minus true. The 95 % limits of agreement are bias +- 1.96 times their
standard deviation (Bland & Altman 1986, Lancet 327; 1999, Stat. Methods Med. Res. 8). ICC is ICC(2,1) of Shrout &
Fleiss 1979, Psychol. Bull. 86, which is ICC(A,1) of McGraw & Wong 1996, Psychol. Methods 1: two-way random effects,
absolute agreement, single measurement. pingouin computes it (extra `validate`)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from math import isfinite
from statistics import fmean, stdev
from typing import TypeVar

from attrs import field, frozen

from ..events import Event, GaitCycleMeasured
from ..show.outcomes.bouts import mean_of
from ..show.outcomes.clinic import OutcomeRequest
from ..show.outcomes.rows import MOBILITY
from ..show.output import CYCLE_FIELDS, cycle_value
from ..types import Foot
from ..types.extras import install_hint
from ..walk.walk import Walk
from .comparison import STRIDE_TOLERANCE
from .matching import TOLERANCE, is_covered, pairs
from .truth_table import DISTANCE, Kind, TrueRow, recording_name

Key = TypeVar("Key", bound=Hashable)
Item = TypeVar("Item")
Span = tuple[float, float]
LIMIT = 1.96
"""Standard deviations from the bias to a limit of agreement: 95 % of a normal distribution (Bland & Altman 1986)."""
MIN_PAIRS = 3
"""Least number of pairs with an ICC, and of recordings whose means are compared; chosen by hand."""
MAX_GROUPS = 20
"""Largest number of values of a column by which results are grouped; with more, it is a number or a comment."""
MEANS = "means of recordings"
"""Group of the means of each recording, in place of all single values."""


class NoMatch(Exception):
    """Error for a truth that has nothing in common with what was found."""


@frozen
class Pair:
    """One value of the truth with what was found."""

    recording: str
    foot: Foot | None
    groups: Mapping[str, str]
    """Values of the truth's other columns."""
    parameter: str
    """Name, with the unit, as in gait_cycles.csv; of an event its name, as in heel_strike_s, with its time as value."""
    true: float | None
    """What was measured; None for what only solepath has."""
    found: float | None
    """What solepath has; None for what only the truth has."""
    is_event: bool = False
    degraded: bool = False
    """True for a stride that solepath says is wrong: it is in no figure."""

    @property
    def values(self) -> Span | None:
        """Return true and found value; None without both, and for a degraded stride."""
        if self.true is None or self.found is None or self.degraded:
            return None
        return self.true, self.found


@frozen
class AgreementRow:
    """The agreement of one parameter, of all pairs or of a group of them."""

    parameter: str
    by: str
    """Column by which pairs are grouped, "foot" or MEANS; "" for all of them."""
    group: str
    """Value in that column."""
    n: int
    """Number of pairs."""
    bias: float | None
    """Mean of found minus true, in the parameter's unit."""
    sd: float | None
    """Standard deviation of the differences."""
    icc: float | None
    """ICC(2,1); None of events, and with fewer than MIN_PAIRS pairs."""
    icc_lower: float | None
    icc_upper: float | None
    """Ends of its 95 % confidence interval."""
    not_found: int
    """Number of values that only the truth has."""
    extra: int
    """Number of values that only solepath has, within the time that the truth covers."""
    degraded: int
    """Number of matched values of degraded strides."""

    @property
    def limits(self) -> Span | None:
        """Return the 95 % limits of agreement; None with fewer than two pairs."""
        return (
            None if self.bias is None or self.sd is None else (self.bias - LIMIT * self.sd, self.bias + LIMIT * self.sd)
        )

    @property
    def f1(self) -> float | None:
        """Return F1, 2 x matched / (true + found)."""
        matched = 2 * (self.n + self.degraded)
        total = matched + self.not_found + self.extra
        return matched / total if total else None


@frozen
class WalkComparison:
    """All pairs of a truth and the walks that it is of."""

    pairs: Sequence[Pair]
    rows: Sequence[AgreementRow] = field(init=False)
    """One row for each parameter."""
    group_rows: Sequence[AgreementRow] = field(init=False)
    """The same by foot, by each column of groups, and of the means of recordings."""

    @rows.default
    def _all(self) -> Sequence[AgreementRow]:
        return [row_of(parameter, found) for parameter, found in self.by_parameter().items()]

    @group_rows.default
    def _grouped(self) -> Sequence[AgreementRow]:
        return [row for parameter, found in self.by_parameter().items() for row in _group_rows(parameter, found)]

    def by_parameter(self) -> dict[str, list[Pair]]:
        """Return the pairs of each parameter."""
        return by_key(self.pairs, lambda pair: pair.parameter)


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
    check_extra()
    found = {name: Walk.of(events) for name, events in walks.items()}
    spans = {name: walk.sample_span or walk.event_span for name, walk in found.items()}
    by_walk = rows_by_walk(truth, [*walks])
    compared = [
        pair
        for name, rows in by_walk.items()
        for pair in compare_walk(rows, found[name], name, start=(spans[name] or (0.0, 0.0))[0], tolerance=tolerance)
    ]
    return WalkComparison(compared)


def check_extra() -> None:
    """Raise ImportError, with what installs it, if the library for the ICC is not there."""
    try:
        import pingouin  # noqa: F401
    except ImportError:
        raise ImportError(f"the ICC needs pingouin: {install_hint('validate')}") from None


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
) -> list[Pair]:
    """Return the pairs of one walk, which keeps all, and the rows of its truth; the recording starts at `start` s."""
    pairing = _Pairing(walk, name, tolerance)
    parts = by_key([row.at(start) for row in rows], lambda row: (row.kind, row.event, row.foot))
    found = [
        pair
        for (kind, *_), part in parts.items()
        for pair in (pairing.figures(part) if kind is Kind.WALK else pairing.matched(part))
    ]
    if all([None in (pair.true, pair.found) for pair in found]):
        times = [row.t_end for part in parts.values() for row in part if row.kind is not Kind.WALK]
        raise NoMatch(f"{name}: nothing of the truth matches{_times_apart(times, walk.event_span)}")
    return found


def _times_apart(true: Sequence[float], found: Span | None) -> str:
    """Return which times truth and recording have; "" if one has none."""
    if not true or found is None:
        return ""
    spans = f"its times are {min(true):.1f} to {max(true):.1f} s, the recording's {found[0]:.1f} to {found[1]:.1f} s"
    return f": {spans}; --offset, or a column offset_s, is added to those of the truth"


@frozen
class _Pairing:
    """Makes the pairs of one walk."""

    walk: Walk
    recording: str
    tolerance: float | None

    def matched(self, rows: Sequence[TrueRow]) -> Iterator[Pair]:
        """Yield the pairs of events of one kind, or of the figures of strides, of a foot."""
        first, by_time = rows[0], {row.t_end: row for row in rows}  # a contact may be in two strides of the truth
        times, is_event = sorted(by_time), first.kind is Kind.EVENT
        rows, cycles = [by_time[t] for t in times], list[GaitCycleMeasured]()
        if is_event:
            found = sorted([t for foot in self._feet(first) for t in self.walk.times[foot][first.event]])
            tolerance, spans = TOLERANCE, [(times[0], times[-1])]
        else:
            cycles = sorted(self._cycles(first), key=lambda cycle: cycle.t)
            found, tolerance = [cycle.t for cycle in cycles], STRIDE_TOLERANCE
            spans = [(row.t_end if row.t_start is None else row.t_start, row.t_end) for row in rows]
        tolerance = tolerance if self.tolerance is None else self.tolerance
        by_true = dict(pairs(times, found, tolerance))
        matches: list[tuple[int | None, int | None]] = [(i, by_true.get(i)) for i in range(len(times))]
        extra = sorted({*range(len(found))} - {*by_true.values()})
        matches += [(None, j) for j in extra if is_covered(found[j], spans, tolerance)]
        for i, j in matches:
            t = None if j is None else found[j]
            row = rows[i] if i is not None else min(rows, key=lambda row: abs(row.t_end - (t or 0.0)))
            if is_event:
                name = f"{row.event.replace('-', '_')}_s"
                yield self._pair(row, name, None if i is None else row.t_end, t, is_event=True)
                continue
            cycle = None if j is None else cycles[j]
            for name, value in row.values.items():
                measured = None if cycle is None else cycle_value(cycle, name)
                is_degraded = cycle is not None and cycle.degraded
                yield self._pair(row, name, None if i is None else value, measured, degraded=is_degraded)

    def figures(self, rows: Sequence[TrueRow]) -> Iterator[Pair]:
        """Yield the pairs of figures of the walk, or of parts of it."""
        for row in rows:
            for name, value in row.values.items():
                yield self._pair(row, name, value, self._figure(row, name))

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
            span, tolerance = [(row.t_start, row.t_end)], TOLERANCE if self.tolerance is None else self.tolerance
            cycles = [one for one in cycles if all([is_covered(t, span, tolerance) for t in (one.t_start, one.t)])]
        return mean_of([cycle_value(cycle, name) for cycle in cycles])

    def _feet(self, row: TrueRow) -> Sequence[Foot]:
        return [*Foot] if row.foot is None else [row.foot]

    def _cycles(self, row: TrueRow) -> list[GaitCycleMeasured]:
        return [cycle for foot in self._feet(row) for cycle in self.walk.cycles[foot]]

    def _pair(self, row: TrueRow, parameter: str, true: float | None, found: float | None, **more: bool) -> Pair:
        return Pair(self.recording, row.foot, row.groups, parameter, true, found, **more)


def row_of(parameter: str, found: Sequence[Pair], by: str = "", group: str = "") -> AgreementRow:
    """Return the agreement of the pairs of a parameter."""
    values = _values(found)
    differences = [b - a for a, b in values]
    has_icc = len(values) >= MIN_PAIRS and not found[0].is_event
    icc, lower, upper = intraclass_correlation(values) if has_icc else (None, None, None)
    return AgreementRow(
        parameter=parameter,
        by=by,
        group=group,
        n=len(values),
        bias=mean_of(differences),
        sd=stdev(differences) if len(values) > 1 else None,
        icc=icc,
        icc_lower=lower,
        icc_upper=upper,
        not_found=len([pair for pair in found if pair.found is None]),
        extra=len([pair for pair in found if pair.true is None]),
        degraded=len([pair for pair in found if pair.degraded and None not in (pair.true, pair.found)]),
    )


def _values(found: Iterable[Pair]) -> list[Span]:
    return [values for pair in found if (values := pair.values) is not None]


def _group_rows(parameter: str, found: Sequence[Pair]) -> Iterator[AgreementRow]:
    """Yield the agreement by foot, by each other column, and of the means of recordings."""
    names = dict.fromkeys([name for pair in found for name in pair.groups])
    named = [("foot", [pair.foot and pair.foot.value for pair in found])]
    named += [(name, [pair.groups.get(name) for pair in found]) for name in names]
    for name, groups in named:
        parts = by_key(zip(groups, found, strict=True), lambda one: one[0] or "")
        if 1 < len(parts) <= MAX_GROUPS:
            yield from [row_of(parameter, [pair for _, pair in part], name, group) for group, part in parts.items()]
    walks = {
        name: values for name, part in by_key(found, lambda pair: pair.recording).items() if (values := _values(part))
    }
    if not found[0].is_event and MIN_PAIRS <= len(walks) < sum(map(len, walks.values())):
        means = {name: [fmean(one) for one in zip(*values, strict=True)] for name, values in walks.items()}
        rows = [Pair(name, None, {}, parameter, true, measured) for name, (true, measured) in means.items()]
        yield row_of(parameter, rows, MEANS)


def intraclass_correlation(pairs: Sequence[Span]) -> tuple[float | None, float | None, float | None]:
    """Return ICC(2,1) of pairs and the ends of its 95 % confidence interval; None for what is not defined."""
    import pandas
    import pingouin

    n, (true, found) = len(pairs), zip(*pairs, strict=True)
    frame = pandas.DataFrame({"pair": [*range(n)] * 2, "by": ["true"] * n + ["found"] * n, "value": [*true, *found]})
    row = pingouin.intraclass_corr(frame, "pair", "by", "value").set_index("Type").loc["ICC(A,1)"]
    icc, lower, upper = [float(value) if isfinite(value) else None for value in (row["ICC"], *row["CI95"])]
    return icc, lower, upper
