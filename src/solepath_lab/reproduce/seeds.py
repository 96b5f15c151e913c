"""An experiment with several seeds: one table and one list of claims of all walks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from attrs import evolve

from .runner import Runner
from .tables import Reproduction

Experiment = Callable[[int | None, int, Runner], Reproduction]
"""Function that returns the results of (number of walks or None, seed, runner)."""


def reproduce_seeds(experiment: Experiment, walks: int | None, seeds: Sequence[int], runner: Runner) -> Reproduction:
    """Return the results of all walks of all seeds; panels are of the first seed."""
    found = []
    for seed in seeds:
        runner.title = f"seed {seed}, " if len(seeds) > 1 else ""
        found.append(experiment(walks, seed, runner))
    return evolve(
        found[0],
        emulation=f"{found[0].emulation}; seed {', '.join(map(str, seeds))}",
        results=tuple([values for one in found for values in one.results]),
    )
