"""Sentences below the table of Li et al. 2016: what its rows are, what else was found, what the paper leaves open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from .scores import StrideErrors, relative_error
from .variants import BEFORE, DEFAULT_ROW, LEVEL, METHODS, STAIRS, STATES, ShoeSetup
from .walks import ShoeResults

Results = Mapping[str, Sequence[ShoeResults]]
"""Results of the wearers by walk."""

DEFINITIONS = (
    "Rows: printed is the paper's method without anything of ours, ours is the recipe shoe-sensing. Length and height "
    'are errors of single steps without their signs, all wearers together; "height of 100 steps" is what the first 100 '
    "steps on the level gained, one figure a wearer; course is the direction of single steps in each 19.2 m, the first "
    "two metres laid on the truth; heading is the direction of the last 19.2 m when the first is laid on the truth; "
    "steps is F1 of steps that end within 0.3 s of a true one; state is the share of the steps found whose own angle "
    "is of the state walked; table 2 is a wearer's mean error over the mean length, divided by 22.5, of the height "
    "upstairs and of the length otherwise; before is without and after is with the elimination of height errors on "
    "level steps; 19.2 m is the distance from one turn to the next, whose true value is that of the foot.",
    "Table 1 is of steps before their heights are corrected. What theta' is made of is in "
    "papers/shoe_sensing/steepness.py; the paper's words for it do not fit its figures.",
    "Rows named short are of one walk with all states, for ours, ours without one addition, the printed method with "
    "windows of N, the magnitude and the recipe default. Stair height is of single steps on stairs, end height of the "
    "whole track.",
)
PAPER_NOTES = (
    "The paper: lengths right to 90.8 % walking, 91.9 % jogging, 90.8 % upstairs and 80.0 % downstairs, at worst "
    "off by 0.34, 0.49, 0.32 and 0.38 m; heights of level steps after elimination at worst off by 0.26 m walking and "
    "0.61 m jogging; states above 95 %, steps nearly 100 %; of the five minutes it has a picture and no figure.",
    'The paper\'s heights before elimination (0.12 m walking, 0.17 m jogging) are of "100 sets of data", and it '
    "does not say how many steps a set has; they stand beside ours of single steps.",
)


def notes(
    results: Results, long_walk: ShoeResults, setups: Sequence[ShoeSetup], setup_walks: Sequence[ShoeResults]
) -> tuple[str, ...]:
    """Return all sentences below the table; `setup_walks` are the short walks of `setups`."""
    return (
        *DEFINITIONS,
        *_length_notes(results),
        *_height_notes(results),
        *_tour_notes(results),
        *_long_notes(long_walk),
        *_setup_notes(setups, setup_walks),
        *PAPER_NOTES,
    )


def scores_of_state(results: Results, state: str, method: str) -> list[StrideErrors]:
    """Return the scores of all wearers in the long walk of a state."""
    return [one.scores[method].states[state] for one in results["stairs" if state in STAIRS else state]]


def _length_notes(results: Results) -> list[str]:
    """Return a sentence about the lengths of each state and method."""
    lines = []
    for state in STATES:
        for method in METHODS:
            scores = scores_of_state(results, state, method)
            lengths = [pair for of in scores for pair in of.lengths]
            if not lengths:
                continue
            merged, split = sum([of.merged for of in scores]), sum([of.split for of in scores])
            line = (
                f"{state.capitalize()}, {method}: {len(lengths)} steps of {np.mean([true for _, true in lengths]):.2f} "
                f"m on average, lengths right to {100.0 * (1.0 - relative_error(lengths)):.1f} %, on average "
                f"{np.mean([error for error, _ in lengths]):+.3f} m, at worst off by "
                f"{max([abs(error) for error, _ in lengths]):.2f} m"
            )
            whole = [abs(error) for of in scores for error in of.whole]
            if merged + split and whole:
                line += (
                    f"; {merged} were joined with the step before, whose stance was missed, and {split} in two "
                    f"pieces; the others are at worst off by {max(whole):.2f} m"
                )
            lines.append(f"{line}.")
    return lines


def _height_notes(results: Results) -> list[str]:
    """Return a sentence about the heights of level walks, and one about ramps."""
    lines = [
        "Heights on the level after elimination say little: a step that is judged level ends exactly as high as it "
        "began, by construction, on any floor, a ramp too. The rows of slopes and of the kerb show what that costs."
    ]
    for state in LEVEL:
        for method in METHODS:
            after, before = (
                [abs(one.scores[recipe].track.height_error) for one in results[state]]
                for recipe in (method, BEFORE[method])
            )
            lines.append(
                f"{state.capitalize()} there and back, {method}: the track ends {max(after):.2f} m off in height at "
                f"worst; without elimination {np.mean(before):.2f} m on average and {max(before):.2f} m at worst."
            )
    return lines


def _tour_notes(results: Results) -> list[str]:
    """Return a sentence about the five minutes by each method."""
    walks, lines = results["five minutes"], []
    for method in (*METHODS, DEFAULT_ROW):
        tracks = [one.scores[method].track for one in walks]
        ends, heights = [of.end_error for of in tracks], [abs(of.height_error) for of in tracks]
        n_exact = sum([of.flights == one.true_flights for of, one in zip(tracks, walks, strict=True)])
        share = 100.0 * sum(ends) / sum([one.path_length for one in walks])
        headings = [abs(of.heading_error) for of in tracks]
        lines.append(
            f"Five minutes, {method}: flights reported exactly in {n_exact} of {len(walks)} walks; the end is off by "
            f"{np.mean(ends):.1f} m on average, {share:.1f} % of the way, and by {max(ends):.1f} m at worst, its "
            f"height by {np.mean(heights):.2f} m and {max(heights):.2f} m; the heading of the last steps by "
            f"{np.mean(headings):.0f} degrees on average and {max(headings):.0f} at worst."
        )
    return lines


def _long_notes(walk: ShoeResults) -> list[str]:
    """Return a sentence about the walk of twenty rounds by each method."""
    lines = []
    for method in METHODS:
        of = walk.scores[method]
        courses = [abs(course) for leg in of.legs for course in leg.courses]
        ours, true = _mean([sum(leg.length) for leg in of.legs]), _mean([leg.length[1] for leg in of.legs])
        lines.append(
            f"Twenty rounds by one wearer, {walk.path_length:.0f} m, {method}: steps "
            f"{of.states['walking'].stride_f1:.1f} %, a leg of {true:.2f} m comes out as {ours:.2f} "
            f"m, the course of steps is off by {_mean(courses):.1f} "
            f"degrees, the heading of the last leg by {abs(of.legs[-1].heading):.0f} degrees, the end by "
            f"{of.track.end_error:.1f} m and its height by {abs(of.track.height_error):.2f} m."
        )
    return lines


def _setup_notes(setups: Sequence[ShoeSetup], walks: Sequence[ShoeResults]) -> list[str]:
    """Return a sentence about each setup of the short walk."""
    lines = [
        "Setups, of which all but the first change one thing; by the printed method and ours: steps walking and "
        "jogging, %; mean error of lengths, m; mean error of heights on stairs, m; states, %."
    ]
    for setup, one in zip(setups, walks, strict=True):
        parts = []
        for method in METHODS:
            states = one.scores[method].states
            found = " and ".join(f"{states[state].stride_f1:.1f}" for state in LEVEL)
            lengths = [abs(error) for of in states.values() for error, _ in of.lengths]
            heights = [abs(error) for state in STAIRS for error, _ in states[state].heights]
            right = [right for of in states.values() for right in of.right]
            parts.append(f"{method} {found}; {_mean(lengths):.3f}; {_mean(heights):.3f}; {100.0 * _mean(right):.1f}")
        lines.append(f"With {setup.name}: {', '.join(parts)}.")
    return lines


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if values else 0.0
