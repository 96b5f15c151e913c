"""Activity parts taught on some wearers' recordings, to be scored on the others'.

A part that learns has a `Learner` here: features of one recording, which take the time and are the same whoever is left
out, and the part that some recordings' features teach.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from attrs import frozen

from .. import recipes
from ..body.footstep_activity import TwoSecondWindows
from ..recipes import AnyActivity
from ..recording import RecordingError
from ..train import footstep_activity
from ..train.folds import FOLDS, fold_of
from .recorded import Meta


@frozen
class Learner:
    """How one kind of part is taught."""

    features: Callable[[Path], Any]
    """Of a recording; runs in another process, so a function of a module. RecordingError when it cannot be read."""
    teach: Callable[[Sequence[Any]], AnyActivity]


def _two_second_windows(taught: Sequence[footstep_activity.Taught]) -> TwoSecondWindows:
    return TwoSecondWindows(footstep_activity.train(taught, "the other folds"))


LEARNERS: dict[type, Learner] = {
    TwoSecondWindows: Learner(footstep_activity.of_recording, _two_second_windows),
}


@frozen
class Lesson:
    """One recording for one kind of part."""

    kind: type
    path: Path
    meta: Meta

    def features(self) -> Any:
        """None when the recording cannot be read: scoring will say why."""
        try:
            return LEARNERS[self.kind].features(self.path)
        except RecordingError:
            return None


Taught = dict[tuple[type, int], AnyActivity]
"""By kind of part and the number of the fold that it was not taught on."""


def kind_of(recipe: str) -> type | None:
    """The kind of the recipe's activity part, where it learns."""
    kind = type(recipes.BY_NAME[recipe].activity)
    return kind if kind in LEARNERS else None


def taught(lessons: Sequence[Lesson], features: Sequence[Any]) -> Taught:
    """A part for each kind and fold of what `features` of the lessons of the other folds teach."""
    found: Taught = {}
    known = [(lesson, what) for lesson, what in zip(lessons, features, strict=True) if what is not None]
    for kind in dict.fromkeys(lesson.kind for lesson in lessons):
        for number in range(len(FOLDS)):
            others = [w for lesson, w in known if lesson.kind is kind and fold_of(lesson.meta["subject"]) != number]
            found[kind, number] = LEARNERS[kind].teach(others)
    return found


def part_for(recipe: str, meta: Meta, parts: Taught) -> AnyActivity | None:
    """The part that was taught without this recording's wearer; None where the recipe's learns nothing."""
    kind = kind_of(recipe)
    return None if kind is None else parts[kind, fold_of(meta["subject"])]
