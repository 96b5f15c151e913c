"""Trains activity parts on some wearers' recordings, to be scored on the other wearers'.

A part that learns has a `Learner` here. It computes the features of one source, which takes the time and does not
depend on the wearers left out, and trains the part on the features of several sources."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from attrs import frozen

from ...body.activity.activities import Activities, ActivitiesSettings
from ...body.part import ActivityPart
from ...papers.footstep_tracker.activity.two_second_windows import TwoSecondSettings, TwoSecondWindows
from ...recipes import Recipe
from ...recording import RecordingError
from ..train import activities, footstep_activity
from ..train.hugadb import FOLDS, fold_of, recordings
from .run import Meta

Sources = Sequence[tuple[Any, int | None]]
"""Sources with the wearer of each. None stands for data of no wearer of hugadb, which serve every fold."""


@frozen
class Learner:
    """Describes how one kind of part is trained."""

    sources: Callable[[Path], Sources]
    """Function that returns the sources in the data directory."""
    features: Callable[[Any], Any]
    """Function of a module that returns a source's features, in another process. It raises RecordingError."""
    train: Callable[[Sequence[Any]], ActivityPart]
    """Function that returns the part trained on the features of several sources."""


WEARERS = frozenset().union(*FOLDS)


def _everyone(folder: Path) -> Sources:
    """Return the wearers, the level walks and the emulated wearers from which `activities` learns."""
    wearers = [(("wearer", folder, wearer), wearer) for wearer in sorted(WEARERS)]
    emulated = [(("emulated", folder, seed), None) for seed in activities.EMULATED]
    return [*wearers, (("level", folder, 0), None), *emulated]


def _blocks(source: tuple[str, Path, int]) -> list[activities.Blocks]:
    """Return the blocks of one of these sources."""
    what, folder, number = source
    if what == "wearer":
        return list(activities.hugadb(folder / "hugadb", WEARERS - {number}))
    return list(activities.level_walks(folder) if what == "level" else activities.emulated_walks([number]))


LEARNERS: dict[type, Learner] = {
    Activities: Learner(
        _everyone,
        _blocks,
        lambda features: Activities(
            ActivitiesSettings(activities.fit_model([one for blocks in features for one in blocks], "the other folds"))
        ),
    ),
    TwoSecondWindows: Learner(
        lambda folder: [(one.path, one.subject) for one in recordings(folder / "hugadb")],
        footstep_activity.of_recording,
        lambda features: TwoSecondWindows(TwoSecondSettings(footstep_activity.train(features, "the other folds"))),
    ),
}


@frozen
class TrainingSource:
    """One source for one kind of part."""

    kind: type
    source: Any
    subject: int | None

    def features(self) -> Any:
        """Return the source's features; None when it cannot be read, which the scoring reports."""
        try:
            return LEARNERS[self.kind].features(self.source)
        except RecordingError:
            return None


def training_sources(folder: Path, recipes: Sequence[Recipe]) -> list[TrainingSource]:
    """Return all sources in the data directory that the recipes' parts learn from."""
    kinds = dict.fromkeys(kind for recipe in recipes if (kind := kind_of(recipe)) is not None)
    return [
        TrainingSource(kind, source, subject) for kind in kinds for source, subject in LEARNERS[kind].sources(folder)
    ]


TrainedParts = dict[tuple[type, int], ActivityPart]
"""Trained parts by kind and by the number of the fold that was left out."""


def kind_of(recipe: Recipe) -> type | None:
    """Return the kind of the recipe's activity part; None when it does not learn."""
    kind = type(next(part for part in recipe.parts if isinstance(part, ActivityPart)))
    return kind if kind in LEARNERS else None


def train_parts(training_sources: Sequence[TrainingSource], features: Sequence[Any]) -> TrainedParts:
    """Return a part for each kind and fold, trained on `features` of the lessons of the other folds."""
    found: TrainedParts = {}
    known = [(source, what) for source, what in zip(training_sources, features, strict=True) if what is not None]
    for kind in dict.fromkeys(source.kind for source in training_sources):
        own = [(source.subject, what) for source, what in known if source.kind is kind]
        for number in range(len(FOLDS)):
            others = [what for subject, what in own if subject is None or fold_of(subject) != number]
            found[kind, number] = LEARNERS[kind].train(others)
    return found


def part_for(recipe: Recipe, meta: Meta, parts: TrainedParts) -> ActivityPart | None:
    """Return the part trained without this recording's wearer; None when the recipe's part does not learn."""
    kind = kind_of(recipe)
    return None if kind is None else parts[kind, fold_of(meta["subject"])]
