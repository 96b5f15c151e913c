"""Gait parameters as a table."""

from __future__ import annotations

from ..body.gait_means import GaitMeans, GaitParameters, StrideFigures
from ..types import Foot
from .gait_rows import gait_rows
from .table import number, percent, table


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
    for row in gait_rows(parameters):
        spread = "" if row.sd is None else f" +- {number(row.sd, row.digits)}"
        feet = [number(one, row.digits) for one in (row.left, row.right)]
        both = f"{number(row.both, row.digits)}{spread}"
        rows.append([f"{row.label} {row.unit}", *feet, both, percent(row.cv), percent(row.asymmetry)])
    lines = table(header, rows).splitlines()
    if parameters.coordination is not None:
        lines.append(f"phase coordination index {percent(parameters.coordination)} %")
    return lines


def _strides(figures: StrideFigures) -> float | None:
    return None if figures.stride_time is None else figures.stride_time.strides
