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

from collections.abc import Iterable, Sequence

import numpy as np
from attrs import evolve

from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR

from .contour.variants import (
    GYROSCOPE_PRINTED_ROW,
    GYROSCOPE_ROW,
    KPA_ROW,
    MAIN,
    PRESSURE_PRINTED_ROW,
    PRESSURE_ROW,
    PUBLISHED_RATE,
    RATE,
    SETUPS,
    SWING_DRIFT_ROW,
    TABLE,
    VARIANTS,
    WITHOUT_BIAS_ROW,
)
from .contour.walks import HALF_HOUR, LOOPS, ContourJob, walk
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import Claim, FigureRow, Plot, Reproduction, Table, WalkResults, claim, pooled, row_of, statistics

NAME = PRESSURE_CONTOUR.name
PAPER_ROWS: Table = {
    **rows_of(NAME),
    "Gyroscope m": statistics([loop.gyroscope for loop in LOOPS]),
    "Pressure m": statistics([loop.pressure for loop in LOOPS]),
    "Gyroscope %": statistics([100.0 * loop.gyroscope / loop.distance for loop in LOOPS]),
    "Pressure %": statistics([100.0 * loop.pressure / loop.distance for loop in LOOPS]),
}
"""Table II, and statistics of LOOPS: loop-closing error in m and in % of the path.

Means and standard deviations in m are those that the paper prints (4.87 +- 2.75 and 4.30 +- 3.15). The paper's mean
percentages, 0.40 and 0.35, are its mean errors divided by its mean distance instead."""
LOOPS_MEAN = PAPER_ROWS["Pressure m"].mean or 0.0
"""Mean of the paper's loop-closing errors by pressure, m."""
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
COMPARED = (PRESSURE_ROW, PRESSURE_PRINTED_ROW)
"""Recipes that walk every setup."""
FIGURES = {"m": 2, "mm/s": 2, "stances %": 1, "strides %": 1, "length m": 3}
"""Digits of the figures of each recipe (contour/walks.py), by name."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` half-hour walks, of as many short ones, and of a short one for every setup."""
    count = WALKS if walks is None else walks
    jobs = loop_jobs(count, seed) + short_jobs(count, seed) + setup_jobs(seed)
    results = runner.run(walk, jobs, _describe)
    loops, shorts, setups = results[:count], results[count : 2 * count], results[2 * count :]
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} walks of {WALK_DURATION / 60.0:g} min at {RATE:g} Hz, another device each time",
        unit="as named",
        rows=tuple([*_rows("", MAIN, loops), *_percentages(loops), *_rows("short: ", VARIANTS, shorts)]),
        panels=_panels(loops, shorts),
        claims=(*_loop_claims(loops), *_short_claims(shorts)),
        notes=(*_loop_notes(loops), *_setup_notes(setups)),
    )


def _describe(one: WalkResults) -> str:
    names = [name for name in MAIN if f"{name} m" in one.values]
    errors = [f"{name.lower()} {one.values[f'{name} m'][0]:.2f} m" for name in names]
    return f"{one.values['distance'][0]:.0f} m, loop-closing error: {', '.join(errors)}"


def loop_jobs(count: int, seed: int) -> list[ContourJob]:
    """Return the walks of table I; `count` other than 6 leaves some out or repeats them."""
    numbers = [LOOP_ORDER[k % len(LOOP_ORDER)] for k in range(count)]
    return [
        ContourJob(
            1000 * seed + k, number, WALK_DURATION, CALIBRATION_LAPS, TABLE, tuple(MAIN), number in FIGURE_TITLES
        )
        for k, number in enumerate(numbers)
    ]


def short_jobs(count: int, seed: int) -> list[ContourJob]:
    """Return `count` short random walks for ours, the printed recipes, and ours without one addition each."""
    return [
        ContourJob(1000 * seed + 100 + k, SHORT_LOOP, SHORT_DURATION, CALIBRATION_LAPS, TABLE, tuple(VARIANTS))
        for k in range(count)
    ]


def setup_jobs(seed: int) -> list[ContourJob]:
    """Return a short random walk for every setup; all have the same seed, so that they differ by the setup only."""
    return [
        ContourJob(1000 * seed + 200, SHORT_LOOP, SHORT_DURATION, CALIBRATION_LAPS, setup, COMPARED) for setup in SETUPS
    ]


def _rows(start: str, names: Iterable[str], walks: Sequence[WalkResults]) -> list[FigureRow]:
    pairs = [(name, figure) for figure in FIGURES for name in names]
    return [
        row_of(
            {} if start else PAPER_ROWS, f"{start}{name} {figure}", pooled(walks, f"{name} {figure}"), FIGURES[figure]
        )
        for name, figure in pairs
    ]


def _percentages(loops: Sequence[WalkResults]) -> list[FigureRow]:
    distances = pooled(loops, "distance")
    return [
        row_of(PAPER_ROWS, f"{name} %", (100.0 * np.divide(pooled(loops, f"{name} m"), distances)).tolist(), 3)
        for name in (GYROSCOPE_ROW, PRESSURE_ROW)
    ]


def _panels(loops: Sequence[WalkResults], shorts: Sequence[WalkResults]) -> tuple[Plot, ...]:
    drawn = [evolve(one.panels[0], title=FIGURE_TITLES[int(one.values["number"][0])]) for one in loops[:2]]
    compared = ("true path", PRESSURE_PRINTED_ROW.lower(), WITHOUT_BIAS_ROW.lower())
    tracks = [track for track in shorts[0].panels[0].tracks if track.name in compared]
    title = "with and without the bias filter (fig. 10)"
    return (*drawn, *loops[0].panels[1:], evolve(shorts[0].panels[0], title=title, tracks=tracks))


def _loop_claims(loops: Sequence[WalkResults]) -> list[Claim]:
    ends = pooled(loops, f"{PRESSURE_ROW} m")
    return [
        claim(f"loops end nearer than the paper's {LOOPS_MEAN:.2f} m", [LOOPS_MEAN] * len(ends), ends),
        _less(loops, "m", "loops end nearer with pressure than with the gyroscope", GYROSCOPE_ROW, PRESSURE_ROW),
        _less(
            loops,
            "mm/s",
            f"as printed the heel is slower at rest by pressure than by a gyroscope below {PUBLISHED_RATE:g} rad/s",
            GYROSCOPE_PRINTED_ROW,
            PRESSURE_PRINTED_ROW,
        ),
        _less(
            loops,
            "mm/s",
            "ours: the heel is slower at rest by pressure than by the gyroscope",
            GYROSCOPE_ROW,
            PRESSURE_ROW,
        ),
        _less(loops, "strides %", "ours finds more strides than the printed one", PRESSURE_ROW, PRESSURE_PRINTED_ROW),
    ]


def _short_claims(shorts: Sequence[WalkResults]) -> list[Claim]:
    names = {
        "lengths err less with the swing's drift taken off": (SWING_DRIFT_ROW, PRESSURE_ROW),
        "lengths err less with levels by share than in kPa": (KPA_ROW, PRESSURE_ROW),
        "as printed lengths err less with the bias filter": (WITHOUT_BIAS_ROW, PRESSURE_PRINTED_ROW),
        "ours errs less in length than the gyroscope": (GYROSCOPE_ROW, PRESSURE_ROW),
    }
    return [
        *[_less(shorts, "length m", f"short: {sentence}", *pair) for sentence, pair in names.items()],
        _less(
            shorts,
            "strides %",
            "short: ours finds more strides than the printed one",
            PRESSURE_ROW,
            PRESSURE_PRINTED_ROW,
        ),
    ]


def _less(walks: Sequence[WalkResults], figure: str, sentence: str, more: str, less: str) -> Claim:
    """Return the claim that a figure of the recipe `less` is smaller than that of `more`."""
    unit = figure.rpartition(" ")[2]
    return claim(sentence, pooled(walks, f"{more} {figure}"), pooled(walks, f"{less} {figure}"), unit)


def _loop_notes(loops: Sequence[WalkResults]) -> list[str]:
    lines = []
    for one in sorted(loops, key=lambda one: one.values["number"]):
        number = int(one.values["number"][0])
        paper = LOOPS[number]
        ours = ", ".join(f"{name.lower()} {one.values[f'{name} m'][0]:.2f} m" for name in MAIN)
        lines.append(
            f"Like experiment {number + 1}, {one.values['distance'][0]:.0f} m: {ours}; paper, {paper.distance:.0f} m: "
            f"gyroscope {paper.gyroscope:.2f} m, pressure {paper.pressure:.2f} m."
        )
    lines.append(
        "The paper's mean percentages, 0.40 and 0.35, are its mean errors over its mean distance; the table above has "
        "the means of its six percentages."
    )
    return lines


def _setup_notes(results: Sequence[WalkResults]) -> list[str]:
    lines = [
        f"Walks of {SHORT_DURATION / 60.0:g} min, of which all but the first change one thing, by pressure and by "
        "pressure as printed: strides found, stances with a sample at rest, velocity of the heel, end of the loop."
    ]
    for setup, one in zip(SETUPS, results, strict=True):
        both = [
            f"{one.values[f'{name} strides %'][0]:.0f} and {one.values[f'{name} stances %'][0]:.0f} %, "
            f"{one.values[f'{name} mm/s'][0]:.2f} mm/s, {one.values[f'{name} m'][0]:.2f} m"
            for name in COMPARED
        ]
        lines.append(f"With {setup.name}: {'; '.join(both)}.")
    return lines
