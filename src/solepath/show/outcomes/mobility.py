"""Digital mobility outcomes of Mobilise-D: plausible bouts, and their aggregates over a recording or a day.

Names, classes of bouts and aggregates are those of `MobilisedAggregator` of mobgap 1.2, which repeats the project's own
script; limits are its `official_mobilised_dmo_thresholds.csv`. The numbers here are in SI units: mobgap gives
`walkdur_all_sum` in minutes. They come from foot-worn sensors, not from the validated pipeline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, fsum, inf, sqrt
from statistics import median

from attrs import frozen

from .bouts import WalkingBout, mean_of

LIMITS: Mapping[str, tuple[float, float]] = {
    "cadence": (40.0, 172.9),
    "walking_speed": (0.08151492, 2.22),
    "stride_length": (0.1505232, 2.19),
    "stride_duration": (0.46, 3.0),
}
"""Limits between which the mean of a bout is plausible, both included: the rows ALL of the thresholds of mobgap, in
steps a minute, m/s, m and s. Mobilise-D widens them for some groups of patients, and by the wearer's height."""
DEPENDENT = {"stride_length": ("walking_speed",), "cadence": ("walking_speed",)}
"""Outcomes that are left out with an implausible one (mobgap)."""
SHORT, MIDDLE, LONG = 10.0, 30.0, 60.0
"""Durations that divide the classes of bouts, s; a bout of exactly that duration is in the class below."""
HIGH_QUANTILE = 0.9
"""Quantile of the outcomes `p90`."""


@frozen(kw_only=True)
class MobilityOutcomes:
    """The digital mobility outcomes of Mobilise-D, from foot-worn sensors: not the validated lower-back pipeline.

    Each outcome is over the bouts of a class of duration: `all`, `1030` (more than 10 and up to 30 s), `10` (more than
    10 s), `30` (more than 30 s), `60` (more than 60 s). `avg` is the mean over bouts (of durations, the median), `p90`
    the 90th percentile with linear interpolation, `var` the coefficient of variation with the standard deviation of
    n - 1. An outcome of no bout, or a variation of fewer than two, is None."""

    walkdur_all_sum: float
    """Sum of the durations of all bouts, s."""
    wbsteps_all_sum: int
    """Number of initial contacts in all bouts."""
    turns_all_sum: int
    """Number of turns by 45 degrees or more in all bouts."""
    wb_all_sum: int
    """Number of bouts."""
    wb_10_sum: int
    """Number of bouts of more than 10 s."""
    wb_30_sum: int
    """Number of bouts of more than 30 s."""
    wb_60_sum: int
    """Number of bouts of more than 60 s."""
    wb_1030_sum: int
    """Number of bouts of more than 10 s and up to 30 s."""
    wbdur_all_avg: float | None
    """Median duration of the bouts, s."""
    wbdur_all_p90: float | None
    """90th percentile of the durations of the bouts, s."""
    wbdur_all_var: float | None
    """Coefficient of variation of the durations of the bouts, as a share."""
    cadence_all_avg: float | None
    """Mean cadence of all bouts, steps a minute."""
    cadence_all_var: float | None
    """Coefficient of variation of the cadences of all bouts, as a share."""
    strdur_all_avg: float | None
    """Mean stride duration of all bouts, s."""
    strdur_all_var: float | None
    """Coefficient of variation of the stride durations of all bouts, as a share."""
    ws_1030_avg: float | None
    """Mean walking speed of bouts of more than 10 s and up to 30 s, m/s."""
    strlen_1030_avg: float | None
    """Mean stride length of bouts of more than 10 s and up to 30 s, m."""
    ws_10_p90: float | None
    """90th percentile of the walking speeds of bouts of more than 10 s, m/s."""
    ws_30_avg: float | None
    """Mean walking speed of bouts of more than 30 s, m/s."""
    ws_30_p90: float | None
    """90th percentile of the walking speeds of bouts of more than 30 s, m/s."""
    ws_30_var: float | None
    """Coefficient of variation of the walking speeds of bouts of more than 30 s, as a share."""
    strlen_30_avg: float | None
    """Mean stride length of bouts of more than 30 s, m."""
    strlen_30_var: float | None
    """Coefficient of variation of the stride lengths of bouts of more than 30 s, as a share."""
    cadence_30_avg: float | None
    """Mean cadence of bouts of more than 30 s, steps a minute."""
    cadence_30_p90: float | None
    """90th percentile of the cadences of bouts of more than 30 s, steps a minute."""
    strdur_30_avg: float | None
    """Mean stride duration of bouts of more than 30 s, s."""


UNITS = {"walkdur": "s", "wbdur": "s", "strdur": "s", "strlen": "m", "ws": "m/s", "cadence": "1/min"}
"""Unit of the outcomes whose names start so; counts and variations have none."""


def unit_of(name: str) -> str:
    """Return the unit of a field of MobilityOutcomes; "" of a count and of a variation, which is a share."""
    kind, _, how = name.rpartition("_")
    return "" if how == "var" else UNITS.get(kind.partition("_")[0], "")


def implausible(bout: WalkingBout, limits: Mapping[str, tuple[float, float]] = LIMITS) -> tuple[str, ...]:
    """Return the names of the means of a bout that are out of their limits, in the order of the limits."""
    values = {name: getattr(bout, name) for name in limits}
    return tuple([name for name, v in values.items() if v is not None and not limits[name][0] <= v <= limits[name][1]])


def mobility_outcomes(
    bouts: Sequence[WalkingBout], limits: Mapping[str, tuple[float, float]] = LIMITS
) -> MobilityOutcomes:
    """Return the digital mobility outcomes of walking bouts; means that are out of `limits` do not count.

    For outcomes of each day, give it the bouts of each day."""
    excluded = {bout.number: _excluded(bout, limits) for bout in bouts}

    def values(name: str, above: float = 0.0, up_to: float = inf) -> list[float]:
        used = [b for b in bouts if above < b.duration <= up_to and name not in excluded[b.number]]
        return [value for value in [getattr(bout, name) for bout in used] if value is not None]

    durations = values("duration")
    return MobilityOutcomes(
        walkdur_all_sum=fsum(durations),
        wbsteps_all_sum=sum([bout.steps for bout in bouts]),  # whole numbers
        turns_all_sum=sum([bout.turns for bout in bouts]),  # whole numbers
        wb_all_sum=len(durations),
        wb_10_sum=len(values("duration", SHORT)),
        wb_30_sum=len(values("duration", MIDDLE)),
        wb_60_sum=len(values("duration", LONG)),
        wb_1030_sum=len(values("duration", SHORT, MIDDLE)),
        wbdur_all_avg=median(durations) if durations else None,
        wbdur_all_p90=high_quantile(durations),
        wbdur_all_var=variation(durations),
        cadence_all_avg=mean_of(values("cadence")),
        cadence_all_var=variation(values("cadence")),
        strdur_all_avg=mean_of(values("stride_duration")),
        strdur_all_var=variation(values("stride_duration")),
        ws_1030_avg=mean_of(values("walking_speed", SHORT, MIDDLE)),
        strlen_1030_avg=mean_of(values("stride_length", SHORT, MIDDLE)),
        ws_10_p90=high_quantile(values("walking_speed", SHORT)),
        ws_30_avg=mean_of(values("walking_speed", MIDDLE)),
        ws_30_p90=high_quantile(values("walking_speed", MIDDLE)),
        ws_30_var=variation(values("walking_speed", MIDDLE)),
        strlen_30_avg=mean_of(values("stride_length", MIDDLE)),
        strlen_30_var=variation(values("stride_length", MIDDLE)),
        cadence_30_avg=mean_of(values("cadence", MIDDLE)),
        cadence_30_p90=high_quantile(values("cadence", MIDDLE)),
        strdur_30_avg=mean_of(values("stride_duration", MIDDLE)),
    )


def _excluded(bout: WalkingBout, limits: Mapping[str, tuple[float, float]]) -> set[str]:
    """Return the names of the means of a bout that do not count: the implausible ones, and those that follow them."""
    wrong = implausible(bout, limits)
    return {*wrong, *[other for name in wrong for other in DEPENDENT.get(name, ())]}


def high_quantile(values: Sequence[float]) -> float | None:
    """Return the 90th percentile of values, with linear interpolation; None of no value."""
    if not values:
        return None
    ordered = sorted(values)
    place = HIGH_QUANTILE * (len(ordered) - 1)
    below = floor(place)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])


def variation(values: Sequence[float]) -> float | None:
    """Return the coefficient of variation of values, as a share; None of fewer than two, and of a mean of zero."""
    if len(values) < 2:
        return None
    mean = fsum(values) / len(values)
    sd = sqrt(fsum([(value - mean) ** 2 for value in values]) / (len(values) - 1))
    return None if mean == 0.0 else sd / mean
