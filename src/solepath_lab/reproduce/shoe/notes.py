"""Sentences below the table of Li et al. 2016: what its rows are, what else was found, what the paper leaves open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..tables import WalkResults, pooled
from .variants import DEFAULT_ROW, LEVEL, METHODS, SETUPS, STAIRS, STATES

Results = Mapping[str, Sequence[WalkResults]]
"""Results of the wearers by walk."""


def figures(walks: Sequence[WalkResults], recipe: str, *names: str) -> list[float]:
    """Return these figures of a recipe on some walks, in one list."""
    return pooled(walks, *[f"{recipe}: {name}" for name in names])


def walk_of(state: str) -> str:
    """Return the name of the long walk of a state."""
    return "stairs" if state in STAIRS else state


DEFINITIONS = (
    "Rows: printed is the paper's method without anything of ours, ours is the recipe shoe-sensing. Length and height "
    "are errors of single steps without their signs, all wearers together; course is the direction of single steps in "
    "each 19.2 m, the first two metres laid on the truth; "
    "steps is F1 of steps that end within 0.3 s of a true one; state is the share of the steps found whose own angle "
    "is of the state walked; table 2 is a wearer's mean error over the mean length, divided by 22.5, of the height "
    "upstairs and of the length otherwise; before is without and after is with the elimination of height errors on "
    "level steps; 19.2 m is the distance from one turn to the next, whose true value is that of the foot.",
    "Table 1 is of steps before their heights are corrected. What theta' is made of is in "
    "papers/shoe_sensing/steepness.py; the paper's words for it do not fit its figures.",
    "Rows named short are of one walk with all states, for ours, ours without one addition, the printed method with "
    "windows of N, the magnitude and the recipe default. Stair height is of single steps on stairs, end height of the "
    "whole track.",
    "Heights on the level after elimination say little: a step that is judged level ends exactly as high as it began, "
    "by construction, on any floor, a ramp too. The rows of slopes and of the kerb show what that costs.",
)
PAPER_NOTES = (
    "The paper: lengths right to 90.8 % walking, 91.9 % jogging, 90.8 % upstairs and 80.0 % downstairs, at worst "
    "off by 0.34, 0.49, 0.32 and 0.38 m; heights of level steps after elimination at worst off by 0.26 m walking and "
    "0.61 m jogging; states above 95 %, steps nearly 100 %; of the five minutes it has a picture and no figure.",
    'The paper\'s heights before elimination (0.12 m walking, 0.17 m jogging) are of "100 sets of data", and it '
    "does not say how many steps a set has; they stand beside ours of single steps.",
)


def notes(results: Results, setup_walks: Sequence[WalkResults]) -> tuple[str, ...]:
    """Return all sentences below the table; `setup_walks` are the short walks of `SETUPS`."""
    return (*DEFINITIONS, *_tour_notes(results), *_setup_notes(setup_walks), *PAPER_NOTES)


def _tour_notes(results: Results) -> list[str]:
    """Return a sentence about the five minutes by each method."""
    walks, lines = results["five minutes"], []
    length = sum(pooled(walks, "path"))
    for method in (*METHODS, DEFAULT_ROW):
        ends, headings = (np.abs(figures(walks, method, name)) for name in ("end", "end heading"))
        lines.append(
            f"Five minutes, {method}: the end is off by {ends.mean():.1f} m on average, "
            f"{100.0 * ends.sum() / length:.1f} % of the way, and by {ends.max():.1f} m at worst; the heading of the "
            f"last steps by {headings.mean():.0f} degrees on average and {headings.max():.0f} at worst."
        )
    return lines


def _setup_notes(walks: Sequence[WalkResults]) -> list[str]:
    """Return a sentence about each setup of the short walk."""
    lines = [
        "Setups, of which all but the first change one thing; by the printed method and ours: steps walking and "
        "jogging, %; mean error of lengths, m; mean error of heights on stairs, m; states, %."
    ]
    for setup, one in zip(SETUPS, walks, strict=True):
        parts = []
        for method in METHODS:
            found = " and ".join(f"{figures([one], method, f'{state} steps')[0]:.1f}" for state in LEVEL)
            lengths = np.mean(np.abs(figures([one], method, *(f"{state} lengths" for state in STATES))))
            heights = np.mean(np.abs(figures([one], method, *(f"{state} heights" for state in STAIRS))))
            right = np.mean(figures([one], method, *(f"{state} right" for state in STATES)))
            parts.append(f"{method} {found}; {lengths:.3f}; {heights:.3f}; {100.0 * right:.1f}")
        lines.append(f"With {setup.name}: {', '.join(parts)}.")
    return lines
