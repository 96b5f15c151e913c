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
from itertools import product
from math import radians

import numpy as np
from attrs import evolve

from solepath.calibration import Calibration
from solepath.emulate.wearers.gait import LoadLaw
from solepath.papers.walking_modes.calibrate import MODES
from solepath.papers.walking_modes.recipe import (
    TOUCHDOWN_ACCELERATION,
    TOUCHDOWN_HEIGHT,
    TOUCHDOWN_PRESSURE,
    WALKING_MODES,
    WALKING_MODES_PRINTED,
)
from solepath.recipes import Recipe

from ..emulated.laps import ACROSS, ALONG
from ..emulated.soles import WORN
from ..emulated.wearers import SUBJECTS
from .modes.figures import panels
from .modes.walks import (
    LOAD_VARIATION,
    RATE,
    USUAL,
    BendsJob,
    Conditions,
    MarkedWalks,
    ModesJob,
    corners_row,
    learn,
    recognise,
    walk,
)
from .runner import Runner
from .tables import Reproduction, WalkResults, gathered

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
BENDS = {
    f"{name}, {1000.0 * variation:g} mm: ": Conditions(law=law, variation=variation)
    for (law, name), variation in product(
        ((LoadLaw.OUTWARD, "outward"), (LoadLaw.HEEL_OUT_FOREFOOT_IN, "heel out, forefoot in")), (0.0, LOAD_VARIATION)
    )
}
"""Load laws with and without variation between steps, in which modes are to be recognised."""
CONDITIONS = {
    "usual: ": USUAL,
    "hips 2 cm too wide: ": evolve(USUAL, hips=0.02),
    "no soft tissue: ": evolve(USUAL, tissue=0.0),
    "twice the soft tissue: ": evolve(USUAL, tissue=2.0),
    "worn sole: ": evolve(USUAL, contact=WORN),
    "tilt 1 deg: ": evolve(USUAL, tilt=radians(1.0)),
}
"""Conditions for which the mean distance over the corners is a row of its own, with one walk over marks in all."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` rectangles, walked by the four wearers in turn."""
    count = WALKS if walks is None else walks
    few = min(count, WALKS_PER_CONDITION)
    wearers = list(range(min(count, len(SUBJECTS))))

    def marked_walks(steps: int, repeats: int, conditions: Conditions) -> list[MarkedWalks]:
        return [MarkedWalks(k, 1000 * seed + 500 + 10 * k, steps, repeats, conditions) for k in wearers]

    def rectangles(
        methods: Sequence[dict[str, tuple[Recipe, Calibration]]], number: int, conditions: Conditions
    ) -> list[ModesJob]:
        return [
            ModesJob(k % len(wearers), 1000 * seed + k, methods[k % len(wearers)], conditions) for k in range(number)
        ]

    marked = {"": marked_walks(MARKED_STEPS, MARKED_REPEATS, USUAL)}
    marked |= {title: marked_walks(BEND_STEPS, 1, conditions) for title, conditions in CONDITIONS.items()}
    learnt = runner.run_blocks(learn, marked, lambda _: "walks over marks")
    laps = {"": rectangles([_methods(one.calibration) for one in learnt[""]], count, USUAL)}
    for title, conditions in CONDITIONS.items():
        two = [{name: (METHODS[name], one.calibration) for name in ("III", "IV")} for one in learnt[title]]
        laps[title] = rectangles(two, few, conditions)
    found = runner.run_blocks(walk, laps, _describe)
    bends = {
        title: [BendsJob(k, 1000 * seed + 700 + k, BEND_STEPS, conditions) for k in wearers]
        for title, conditions in BENDS.items()
    }
    shares = runner.run_blocks(recognise, bends, lambda _: "modes in bends")
    table_1 = [one.results for one in learnt[""]]
    return Reproduction(
        name=NAME,
        emulation=f"{count} rectangles of {ALONG} m by {ACROSS} m by {len(wearers)} wearers at {RATE:g} Hz",
        unit="m",
        results=gathered({**found, "table 1 ": table_1, **shares}),
        panels=panels([one.values for one in found[""]], tuple(METHODS), seed),
    )


def _describe(one: WalkResults) -> str:
    errors = {method: one.values.get(corners_row(method)) for method in METHODS}
    return (
        "mean deviation " + ", ".join([f"{of} {100.0 * error[0]:.1f}" for of, error in errors.items() if error]) + " cm"
    )


def _methods(calibration: Calibration) -> dict[str, tuple[Recipe, Calibration]]:
    """Return the methods for a wearer with this calibration, and two variants of IV.

    One is as printed, with the modes of table 2 and the values of table 1. One has the mean of the wearer's own values
    in all modes, one for each foot."""
    own = calibration.modes or {}
    means = {foot: np.mean(list(row.values()), axis=0).tolist() for foot, row in own.items()}
    one_value = evolve(calibration, modes={foot: dict.fromkeys(MODES, (x, y)) for foot, (x, y) in means.items()})
    return {
        **{name: (recipe, calibration) for name, recipe in METHODS.items()},
        "IV printed": (WALKING_MODES_PRINTED, calibration),
        "IV one value": (WALKING_MODES, one_value),
    }
