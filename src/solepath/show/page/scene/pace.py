"""What the wearer does now; and how fast, by the newest strides, and nothing once they are over."""

from __future__ import annotations

from typing import Any

from attrs import define, field

from ....events import GaitCycleMeasured
from ....types import Activity, Foot
from ..messages import shown

STRIDES = 2
"""Of a foot, which follow on one another: one alone errs by some per cent."""
PATIENCE = 1.5
"""Times as long as the last stride the next one may take."""
KNOWN = 1.0
"""s after which it is known at the latest."""
STILL = (Activity.STANDING, Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)


@define
class ScenePace:
    """The newest strides of each foot. Times in s."""

    strides: dict[Foot, tuple[GaitCycleMeasured, ...]] = field(factory=dict)

    def take(self, stride: GaitCycleMeasured) -> None:
        """One more stride."""
        before = self.strides.get(stride.foot, ())
        follows = bool(before) and before[-1].t == stride.t_start
        self.strides[stride.foot] = (*(before[1 - STRIDES :] if follows else ()), stride)

    def interrupt(self, foot: Foot) -> None:
        """Nothing that comes follows what came."""
        self.strides.pop(foot, None)

    def frame(self, now: float, activity: Activity, since: float) -> dict[str, Any] | None:
        """As "pace" of a frame at `now`, while the wearer does `activity` since then; None while there is no pace."""
        still = activity in STILL
        walked = [
            strides
            for strides in self.strides.values()
            if now - strides[-1].t <= PATIENCE * strides[-1].stride_time + KNOWN
            and not (still and strides[-1].t <= since)
        ]
        if not walked:
            return None
        cadence = _mean([_mean([stride.cadence for stride in strides]) for strides in walked])
        speeds = [[stride.speed for stride in strides if stride.speed is not None] for strides in walked]
        known = [_mean(some) for some in speeds if some]
        return {"cadence": shown(cadence, 1), "speed": shown(_mean(known), 2) if known else None}


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def activity_frame(since: float, activity: Activity, unheard_since: float | None) -> dict[str, Any]:
    """As "activity" of a frame: what the wearer does, and since when, s. `unheard_since`: when a foot was heard last,
    s, while none is; then what the wearer does is not known."""
    if unheard_since is None:
        return {"now": activity.value, "since": shown(since), "last": None}
    last = None if activity is Activity.UNKNOWN else activity.value
    return {"now": Activity.UNKNOWN.value, "since": shown(unheard_since), "last": last}
