"""Mutated samples: numbers of any size and kind, vectors of wrong lengths, other times and sites, absent sensors."""

from __future__ import annotations

from functools import cache
from random import Random
from typing import Any

import numpy as np
import walks
from attrs import evolve
from changes import NUMBERS
from checks import Checked

from solepath import Sample, Session, Site, recipes

SAMPLES = 500
"""Number of samples of a round."""
MUTATED_SHARE = 0.4
"""Share of the samples that are mutated; the others keep a walk going."""
NAMES = ("acc", "gyro", "acc", "gyro", "pressure", "quat", "mag", "air_pressure", "t", "known_at", "site")
"""Fields that are mutated; motion more often than others."""
NO_NUMBERS: tuple[Any, ...] = ("1", b"1", (), [1.0], {}, 1j, object())
"""Values that are no numbers."""


@cache
def sources() -> tuple[tuple[Sample, ...], ...]:
    """Return the samples of emulated walks, with and without cells, and of seven sites."""
    return walks.samples(cells=0), walks.samples(), walks.samples(rate=25.0), walks.suited()


def run(seed: int) -> tuple[int, int]:
    """Feed a session mutated samples; return their number and the number of events."""
    random = Random(seed)
    source = random.choice(sources())
    recipe = recipes.by_name(random.choice(("default", "default", *recipes.NAMES)))
    session = Session(recipe, poses=random.random() < 0.5, pressures=random.random() < 0.2)
    checked, mutated = Checked(session, recipe, random), 0
    start = random.randrange(len(source))
    for number in range(start, start + SAMPLES):
        sample = source[number % len(source)]
        t = sample.t + (source[-1].t + 1.0) * (number // len(source))
        sample = evolve(sample, t=t, known_at=t)
        if random.random() < MUTATED_SHARE:
            sample = _mutated(sample, random)
            mutated += 1
        checked.feed(sample, may_raise=True)
    checked.finish()
    return mutated, checked.events


def _mutated(sample: Sample, random: Random) -> Sample:
    name = random.choice(NAMES)
    if name == "site":
        return evolve(sample, site=random.choice(list(Site)))
    if name in ("t", "known_at"):
        value: Any = random.choice((*NUMBERS, sample.t - 0.005, sample.t + 60.0, np.float64(sample.t), sample.t * 1e3))
    elif name == "air_pressure":
        value = _number(101_325.0, random)
    else:
        size = {"quat": 4, "pressure": random.choice((0, 1, 24, 24, 24, 99, 1000))}.get(name, 3)
        kept = getattr(sample, name) or tuple([random.gauss(0.0, 5.0) for _ in range(size)])
        value = _vector(kept, random)
    return evolve(sample, **{name: value})


def _vector(values: tuple[float, ...], random: Random) -> Any:
    kind = random.randrange(8)
    if kind == 0:
        return random.choice((None, values[:-1], (*values, 0.0), np.array(values), list(values), *NO_NUMBERS))
    if kind == 1:
        factor = random.choice((1.0 / 9.81, 57.3, 1e3, 0.0, -1.0, 1e-6))
        return tuple([factor * value for value in values])
    if kind == 2:
        return tuple(map(np.float32, values))
    at = random.randrange(len(values)) if values else 0
    return (*values[:at], _number(values[at] if values else 0.0, random), *values[at + 1 :])


def _number(value: float, random: Random) -> Any:
    return random.choice((*NUMBERS, value * 10.0, np.float64(value), None, *NO_NUMBERS[:3]))
