"""Gait parameters as a table."""

from __future__ import annotations

from ...body.gait.means import GaitMeans, GaitParameters
from ...types import Foot
from .gait_rows import gait_rows, strides_of
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
    what = "running" if parameters.running else "walking"
    header = [f"{what}, steady strides", "left", "right", "both +- SD", "CV %", "asymmetry"]
    strides = [number(strides_of(parameters, foot), 0) for foot in Foot]
    rows = [["strides", *strides, "-", "-", "-"]]
    rows.append(["cadence steps/min", "-", "-", number(parameters.cadence, 1), "-", "-"])
    for row in gait_rows(parameters):
        rows.append([f"{row.label} {row.unit}", *row.cells(" +-")])
    lines = table(header, rows).splitlines()
    if parameters.coordination is not None:
        lines.append(f"phase coordination index {percent(parameters.coordination)} %")
    return lines
