"""Stance evidence: what a detector says of a foot, and what it is asked.

A stance detector never answers yes or no: for every sample it says which velocity the sensor ought to have now and how
far to trust that (`Stance`). Detectors share one signature, so they and the correctors that use them are
interchangeable.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple, Protocol, Self

from ...calibration import Calibration
from ...types import Foot, Layout, Phase, Quat, Vec3
from ...types.attrs import frozen
from ...types.vector import IDENTITY, ZERO
from ..settings import StanceThreshold


@frozen
class Load:
    """What the pressure cells say at one instant; loads are fractions of the wearer's own full load."""

    total: float
    heel: float | None
    forefoot: float | None
    highest: float
    """The most loaded single cell, as a fraction of the most loaded cell ever seen."""
    airborne: bool
    """No load at all: the foot is in the air."""
    cells: tuple[float, ...] = ()
    """Every cell by itself, newtons and noise seen to, in the unit of the samples."""
    centre: tuple[float, float] | None = None
    """Centre of pressure (x, y), foot frame, m; None with hardly any load or without a layout."""


class Stance(NamedTuple):
    """What one sample says about the velocity of the sensor."""

    v_ref: Vec3
    """The velocity that the sensor ought to have now, m/s, navigation frame (strapdown.py); zero for ZUPT."""
    sigma: float
    """How far to trust it, m/s an axis, for one update every 5 ms; infinite where the detector has nothing to say."""
    statistic: float
    """The detector's own, in its own unit; where the hint is None, ErrorStateFilter takes less for stiller."""
    hint: Phase | None
    """STATIONARY where the detector is certain, SWING where it is certain of the opposite, LOADING or PUSH_OFF where
    v_ref is that of a shoe that rolls over heel or forefoot, otherwise None."""
    detail: object = None
    """What the detector hands to the cues and the corrector of its own recipe; nobody else looks at it."""


class Detector(Protocol):
    """What says that a foot stands still, or how fast it rolls. An app's own extends this and may stand in a Recipe
    beside ours; testing/promises.py tries whether it keeps what follows, docs/extending.md shows one.

    An attrs class (`@define`) with fields of kinds that can be saved. When times begin anew, after a restart of the
    device, the session goes on with `evolve(detector)`: fields with `init=False` are then as at first, settings and
    whatever else `__init__` takes stay. A detector reads no clock and no random numbers, costs the same at every
    sample, remembers no more the longer it is fed, and never raises: samples are finite, but otherwise of any size (up
    to 500 m/s^2, 100 rad/s) and at any distance in time.
    """

    __slots__ = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        """What this sample says. `t`: its time, `dt`: since the one before, s; `acc` in m/s^2 and `gyro` in rad/s,
        sensor frame, scale and bias of the gyroscope seen to; `load` None without pressure cells; `attitude`: sensor to
        navigation frame, predicted to this sample (of no meaning before the foot was levelled)."""

    # what a detector may pay heed to; it need not

    @property
    def lacking(self) -> str | None:
        """What it must do without, a sentence that becomes a Limitation; read when it was told of a layout."""
        return None

    def set_layout(self, layout: Layout) -> None:
        """Where the cells are; told once that is known, and again when it changes."""
        return

    def scaled(self, scale: float) -> None:
        """What acc is multiplied by from now on, so that it reads 1 g at rest."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """The detector to be used for that foot, with what the calibration says of it."""
        return self


def soften(statistic: float, settings: StanceThreshold) -> Stance:
    """Zero-velocity evidence whose noise grows with the statistic: sigma sqrt(max(1, T / base)) up to the gate."""
    base = settings.base
    if statistic >= settings.gate:
        return Stance(ZERO, inf, statistic, None)
    hint = Phase.STATIONARY if statistic < base else None
    return Stance(ZERO, settings.sigma * sqrt(max(1.0, statistic / base)), statistic, hint)
