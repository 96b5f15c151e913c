"""Figures of the papers, as printed: published.toml has them.

Chen et al. 2019: D. Chen and others, "Smart Insole-Based Indoor Localization System for Internet of Things
Applications", IEEE Internet of Things Journal. Bebek et al. 2010: O. Bebek and others, "Personal Navigation via
High-Resolution Gait-Corrected Inertial Measurement Units", IEEE Transactions on Instrumentation and Measurement. Gong
et al. 2023: "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm
against Walking Modes", Sensors. Liu et al. 2015: C. Liu and others, "Track Your Foot Step: Anchor-free Indoor
Localization based on Sensing Users' Foot Steps", IEEE MASS. Li et al. 2016: F. Li and others, "3D Tracking via Shoe
Sensing", Sensors 16, 1809."""

from __future__ import annotations

import tomllib
from math import isnan
from pathlib import Path
from typing import Any

from .tables import Statistics, Table

METHODS = ("printed", "ours")
"""Methods beside which the rows with braces stand."""
PUBLISHED: dict[str, dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("published.toml").read_text(encoding="utf-8")
)
"""What each paper prints, by the name of its experiment."""


def rows_of(name: str) -> Table:
    """Return the statistics that a paper prints, by row."""
    return {
        row.format(method): Statistics(*[None if isnan(value) else value for value in values])
        for row, values in PUBLISHED[name]["rows"].items()
        for method in METHODS
    }
