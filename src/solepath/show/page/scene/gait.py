"""The gait as a page shows it: present activity, pace of the newest strides, and means of steady strides."""

from __future__ import annotations

from typing import Any

from attrs import asdict, define, field

from ....body.gait.means import GaitMeans, GaitParameters
from ....events import GaitCycleMeasured
from ....types import Activity, Foot
from ...tables.gait import MIN_STRIDES, GaitRow, gait_rows, strides_of
from ..messages import rounded

STRIDES = 2
"""Consecutive strides of a foot that the pace is averaged over: a single one errs by some per cent."""
PATIENCE = 1.5
"""Time that the next stride may take, as a multiple of the last one."""
KNOWN = 1.0
"""Time after which a stride is known at the latest, s."""
STILL = (Activity.STANDING, Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN)


@define
class ScenePace:
    """Newest strides of each foot, from which the present pace is computed; times in s."""

    strides: dict[Foot, tuple[GaitCycleMeasured, ...]] = field(factory=dict)

    def take(self, stride: GaitCycleMeasured) -> None:
        """Add one more stride."""
        before = self.strides.get(stride.foot, ())
        follows = bool(before) and before[-1].t == stride.t_start
        self.strides[stride.foot] = (*(before[1 - STRIDES :] if follows else ()), stride)

    def reset(self, foot: Foot) -> None:
        """Discard the strides of a foot, since later ones do not follow them."""
        self.strides.pop(foot, None)

    def frame(self, now: float, activity: Activity, since: float) -> dict[str, Any] | None:
        """Return the member "pace" of a frame at `now`; None while there is no pace.

        The wearer does `activity` from time `since` on."""
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
        return {"cadence": rounded(cadence, 1), "speed": rounded(_mean(known), 2) if known else None}


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def activity_frame(since: float, activity: Activity, silent_since: float | None) -> dict[str, Any]:
    """Return the member "activity" of a frame: the present activity and its start, s.

    `silent_since` is the time of the last sample of any foot, s, while no foot sends any; the activity is then unknown.
    It is None while a foot sends."""
    if silent_since is None:
        return {"now": activity.value, "since": rounded(since), "last": None}
    last = None if activity is Activity.UNKNOWN else activity.value
    return {"now": Activity.UNKNOWN.value, "since": rounded(silent_since), "last": last}


@define
class SceneMeasures:
    """Running means over the newest strides, of walking or of running as the newest stride was.

    They are computed again when a stride came."""

    _newest: tuple[GaitCycleMeasured | None, GaitCycleMeasured | None] = (None, None)
    _frame: dict[str, Any] | None = None

    def frame(self, means: GaitMeans) -> dict[str, Any] | None:
        """Return the member "gait" of a frame; None before any steady stride."""
        newest = (means.left, means.right)
        if newest[0] is not self._newest[0] or newest[1] is not self._newest[1]:
            self._newest = newest
            parameters = means.parameters
            self._frame = None if parameters is None else _gait_frame(parameters)
        return self._frame


def _gait_frame(parameters: GaitParameters) -> dict[str, Any]:
    return {
        "running": parameters.running,
        "cadence": rounded(parameters.cadence, 1),
        "coordination": rounded(parameters.coordination, 4),
        "strides": {foot.value: strides_of(parameters, foot) for foot in Foot},
        "enough": MIN_STRIDES,
        "rows": [_row(row) for row in gait_rows(parameters)],
    }


def _row(row: GaitRow) -> dict[str, Any]:
    frame = asdict(row)
    for name in ("left", "right", "both", "sd", "difference"):
        frame[name] = rounded(frame[name], row.digits)
    for name in ("cv", "asymmetry"):
        frame[name] = rounded(frame[name], 4)
    return frame
