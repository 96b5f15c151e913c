"""Gong et al. 2023: positions at the corners of 40 rectangles of 2.8 m by 4.0 m, by touchdown methods I to IV.

Four wearers walk ten rectangles each, with seven attitude sensors and two insoles of 99 cells at 50 Hz. The wearers are
those of table 3 (emulate/wearers/gait.py). They walk from A over B, C and D back to A, turning left without a halt. For
each corner and foot, one stride counts: that whose foot-flat is nearest to the time when the pelvis passes the corner.
The deviation at a corner is the session's touchdown minus the true footprint of these strides, averaged over both feet.

The floor is surveyed, as in the paper: sessions know the direction of the first side relative to the sensors' common
north. Methods I, II and III of papers/walking_modes detect touchdowns by height, net acceleration and pressure. IV also
uses pressure, and compensates with the errors of the same wearer's walks over marks on the floor (section 3.3). These
are other walks, for which the sensors were attached anew. What IV has that the paper has not is taken away piece by
piece (`VARIANTS`). Then come recognition of the modes under two load laws, and the corners under other conditions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from math import radians

import numpy as np
from attrs import evolve

from solepath.calibration import Calibration
from solepath.emulate.wearers.gait import LoadLaw
from solepath.papers.walking_modes.calibrate import MODES
from solepath.papers.walking_modes.compensation import TABLE_1, Compensation
from solepath.papers.walking_modes.recipe import (
    TOUCHDOWN_ACCELERATION,
    TOUCHDOWN_HEIGHT,
    TOUCHDOWN_PRESSURE,
    WALKING_MODES,
    WALKING_MODES_PRINTED,
)
from solepath.papers.walking_modes.settings import ModeRule
from solepath.recipes import Recipe
from solepath.types import Foot

from ..emulated.laps import ACROSS, ALONG
from ..emulated.soles import SLIPPING, WORN
from ..emulated.wearers import SUBJECTS
from .modes.figures import CORNER_POSITIONS, panels
from .modes.walks import (
    LOAD_VARIATION,
    RATE,
    USUAL,
    BendsJob,
    Conditions,
    MarkedWalks,
    ModesJob,
    corner_row,
    deviations,
    learn,
    recognise,
    walk,
    with_settings,
)
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import FigureRow, Reproduction, Statistics, WalkResults, pooled, row_of, statistics

NAME = WALKING_MODES.name
PAPER_ROWS = rows_of(NAME)
WALKS = 40
MARKED_STEPS, MARKED_REPEATS = 50, 3
"""Number of steps of a walk over marks, and number of its repetitions.

Section 3.3: "50 steps at a time and repeated this three times along each path"."""
BEND_STEPS = 20
"""Number of steps of each walk in which modes are to be recognised, and over marks under each of `CONDITIONS`."""
WALKS_PER_CONDITION = 8
"""Largest number of rectangles under each of `CONDITIONS`, walked after one repetition over the marks."""
METHODS = {"I": TOUCHDOWN_HEIGHT, "II": TOUCHDOWN_ACCELERATION, "III": TOUCHDOWN_PRESSURE, "IV": WALKING_MODES}
VARIANTS = {
    "IV printed": "IV as printed: the modes of table 2, the values of table 1",
    "IV our table 1": "IV as printed, with the values that table 1 has for these wearers: the mean of all of them",
    "IV table 2": "IV with the wearer's own values, and the modes of table 2",
    "IV one value": "IV with the mean of the wearer's own values in all modes, one for each foot",
}
"""Methods between IV as printed and ours, and what they are."""
LAWS = {LoadLaw.OUTWARD: "outward", LoadLaw.HEEL_OUT_FOREFOOT_IN: "heel out, forefoot in"}
RULES = {ModeRule.TURN: "by turn", ModeRule.TABLE_2: "table 2", ModeRule.TABLE_2_AT_SPEED: "table 2 at speed"}
BENDS = {
    f"{name}, {1000.0 * variation:g} mm": Conditions(law=law, variation=variation)
    for law, name in LAWS.items()
    for variation in (0.0, LOAD_VARIATION)
}
"""Load laws with and without variation between steps, in which modes are to be recognised."""
CONDITIONS = {
    "usual": USUAL,
    "hips 2 cm too wide": evolve(USUAL, hips=0.02),
    "no soft tissue": evolve(USUAL, tissue=0.0),
    "twice the soft tissue": evolve(USUAL, tissue=2.0),
    "load outward": evolve(USUAL, law=LoadLaw.OUTWARD, variation=0.0),
    "worn sole": evolve(USUAL, contact=WORN),
    "pivot +2 cm": evolve(USUAL, contact=evolve(WORN, pivot_shift=0.02)),
    "slip 2 cm": evolve(USUAL, contact=SLIPPING),
    "tilt 1 deg": evolve(USUAL, tilt=radians(1.0)),
}
"""Conditions for which the mean distance over the corners is a row of its own, with one walk over marks in all."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` rectangles, walked by the four wearers in turn."""
    count = WALKS if walks is None else walks
    wearers = list(range(min(count, len(SUBJECTS))))
    few = min(count, WALKS_PER_CONDITION)

    def marked_walks(steps: int, repeats: int, conditions: Conditions = USUAL) -> list[MarkedWalks]:
        seeds = [1000 * seed + 500 + 10 * subject for subject in wearers]
        return [MarkedWalks(subject, seeds[subject], steps, repeats, conditions) for subject in wearers]

    full_walks = marked_walks(MARKED_STEPS, MARKED_REPEATS)
    calibrations = runner.run(learn, full_walks, lambda _: "walks over marks of one wearer")
    methods = [_methods(calibration, _mean_table(calibrations)) for calibration in calibrations]
    jobs = [ModesJob(k % len(wearers), 1000 * seed + k, methods[k % len(wearers)]) for k in range(count)]
    results = runner.run(walk, jobs, _describe)
    bends = [
        BendsJob(subject, 1000 * seed + 700 + subject, BEND_STEPS, c) for c in BENDS.values() for subject in wearers
    ]
    shares = runner.run(recognise, bends, lambda _: "modes in bends")
    again = [job for condition in CONDITIONS.values() for job in marked_walks(BEND_STEPS, 1, condition)]
    learnt = iter(runner.run(learn, again, lambda _: "one walk over marks"))
    condition_jobs = []
    for condition in CONDITIONS.values():
        of_wearers = list(islice(learnt, len(wearers)))
        two = [{name: (METHODS[name], calibration) for name in ("III", "IV")} for calibration in of_wearers]
        condition_jobs += [
            ModesJob(k % len(wearers), 1000 * seed + k, two[k % len(wearers)], condition) for k in range(few)
        ]
    found = runner.run(walk, condition_jobs, _describe)

    rows = [
        row_of(PAPER_ROWS, name, pooled(results, name), digits=4)
        for point in CORNER_POSITIONS
        for method in METHODS
        for name in (corner_row(point, method, axis) for axis in "xy")
    ]
    for method in (*METHODS, *VARIANTS):
        rows.append(row_of({}, f"corners, {method}", _lengths(results, method), digits=3))
    rows += _table_1_rows(calibrations)
    for rule, rule_name in RULES.items():
        for n, name in enumerate(BENDS):
            of_bends = pooled(shares[n * len(wearers) : (n + 1) * len(wearers)], rule.name)
            rows.append(row_of({}, f"modes {rule_name} %, {name}", of_bends, digits=1))
    for n, name in enumerate(CONDITIONS):
        for method in ("III", "IV"):
            lengths = _lengths(found[n * few : (n + 1) * few], method)
            rows.append(row_of({}, f"corners, {method}, {name}", lengths, digits=3))
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} rectangles of {ALONG} m by {ACROSS} m by {len(wearers)} wearers at {RATE:g} Hz",
        unit="m",
        rows=tuple(rows),
        panels=panels(results, tuple(METHODS), seed),
        notes=_notes(results, rows),
    )


def _describe(one: WalkResults) -> str:
    lengths = {method: _lengths([one], method) for method in METHODS if corner_row("A", method, "x") in one.values}
    return "mean deviation " + ", ".join(f"{method} {100.0 * off:.1f}" for method, (off,) in lengths.items()) + " cm"


def _lengths(results: Sequence[WalkResults], method: str) -> list[float]:
    """Return the mean length of the deviations at all corners, m, for each walk."""
    off = [np.hypot(*deviations(results, point, method).T) for point in CORNER_POSITIONS]
    lengths: list[float] = np.mean(off, axis=0).tolist()
    return lengths


def _methods(calibration: Calibration, ours: Compensation) -> dict[str, tuple[Recipe, Calibration]]:
    """Return the methods and the variants for a wearer with this calibration; `ours` is the mean of all wearers."""
    own = calibration.modes or {}
    one: Compensation = {foot: {mode: _mean(list(row.values())) for mode in MODES} for foot, row in own.items()}
    recipes = {
        **METHODS,
        "IV printed": WALKING_MODES_PRINTED,
        "IV our table 1": with_settings(WALKING_MODES_PRINTED, compensation=ours, own_compensation=False),
        "IV table 2": with_settings(WALKING_MODES, rule=ModeRule.TABLE_2),
        "IV one value": with_settings(WALKING_MODES, compensation=one, own_compensation=False),
    }
    return {name: (recipe, calibration) for name, recipe in recipes.items()}


def _mean(pairs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    x, y = np.mean(pairs, axis=0).tolist()
    return x, y


def _mean_table(calibrations: Sequence[Calibration]) -> Compensation:
    """Return the mean compensation of these wearers, as table 1 is the mean of the paper's."""
    tables = [calibration.modes or {} for calibration in calibrations]
    return {foot: {mode: _mean([table[foot][mode] for table in tables]) for mode in MODES} for foot in Foot}


def _table_1_rows(calibrations: Sequence[Calibration]) -> list[FigureRow]:
    """Return the compensation of the wearers as table 1 has it: x to the right, y ahead."""
    tables = [calibration.modes or {} for calibration in calibrations]
    return [
        FigureRow(
            f"table 1 {foot.value} {mode.value} {axis}",
            tuple([sign * t[foot][mode][k] for t in tables]),
            Statistics(mean=sign * TABLE_1[foot][mode][k]),
            digits=4,
        )
        for foot in Foot
        for mode in MODES
        for axis, k, sign in (("x", 1, -1.0), ("y", 0, 1.0))
    ]


def _notes(results: Sequence[WalkResults], rows: Sequence[FigureRow]) -> tuple[str, ...]:
    lines = []
    for point in CORNER_POSITIONS:
        off = {method: deviations(results, point, method) for method in (*METHODS, *VARIANTS)}
        of_mean = [f"{method} {100.0 * float(np.hypot(*of.mean(axis=0))):.1f}" for method, of in off.items()]
        mean_of = [f"{method} {100.0 * float(np.hypot(*of.T).mean()):.1f}" for method, of in off.items()]
        names = {method: [corner_row(point, method, axis) for axis in "xy"] for method in METHODS}
        printed = {method: [PAPER_ROWS[name].mean or 0.0 for name in of] for method, of in names.items()}
        paper = [f"{method} {100.0 * float(np.linalg.norm(of)):.1f}" for method, of in printed.items()]
        better = int(np.sum(np.hypot(*off["IV"].T) < np.hypot(*off["III"].T)))
        lines.append(f"{point}: the length of our mean deviation, the paper's statistic, is {', '.join(of_mean)} cm; "
                     f"that of the paper is {', '.join(paper)} cm.")  # fmt: skip
        lines.append(f"{point}: the mean length of our deviations is {', '.join(mean_of)} cm; IV is nearer than III in "
                     f"{better} of {len(results)} walks.")  # fmt: skip
    for row in rows:
        if row.name.startswith(("corners, ", "modes ")):
            scale, unit = (100.0, "cm") if row.name.startswith("corners") else (1.0, "%")
            mean, least = statistics(row.values).mean or 0.0, min(row.values, default=0.0)
            worst = "" if unit == "cm" else f", at worst {least:.0f} %"
            lines.append(f"{row.name.replace(' %', '')}: {scale * mean:.1f} {unit} on average{worst}.")
    lines += [f"{name} is {what}." for name, what in VARIANTS.items()]
    lines.append("All methods are given the direction of the first side relative to the sensors' common north.")
    lines.append("The heading of the paper's table says mm, but its numbers are read as m. It has no quartiles.")
    return tuple(lines)
