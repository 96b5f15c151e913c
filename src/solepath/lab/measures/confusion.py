"""What was told of labelled time, by what was true; and lift rides found."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from attrs import field, frozen

from ...types import Activity

CLASSES = tuple(activity for activity in Activity if activity is not Activity.UNKNOWN)


@frozen
class ActivityScore:
    """Counts of labelled samples and of rides; scores of several recordings add up."""

    samples: Mapping[tuple[Activity, Activity], int] = field(factory=dict)
    """(what was true, what was told): how many."""
    rides_true: int = 0
    rides_found: int = 0
    """Of the true ones, with the right direction."""
    rides_invented: int = 0

    def __add__(self, other: ActivityScore) -> ActivityScore:
        return ActivityScore(
            Counter(self.samples) + Counter(other.samples),
            self.rides_true + other.rides_true,
            self.rides_found + other.rides_found,
            self.rides_invented + other.rides_invented,
        )

    def told_of(self, true: Activity) -> dict[Activity, int]:
        """What was told of the samples of one activity."""
        return {told: count for (was, told), count in self.samples.items() if was is true}

    def f1(self, activity: Activity) -> float | None:
        """2 x right / (true + told); None where it neither was nor was told."""
        right = self.samples.get((activity, activity), 0)
        true = sum(self.told_of(activity).values())
        told = sum([count for (_, said), count in self.samples.items() if said is activity])
        return 2.0 * right / (true + told) if true + told else None

    @property
    def accuracy(self) -> float | None:
        """Share of labelled samples of which the right activity was told."""
        every = sum(self.samples.values())
        return sum([count for (was, told), count in self.samples.items() if was is told]) / every if every else None

    @property
    def most_frequent(self) -> float | None:
        """What always telling the most frequent activity would come to."""
        every = sum(self.samples.values())
        return max([sum(self.told_of(activity).values()) for activity in Activity]) / every if every else None

    @property
    def figures(self) -> dict[str, float | None]:
        """By name, as in tables and JSON."""
        return {
            "accuracy": self.accuracy,
            "most_frequent": self.most_frequent,
            **{f"f1_{activity.value.lower()}": self.f1(activity) for activity in CLASSES},
            "rides_true": self.rides_true,
            "rides_found": self.rides_found,
            "rides_invented": self.rides_invented,
        }

    @property
    def table(self) -> dict[str, dict[str, int]]:
        """{true: {told: samples}} by name, in the order of the enum, those that never were left out."""
        told = [activity for activity in Activity if any(said is activity for _, said in self.samples)]
        return {
            was.value: {said.value: self.samples.get((was, said), 0) for said in told}
            for was in CLASSES
            if self.told_of(was)
        }
