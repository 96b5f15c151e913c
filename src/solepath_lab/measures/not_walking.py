"""What a session reports of a wearer who takes no step, as on a bicycle: nothing of it should be walking."""

from __future__ import annotations

from attrs import field, frozen

from solepath.types import Activity
from solepath.walk.walk import Walk

SHARES: dict[str, tuple[Activity, ...]] = {
    "share_unknown": (Activity.UNKNOWN,),
    "share_standing": (Activity.STANDING,),
    "share_walking": (Activity.WALKING,),
    "share_running": (Activity.RUNNING,),
    "share_stairs": (Activity.STAIRS_UP, Activity.STAIRS_DOWN),
    "share_lifts": (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN),
    "share_moving": (
        Activity.WALKING, Activity.RUNNING, Activity.STAIRS_UP, Activity.STAIRS_DOWN, Activity.ELEVATOR_UP,
        Activity.ELEVATOR_DOWN,
    ),
}  # fmt: skip
"""Activities of each figure that is a share of the time."""


@frozen
class NotWalking:
    """The counts of time without a step. Scores of several recordings can be added."""

    duration: float = 0.0
    """Time, s."""
    strides: int = 0
    """Number of strides of both feet."""
    distance: float = 0.0
    """Sum of the lengths of the strides, m."""
    steady: int = 0
    """Number of gait cycles that count as steady."""
    times: dict[Activity, float] = field(factory=lambda: dict.fromkeys(Activity, 0.0))
    """Time of each reported activity, s."""

    @classmethod
    def of(cls, walk: Walk, start: float, end: float) -> NotWalking:
        """Return the counts of the time from `start` to `end`, s, in a walk that keeps all."""
        strides = [one for kept in walk.strides.values() for one in kept if start <= one.t_end <= end]
        times = dict.fromkeys(Activity, 0.0)
        for first, last, activity in walk.timeline.spans(end):
            times[activity] += max(0.0, last - max(first, start))
        times[Activity.UNKNOWN] += end - start - sum(times.values())
        return cls(
            duration=end - start,
            strides=len(strides),
            distance=sum([one.length for one in strides]),
            steady=sum([one.steady and start <= one.t <= end for kept in walk.cycles.values() for one in kept]),
            times=times,
        )

    def __add__(self, other: NotWalking) -> NotWalking:
        times = {activity: self.times[activity] + other.times[activity] for activity in Activity}
        return NotWalking(
            duration=self.duration + other.duration,
            strides=self.strides + other.strides,
            distance=self.distance + other.distance,
            steady=self.steady + other.steady,
            times=times,
        )

    @property
    def figures(self) -> dict[str, float | None]:
        """Figures by name, as in tables and JSON."""
        minutes = self.duration / 60.0
        return {
            "strides_a_minute": self.strides / minutes,
            "metres_a_minute": self.distance / minutes,
            **{name: sum([self.times[one] for one in of]) / self.duration for name, of in SHARES.items()},
            "steady_cycles": self.steady,
        }
