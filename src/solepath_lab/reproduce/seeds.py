"""An experiment with several seeds: one table and one list of claims of all walks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from attrs import evolve

from .runner import Runner
from .tables import Claim, FigureRow, Reproduction

Experiment = Callable[[int | None, int, Runner], Reproduction]
"""Function that returns the results of (number of walks or None, seed, runner)."""


Pooled = TypeVar("Pooled", FigureRow, Claim)


def reproduce_seeds(experiment: Experiment, walks: int | None, seeds: Sequence[int], runner: Runner) -> Reproduction:
    """Return the results of all walks of all seeds.

    Rows and claims have the values of every seed. Panels are of the first seed; notes name their seed if there are
    several."""
    found = []
    for seed in seeds:
        runner.title = f"seed {seed}, " if len(seeds) > 1 else ""
        found.append(experiment(walks, seed, runner))
    first = found[0]
    common = [note for note in first.notes if all(note in one.notes for one in found)]
    notes = [
        f"Seed {seed}: {note}"
        for seed, one in zip(seeds, found, strict=True)
        for note in one.notes
        if note not in common
    ]
    return evolve(
        first,
        emulation=f"{first.emulation}; seed {', '.join(str(seed) for seed in seeds)}",
        rows=_pooled([one.rows for one in found], "values"),
        claims=_pooled([one.claims for one in found], "margins"),
        notes=(*notes, *common),
    )


def _pooled(of_seeds: Sequence[tuple[Pooled, ...]], name: str) -> tuple[Pooled, ...]:
    """Return the records of the first seed, each with the values that its field `name` has with every seed."""
    return tuple(
        [
            evolve(same[0], **{name: tuple([value for one in same for value in getattr(one, name)])})
            for same in zip(*of_seeds, strict=True)
        ]
    )
