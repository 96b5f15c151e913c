"""Gait parameters as a table."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees

from ..body.gait_means import Figure, GaitMeans, GaitParameters, StrideFigures
from ..types import Foot
from .table import number, percent, table

ROWS: tuple[tuple[str, str, int, Callable[[float], float] | None], ...] = (
    ("stride_time", "stride time s", 3, None),
    ("step_time", "step time s", 3, None),
    ("stride_length", "stride length m", 3, None),
    ("step_length", "step length m", 3, None),
    ("step_width", "step width m", 3, None),
    ("speed", "speed m/s", 2, None),
    ("clearance", "rise of the sensor m", 3, None),
    ("toe_off_angle", "toe-off angle deg", 1, degrees),
    ("heel_strike_angle", "heel-strike angle deg", 1, degrees),
)
"""Parameter, what it is called, digits, and how it is turned into the unit of the name."""
SHARES = (
    ("stance_time", "stance %"),
    ("single_support", "single support %"),
    ("initial_double_support", "initial double support %"),
    ("terminal_double_support", "terminal double support %"),
)


def gait_lines(means: GaitMeans) -> list[str]:
    """A table for walking and one for running, each of steady strides and followed by a blank line; nothing where there
    were none."""
    lines: list[str] = []
    for running in (False, True):
        parameters = means.of(running)
        if parameters is not None:
            lines += [*_table(parameters), ""]
    return lines


def _table(parameters: GaitParameters) -> list[str]:
    columns = [parameters.feet.get(foot) for foot in Foot]
    what = "running" if parameters.running else "walking"
    header = [f"{what}, steady strides", "left", "right", "both +- SD", "CV %", "asymmetry %"]
    strides = [number(None if one is None else _strides(one), 0) for one in (*columns, parameters.both)]
    rows = [["strides", *strides, "-", "-"], ["cadence steps/min", "-", "-", number(parameters.cadence, 1), "-", "-"]]
    for name, title, digits, turned in ROWS:
        both: Figure | None = getattr(parameters.both, name)
        if both is not None:
            unit = 1.0 if turned is None else turned(1.0)
            means = [None if one is None else getattr(one, name) for one in columns]
            told = [number(None if one is None else unit * one.mean, digits) for one in means]
            spread = "" if both.sd is None else f" +- {unit * both.sd:.{digits}f}"
            asymmetry = percent(parameters.asymmetry(name))
            rows.append([title, *told, f"{unit * both.mean:.{digits}f}{spread}", percent(both.cv), asymmetry])
    for name, title in SHARES:
        if getattr(parameters.both, name) is not None:
            shares = [None if one is None else one.share(name) for one in (*columns, parameters.both)]
            rows.append([title, *map(percent, shares), "-", percent(parameters.asymmetry(name))])
    lines = table(header, rows).splitlines()
    if parameters.coordination is not None:
        lines.append(f"phase coordination index {percent(parameters.coordination)} %")
    return lines


def _strides(figures: StrideFigures) -> float | None:
    return None if figures.stride_time is None else figures.stride_time.strides
