"""Trains activity parts on the recordings of some wearers, so that they can be scored on the other wearers.

Each class of trained parts has a `Learner` here. It computes the features of each source once, which is slow. Then it
trains one part for each fold, on the features of all sources without the wearers of that fold."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from attrs import frozen

from solepath.body.activity.activities import Activities, ActivitiesSettings
from solepath.body.part import ActivityPart
from solepath.papers.footstep_tracker.activity.two_second_windows import TwoSecondSettings, TwoSecondWindows
from solepath.recipes import Recipe
from solepath.recording import RecordingError

from ..train import activities, footstep_activity
from ..train.hugadb import FOLDS, fold_of, recordings
from .run import Meta

Source = Callable[[], Any]
"""Function that returns the features of a source of training data, or raises RecordingError; run in another process."""
Sources = Sequence[tuple[Source, int | None]]
"""Pairs of a source and its wearer in hugadb. Other data have None and are used in every fold."""


@frozen
class Learner:
    """The functions that train one class of parts."""

    sources: Callable[[Path], Sources]
    """Function that returns the sources in the data directory."""
    train: Callable[[Sequence[Any]], ActivityPart]
    """Function that returns the part trained on the features of several sources."""


LEARNERS: dict[type, Learner] = {
    Activities: Learner(
        activities.sources,
        lambda features: Activities(
            ActivitiesSettings(activities.fit_model([one for blocks in features for one in blocks], "the other folds"))
        ),
    ),
    TwoSecondWindows: Learner(
        lambda folder: [
            (partial(footstep_activity.of_recording, one.path), one.subject) for one in recordings(folder / "hugadb")
        ],
        lambda features: TwoSecondWindows(TwoSecondSettings(footstep_activity.train(features, "the other folds"))),
    ),
}


@frozen
class TrainingSource:
    """One source of training data for one class of parts."""

    kind: type
    """Class of the part."""
    source: Source
    subject: int | None
    """Number of the wearer in hugadb; None for other data."""

    def features(self) -> Any:
        """Return the source's features; None when it cannot be read, which its scorer reports."""
        try:
            return self.source()
        except RecordingError:
            return None


def training_sources(folder: Path, recipes: Sequence[Recipe]) -> list[TrainingSource]:
    """Return all sources in the data directory from which the activity parts of the recipes are trained."""
    kinds = dict.fromkeys(kind for recipe in recipes if (kind := kind_of(recipe)) is not None)
    return [
        TrainingSource(kind, source, subject) for kind in kinds for source, subject in LEARNERS[kind].sources(folder)
    ]


TrainedParts = dict[tuple[type, int], ActivityPart]
"""Trained parts by class and by the number of the fold that was left out."""


def kind_of(recipe: Recipe) -> type | None:
    """Return the class of the recipe's activity part; None when that class is not trained."""
    kind = type(next(part for part in recipe.parts if isinstance(part, ActivityPart)))
    return kind if kind in LEARNERS else None


def train_parts(training_sources: Sequence[TrainingSource], features: Sequence[Any]) -> TrainedParts:
    """Return a part for each class and fold, trained on the `features` of the sources without that fold's wearers."""
    parts: TrainedParts = {}
    readable = [
        (source, values) for source, values in zip(training_sources, features, strict=True) if values is not None
    ]
    for kind in dict.fromkeys(source.kind for source in training_sources):
        of_kind = [(source.subject, values) for source, values in readable if source.kind is kind]
        for number in range(len(FOLDS)):
            others = [values for subject, values in of_kind if subject is None or fold_of(subject) != number]
            parts[kind, number] = LEARNERS[kind].train(others)
    return parts


def part_for(recipe: Recipe, meta: Meta, parts: TrainedParts) -> ActivityPart | None:
    """Return the part trained without this recording's wearer; None when the recipe's part is not trained."""
    kind = kind_of(recipe)
    return None if kind is None else parts[kind, fold_of(meta["subject"])]
