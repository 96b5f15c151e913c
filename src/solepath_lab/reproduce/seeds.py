"""An experiment with several seeds: one table of all walks, and the means of each seed below it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from attrs import evolve

from .runner import Runner
from .tables import Reproduction

Experiment = Callable[[int | None, int, Runner], Reproduction]
"""Function that returns the results of (number of walks or None, seed, runner)."""


def reproduce_seeds(experiment: Experiment, walks: int | None, seeds: Sequence[int], runner: Runner) -> Reproduction:
    """Return the results of all walks of all seeds.

    A row has the values of every seed. Panels are of the first seed; notes name their seed if there are several."""
    by_seed = {}
    for seed in seeds:
        runner.title = f"seed {seed}, " if len(seeds) > 1 else ""
        by_seed[seed] = experiment(walks, seed, runner)
    first, *others = by_seed.values()
    if not others:
        return first
    rows = tuple(
        evolve(row, values=tuple([value for one in by_seed.values() for value in one.rows[k].values]))
        for k, row in enumerate(first.rows)
    )
    common = [note for note in first.notes if all(note in one.notes for one in others)]
    notes = [f"Seed {seed}: {note}" for seed, one in by_seed.items() for note in one.notes if note not in common]
    return evolve(
        first,
        emulation=f"{first.emulation}; seeds {', '.join(str(seed) for seed in seeds)}",
        rows=rows,
        notes=(*notes, *common),
        by_seed=tuple((seed, one.table) for seed, one in by_seed.items()),
    )
