"""Activity parts taught on some wearers' recordings, to be scored on the others'.

A part that learns has a `Learner` here: the features of one source of what it learns from, which take the time and are
the same whoever is left out, and the part that some sources' features teach.
"""

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
"""Each with who wore it; None for what is no wearer's of hugadb, which may teach whoever is scored."""


@frozen
class Learner:
    """How one kind of part is taught."""

    sources: Callable[[Path], Sources]
    """What there is to learn from in the data directory."""
    features: Callable[[Any], Any]
    """Of a source; runs in another process, so a function of a module. RecordingError when it cannot be read."""
    teach: Callable[[Sequence[Any]], ActivityPart]


WEARERS = frozenset().union(*FOLDS)


def _everyone(folder: Path) -> Sources:
    """The wearers, the level walks and the emulated wearers that `activities` learns from."""
    wearers = [(("wearer", folder, wearer), wearer) for wearer in sorted(WEARERS)]
    emulated = [(("emulated", folder, seed), None) for seed in activities.EMULATED]
    return [*wearers, (("level", folder, 0), None), *emulated]


def _blocks(source: tuple[str, Path, int]) -> list[activities.Blocks]:
    """Of one of those."""
    what, folder, number = source
    if what == "wearer":
        return list(activities.hugadb(folder / "hugadb", WEARERS - {number}))
    return list(activities.level_walks(folder) if what == "level" else activities.emulated_walks([number]))


LEARNERS: dict[type, Learner] = {
    Activities: Learner(
        _everyone,
        _blocks,
        lambda taught: Activities(
            ActivitiesSettings(activities.learnt([one for blocks in taught for one in blocks], "the other folds"))
        ),
    ),
    TwoSecondWindows: Learner(
        lambda folder: [(one.path, one.subject) for one in recordings(folder / "hugadb")],
        footstep_activity.of_recording,
        lambda taught: TwoSecondWindows(TwoSecondSettings(footstep_activity.train(taught, "the other folds"))),
    ),
}


@frozen
class Lesson:
    """One source for one kind of part."""

    kind: type
    source: Any
    subject: int | None

    def features(self) -> Any:
        """None when it cannot be read: scoring will say why."""
        try:
            return LEARNERS[self.kind].features(self.source)
        except RecordingError:
            return None


def lessons(folder: Path, recipes: Sequence[Recipe]) -> list[Lesson]:
    """All that the recipes' parts have to learn from in the data directory."""
    kinds = dict.fromkeys(kind for recipe in recipes if (kind := kind_of(recipe)) is not None)
    return [Lesson(kind, source, subject) for kind in kinds for source, subject in LEARNERS[kind].sources(folder)]


Taught = dict[tuple[type, int], ActivityPart]
"""By kind of part and the number of the fold that it was not taught on."""


def kind_of(recipe: Recipe) -> type | None:
    """The kind of the recipe's activity part, where it learns."""
    kind = type(next(part for part in recipe.parts if isinstance(part, ActivityPart)))
    return kind if kind in LEARNERS else None


def taught(lessons: Sequence[Lesson], features: Sequence[Any]) -> Taught:
    """A part for each kind and fold of what `features` of the lessons of the other folds teach."""
    found: Taught = {}
    known = [(lesson, what) for lesson, what in zip(lessons, features, strict=True) if what is not None]
    for kind in dict.fromkeys(lesson.kind for lesson in lessons):
        own = [(lesson.subject, what) for lesson, what in known if lesson.kind is kind]
        for number in range(len(FOLDS)):
            others = [what for subject, what in own if subject is None or fold_of(subject) != number]
            found[kind, number] = LEARNERS[kind].teach(others)
    return found


def part_for(recipe: Recipe, meta: Meta, parts: Taught) -> ActivityPart | None:
    """The part that was taught without this recording's wearer; None where the recipe's learns nothing."""
    kind = kind_of(recipe)
    return None if kind is None else parts[kind, fold_of(meta["subject"])]
