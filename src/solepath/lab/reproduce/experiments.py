"""The experiments that can be walked again, by the name of their recipe."""

from __future__ import annotations

from typing import Protocol

from . import footstep_tracker, kupt_dfpc, pressure_contour, shoe_sensing, walking_modes
from .pool import Progress
from .tables import Reproduction


class Experiment(Protocol):
    """`walks`: how many; None: as many as the paper. The same `seed` walks the same ways with the same sensors."""

    def __call__(
        self, walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
    ) -> Reproduction: ...


EXPERIMENTS: dict[str, Experiment] = {
    kupt_dfpc.NAME: kupt_dfpc.reproduce,
    pressure_contour.NAME: pressure_contour.reproduce,
    walking_modes.NAME: walking_modes.reproduce,
    footstep_tracker.NAME: footstep_tracker.reproduce,
    shoe_sensing.NAME: shoe_sensing.reproduce,
}
