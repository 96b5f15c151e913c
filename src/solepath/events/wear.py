"""Events of sensors that are worn wrongly or whose cells fail; the session continues without the faulty data."""

from __future__ import annotations

from enum import Enum

from ..types import Foot, Site
from ..types.attrs import frozen
from .happening import BaseEvent


class CellFault(Enum):
    """Fault of a pressure cell."""

    DEAD = "dead"
    """The cell shows no load although its neighbours do."""
    STUCK = "stuck"
    """The cell's value never changes."""
    SATURATED = "saturated"
    """The cell's value stays at the end of its range."""
    MISSING = "missing"
    """The cell's value is not a number."""


@frozen(kw_only=True)
class CellsFailed(BaseEvent):
    """Some cells have a fault and are not used from `t` on; it is reported once for each fault and set of cells.

    `t` is the end of the second of two successive windows of walking that show the fault, at which it is reported; a
    window has at least four swings and 3 s. MISSING is reported after 1 s."""

    site: Site
    fault: CellFault
    """Fault of the cells."""
    cells: tuple[int, ...]
    """Numbers of the cells in the layout's order, from 0."""


@frozen(kw_only=True)
class InsoleNeverUnloads(BaseEvent):
    """The insole shows load all the time while the foot walks: it is jammed, or the shoe presses on it too hard.

    While that lasts, phases come from the inertial sensor. `t` is the end of the second of two successive windows of
    walking in which the load never ended, at which it is reported; a window has at least four swings and 3 s."""

    site: Site
    seconds: float
    """Time for which the load has lasted so far, s."""


@frozen(kw_only=True)
class FeetSwapped(BaseEvent):
    """The data of each foot look like those of the other foot, so the sensors or insoles may be on the wrong feet.

    It is reported once, and the session does not exchange the feet. `t` is the time at which it is reported: when the
    layouts of both insoles show it, else after at least 8 strides of each foot, by the way in which the feet roll or
    load moves over the soles. It is reported late or never for a wearer who hardly rolls the feet."""


@frozen(kw_only=True)
class FootSilent(BaseEvent):
    """One foot continues to walk while no data come from the other foot.

    `t` is the walking foot's first sample after three of its strides and 3 s without a sample of the silent foot. It is
    reported with that sample."""

    foot: Foot
    """Foot without data."""
    silent_for: float
    """Time since the last sample of `foot`, s."""


@frozen(kw_only=True)
class FootResumed(BaseEvent):
    """Samples of a foot came again after FootSilent; `t` is the first of them, with which it is reported."""

    foot: Foot
    """Foot that was silent."""
    silent_for: float
    """Time from the last sample of `foot` before the silence to the first sample after it, s."""
