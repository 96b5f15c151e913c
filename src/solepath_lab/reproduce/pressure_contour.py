"""Bebek et al. 2010: half-hour walks that end where they start, and what the heel does while it is taken to be at rest.

The lengths of the walks are those of table I. The paper says that the fourth walk was laps of the square and that the
fifth was random. Here walks that fit into half an hour at PACE are laps of the square, and longer ones are random. The
wearer walks at PACE, or faster where the half hour requires it, and stands for the rest of the half hour. The paper
does not give the sampling rate.

The paper compares detectors by loops, and its six pairs do not differ significantly. A loop is a poor test of a
detector: it hides what the laps calibrate away and what turns with the wearer. So the true velocity of the heel in each
stance is compared as well: the "zero-velocity sensing bias per step" of table II.

Short walks show what each of our additions gains, and how the results depend on what is emulated (contour/variants.py).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from attrs import evolve

from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR

from .contour.runs import sign_test
from .contour.variants import (
    GYROSCOPE_PRINTED_ROW,
    GYROSCOPE_ROW,
    LESS,
    MAIN,
    PRESSURE_PRINTED_ROW,
    PRESSURE_ROW,
    RATE,
    SETUPS,
    TABLE,
    VARIANTS,
    WITHOUT_BIAS_ROW,
)
from .contour.walks import HALF_HOUR, LOOPS, NOT_FOUND, ContourJob, walk
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import FigureRow, Plot, Reproduction, Table, WalkResults, pooled, row_of, statistics

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
COMPARED = (GYROSCOPE_ROW, PRESSURE_ROW, PRESSURE_PRINTED_ROW)
"""Recipes that walk every setup."""


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
        rows=tuple([*_loop_rows(loops), *_short_rows(shorts)]),
        panels=_panels(loops, shorts),
        notes=(*_loop_notes(loops), *_velocity_notes(loops), *_setup_notes(setups)),
    )


def _describe(one: WalkResults) -> str:
    names = [name for name in MAIN if f"{name} m" in one.values]
    errors = [
        f"{name.lower()} {one.values[f'{name} m'][0]:.2f} m and {_mean_bias(one, name):.2f} mm/s" for name in names
    ]
    return f"{one.values['distance'][0]:.0f} m, closing error and velocity of the heel: {', '.join(errors)}"


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


def _loop_rows(loops: Sequence[WalkResults]) -> list[FigureRow]:
    rows = [row_of(PAPER_ROWS, f"{name} m", pooled(loops, f"{name} m")) for name in MAIN]
    distances = pooled(loops, "distance")
    for name in (GYROSCOPE_ROW, PRESSURE_ROW):
        shares = 100.0 * np.divide(pooled(loops, f"{name} m"), distances)
        rows.append(row_of(PAPER_ROWS, f"{name} %", shares.tolist(), 3))
    rows += [row_of(PAPER_ROWS, f"{name} mm/s", [_mean_bias(one, name) for one in loops]) for name in MAIN]
    for name in (PRESSURE_ROW, PRESSURE_PRINTED_ROW):
        rows.append(row_of(PAPER_ROWS, f"{name}, stances found %", pooled(loops, f"{name} found"), 1))
    return rows


def _short_rows(shorts: Sequence[WalkResults]) -> list[FigureRow]:
    names = (PRESSURE_ROW, *LESS, PRESSURE_PRINTED_ROW, GYROSCOPE_ROW, GYROSCOPE_PRINTED_ROW)
    rows = [row_of({}, f"short: {name} m", pooled(shorts, f"{name} m")) for name in names]
    return rows + [row_of({}, f"short: {name} mm/s", [_mean_bias(one, name) for one in shorts]) for name in names]


def _mean_bias(result: WalkResults, name: str) -> float:
    """Return the mean velocity of the heel over the stances that were found, mm/s; 0 when none was."""
    found = [bias for bias in result.values[f"{name} biases"] if bias != NOT_FOUND]
    return 1e3 * float(np.mean(found)) if found else 0.0


def _panels(loops: Sequence[WalkResults], shorts: Sequence[WalkResults]) -> tuple[Plot, ...]:
    drawn = [evolve(one.panels[0], title=FIGURE_TITLES[int(one.values["number"][0])]) for one in loops[:2]]
    compared = ("true path", PRESSURE_PRINTED_ROW.lower(), WITHOUT_BIAS_ROW.lower())
    tracks = [track for track in shorts[0].panels[0].tracks if track.name in compared]
    title = "with and without the bias filter (fig. 10)"
    return (*drawn, *loops[0].panels[1:], evolve(shorts[0].panels[0], title=title, tracks=tracks))


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


def _velocity_notes(loops: Sequence[WalkResults]) -> list[str]:
    """Return the comparisons of detectors by the velocity of the heel, stance by stance, and by loops."""
    pairs = ((PRESSURE_ROW, GYROSCOPE_ROW), (PRESSURE_PRINTED_ROW, GYROSCOPE_PRINTED_ROW))
    lines = []
    for first, second in pairs:
        biases = [np.array(pooled(loops, f"{name} biases")) for name in (first, second)]
        steps = sign_test(*[np.where(of == NOT_FOUND, np.nan, of) for of in biases])
        walks = sum([_mean_bias(one, first) < _mean_bias(one, second) for one in loops])
        ends = sign_test(*[np.array(pooled(loops, f"{name} m")) for name in (first, second)])
        lines.append(
            f"{first} against {second.lower()}: the heel is slower while taken to be at rest in {steps.smaller} of "
            f"{steps.pairs} stances (sign test, p {_probability(steps.probability)}) and on average in {walks} of "
            f"{len(loops)} walks; the loop ends nearer in {ends.smaller} of {ends.pairs} (p "
            f"{_probability(ends.probability)})."
        )
    return lines


def _probability(p: float) -> str:
    return f"= {p:.2g}" if p >= 1e-12 else "< 1e-12"


def _setup_notes(results: Sequence[WalkResults]) -> list[str]:
    lines = [
        f"Walks of {SHORT_DURATION / 60.0:g} min, of which all but the first change one thing: velocity of the heel, "
        f"stances found and loop-closing error of {', '.join(name.lower() for name in COMPARED)}."
    ]
    for setup, one in zip(SETUPS, results, strict=True):
        velocities = ", ".join(f"{_mean_bias(one, name):.2f}" for name in COMPARED)
        found, ends = (
            ", ".join(f"{one.values[f'{name} {what}'][0]:.{digits}f}" for name in COMPARED)
            for what, digits in (("found", 0), ("m", 2))
        )
        lines.append(f"With {setup.name}: {velocities} mm/s; {found} %; {ends} m.")
    return lines
