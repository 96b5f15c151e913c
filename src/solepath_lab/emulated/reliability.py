"""Weights of candidates against how often such a candidate is the true one, in the emulated building.

    solepath-lab emulated reliability [--walks N] [--seed S]

prints a table as Markdown. Every candidate of every scored stride (place.py) of walks without a
known start is counted in the bin of its weight. Candidates near a heavier one on its level are one place with it, and
their weights are added. Weights are calibrated when the share of true places in a bin
is their mean weight. Strides of one walk are far from independent: the number of walks says how much a bin shows."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from attrs import define, field

from solepath import recipes
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.events import Candidate, Placed
from solepath.floorplan.index import IndexedPlan
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot
from solepath.validate.place import is_near, is_on_floor

from ..tables import markdown

BINS = 10
"""Number of bins of equal width; a place that is the only one has a bin of its own after them."""
DEVICES: dict[str, Device] = {"default": Insole(cells=8), "footstep-tracker": CC2541(rate=20.0, mounting=IN_SOLE)}
"""Device on both feet by the name of the recipe."""
TITLES = {"default": "`default`, insoles", "footstep-tracker": "`footstep-tracker`, CC2541"}


@define
class WeightBin:
    """The places whose weights lie in one bin."""

    count: int = 0
    """Number of places."""
    true: int = 0
    """Number of those that were the true one."""
    weight_sum: float = 0.0
    seeds: set[int] = field(factory=set)
    """Seeds of the walks that have one of them."""

    @property
    def text(self) -> str:
        """Mean weight, share that was true, and numbers of places and walks; empty without places."""
        if not self.count:
            return ""
        return f"{self.weight_sum / self.count:.3f}: {self.true / self.count:.3f} ({self.count} in {len(self.seeds)})"


def join(candidates: Sequence[Candidate]) -> list[list[Candidate]]:
    """Return the candidates in groups, each of those near its heaviest one on the same level."""
    groups: list[list[Candidate]] = []
    for candidate in candidates:  # the heaviest first
        x, y, _ = candidate.position
        group = next((group for group in groups if is_near(group[0], candidate.level, x, y)), None)
        if group is None:
            groups.append([candidate])
        else:
            group.append(candidate)
    return groups


def scored_places(recipe: str, seed: int) -> Iterator[tuple[float, bool, bool]]:
    """Yield the weight of each scored place, whether it is the only one, and whether it is the true one."""
    way = wandering(seed)
    walk = emulate(way.route, devices={SITE_OF_FOOT[foot]: DEVICES[recipe] for foot in Foot}, seed=seed)
    session = Session(recipes.by_name(recipe), floorplan=IndexedPlan(BUILDING))
    placed = [event for event in session.feed(walk.packets) + session.finish() if isinstance(event, Placed)]
    places = way.places(walk.walker, np.array([one.t for one in placed])) if placed else []
    for one, place in zip(placed, places, strict=True):
        if is_on_floor(walk.truth, one.t):
            groups = join(one.candidates)
            for group in groups:
                weight = sum([candidate.weight for candidate in group])
                yield weight, len(groups) == 1, any([is_near(candidate, *place) for candidate in group])


def count(walks: Iterable[tuple[int, Iterable[tuple[float, bool, bool]]]]) -> list[WeightBin]:
    """Return the bins of the scored places of all walks by their seeds, with that of only places at the end."""
    bins = [WeightBin() for _ in range(BINS + 1)]
    for seed, places in walks:
        for weight, is_only, is_true in places:
            one = bins[BINS if is_only else min(int(weight * BINS), BINS - 1)]
            one.count, one.true, one.weight_sum = one.count + 1, one.true + is_true, one.weight_sum + weight
            one.seeds.add(seed)
    return bins


def table(results: dict[str, list[WeightBin]]) -> list[str]:
    """Return the table as Markdown: for each recipe mean weight, share true, and numbers of places and walks."""
    rows = []
    for k, bins in enumerate(zip(*results.values(), strict=True)):
        name = "the only one" if k == BINS else f"{k / BINS:.1f} to {(k + 1) / BINS:.1f}"
        rows.append([name, *(one.text for one in bins)])
    return markdown.table(["weight", *(TITLES[recipe] for recipe in results)], rows)


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    seeds = range(options.seed, options.seed + options.walks)
    results = {recipe: count([(seed, scored_places(recipe, seed)) for seed in seeds]) for recipe in DEVICES}
    print("\n".join(table(results)))
    return 0
