"""Ablation: the main figures of the default recipe without each of its parts.

Each row of the table is the default recipe with one part switched off by its settings, or replaced by the simpler part
that came before it. main_figures.csv lists the main figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from attrs import evolve, frozen

from solepath.body.altitude import Altitude
from solepath.body.fuse.both_feet import BothFeet, BothFeetSettings
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.settings import CycleSettings, ErrorStateSettings
from solepath.foot.stance.cycle import Cycle
from solepath.recipes import DEFAULT, Recipe

from ..descriptions import read_rows
from .report import Result

UNREACHABLE_LIMIT = 1e12
"""Limit that no statistic, duration or innovation exceeds; it switches a test off."""
FIXED_THRESHOLD = 1e6
"""Fixed threshold of the SHOE statistic, no unit: the best of 8e4, 2e5, 4e5 and 1e6 on recorded walks."""


def _cycle(**settings: Any) -> Recipe:
    return evolve(DEFAULT, detector=Cycle(CycleSettings(**settings)))


def _filter(**settings: Any) -> Recipe:
    return evolve(DEFAULT, corrector=ErrorStateFilter(ErrorStateSettings(**settings)))


ABLATED_RECIPES: dict[str, Recipe] = {
    "one threshold for all, no wearer's own cycle": _cycle(least_threshold=FIXED_THRESHOLD, threshold_position=0.0),
    "evidence of one noise, whatever the motion": _cycle(
        noise_per_rate_square=0.0, noise_per_acceleration=0.0, noise_per_acceleration_square=0.0
    ),
    "zero velocity, no rolling foot": _cycle(rolls=False),
    "no extra noise of a foot that is braked": _cycle(noise_per_acceleration_square=0.0),
    "no innovation gate": _filter(innovation_gate=UNREACHABLE_LIMIT),
    "no recovery after gated evidence": _filter(stance_share=UNREACHABLE_LIMIT, time_until_ungated=UNREACHABLE_LIMIT),
    "no level, slope or stair": _filter(level=False),
    "no noise of what lies between samples": _filter(noise_per_difference=0.0),
    "no recovery of a clipped gyroscope": _filter(recover=False),
    "no straight ways": DEFAULT.replace_part(TrackPart, BothFeet(BothFeetSettings(straightness=False))),
    "each foot by itself": DEFAULT.replace_part(TrackPart, MeanOfFeet()),
    "no heights of elevators and air pressure": DEFAULT.replace_part(Altitude, None),
}
"""Recipes by the name of the part or step that each of them lacks."""


def recipes() -> list[Recipe]:
    """Return the default recipe, then the recipes of ABLATED_RECIPES with their keys as names."""
    return [DEFAULT, *(evolve(recipe, name=name) for name, recipe in ABLATED_RECIPES.items())]


@frozen
class Column:
    """A column of the table: one main figure of one group of recordings of a data set."""

    title: str
    data_set: str
    figure: str
    """Name of the figure in JSON."""
    unit: str
    """Unit in which the table shows the figure: m, %, ms, or empty for F1."""
    pooled: str
    """"pooled" for a figure over the events of all recordings; empty for the mean of the recordings' figures."""
    group: str

    def find_figure(self, results: Sequence[Result], recipe: str) -> float | None:
        """Return the figure of one recipe in SI units; None when the recipe was not scored."""
        for result in results:
            if (result.data_set.name, result.recipe) == (self.data_set, recipe):
                for summary in result.summaries:
                    if summary.group == self.group:
                        return (summary.together if self.pooled else summary.mean).get(self.figure)
        return None


def _columns(table: str) -> tuple[Column, ...]:
    """Return the columns of a table: "ablation" or "sensitivity"."""
    rows = [row for row in read_rows(__file__, "main_figures.csv") if table in row.pop("tables").split()]
    return tuple([Column(**row) for row in rows])


COLUMNS, SENSITIVITY_COLUMNS = _columns("ablation"), _columns("sensitivity")
"""The main figures, in the order of the tables."""
