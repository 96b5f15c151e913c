"""Text tables of scores: of each data set, of the ablation, and of the changes since an earlier evaluation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import degrees

from solepath.show.tables.table import milliseconds, number, percent, table
from solepath.show.tables.words import activity_words
from solepath.types import Activity

from ..emulated.heading import CHECKED_TIMES
from ..evaluate.ablation import COLUMNS as MAIN_FIGURES
from ..evaluate.ablation import Column
from ..evaluate.changes import DIGITS, SUMMARY_ROWS, Changes, Scores, Verdict, compare_scores, names_missing
from ..evaluate.report import Result
from ..measures.confusion import CLASSES, DELAYS
from ..measures.score import Figures, Summary

_metres = _three_digits = partial(number, digits=3)
_two_digits = partial(number, digits=2)
_short_metres = partial(number, digits=1)
_count = partial(number, digits=0)
_fine_percent = partial(percent, digits=2)


def _degrees(value: float | None) -> str:
    return number(None if value is None else degrees(value), 1)


def _fine_degrees(value: float | None) -> str:
    return number(None if value is None else degrees(value), 3)


def _degrees_a_minute(value: float | None) -> str:
    return _degrees(None if value is None else 60.0 * value)


COLUMNS: dict[str, tuple[str, Callable[[float | None], str]]] = {
    "armse_2d": ("ARMSE2d m", _metres),
    "rms_2d": ("RMS 2D m", _metres),
    "rms_3d": ("RMS 3D m", _metres),
    "rms_z": ("height m", _metres),
    "path": ("path m", _short_metres),
    "relative": ("of path %", percent),
    "position_mean": ("error m", _metres),
    "position_max": ("largest m", _metres),
    "largest_relative": ("largest, of path %", _fine_percent),
    "authors": ("authors' m", _metres),
    "authors_beaten": ("better %", percent),
    "end_error": ("end error m", _metres),
    "end_error_2d": ("in 2D m", _metres),
    "end_height": ("in height m", _metres),
    "position_end": ("at the end m", _metres),
    "end_relative": ("at the end, of path %", _fine_percent),
    "heading_end": ("heading degrees", _degrees),
    "radius_error": ("radius off by %", _fine_percent),
    "drift": ("drift degrees/min", _degrees_a_minute),
    "drift_left": ("left", _degrees_a_minute),
    "drift_right": ("right", _degrees_a_minute),
    "drift_stride": ("degrees a stride", _fine_degrees),
    **{
        f"{figure}_{t}": (f"{title} {t} s", _two_digits)
        for t in CHECKED_TIMES
        for figure, title in (("nees", "NEES/2"), ("held", "held"), ("heading_nees", "heading^2/variance"))
    },
    "end_without": ("without a place m", _metres),
    "end_return": ("with one m", _metres),
    "way_places": ("along the way with three m", _metres),
    "nees_return": ("NEES/2 with one", _two_digits),
    "held_return": ("held", _two_digits),
    "rejected_first": ("20 m off, rejected %", percent),
    "rejected_later": ("after another %", percent),
    "used": ("right, used %", percent),
    "nees_end": ("NEES/2 at the end", _two_digits),
    "held_end": ("held", _two_digits),
    "height_end": ("height at end m", _metres),
    "height_max": ("height, largest m", _metres),
    "strides_found": ("found", _count),
    "strides_true": ("of strides", _count),
    "strides_invented": ("invented", _count),
    "stride_error": ("length MAE %", percent),
    "stride_error_median": ("median %", percent),
    "stride_error_track": ("live track %", percent),
    "stride_longest": ("longest m", _metres),
    "heel_strike_true": ("HS true", _count),
    "heel_strike_found": ("found", _count),
    "heel_strike_f1": ("F1", _three_digits),
    "heel_strike_bias": ("bias ms", milliseconds),
    "heel_strike_mad": ("MAD ms", milliseconds),
    "heel_strike_scatter": ("by foot ms", milliseconds),
    "heel_strike_off": ("off ms", milliseconds),
    "toe_off_true": ("TO true", _count),
    "toe_off_found": ("found", _count),
    "toe_off_f1": ("F1", _three_digits),
    "toe_off_bias": ("bias ms", milliseconds),
    "toe_off_mad": ("MAD ms", milliseconds),
    "toe_off_scatter": ("by foot ms", milliseconds),
    "toe_off_off": ("off ms", milliseconds),
    "stride_time_error_median": ("stride time: median ms", milliseconds),
    "stride_time_error": ("MAE ms", milliseconds),
    "stride_time_bias": ("bias ms", milliseconds),
    "leg_error_median": ("legs, by foot: median %", percent),
    "leg_error": ("MAE %", percent),
    "leg_bias": ("bias %", percent),
    "body_leg_error_median": ("legs, by wearer: median %", percent),
    "body_leg_error": ("MAE %", percent),
    "body_leg_bias": ("bias %", percent),
    "leg_spread": ("spread %", percent),
    "uturn_found": ("U-turn found %", percent),
    "uturn_angle": ("off by degrees", _degrees),
    "uturn_invented": ("invented", _three_digits),
    "accuracy": ("right %", percent),
    "right_inside": ("beyond 1 s of edges %", percent),
    "right_at_once": ("at once %", percent),
    **{name: (f"by {delay:g} s %", percent) for name, delay in DELAYS.items() if delay},
    "most_frequent": ("most freq %", percent),
    **{f"f1_{activity.value.lower()}": (f"F1 {activity_words(activity)}", _three_digits) for activity in CLASSES},
    "rides_true": ("rides", _count),
    "rides_found": ("found", _count),
    "rides_invented": ("invented", _count),
    "stairs_called": ("on stairs: called stairs %", percent),
    "stairs_direction": ("direction right %", percent),
    "level_called": ("on the level: called stairs %", percent),
}
"""Column title and number format of every figure, by the figure's name in JSON.

ARMSE2d is the RMS 2D error / sqrt 2. `relative` is the error (RMS 2D, mean or end error) as a share of the path length.
`end_error` is the distance between the ends of a closed loop, `position_end` that from the estimated to the true end.
`authors` is the mean error of the system of the data set's authors. `stride_error_track` is the mean stride length
error by the live positions. `nees`, `held` and `heading_nees` are defined in emulated/heading.py, `drift` in
measures/drift.py. `off` is the median magnitude of the offsets. `uturn_invented` is a number a recording."""


def score_table(result: Result) -> str:
    """Return the title, table of figures with a value, confusion matrix and failures of a data set."""
    data_set = result.data_set
    known = [score.flat() for score in result.scores]
    known += [figures for one in result.summaries for figures in (one.mean, one.median, one.together)]
    keys = [key for key in data_set.figures if any(one.get(key) is not None for one in known)]
    header = ["recording", *(COLUMNS[key][0] for key in keys)]
    rows: list[Sequence[str]] = []
    if data_set.lists_recordings:
        rows += [_row(score.recording, score.flat(), keys) for score in result.scores]
        rows.append([])
    for summary in result.summaries:
        name = "" if summary.group == "all" else f" {summary.group}"
        if summary.mean:
            rows.append(_row(f"mean of {summary.count}{name}", summary.mean | summary.together, keys))
            rows.append(_row("median", summary.median, keys))
        else:
            rows.append(_row(f"pooled {summary.count}{name}", summary.together, keys))
    wall_time, samples = sum(s.seconds for s in result.scores), sum(s.samples for s in result.scores)
    speed = f"{samples} samples" if samples else "no samples"
    if samples and wall_time > 0.0:
        speed = f"{speed}, {1e6 * wall_time / samples:.1f} us each"
    title = f"{data_set.name}: {data_set.title} ({result.recipe}; {speed})"
    lines = [title, table(header, rows)]
    lines += [_confusion(summary) for summary in result.summaries if summary.group == "all" and summary.confusion]
    return "\n".join([*lines, *(f"failed: {sentence}" for sentence in result.failures)])


def _confusion(summary: Summary) -> str:
    """Return the confusion matrix: of the samples of each true activity, the share of each reported one, %."""
    counts = summary.confusion or {}
    reported = [activity for activity in Activity if any(activity.value in row for row in counts.values())]
    rows = []
    for activity in CLASSES:
        if (row := counts.get(activity.value)) is not None:
            total = sum(row.values())
            shares = [percent(row.get(other.value, 0) / total) for other in reported]
            rows.append([activity_words(activity), *shares, number(float(total), 0)])
    return table(["% of the true activity, reported as", *map(activity_words, reported), "samples"], rows)


def _row(name: str, figures: Figures, keys: Sequence[str]) -> list[str]:
    return [name, *(COLUMNS[key][1](figures.get(key)) for key in keys)]


def ablation_table(results: Sequence[Result], markdown: bool = False) -> str:
    """Return a table with a line for each recipe and a column for each main figure that was scored."""
    recipes = list(dict.fromkeys(result.recipe for result in results))
    scored = {result.data_set.name for result in results}
    columns = [column for column in MAIN_FIGURES if column.data_set in scored]
    header = ["", *(f"{column.title} {column.unit}".strip() for column in columns)]
    rows = [
        [recipe, *(_main_figure(column, column.find_figure(results, recipe)) for column in columns)]
        for recipe in recipes
    ]
    if not markdown:
        return table(header, rows)
    lines = [header, ["---", *("---:" for _ in columns)], *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _main_figure(column: Column, value: float | None) -> str:
    match column.unit:
        case "%":
            return percent(value, 2)
        case "ms":
            return milliseconds(value)
        case _:
            return number(value, 3)


HEADER = ("figure", "was", "is", "")


def changes_table(changes: Changes) -> str:
    """Return the table of summaries and of changed figures of recordings; removed and new recordings are below it."""
    rows = [
        (f"{change.figure} ({change.row})", _format(change.earlier), _format(change.present), change.verdict.value)
        for change in changes.changes
        if change.row.split()[0] in SUMMARY_ROWS or change.verdict is not Verdict.SAME
    ]
    counts = [
        f"{sum(change.verdict is which for change in changes.changes)} {which.value}"
        for which in (Verdict.BETTER, Verdict.WORSE, Verdict.SAME)
    ]
    lines = [f"{changes.data_set}, {changes.recipe}, compared: {', '.join(counts)} (SI units)"]
    if rows:
        lines.append(table(HEADER, rows))
    if changes.removed:
        lines.append(f"scored then and not now: {', '.join(changes.removed)}")
    if changes.new:
        lines.append(f"not scored then: {', '.join(changes.new)}")
    return "\n".join(lines)


def comparison_tables(earlier: Scores, present: Scores) -> str:
    """Return a table for each data set of both evaluations, and the names of data sets that only one of them has."""
    parts = [changes_table(changes) for changes in compare_scores(earlier, present)]
    removed, new = names_missing(earlier, present), names_missing(present, earlier)
    if removed:
        parts.append(f"evaluated then and not now: {', '.join(removed)}")
    if new:
        parts.append(f"not evaluated then: {', '.join(new)}")
    return "\n\n".join(parts)


def _format(value: float | None) -> str:
    return "-" if value is None else f"{value:.{DIGITS}g}"
