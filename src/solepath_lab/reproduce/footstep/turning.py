"""Turns: the angle by 30 degrees (fig. 13 d), and the class as left, right or about-turn (fig. 13 e)."""

from __future__ import annotations

from math import degrees, fsum, pi, radians, remainder

import numpy as np

from solepath.emulate.routes.route import Route
from solepath.events import TurnMade
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.recipes import Recipe
from solepath.types import Packet, Turn

from ..tables import Values, WalkResults, mean, pooled
from ..walks import final_strides, run_session
from .wearers import PRINTED_TURN, WearerJob

TURN_ANGLES = tuple(radians(angle) for angle in range(-180, 181, 30) if angle)
"""Turn angles of fig. 13 (d), rad, positive to the left."""
CLASS_ANGLES = {Turn.LEFT: (0.5 * pi,), Turn.RIGHT: (-0.5 * pi,), Turn.ABOUT: (pi, -pi)}
"""Turn angles of each class, rad."""
TURNS_PER_CLASS = 5
"""Number of turns of each class for each wearer; the paper has 30 for training and five other wearers for the test."""
TURN_SPREAD = radians(15.0)
"""Standard deviation of the turn angle, rad, because nobody turns by exactly 90 degrees.

The classifier was trained with the same value (lab/train/turns.py)."""
CIRCLE = Route(speed=1.2).stand(2.5).walk(6.0).turn(2.0 * pi, 6.0).walk(6.0).stop(3.0)
"""A circle of 6 m, wider than any corner of the building: a stride turns by some 12 degrees."""
VARIANTS = {"ours": FOOTSTEP_TRACKER, "printed": PRINTED_TURN}


def score_turns(job: WearerJob) -> WalkResults:
    """Return the turns of one wearer.

    They are rows, the errors of TURN_ANGLES in their order among them, and the share of each class that is right, %."""
    rng = np.random.default_rng([job.seed, 18])
    values = Values()
    angles = [(angle, _packets(job, angle, rng, 600 + k)) for k, angle in enumerate(TURN_ANGLES)]
    circle = job.walk(CIRCLE, 800).packets
    for name, recipe in VARIANTS.items():
        values[f"turn angle, {name} deg"] = tuple([_error(_turns(recipe, packets), angle) for angle, packets in angles])
        strides = final_strides(run_session(recipe, circle))
        turned = 0.5 * fsum([one.heading_change for one in strides])
        values[f"circle, {name} deg"] = (abs(degrees(turned - 2.0 * pi)),)
    for turn, angles_of_class in CLASS_ANGLES.items():
        n_right = 0
        for k in range(TURNS_PER_CLASS):
            angle = angles_of_class[k % len(angles_of_class)] + float(rng.normal(0.0, TURN_SPREAD))
            found = _turns(FOOTSTEP_TRACKER, _packets(job, angle, rng, 700 + k))
            n_right += [one.turn for one in found if one.turn is not None] == [turn]
        values[f"turn {turn.value} %"] = (100.0 * n_right / TURNS_PER_CLASS,)
    values["turn classes %"] = (mean(pooled([values], *[f"turn {turn.value} %" for turn in Turn])),)
    return WalkResults(values)


def _packets(job: WearerJob, angle: float, rng: np.random.Generator, more: int) -> tuple[Packet, ...]:
    """Return the packets of a wearer who walks 6 m, turns by `angle` rad and walks 6 m."""
    radius = float(rng.uniform(0.0, 1.2))
    route = Route(speed=float(rng.uniform(0.9, 1.3))).stand(2.5).walk(6.0).turn(angle, radius if radius > 0.4 else 0.0)
    return job.walk(route.walk(6.0).stop(3.0), more).packets


def _turns(recipe: Recipe, packets: tuple[Packet, ...]) -> list[TurnMade]:
    return [event for event in run_session(recipe, packets) if isinstance(event, TurnMade)]


def _error(turns: list[TurnMade], angle: float) -> float:
    """Return the error of the sum of the turns, degrees; a turn by 180 degrees to the left is one to the right."""
    return abs(degrees(remainder(fsum([one.angle for one in turns]) - angle, 2.0 * pi)))
