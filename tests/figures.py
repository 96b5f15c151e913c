"""The README's short table: a row a figure, from what the commands print or write.

A row is (what, came to, command). Rows are made of the scores of `evaluate --json`, of what `demo` prints and of what
the benchmark prints, each by itself, so that those can be refreshed that can be computed.
"""

from __future__ import annotations

import re
from typing import Any

from solepath.evaluate.datasets import DATASETS

Row = tuple[str, str, str]

MARK = "<!-- figures -->\n"
HEADER = ["| figure | came to | command |", "|---|---|---|"]
LONG_DEMO = ["demo", "--distance", "100", "--loss", "0.05", "--jitter", "0.05"]
BENCH = "tests/bench/bench.py"
BLUETOOTH = "tests/bench/bluetooth.py"
COMPARED = ("default", "kupt-dfpc", "zupt", "pressure-contour", "gyroscope")
INSOLES = [
    *(word for data in ("smart_insole_35", "marpino_pressed", "gaitpdb_vgrf") for word in ("--only", data)),
    *(word for name in COMPARED for word in ("--recipe", name)),
    "--markdown",
]
QUICK = [word for data_set in DATASETS if not data_set.folds for word in ("--only", data_set.name)]
"""All data but those for which a recipe must first learn, in folds: that takes minutes."""
ACTIVITIES = [
    *(word for data in ("hugadb", "stairs") for word in ("--only", data)),
    *(word for name in ("default", "footstep-tracker") for word in ("--recipe", name)),
    "--markdown",
]
LONG_WAYS = [
    *("--emulated", "--walks", "3", "--recipe", "default", "--recipe", "straight-corridors"),
    "--markdown",
]
EXPERIMENTS = ("kupt-dfpc", "pressure-contour", "walking-modes", "footstep-tracker", "shoe-sensing")
SURVEYED = ("exp31", "exp33", "exp37")
EVENTS = ("heel-strike", "foot-flat", "heel-off", "toe-off")


def evaluated(scores: dict[str, Any]) -> list[Row]:
    """`scores`: the default recipe's part of the JSON."""
    vicon = scores["pyshoe_vicon"]["summary"]["all"]
    mean, median = (vicon[part]["armse_2d"] for part in ("mean", "median"))
    command = "solepath evaluate DIR --only pyshoe_vicon"
    title = f"`pyshoe_vicon`, {vicon['count']} recordings: ARMSE2d"
    rows = [(title, f"mean {mean:.3f} m, median {median:.3f} m", command)]
    for name in SURVEYED:
        one = scores["gumushane_surveyed"]["recordings"][name]
        strides = f"{one['strides_found']} of {one['strides_true']} strides found, {one['strides_invented']} invented"
        came_to = f"{strides}; stride length error mean {100 * one['stride_error']:.1f} %"
        rows.append((f"`gumushane_gcp/{name}`", came_to, "solepath evaluate DIR --only gumushane_surveyed"))
    end = scores["xio_closed_walks"]["recordings"]["long_walk"]["end_error"]
    command = "solepath evaluate DIR --only xio_closed_walks"
    rows.append(("`xio_closed_walks/long_walk`: end error", f"{end:.3f} m", command))
    return rows


def walked(printed: str) -> list[Row]:
    """`printed`: what `solepath` LONG_DEMO prints."""
    _, table = printed.split("against the truth", 1)
    left: dict[str, str] = {}
    right: dict[str, str] = {}
    for line in table.splitlines():
        match re.split(r"\s{2,}", line.strip()):
            case [what, ours, theirs]:
                left[what], right[what] = ours, theirs
    command = " ".join(["solepath", *LONG_DEMO])
    title = "emulated 100 m, both insoles, 5 % loss, 50 ms jitter"
    steps = (
        f"{name} {foot['steps found']} of {foot['steps walked']} found, {foot['steps invented']} invented"
        for name, foot in (("left", left), ("right", right))
    )

    def both(key: str, unit: str) -> str:
        return f"{left[f'{key} {unit}']} and {right[f'{key} {unit}']} {unit}"

    offsets = (f"{event} {both(f'{event}, median offset', 'ms')}" for event in EVENTS)
    return [
        (f"{title}: steps", "; ".join(steps), command),
        ("the same: median offsets, left and right", "; ".join(offsets), command),
        ("the same: stride length error, mean", both("stride length, mean error", "%"), command),
        ("the same: end position, error", both("end position, error", "m"), command),
    ]


def measured(printed: str) -> list[Row]:
    """`printed`: what BENCH prints."""

    def found(pattern: str) -> str:
        match = re.search(pattern, printed, re.MULTILINE)
        if match is None:
            raise ValueError(f"the benchmark does not print {pattern!r}")
        return match[1]

    sample, decode = (
        found(rf"^{re.escape(what)} +([\d.]+) us ")
        for what in ("foot sample, inertial", "insole frame, 96 cells: decode")
    )
    python, cores = found(r"^Python ([\d.]+)"), found(r"(\d+) cores")
    factor, memory = found(r"^real-time factor.*: (.+)$"), found(r"^memory of a session: (.+)$")
    command = f"python {BENCH}"
    return [
        (f"default recipe (one of {cores} cores, Python {python})", f"{sample} us a foot sample", command),
        ("the same: insole frame of 96 cells, decoded", f"{decode} us a packet", command),
        ("the same: both feet with 96 cells at 100 Hz", f"{factor} times real time", command),
        ("the same: memory of a session", memory, command),
    ]


def lines(rows: list[Row]) -> list[str]:
    """The table in Markdown."""
    return [*HEADER, *(f"| {what} | {came_to} | `{command}` |" for what, came_to, command in rows)]
