"""Gong et al. 2023: positions at the corners of 40 rectangles of 2.8 m by 4.0 m, by touchdown methods I to IV.

Four wearers walk ten rectangles each, with seven attitude sensors and two insoles of 99 cells at 50 Hz. The wearers are
those of table 3 (emulate/wearers/gait.py). They walk from A over B, C and D back to A, turning left without a halt. For
each corner and foot, one stride counts: that whose foot-flat is nearest to the time when the pelvis passes the corner.
The deviation at a corner is the session's touchdown minus the true footprint of these strides, averaged over both feet.

The floor is surveyed, as in the paper: sessions know the direction of the first side relative to the sensors' common
north. Methods I, II and III of papers/walking_modes detect touchdowns by height, net acceleration and pressure. IV also
uses pressure, and compensates with the errors of the same wearer's walks over marks on the floor (section 3.3). These
are other walks, for which the sensors were attached anew. Then come recognition of the modes under two load laws, and
the corners under other conditions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice, product
from math import radians

import numpy as np
from attrs import evolve

from solepath.calibration import Calibration
from solepath.emulate.wearers.gait import LoadLaw
from solepath.papers.walking_modes.calibrate import MODES
from solepath.papers.walking_modes.compensation import TABLE_1
from solepath.papers.walking_modes.recipe import (
    TOUCHDOWN_ACCELERATION,
    TOUCHDOWN_HEIGHT,
    TOUCHDOWN_PRESSURE,
    WALKING_MODES,
    WALKING_MODES_PRINTED,
)
from solepath.recipes import Recipe
from solepath.types import Foot

from ..emulated.laps import ACROSS, ALONG
from ..emulated.soles import WORN
from ..emulated.wearers import SUBJECTS
from .modes.figures import CORNER_POSITIONS, panels
from .modes.walks import (
    LOAD_VARIATION,
    RATE,
    RULES,
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
)
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import Claim, FigureRow, Reproduction, Statistics, WalkResults, claim, pooled, row_of

NAME = WALKING_MODES.name
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
    "IV one value": "IV with the mean of the wearer's own values in all modes, one for each foot",
}
"""Other methods, and what they are."""
BENDS = {
    f"{name}, {1000.0 * variation:g} mm": Conditions(law=law, variation=variation)
    for (law, name), variation in product(
        ((LoadLaw.OUTWARD, "outward"), (LoadLaw.HEEL_OUT_FOREFOOT_IN, "heel out, forefoot in")), (0.0, LOAD_VARIATION)
    )
}
"""Load laws with and without variation between steps, in which modes are to be recognised."""
CONDITIONS = {
    "usual": USUAL,
    "hips 2 cm too wide": evolve(USUAL, hips=0.02),
    "no soft tissue": evolve(USUAL, tissue=0.0),
    "twice the soft tissue": evolve(USUAL, tissue=2.0),
    "worn sole": evolve(USUAL, contact=WORN),
    "tilt 1 deg": evolve(USUAL, tilt=radians(1.0)),
}
"""Conditions for which the mean distance over the corners is a row of its own, with one walk over marks in all."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` rectangles, walked by the four wearers in turn."""
    count = WALKS if walks is None else walks
    wearers = list(range(min(count, len(SUBJECTS))))

    def marked_walks(steps: int, repeats: int, conditions: Conditions = USUAL) -> list[MarkedWalks]:
        return [MarkedWalks(k, 1000 * seed + 500 + 10 * k, steps, repeats, conditions) for k in wearers]

    def rectangles(
        methods: Sequence[dict[str, tuple[Recipe, Calibration]]], number: int, conditions: Conditions = USUAL
    ) -> list[ModesJob]:
        return [
            ModesJob(k % len(wearers), 1000 * seed + k, methods[k % len(wearers)], conditions) for k in range(number)
        ]

    calibrations = runner.run(learn, marked_walks(MARKED_STEPS, MARKED_REPEATS), lambda _: "walks over marks")
    results = runner.run(walk, rectangles([_methods(one) for one in calibrations], count), _describe)
    bends = [
        BendsJob(subject, 1000 * seed + 700 + subject, BEND_STEPS, c) for c in BENDS.values() for subject in wearers
    ]
    shares = runner.run(recognise, bends, lambda _: "modes in bends")
    again = [job for condition in CONDITIONS.values() for job in marked_walks(BEND_STEPS, 1, condition)]
    learnt = iter(runner.run(learn, again, lambda _: "one walk over marks"))
    few = min(count, WALKS_PER_CONDITION)
    condition_jobs = []
    for condition in CONDITIONS.values():
        two = [{name: (METHODS[name], one) for name in ("III", "IV")} for one in islice(learnt, len(wearers))]
        condition_jobs += rectangles(two, few, condition)
    found = runner.run(walk, condition_jobs, _describe)
    by_condition = {name: found[n * few : (n + 1) * few] for n, name in enumerate(CONDITIONS)}
    by_bend = {name: shares[n * len(wearers) : (n + 1) * len(wearers)] for n, name in enumerate(BENDS)}
    rows = [
        row_of(rows_of(NAME), corner_row(*of), pooled(results, corner_row(*of)), digits=4)
        for of in product(CORNER_POSITIONS, METHODS, "xy")
    ]
    rows += [row_of({}, f"corners, {name}", _lengths(results, name), digits=3) for name in (*METHODS, *VARIANTS)]
    rows += _table_1_rows(calibrations)
    for rule, (name, of_bends) in product(RULES, by_bend.items()):
        rows.append(row_of({}, f"modes {rule} %, {name}", pooled(of_bends, rule), digits=1))
    for (name, of), method in product(by_condition.items(), ("III", "IV")):
        rows.append(row_of({}, f"corners, {method}, {name}", _lengths(of, method), digits=3))
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} rectangles of {ALONG} m by {ACROSS} m by {len(wearers)} wearers at {RATE:g} Hz",
        unit="m",
        rows=tuple(rows),
        panels=panels(results, tuple(METHODS), seed),
        notes=_notes(results),
        claims=_claims(results, by_bend, by_condition),
    )


def _describe(one: WalkResults) -> str:
    methods = [method for method in METHODS if corner_row("A", method, "x") in one.values]
    return "mean deviation " + ", ".join([f"{of} {100.0 * _lengths([one], of)[0]:.1f}" for of in methods]) + " cm"


def _distances(results: Sequence[WalkResults], point: str, method: str) -> list[float]:
    """Return the length of the deviation at a corner, m, for each walk."""
    lengths: list[float] = np.hypot(*deviations(results, point, method).T).tolist()
    return lengths


def _lengths(results: Sequence[WalkResults], method: str) -> list[float]:
    """Return the mean length of the deviations at all corners, m, for each walk."""
    lengths: list[float] = np.mean([_distances(results, point, method) for point in CORNER_POSITIONS], axis=0).tolist()
    return lengths


def _methods(calibration: Calibration) -> dict[str, tuple[Recipe, Calibration]]:
    """Return the methods and the variants for a wearer with this calibration."""
    own = calibration.modes or {}
    means = {foot: np.mean(list(row.values()), axis=0).tolist() for foot, row in own.items()}
    one_value = evolve(calibration, modes={foot: dict.fromkeys(MODES, (x, y)) for foot, (x, y) in means.items()})
    return {
        **{name: (recipe, calibration) for name, recipe in METHODS.items()},
        "IV printed": (WALKING_MODES_PRINTED, calibration),
        "IV one value": (WALKING_MODES, one_value),
    }


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
        for foot, mode, (axis, k, sign) in product(Foot, MODES, (("x", 1, -1.0), ("y", 0, 1.0)))
    ]


def _claims(
    results: Sequence[WalkResults], by_bend: dict[str, list[WalkResults]], by_condition: dict[str, list[WalkResults]]
) -> tuple[Claim, ...]:
    """Return what docs/papers/walking-modes.md claims, with a margin for each walk."""
    lengths = {name: _lengths(results, name) for name in (*METHODS, *VARIANTS)}
    claims = [
        claim(f"at {point} IV is nearer than III", _distances(results, point, "III"), _distances(results, point, "IV"))
        for point in CORNER_POSITIONS
    ]
    claims += [
        claim("over all corners IV is nearer than III", lengths["III"], lengths["IV"]),
        claim("over all corners III is nearer than II", lengths["II"], lengths["III"]),
        claim("over all corners IV as printed is nearer than III", lengths["III"], lengths["IV printed"]),
        claim("a value for each mode is nearer than one for each foot", lengths["IV one value"], lengths["IV"]),
    ]
    for name, of in by_condition.items():
        claims.append(claim(f"{name}: IV is nearer than III", _lengths(of, "III"), _lengths(of, "IV")))
    for name, of in by_bend.items():
        right, printed = (pooled(of, rule) for rule in RULES)
        claims.append(claim(f"{name}: modes by turn are right more often than by table 2", right, printed, "%"))
    return tuple(claims)


def _notes(results: Sequence[WalkResults]) -> tuple[str, ...]:
    lines = []
    for point in CORNER_POSITIONS:
        off = {method: deviations(results, point, method) for method in (*METHODS, *VARIANTS)}
        of_mean = [f"{method} {100.0 * float(np.hypot(*of.mean(axis=0))):.1f}" for method, of in off.items()]
        names = {method: [corner_row(point, method, axis) for axis in "xy"] for method in METHODS}
        printed = {method: [rows_of(NAME)[name].mean or 0.0 for name in of] for method, of in names.items()}
        paper = [f"{method} {100.0 * float(np.linalg.norm(of)):.1f}" for method, of in printed.items()]
        lines.append(f"{point}: the length of our mean deviation, the paper's statistic, is {', '.join(of_mean)} cm; "
                     f"that of the paper is {', '.join(paper)} cm.")  # fmt: skip
    lines += [f"{name} is {what}." for name, what in VARIANTS.items()]
    lines.append("All methods are given the direction of the first side relative to the sensors' common north.")
    lines.append("The heading of the paper's table says mm, but its numbers are read as m. It has no quartiles.")
    return tuple(lines)
