"""Computes the gait that a page shows: present activity, pace of the newest strides, and means of steady strides.

Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from attrs import asdict, define, field

from ....body.gait.means import GaitMeans, GaitParameters
from ....events import GaitCycleMeasured
from ....types import Activity, Foot
from ....types.attrs import NOT_SAVED
from ...tables.gait import MIN_STRIDES, GaitRow, gait_rows, strides_of
from ..messages import members, plain

PACE_STRIDES = 2
"""Number of consecutive strides of a foot over which the pace is averaged: a single stride errs by some per cent."""
MAX_TIME_RATIO = 1.5
"""Longest time of the next stride, as a multiple of the last stride time; a foot that takes longer has no pace."""
MAX_STRIDE_LATENCY = 1.0
"""Longest time from the end of a stride to its event, s."""
FIRST_ROWS = (
    "stride_length",
    "speed",
    "stride_time",
    "stance_time",
    "initial_double_support",
    "terminal_double_support",
)
"""Rows of the means since the start: those that a page shows first."""
STILL_ACTIVITIES = (Activity.STANDING, Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)


@define
class ScenePace:
    """The newest strides of each foot, from which the present pace is computed; times in s."""

    strides: dict[Foot, tuple[GaitCycleMeasured, ...]] = field(factory=dict)

    def add_stride(self, stride: GaitCycleMeasured) -> None:
        """Add the next stride of a foot."""
        earlier = self.strides.get(stride.foot, ())
        follows = bool(earlier) and earlier[-1].t == stride.t_start
        self.strides[stride.foot] = (*(earlier[1 - PACE_STRIDES :] if follows else ()), stride)

    def reset(self, foot: Foot) -> None:
        """Discard the strides of a foot; after a reset, times are not comparable with theirs."""
        self.strides.pop(foot, None)

    def frame(self, now: float, activity: Activity, since: float, spoilt: Sequence[Foot] = ()) -> dict[str, Any] | None:
        """Return the member "pace" of a frame at `now`, s; None while there is no pace.

        `activity` is the wearer's activity, which started at `since`, s. Strides of `spoilt` feet do not count."""
        is_still = activity in STILL_ACTIVITIES
        recent = [
            strides
            for foot, strides in self.strides.items()
            if foot not in spoilt
            and now - strides[-1].t <= MAX_TIME_RATIO * strides[-1].stride_time + MAX_STRIDE_LATENCY
            and not (is_still and strides[-1].t <= since)
        ]
        if not recent:
            return None
        cadence = _mean([_mean([stride.cadence for stride in strides]) for strides in recent])
        speeds = [[stride.speed for stride in strides if stride.speed is not None] for strides in recent]
        means = [_mean(foot_speeds) for foot_speeds in speeds if foot_speeds]
        return {"cadence": plain(cadence, 1), "speed": plain(_mean(means), 2) if means else None}


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def activity_frame(since: float, activity: Activity, silent_since: float | None) -> dict[str, Any]:
    """Return the member "activity" of a frame: the present activity and its start, s.

    `silent_since` is None while a foot sends. While no foot sends, it is the time of the last sample, s, and the
    activity is unknown."""
    if silent_since is None:
        return {"now": activity.value, "since": plain(since), "last": None}
    last = None if activity is Activity.UNKNOWN else activity.value
    return {"now": Activity.UNKNOWN.value, "since": plain(silent_since), "last": last}


@define
class SceneGaitMeans:
    """The means that a page shows: those of running if the newest stride was one of running, else those of walking."""

    _newest: dict[Foot, GaitCycleMeasured | None] = field(factory=dict, metadata=NOT_SAVED)
    """Newest strides in `_frames`."""
    _frames: dict[str, Any] = field(factory=dict, metadata=NOT_SAVED)

    def frames(self, recent: GaitMeans, total: GaitMeans) -> dict[str, Any]:
        """Return the members "gait", of recent means, and "total", of those since the start; None before any stride."""
        if self._newest != recent.newest:
            self._newest = dict(recent.newest)
            near, all_strides = recent.parameters, total.parameters
            self._frames = {
                "gait": None if near is None else _gait_frame(near),
                "total": None if all_strides is None else _total_frame(all_strides),
            }
        return self._frames


def _total_frame(parameters: GaitParameters) -> dict[str, Any]:
    speed = parameters.both.speed
    return {
        "cadence": plain(parameters.cadence, 1),
        "speed": None if speed is None else plain(speed.mean, 2),
        "rows": [_row(row) for row in gait_rows(parameters) if row.name in FIRST_ROWS],
    }


def _gait_frame(parameters: GaitParameters) -> dict[str, Any]:
    return {
        **members(parameters, "running", "cadence", "coordination", cadence=1, coordination=4),
        "strides": {foot.value: strides_of(parameters, foot) for foot in Foot},
        "enough": MIN_STRIDES,
        "rows": [*map(_row, gait_rows(parameters))],
    }


def _row(row: GaitRow) -> dict[str, Any]:
    digits = dict.fromkeys(("left", "right", "both", "sd", "difference"), row.digits)
    return members(row, *asdict(row), **digits, cv=4, asymmetry=4)
