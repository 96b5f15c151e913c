"""What is wrong with how sensors are worn, or with their cells. The rest goes on."""

from __future__ import annotations

from enum import Enum

from ..types import Foot, Site
from ..types.attrs import frozen
from .happening import Happening


class CellFault(Enum):
    """What is wrong with a pressure cell."""

    DEAD = "dead"  # it shows no load where its neighbours do
    STUCK = "stuck"  # it shows one value, whatever happens
    SATURATED = "saturated"  # it stays at the end of its range
    MISSING = "missing"  # no number comes from it


@frozen(kw_only=True)
class CellsFailed(Happening):
    """These cells are left out from now on. Said once for each fault and set of cells. Known at the end of the second
    window of walking in a row that shows it (four swings each and 3 s at least), which `t` is; MISSING after 1 s."""

    site: Site
    fault: CellFault
    cells: tuple[int, ...]
    """Their numbers in the layout's order, from 0."""


@frozen(kw_only=True)
class InsoleNeverUnloads(Happening):
    """The foot walks and its insole shows load all the time: it is jammed, or the shoe presses on it too hard.

    Phases come from the inertial sensor as long as that lasts. Known at the end of the second window of walking in a
    row in which the load never went (four swings each and 3 s at least), which `t` is.
    """

    site: Site
    seconds: float
    """For how long already, s."""


@frozen(kw_only=True)
class FeetSwapped(Happening):
    """What comes as the left foot looks like a right one, and the other way round. Said once; nothing is changed by it.
    Known once the layouts of both insoles show it, else after 8 steps or more of each foot, by how they roll or how
    load moves over them; late or never of who hardly rolls them. `t` is then."""


@frozen(kw_only=True)
class FootSilent(Happening):
    """One foot walks on and nothing comes from this one. Known with the other foot's sample by which it has taken three
    steps and 3 s have passed since this one's last, which `t` is. `foot`: the silent one."""

    foot: Foot
    silent_for: float
    """Since its last sample, s."""


@frozen(kw_only=True)
class FootResumed(Happening):
    """Samples of this foot came again after FootSilent. Known with the first of them, which `t` is."""

    foot: Foot
    silent_for: float
    """From its last sample before to that one, s."""
