"""Gait parameters of steady strides as a page shows them."""

from __future__ import annotations

from typing import Any

from attrs import asdict, define, field

from ....body.gait.means import GaitMeans, GaitParameters
from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.gait_rows import ENOUGH, GaitRow, gait_rows, strides_of
from .rounding import shown


@define
class SceneMeasures:
    """Running means over the newest strides, of walking or of running as the newest was."""

    means: GaitMeans = field(factory=GaitMeans)
    _told: dict[str, Any] | None = None
    _new: bool = False
    """A stride came since it was told."""

    def take(self, stride: GaitCycleMeasured) -> None:
        """One more stride."""
        self.means.hear(stride)
        self._new = True

    def interrupt(self, foot: Foot) -> None:
        """The foot's times begin anew."""
        self.means.interrupt(foot)

    def frame(self) -> dict[str, Any] | None:
        """As "gait" of a frame; None before any steady stride."""
        if self._new:
            self._new = False
            parameters = self.means.parameters
            self._told = None if parameters is None else _told(parameters)
        return self._told


def _told(parameters: GaitParameters) -> dict[str, Any]:
    return {
        "running": parameters.running,
        "cadence": shown(parameters.cadence, 1),
        "coordination": shown(parameters.coordination, 4),
        "strides": {foot.value: strides_of(parameters, foot) for foot in Foot},
        "enough": ENOUGH,
        "rows": [_row(row) for row in gait_rows(parameters)],
    }


def _row(row: GaitRow) -> dict[str, Any]:
    told = asdict(row)
    for name in ("left", "right", "both", "sd", "difference"):
        told[name] = shown(told[name], row.digits)
    for name in ("cv", "asymmetry"):
        told[name] = shown(told[name], 4)
    return told
