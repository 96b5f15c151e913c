"""What is wrong with how sensors are worn, or with their cells. The rest goes on."""

from __future__ import annotations

from enum import Enum

from attrs import frozen

from ..types import Foot, Site
from .happening import Happening


class CellFault(Enum):
    """What is wrong with a pressure cell."""

    DEAD = "dead"  # it shows no load where its neighbours do
    STUCK = "stuck"  # it shows one value, whatever happens
    SATURATED = "saturated"  # it stays at the end of its range
    MISSING = "missing"  # no number comes from it


@frozen(kw_only=True)
class CellsFailed(Happening):
    """These cells are left out from now on. Said once for each fault and set of cells."""

    site: Site
    fault: CellFault
    cells: tuple[int, ...]
    """Their numbers in the layout's order, from 0."""


@frozen(kw_only=True)
class InsoleNeverUnloads(Happening):
    """The foot walks and its insole shows load all the time: it is jammed, or the shoe presses on it too hard.

    Phases come from the inertial sensor as long as that lasts.
    """

    site: Site
    seconds: float
    """For how long already."""


@frozen(kw_only=True)
class FeetSwapped(Happening):
    """What comes as the left foot looks like a right one, and the other way round. Nothing is changed by it."""


@frozen(kw_only=True)
class FootSilent(Happening):
    """One foot walks on and nothing comes from this one."""

    foot: Foot
    silent_for: float
    """s."""


@frozen(kw_only=True)
class FootHeard(Happening):
    """Samples of this foot came again after FootSilent."""

    foot: Foot
    silent_for: float
    """s."""
