"""Gait parameters of steady strides as a page shows them."""

from __future__ import annotations

from typing import Any

from attrs import asdict, define

from ....body.gait.means import GaitMeans, GaitParameters
from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.gait import ENOUGH, GaitRow, gait_rows, strides_of
from ..messages import shown


@define
class SceneMeasures:
    """Running means over the newest strides, of walking or of running as the newest was: written down anew when a
    stride came."""

    _newest: tuple[GaitCycleMeasured | None, GaitCycleMeasured | None] = (None, None)
    _told: dict[str, Any] | None = None

    def frame(self, means: GaitMeans) -> dict[str, Any] | None:
        """As "gait" of a frame; None before any steady stride."""
        newest = (means.left, means.right)
        if newest[0] is not self._newest[0] or newest[1] is not self._newest[1]:
            self._newest = newest
            parameters = means.parameters
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
