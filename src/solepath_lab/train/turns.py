"""The classifier of turns (body/gait/turns.py): `solepath-lab train turns` prints its weights.

As in Liu et al. 2015 (IEEE MASS), section V.E, wearers turn 30 times to the left, to the right and about, and a linear
SVM learns to classify the turns by the angles of both feet. The turns are emulated. A wearer of random stature with a
20 Hz SensorTag in each sole walks 4 m, turns on the spot or along an arc with a radius up to 1.2 m, and walks on. Each
line of turns.csv beside this file is a turn: seed, class, and the angles of the left and right foot, degrees, positive
to the left, as the recipe footstep-tracker measured them. `--emulate` writes turns.csv again. Nothing is scored on its
seeds."""

from __future__ import annotations

import csv
from argparse import Namespace
from collections.abc import Iterable, Iterator
from math import degrees, radians
from pathlib import Path

import numpy as np

from solepath.body.gait.turns import TurnDetector, TurnProcess, features
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.events import StrideTaken
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Turn

from ..descriptions import read_rows
from ..emulated.wearers import random_wearer

TURNS_FILE = Path(__file__).with_name("turns.csv")
FIRST_TRAINING_SEED = 101
TURNS_PER_CLASS = 30
"""Number of turns of each class (section V.E)."""
WEARERS = 3
ANGLES = {Turn.LEFT: 90.0, Turn.RIGHT: -90.0, Turn.ABOUT: 180.0}
"""Mean turn angle of each class, degrees, positive to the left."""
TURN_SPREAD = 15.0
"""Standard deviation of the turn angle, degrees, because nobody turns by exactly 90 degrees."""
ITERATIONS = 20_000
REGULARISATION = 1e-3
"""Weight of the squared length of the weights against the mean hinge loss (lambda of Pegasos); chosen by hand."""


Example = tuple[Turn, float, float]
"""One turn: its class, and the angles of the left and the right foot, rad, positive to the left."""


def walk(seed: int, turn: Turn) -> EmulatedWalk:
    """Return a walk with one turn. The same seed and class always give the same walk."""
    rng = np.random.default_rng([seed, 7, list(Turn).index(turn)])
    angle = radians(float(rng.normal(ANGLES[turn], TURN_SPREAD)))
    if turn is Turn.ABOUT and rng.uniform() < 0.5:
        angle = -angle
    radius = 0.0 if rng.uniform() < 0.3 else float(rng.uniform(0.3, 1.2))
    route = Route().stand(2.5).walk(4.0, float(rng.uniform(0.9, 1.4))).turn(angle, radius).walk(4.0).stop(2.0)
    devices = {site: CC2541(rate=20.0, mounting=IN_SOLE) for site in SITE_OF_FOOT.values()}
    # the seeds of each hundred use WEARERS wearers in rotation
    who, _ = random_wearer(np.random.default_rng([seed // 100, seed % WEARERS, 11]))
    return emulate(route, wearer=who, devices=devices, seed=seed)


def largest_turn(walked: EmulatedWalk) -> TurnProcess | None:
    """Return the largest turn that the recipe finds in a walk."""
    session, detector = Session(FOOTSTEP_TRACKER), TurnDetector()
    strides = [event for packet in walked.packets for event in session.feed(packet) if isinstance(event, StrideTaken)]
    found = [detector.add_stride(stride) for stride in strides]
    if strides:
        found.append(detector.advance(strides[-1].t_end + 1e3))
    turns = [one for one in found if one is not None]
    return max(turns, key=lambda one: abs(one.angle), default=None)


def emulated_rows(seeds: Iterable[int]) -> Iterator[tuple[int, str, float, float]]:
    """Yield the rows of turns.csv: a turn of each class for every seed, if the recipe finds a turn of both feet."""
    for seed in seeds:
        for turn in ANGLES:
            found = largest_turn(walk(seed, turn))
            if found is not None and found.left is not None and found.right is not None:
                yield seed, turn.name, round(degrees(found.left), 1), round(degrees(found.right), 1)


def train_weights(examples: list[Example]) -> dict[Turn, tuple[float, ...]]:
    """Return the weights w of one linear function for each class against the others.

    They minimise REGULARISATION |w|^2 / 2 + mean hinge loss by subgradient descent over all examples at once
    (Shalev-Shwartz et al. 2011, Pegasos). The result is the mean of the second half of the iterations."""
    # a turn to the other side with the feet exchanged is an example too, because left and right are equivalent
    other = {Turn.LEFT: Turn.RIGHT, Turn.RIGHT: Turn.LEFT, Turn.ABOUT: Turn.ABOUT}
    examples = [*examples, *[(other[turn], -right, -left) for turn, left, right in examples]]
    x = np.array([features(left, right) for _, left, right in examples])
    weights: dict[Turn, tuple[float, ...]] = {}
    for turn in ANGLES:
        y = np.array([1.0 if one is turn else -1.0 for one, _, _ in examples])
        share = np.where(y > 0.0, 0.5 / np.sum(y > 0.0), 0.5 / np.sum(y < 0.0))
        w, mean = np.zeros(x.shape[1]), np.zeros(x.shape[1])
        for k in range(1, ITERATIONS + 1):
            wrong = y * (x @ w) < 1.0
            w = w - (REGULARISATION * w - (share * y * wrong) @ x) / (REGULARISATION * (k + 100.0))
            if 2 * k > ITERATIONS:
                mean += w / (ITERATIONS - ITERATIONS // 2)
        weights[turn] = tuple(round(float(value), 2) for value in mean)
    return weights


def read() -> list[Example]:
    """Return the turns of turns.csv."""
    rows = read_rows(__file__, TURNS_FILE.name)
    return [(Turn[row["class"]], radians(float(row["left"])), radians(float(row["right"]))) for row in rows]


def run(options: Namespace) -> int:
    """Train the turn model and print its weights; return the exit status."""
    if options.emulate:
        with TURNS_FILE.open("w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["seed", "class", "left", "right"])
            rows.writerows(emulated_rows(range(FIRST_TRAINING_SEED, FIRST_TRAINING_SEED + TURNS_PER_CLASS)))
    for turn, weights in train_weights(read()).items():
        print(f"    Turn.{turn.name}: {weights},")
    return 0
