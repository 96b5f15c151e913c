"""Events of faults in how sensors are worn, or in their cells. The rest of the session goes on."""

from __future__ import annotations

from enum import Enum

from ..types import Foot, Site
from ..types.attrs import frozen
from .happening import Happening


class CellFault(Enum):
    """Fault of a pressure cell."""

    DEAD = "dead"  # it shows no load where its neighbours do
    STUCK = "stuck"  # it shows one value, whatever happens
    SATURATED = "saturated"  # it stays at the end of its range
    MISSING = "missing"  # no number comes from it


@frozen(kw_only=True)
class CellsFailed(Happening):
    """Some cells are left out from now on. Reported once for each fault and set of cells.

    Known at the end of the second window of walking in a row that shows it (four swings each and 3 s at least), which
    `t` is; MISSING after 1 s."""

    site: Site
    fault: CellFault
    """Fault of the cells."""
    cells: tuple[int, ...]
    """Numbers of the cells in the layout's order, from 0."""


@frozen(kw_only=True)
class InsoleNeverUnloads(Happening):
    """The foot walks and its insole shows load all the time: it is jammed, or the shoe presses on it too hard.

    Phases come from the inertial sensor as long as that lasts. Known at the end of the second window of walking in a
    row in which the load never ended (four swings each and 3 s at least), which `t` is."""

    site: Site
    seconds: float
    """Time for which the load has lasted so far, s."""


@frozen(kw_only=True)
class FeetSwapped(Happening):
    """The data of the left foot look like a right foot's, and the other way round. Reported once; it changes nothing.

    Known once the layouts of both insoles show it, else after 8 strides or more of each foot, by how they roll or how
    load moves over them; late or never for a wearer who hardly rolls the feet. `t` is that time."""


@frozen(kw_only=True)
class FootSilent(Happening):
    """One foot walks on and no data come from the other.

    Known with the walking foot's sample by which it has taken three strides and 3 s have passed since the silent foot's
    last sample, which `t` is."""

    foot: Foot
    """The silent foot."""
    silent_for: float
    """Time since its last sample, s."""


@frozen(kw_only=True)
class FootResumed(Happening):
    """Samples of this foot came again after FootSilent. Known with the first of them, which `t` is."""

    foot: Foot
    """The foot that was silent."""
    silent_for: float
    """Time from its last sample before the silence to the first after it, s."""
