"""Counts of reported activities by true activity, and of elevator rides that were found."""

from __future__ import annotations

from collections import Counter
from operator import add

from attrs import astuple, field, frozen

from solepath.types import Activity

CLASSES = tuple(activity for activity in Activity if activity is not Activity.UNKNOWN)
"""Activities that a label can have."""
DELAYS = {"right_at_once": 0.0, "right_by_500ms": 0.5, "right_by_1s": 1.0, "right_by_2s": 2.0, "right_by_3s": 3.0}
"""Names of the shares of time for which the right activity was reported so many seconds later, s."""
CHECKS = ("right_inside", *DELAYS)
"""Names of all shares: `right_inside` leaves out what is near to a change of the label."""


@frozen
class ActivityScore:
    """The counts of labelled samples and of elevator rides. Scores of several recordings can be added."""

    samples: Counter[tuple[Activity, Activity]] = field(factory=Counter)
    """Number of samples by (true activity, reported activity)."""
    rides_true: int = 0
    """Number of true rides."""
    rides_found: int = 0
    """Number of true rides that were found with the right direction."""
    rides_invented: int = 0
    """Number of reported rides that match no true one."""
    checks: Counter[tuple[str, bool]] = field(factory=Counter)
    """Number of samples by the name of a figure of `CHECKS` and by whether the right activity was reported."""

    def __add__(self, other: ActivityScore) -> ActivityScore:
        return ActivityScore(*map(add, astuple(self, recurse=False), astuple(other, recurse=False)))

    def reported_for(self, true: Activity) -> Counter[Activity]:
        """Return the number of samples by reported activity, for the samples of one true activity."""
        return Counter({reported: count for (was, reported), count in self.samples.items() if was is true})

    def f1(self, activity: Activity) -> float | None:
        """Return 2 x right / (true + reported); None when the activity is neither true nor reported."""
        count = sum([count * of.count(activity) for of, count in self.samples.items()])
        return 2.0 * self.samples[activity, activity] / count if count else None

    @property
    def accuracy(self) -> float | None:
        """Share of labelled samples for which the right activity was reported."""
        right = sum([count for (was, reported), count in self.samples.items() if was is reported])
        return right / self.samples.total() if self.samples else None

    @property
    def most_frequent(self) -> float | None:
        """Accuracy of a method that always reports the most frequent activity."""
        counts = [sum(self.reported_for(activity).values()) for activity in Activity]
        return max(counts) / self.samples.total() if self.samples else None

    def share_right(self, check: str) -> float | None:
        """Return the share of samples of a figure of `CHECKS` with the right activity; None without any."""
        right, wrong = self.checks[check, True], self.checks[check, False]
        return right / (right + wrong) if right + wrong else None

    @property
    def figures(self) -> dict[str, float | None]:
        """Figures by name, as in tables and JSON."""
        return {
            "accuracy": self.accuracy,
            "most_frequent": self.most_frequent,
            **{f"f1_{activity.value.lower()}": self.f1(activity) for activity in CLASSES},
            **{check: self.share_right(check) for check in CHECKS},
            "rides_true": self.rides_true,
            "rides_found": self.rides_found,
            "rides_invented": self.rides_invented,
        }

    @property
    def table(self) -> dict[str, dict[str, int]]:
        """Confusion matrix {true: {reported: samples}} by name, in the order of Activity.

        Activities that never occur are left out."""
        reported = [activity for activity in Activity if any(answer is activity for _, answer in self.samples)]
        return {
            was.value: {answer.value: self.samples[was, answer] for answer in reported}
            for was in CLASSES
            if self.reported_for(was)
        }
