"""Bebek et al. 2010: half-hour walks that end where they start, and what the heel does while it is taken to be at rest.

The lengths of the walks are those of table I. The paper says that the fourth walk was laps of the square and that the
fifth was random. Here walks that fit into half an hour at PACE are laps of the square, and longer ones are random. The
wearer walks at PACE, or faster where the half hour requires it, and stands for the rest of the half hour. The paper
does not give the sampling rate.

The paper compares detectors by loops, and its six pairs do not differ significantly. A loop is a poor test of a
detector: it hides what the laps calibrate away and what turns with the wearer. So three more figures are compared: the
strides that a user gets with their lengths, the stances found (those with a single sample at rest count), and the true
velocity of the heel while it is taken to be at rest, the "zero-velocity sensing bias per step" of table II.

Short walks show what each of our additions gains, and how the results depend on what is emulated (contour/variants.py).
"""

from __future__ import annotations

from collections.abc import Sequence

from attrs import evolve

from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR

from .contour.variants import MAIN, PRESSURE_PRINTED_ROW, PRESSURE_ROW, RATE, SETUPS, TABLE, VARIANTS, WITHOUT_BIAS_ROW
from .contour.walks import HALF_HOUR, NUMBER, ContourJob, walk
from .runner import Runner
from .tables import Plot, Reproduction, WalkResults, gathered

NAME = PRESSURE_CONTOUR.name
WALKS = 6
WALK_DURATION = HALF_HOUR
"""Duration of each emulated walk, s. Tests shorten it; the lengths of LOOPS are scaled with it."""
SHORT_DURATION = 300.0
"""Duration of the short walks, s."""
CALIBRATION_LAPS = 5
"""Number of laps of the calibration square; the paper has "four to six"."""
FIGURE_TITLES = {3: "square (fig. 14)", 4: "random walk (figs. 15 and 16)"}
"""Titles of the walks that the paper draws, by their index in LOOPS. These are walked first."""
LOOP_ORDER = (*FIGURE_TITLES, 0, 1, 2, 5)
"""Indices of LOOPS in the order in which they are walked."""
SHORT_LOOP = 4
"""Index in LOOPS of the walk whose speed the short walks have: the random one."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` half-hour walks, of as many short ones, and of a short one for every setup.

    Other numbers of walks than 6 leave some of table I out or repeat them. Short walks are random ones, for ours, the
    printed recipes, and ours without one addition each. Those for the setups have one seed, so that they differ by the
    setup only."""
    count, seed = WALKS if walks is None else walks, 1000 * seed
    numbers = [LOOP_ORDER[k % len(LOOP_ORDER)] for k in range(count)]
    jobs = {
        "": [
            ContourJob(seed + k, number, WALK_DURATION, CALIBRATION_LAPS, TABLE, tuple(MAIN), number in FIGURE_TITLES)
            for k, number in enumerate(numbers)
        ],
        "short: ": [
            ContourJob(seed + 100 + k, SHORT_LOOP, SHORT_DURATION, CALIBRATION_LAPS, TABLE, tuple(VARIANTS))
            for k in range(count)
        ],
    }
    compared = PRESSURE_ROW, PRESSURE_PRINTED_ROW
    for setup in SETUPS:
        job = ContourJob(seed + 200, SHORT_LOOP, SHORT_DURATION, CALIBRATION_LAPS, setup, compared)
        jobs[f"with {setup.name}: "] = [job]
    found = runner.run_blocks(walk, jobs, _describe)
    return Reproduction(
        name=NAME,
        emulation=f"{count} walks of {WALK_DURATION / 60.0:g} min at {RATE:g} Hz, another device each time",
        unit="as named",
        results=gathered(found),
        panels=_panels(found[""], found["short: "]),
    )


def _describe(one: WalkResults) -> str:
    names = [name for name in MAIN if f"{name} m" in one.values]
    errors = [f"{name.lower()} {one.values[f'{name} m'][0]:.2f} m" for name in names]
    return f"loop-closing error: {', '.join(errors)}"


def _panels(loops: Sequence[WalkResults], shorts: Sequence[WalkResults]) -> tuple[Plot, ...]:
    drawn = [evolve(one.panels[0], title=FIGURE_TITLES[int(one.values[NUMBER][0])]) for one in loops[:2]]
    compared = ("true path", PRESSURE_PRINTED_ROW.lower(), WITHOUT_BIAS_ROW.lower())
    tracks = [track for track in shorts[0].panels[0].tracks if track.name in compared]
    title = "with and without the bias filter (fig. 10)"
    return (*drawn, *loops[0].panels[1:], evolve(shorts[0].panels[0], title=title, tracks=tracks))
