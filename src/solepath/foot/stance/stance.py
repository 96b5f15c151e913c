"""Stance evidence, and the interface of stance detectors.

A stance detector never answers yes or no. For every sample it returns the velocity that the sensor should have now and
the standard deviation of this velocity (`Stance`). All detectors have the same signature, so any detector works with
any corrector."""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Protocol, Self

from ...calibration import Calibration
from ...types import Floats, Foot, Layout, Phase, Quat, Vec2, Vec3
from ...types.vector import IDENTITY


class Load(NamedTuple):
    """The load of the pressure cells in one sample, as shares of the full load.

    The full load is that of all cells when they bear the wearer (pressure/insole.py)."""

    total: float
    """Load of all cells, as a share of the full load."""
    heel: float | None
    """Load of the heel area, as a share of the full load; None if no working cell is in that area."""
    forefoot: float | None
    """Load of the forefoot area, as a share of the full load; None if no working cell is in that area."""
    airborne: bool
    """The foot is in the air: there is hardly any load."""
    cells: Floats = ()
    """Value of each cell without noise, in N with a calibration, otherwise in the unit of the samples."""
    centre: Vec2 | None = None
    """Centre of pressure (x, y), foot frame, m; None with hardly any load or without a layout.

    It is computed only for detectors and cues that say so (`uses_centre`), otherwise None."""
    unloaded: Floats = ()
    """Value of each of `cells` in the air, as learnt in the last swing; empty before any."""


class Stance(NamedTuple):
    """Evidence of one sample about the velocity of the sensor."""

    v_ref: Vec3
    """Velocity that the sensor should have now, m/s, navigation frame (strapdown.py); zero for ZUPT."""
    sigma: float
    """Standard deviation of each axis of `v_ref` for one update every 5 ms, m/s; inf without evidence."""
    statistic: float
    """Statistic of the detector, in the unit of that detector, for plots and comparisons; no corrector uses it."""
    hint: Phase | None
    """Phase that the detector is sure of, or None.

    STATIONARY: the foot certainly stands. SWING: it certainly does not. LOADING or PUSH_OFF: `v_ref` is that of a shoe
    that rolls over heel or forefoot."""
    detail: object = None
    """Data for cues and corrector of the same recipe; no other part uses it."""


class Detector(Protocol):
    """The interface of a stance detector.

    An app's own detector extends this class and can be used in a Recipe. testing/promises.py checks the rules below,
    docs/architecture.md shows an example.

    A detector is an attrs class (`@define`) with fields that can be saved. When times restart, for example after a
    restart of the device, the session continues with `evolve(detector)`: fields with `init=False` get their initial
    values, settings and other arguments of `__init__` stay. A detector reads no clock and no random numbers, has a
    constant cost for each sample, uses bounded memory, and never raises. Samples are finite, at most 500 m/s^2 and
    100 rad/s, and come at any interval."""

    __slots__ = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        """Return the evidence of one sample.

        `t` is the time of the sample and `dt` the time since the last one, s. `acc` (m/s^2) and `gyro` (rad/s) are in
        the sensor frame, with scale and bias applied. `load` is None without pressure cells. `attitude` is sensor to
        navigation frame, predicted for this sample; it has no meaning before the first attitude is known."""

    # what follows is optional: the default does nothing

    uses_centre: ClassVar[bool] = False
    """Flag: `load` has the centre of pressure in every sample; it is computed only for those who need it."""

    @property
    def lacking(self) -> str | None:
        """Sentence about missing data, which becomes a Limitation; None if nothing is missing.

        The session reads it after each `set_layout`."""
        return None

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells; called once it is known, and when it changes."""
        return

    def scaled(self, scale: float) -> None:
        """Set `scale`, the factor for acc with which it is 1 g at rest; called when it changes."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """Return the detector with the calibration of `foot`."""
        return self
