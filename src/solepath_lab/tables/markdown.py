"""Short scores as the Markdown table that docs/accuracy.md quotes."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from solepath.show.tables.table import milliseconds, number, percent

from ..emulated.heading import CHECKED_TIMES
from ..evaluate.report import Result
from ..measures.confusion import CLASSES, DELAYS
from ..measures.score import Figures, Summary

POSITION_FIGURES = {
    "rms_2d": "position error RMS, horizontal",
    "armse_2d": "the same / sqrt 2 (ARMSE2d)",
    "rms_3d": "position error RMS, in space",
    "rms_z": "height error RMS",
    "position_mean": "position error at the footprints",
    "position_end": "off at the end, horizontal",
    "end_error": "from end to start, in space",
    "end_error_2d": "from end to start, horizontal",
    "end_height": "from end to start, in height",
}
"""Figures that are averaged over recordings, m."""
PATH_SHARES = {
    "end_relative": "off at the end, share of the path",
    "radius_error": "radius of circles too large or too small by",
}
"""Shares that are averaged over recordings."""
ANGLES = {
    "heading_end": (1.0, "heading off at the end", "degrees"),
    "drift": (60.0, "drift of the heading", "degrees/min"),
}
"""Factor, name and unit of angles, rad, and of drifts, rad/s, that are averaged over recordings."""
AUTHORS_SHARES = {"authors_beaten": "trials in which the authors' own system is further off"}
"""Shares of recordings."""
STAIR_SHARES = {
    "stairs_called": "time on stairs that was called stairs",
    "stairs_direction": "the same in the right direction",
    "level_called": "time on the level that was called stairs",
}
"""Shares of time on stairs and on the level that are averaged over recordings."""
LEG_ERRORS = {"leg": "length of a leg, by each foot's track", "body_leg": "the same by the wearer's position"}
"""Relative length errors of legs (straight ways of known length, measures/legs.py), pooled over recordings."""
EVENTS = {"heel_strike": "heel-strike", "toe_off": "toe-off"}


def accuracy_table(results: Sequence[Result]) -> str:
    """Return the table with one line for each figure of each data set, and one column of results for each recipe."""
    recipes = list(dict.fromkeys(result.recipe for result in results))
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for result in results:
        for summary in result.summaries:
            if summary.group != "all":
                continue
            count = f"{summary.count} recording{'s' * (summary.count > 1)}"
            data = f"{result.data_set.title}: `{result.data_set.name}`, {count}"
            bipedal = [other for other in result.summaries if other.group == "bipedal"]
            figures = [
                *_position_lines(summary), *_heading_lines(summary), *_share_lines(summary, AUTHORS_SHARES),
                *(row for other in bipedal for row in _bipedal_lines(other)), *_stride_lines(summary.together),
                *_leg_lines(summary.together), *_event_lines(summary.together), *_activity_lines(summary),
            ]  # fmt: skip
            for measured, figure in figures:
                rows.setdefault((data, measured), {})[result.recipe] = figure
    headings = ["came to"] if len(recipes) == 1 else [f"`{recipe}`" for recipe in recipes]
    lines = [_line("data", "measured", *headings), "|" + "---|" * (2 + len(headings))]
    previous_data = ""
    for (data, measured), entries in rows.items():
        lines.append(
            _line("" if data == previous_data else data, measured, *(entries.get(recipe, "-") for recipe in recipes))
        )
        previous_data = data
    return "\n".join(lines)


def _line(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def _position_lines(summary: Summary) -> list[tuple[str, str]]:
    # errors in m need the length of the walk beside them, shares of the path do not
    lengths = {} if PATH_SHARES.keys() & summary.mean.keys() else {"path": ("length of the walk", 1)}
    entries = []
    for key, (measured, digits) in (lengths | {key: (name, 3) for key, name in POSITION_FIGURES.items()}).items():
        if key in summary.mean:
            mean, median = (f"{number(averages[key], digits)} m" for averages in (summary.mean, summary.median))
            entries.append((measured, mean if summary.count == 1 else f"mean {mean}, median {median}"))
    return entries


def _heading_lines(summary: Summary) -> list[tuple[str, str]]:
    lines = []
    for key, name in PATH_SHARES.items():
        if key in summary.mean:
            mean, median = (percent(averages[key], 2) for averages in (summary.mean, summary.median))
            lines.append((name, f"mean {mean} %, median {median} %"))
    for key, (factor, name, unit) in ANGLES.items():
        if key in summary.mean:
            mean, median = (
                number(degrees(factor * (averages[key] or 0.0)), 1) for averages in (summary.mean, summary.median)
            )
            lines.append((name, f"mean {mean}, median {median} {unit}"))
    moments = {"end": "at the end", **{str(t): f"after {t // 60} min" for t in CHECKED_TIMES}}
    for moment, when in moments.items():
        if f"nees_{moment}" in summary.mean:
            mean, median = (number(averages[f"nees_{moment}"], 2) for averages in (summary.mean, summary.median))
            held = percent(summary.mean[f"held_{moment}"], 0)
            name = f"NEES/2 {when}, and walks within the ellipse of 95 %"
            lines.append((name, f"mean {mean}, median {median}, {held} %"))
    return lines


def _share_lines(summary: Summary, titles: dict[str, str]) -> list[tuple[str, str]]:
    return [(measured, f"{percent(summary.mean[key])} %") for key, measured in titles.items() if key in summary.mean]


def _bipedal_lines(summary: Summary) -> list[tuple[str, str]]:
    mean, median = (f"{number(averages['armse_2d'], 3)} m" for averages in (summary.mean, summary.median))
    return [(f"ARMSE2d of the {summary.count} bipedal trials", f"mean {mean}, median {median}")]


def _stride_lines(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    if (true := pooled.get("strides_true")) is not None:
        found, invented = (number(pooled[f"strides_{suffix}"], 0) for suffix in ("found", "invented"))
        entries.append(("strides", f"{found} of {number(true, 0)} found, {invented} invented"))
    if (error := pooled.get("stride_error")) is not None:
        median = percent(pooled["stride_error_median"])
        entries.append(("stride length error", f"mean {percent(error)} %, median {median} %"))
    if (longest := pooled.get("stride_longest")) is not None:
        entries.append(("longest stride", f"{number(longest)} m"))
    return entries


def _leg_lines(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    for kind, measured in LEG_ERRORS.items():
        if pooled.get(f"{kind}_error") is not None:
            mean, median = (percent(pooled[f"{kind}_{suffix}"]) for suffix in ("error", "error_median"))
            entries.append(
                (f"{measured} ({number(pooled[f'{kind}_count'], 0)})", f"median error {median} %, mean {mean} %")
            )
    if (error := pooled.get("stride_time_error")) is not None:
        median = milliseconds(pooled["stride_time_error_median"])
        entries.append(("stride time", f"median error {median} ms, mean {milliseconds(error)} ms"))
    return entries


def _event_lines(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    for kind, measured in EVENTS.items():
        if (true := pooled.get(f"{kind}_true")) is not None:
            bias, mad = (milliseconds(pooled[f"{kind}_{suffix}"]) for suffix in ("bias", "mad"))
            figures = f"F1 {number(pooled[f'{kind}_f1'], 3)}, median offset {bias} ms, MAD {mad} ms"
            entries.append((f"{number(true, 0)} {measured}s", figures))
    return entries


def _activity_lines(summary: Summary) -> list[tuple[str, str]]:
    pooled, entries = summary.together, []
    if (accuracy := pooled.get("accuracy")) is not None:
        entries.append(("labelled time classified correctly", f"{percent(accuracy)} %"))
        delays = [pooled.get(name) for name in DELAYS]
        if (inside := pooled.get("right_inside")) is not None:
            entries.append(("the same, more than 1 s from a change of the label", f"{percent(inside)} %"))
            curve = ", ".join([percent(share) for share in delays])
            entries.append(("the same at once, and by 0.5, 1, 2 and 3 s later", f"{curve} %"))
        entries.append(
            ("the same by always reporting the most frequent activity", f"{percent(pooled['most_frequent'])} %")
        )
        f1 = {activity: pooled[f"f1_{activity.value.lower()}"] for activity in CLASSES}
        entries += [
            (f"F1 of {activity.value}", number(value, 3)) for activity, value in f1.items() if value is not None
        ]
    if rides := pooled.get("rides_true"):
        found, invented = (number(pooled[f"rides_{suffix}"], 0) for suffix in ("found", "invented"))
        entries.append(
            ("lift rides, with their direction", f"{found} of {number(rides, 0)} found, {invented} invented")
        )
    return entries + _share_lines(summary, STAIR_SHARES)
