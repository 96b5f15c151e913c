"""Short scores as the Markdown table that docs/accuracy.md quotes."""

from __future__ import annotations

from collections.abc import Sequence

from ...show.tables.table import milliseconds, number, percent
from ..evaluate.report import Result
from ..measures.confusion import CLASSES
from ..measures.score import Figures, Summary

PLACES = {
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
BETTER = {"authors_beaten": "trials in which the authors' own system is further off"}
STAIRS = {
    "stairs_called": "time on stairs that was called stairs",
    "stairs_direction": "the same in the right direction",
    "level_called": "time on the level that was called stairs",
}
"""Shares that are averaged over recordings."""
LEGS = {"leg": "length of a leg, by each foot's track", "body_leg": "the same by the wearer's position"}
"""Relative errors that are pooled."""
EVENTS = {"heel_strike": "heel-strike", "toe_off": "toe-off"}


def accuracy_table(results: Sequence[Result]) -> str:
    """Return the table with one line a figure over all recordings of each data set.

    It has one column for the result, or one for each recipe when there are several."""
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
                *_places(summary), *_shares(summary, BETTER), *(row for other in bipedal for row in _bipedal(other)),
                *_strides(summary.together), *_legs(summary.together), *_events(summary.together),
                *_activities(summary),
            ]  # fmt: skip
            for what, figure in figures:
                rows.setdefault((data, what), {})[result.recipe] = figure
    heads = ["came to"] if len(recipes) == 1 else [f"`{recipe}`" for recipe in recipes]
    lines = [_line("data", "measured", *heads), "|" + "---|" * (2 + len(heads))]
    before = ""
    for (data, what), entries in rows.items():
        lines.append(_line("" if data == before else data, what, *(entries.get(recipe, "-") for recipe in recipes)))
        before = data
    return "\n".join(lines)


def _line(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def _places(summary: Summary) -> list[tuple[str, str]]:
    entries = []
    for key, what in PLACES.items():
        if key in summary.mean:
            mean, median = (f"{number(part[key], 3)} m" for part in (summary.mean, summary.median))
            entries.append((what, mean if summary.count == 1 else f"mean {mean}, median {median}"))
    return entries


def _shares(summary: Summary, named: dict[str, str]) -> list[tuple[str, str]]:
    return [(what, f"{percent(summary.mean[key])} %") for key, what in named.items() if key in summary.mean]


def _bipedal(summary: Summary) -> list[tuple[str, str]]:
    mean, median = (f"{number(part['armse_2d'], 3)} m" for part in (summary.mean, summary.median))
    return [(f"ARMSE2d of the {summary.count} bipedal trials", f"mean {mean}, median {median}")]


def _strides(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    if (true := pooled.get("strides_true")) is not None:
        found, invented = (number(pooled[f"strides_{what}"], 0) for what in ("found", "invented"))
        entries.append(("strides", f"{found} of {number(true, 0)} found, {invented} invented"))
    if (error := pooled.get("stride_error")) is not None:
        median = percent(pooled["stride_error_median"])
        entries.append(("stride length error", f"mean {percent(error)} %, median {median} %"))
    return entries


def _legs(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    for kind, what in LEGS.items():
        if pooled.get(f"{kind}_error") is not None:
            mean, median = (percent(pooled[f"{kind}_{part}"]) for part in ("error", "error_median"))
            entries.append(
                (f"{what} ({number(pooled[f'{kind}_count'], 0)})", f"median error {median} %, mean {mean} %")
            )
    if (error := pooled.get("stride_time_error")) is not None:
        median = milliseconds(pooled["stride_time_error_median"])
        entries.append(("stride time", f"median error {median} ms, mean {milliseconds(error)} ms"))
    return entries


def _events(pooled: Figures) -> list[tuple[str, str]]:
    entries = []
    for kind, what in EVENTS.items():
        if (true := pooled.get(f"{kind}_true")) is not None:
            bias, mad = (milliseconds(pooled[f"{kind}_{part}"]) for part in ("bias", "mad"))
            figures = f"F1 {number(pooled[f'{kind}_f1'], 3)}, median offset {bias} ms, MAD {mad} ms"
            entries.append((f"{number(true, 0)} {what}s", figures))
    return entries


def _activities(summary: Summary) -> list[tuple[str, str]]:
    """Return the lines about activities."""
    pooled, entries = summary.together, []
    if (accuracy := pooled.get("accuracy")) is not None:
        entries.append(("labelled time classified correctly", f"{percent(accuracy)} %"))
        entries.append(
            ("the same by always telling the most frequent activity", f"{percent(pooled['most_frequent'])} %")
        )
        f1 = {activity: pooled[f"f1_{activity.value.lower()}"] for activity in CLASSES}
        entries += [
            (f"F1 of {activity.value}", number(value, 3)) for activity, value in f1.items() if value is not None
        ]
    if rides := pooled.get("rides_true"):
        found, invented = (number(pooled[f"rides_{what}"], 0) for what in ("found", "invented"))
        entries.append(
            ("lift rides, with their direction", f"{found} of {number(rides, 0)} found, {invented} invented")
        )
    return entries + _shares(summary, STAIRS)
