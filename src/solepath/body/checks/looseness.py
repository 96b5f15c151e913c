"""A sensor that came loose in mid-walk, and swings or slides on the shoe.

A foot that stands has the velocity 0. A sensor that swings on it has another one, so the integrated velocity of the
foot at its stances is wrong by more than it was in the first strides of the same sensor. Other ways to walk, another
ground or a turn change the errors of both feet, a loose sensor those of one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...events import Defect, DefectFound, StrideTaken
from ...foot.view import FootView
from ...types import OTHER, SITE_OF_FOOT, Foot, Site
from ...types.attrs import define, field
from ..part import Part, PartOutput

FIRST_STRIDES = 20
"""Number of strides from which the usual error of the velocity is learnt."""
LEAST_ERROR, UNUSUAL = 0.2, 4.0
"""Least error of the velocity that may be unusual, m/s, and its least ratio to the usual one.

On recordings of walkers the error at a stance is 0.05 to 0.13 m/s in the median (moticon-like soles at 35 Hz: 0.19)."""
RECENT, MOST_UNUSUAL, FEW_UNUSUAL = 10, 7, 3
"""Number of recent strides, how many unusual ones show a loose sensor, and how many at most the other foot has then."""


@define
class LandingErrors:
    """The velocity errors of one foot."""

    count: int = 0
    usual: float = 0.0
    """Mean error of the first strides, m/s."""
    recent: tuple[bool, ...] = ()
    """Flag of each of the recent strides, the oldest first: its error was unusual."""
    reported: bool = False

    def add(self, error: float) -> None:
        """Add the error of a stride, m/s."""
        self.count += 1
        if self.count <= FIRST_STRIDES:
            self.usual += (error - self.usual) / self.count
        else:
            is_unusual = error > LEAST_ERROR and error > UNUSUAL * self.usual
            self.recent = (*self.recent[1 - RECENT :], is_unusual)


@define
class Looseness(Part):
    """Reports a sensor that came loose, once for a device; from then on its strides are degraded.

    It needs both feet, and a sensor that was fixed for `FIRST_STRIDES` strides. Latency: `MOST_UNUSUAL` strides."""

    needs_samples: ClassVar[bool] = True

    left: LandingErrors = field(factory=LandingErrors, init=False)
    right: LandingErrors = field(factory=LandingErrors, init=False)

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add a stride of the foot; return the event if its sensor came loose."""
        found: list[PartOutput] = []
        for event in view.events:
            if not isinstance(event, StrideTaken):
                continue
            this, other = self._errors(event.foot), self._errors(OTHER[event.foot])
            x, y, z = view.after.velocity_error
            this.add((x * x + y * y + z * z) ** 0.5)
            is_loose = this.recent.count(True) >= MOST_UNUSUAL and len(other.recent) == RECENT
            if is_loose and not this.reported and other.recent.count(True) <= FEW_UNUSUAL:
                this.reported = True
                found.append(_loose(event))
        return found

    def reset(self, site: Site) -> None:
        """Forget a foot whose device or clock is another one."""
        if site.foot is Foot.LEFT:
            self.left = LandingErrors()
        elif site.foot is Foot.RIGHT:
            self.right = LandingErrors()

    def _errors(self, foot: Foot) -> LandingErrors:
        return self.left if foot is Foot.LEFT else self.right


def _loose(event: StrideTaken) -> DefectFound:
    what = "the sensor moves while the foot stands, and did not before: it came loose. Fix it to the shoe"
    return DefectFound(
        t=event.t, known_at=event.known_at, site=SITE_OF_FOOT[event.foot], defect=Defect.LOOSE, what=what
    )
