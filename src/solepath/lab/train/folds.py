"""Five folds over the wearers of hugadb: what is scored on a fold was trained on the wearers of the other four.

A wearer is never in two folds, because a gait that was learnt is found again easily. Five of its wearers have all but
46 s of the recordings, so each fold has one of them; the two others (one lift ride down, 30 s of sitting and standing)
go where they weigh least: wearer 12 to wearer 1, who rides no lift, wearer 15 to wearer 3, who has the fewest minutes
next to wearer 10. The folds are fixed, so that figures of two days and of two methods compare.
"""

from __future__ import annotations

FOLDS: tuple[frozenset[int], ...] = tuple(frozenset(wearers) for wearers in ((1, 12), (3, 15), (6,), (8,), (10,)))
"""The wearers (`subject` in dataset.json) of each fold."""


def fold_of(subject: int) -> int:
    """The number of the fold that the wearer is in, from 0. ValueError when in none."""
    for number, wearers in enumerate(FOLDS):
        if subject in wearers:
            return number
    raise ValueError(f"wearer {subject} is in none of the {len(FOLDS)} folds")
