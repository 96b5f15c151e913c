"""Digital mobility outcomes of Mobilise-D: plausible bouts, and their aggregates over a recording or a day.

Names, classes of bouts and aggregates are those of `MobilisedAggregator` of mobgap 1.2, which repeats the project's own
script; limits are its `official_mobilised_dmo_thresholds.csv`. The numbers here are in SI units: mobgap gives
`walkdur_all_sum` in minutes. They come from foot-worn sensors, not from the validated pipeline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import fsum, inf
from statistics import fmean, median, quantiles, stdev
from typing import Any

from attrs import fields, frozen

from .bouts import WalkingBout

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
    turns_all_sum: int | None
    """Number of turns by 45 degrees or more in all bouts; None when those of no bout are known."""
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


KINDS = {
    "walkdur": ("duration", "s"),
    "wbsteps": ("steps", ""),
    "turns": ("turns", ""),
    "wb": ("number", ""),
    "wbdur": ("duration", "s"),
    "cadence": ("cadence", "1/min"),
    "strdur": ("stride_duration", "s"),
    "ws": ("walking_speed", "m/s"),
    "strlen": ("stride_length", "m"),
}
"""Field of WalkingBout and unit of the outcomes whose names start so; counts have no unit."""
CLASSES = {"all": (0.0, inf), "1030": (10.0, 30.0), "10": (10.0, inf), "30": (30.0, inf), "60": (60.0, inf)}
"""Durations, s, above which and up to which a bout is in the class with this part of a name."""


def unit_of(name: str) -> str:
    """Return the unit of a field of MobilityOutcomes; "" of a count and of a variation, which is a share."""
    kind, _, how = name.split("_")
    return "" if how == "var" else KINDS[kind][1]


def implausible(bout: WalkingBout, limits: Mapping[str, tuple[float, float]] = LIMITS) -> tuple[str, ...]:
    """Return the names of the means of a bout that are out of their limits, in the order of the limits."""
    values = {name: getattr(bout, name) for name in limits}
    return tuple([name for name, v in values.items() if v is not None and not limits[name][0] <= v <= limits[name][1]])


def mobility_outcomes(
    bouts: Sequence[WalkingBout], limits: Mapping[str, tuple[float, float]] = LIMITS
) -> MobilityOutcomes:
    """Return the digital mobility outcomes of walking bouts; means that are out of `limits` do not count.

    For outcomes of each day, give it the bouts of each day."""
    pairs = [(bout, _excluded(bout, limits)) for bout in bouts]

    def outcome(kind: str, of_bouts: str, how: str) -> Any:
        name, (above, up_to) = KINDS[kind][0], CLASSES[of_bouts]
        found = [
            getattr(bout, name) for bout, excluded in pairs if above < bout.duration <= up_to and name not in excluded
        ]
        values = [value for value in found if value is not None]
        if how == "sum" and (values or not found):
            return len(values) if kind == "wb" else sum(values) if name in ("steps", "turns") else fsum(values)
        if how == "var":
            return stdev(values) / fmean(values) if len(values) > 1 else None
        if not values:
            return None
        if how == "p90":
            return quantiles(values, n=10, method="inclusive")[-1] if len(values) > 1 else values[0]
        return median(values) if kind == "wbdur" else fmean(values)

    return MobilityOutcomes(**{one.name: outcome(*one.name.split("_")) for one in fields(MobilityOutcomes)})


def _excluded(bout: WalkingBout, limits: Mapping[str, tuple[float, float]]) -> set[str]:
    """Return the names of the means of a bout that do not count: the implausible ones, and those that follow them."""
    wrong = implausible(bout, limits)
    return {*wrong, *[other for name in wrong for other in DEPENDENT.get(name, ())]}
