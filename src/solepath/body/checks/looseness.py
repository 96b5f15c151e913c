"""A sensor that came loose in mid-walk, and swings or slides on the shoe.

A foot that stands has the velocity 0. A sensor that swings on it has another one, so the integrated velocity of the
foot at its stances is wrong by more than it was in the first strides of the same sensor. Other ways to walk, another
ground or a turn change the errors of both feet, a loose sensor those of one."""

from __future__ import annotations

from ...events import Defect, StrideTaken
from ...foot.view import FootView
from ...types import OTHER, PerFoot, Site, per_foot
from ...types.attrs import define, state, stateful
from ...types.vector import dot
from ..part import Inputs, Outputs, Part, PartOutput
from .stances import Finding

FIRST_STRIDES = 20
"""Number of strides from which the usual error of the velocity is learnt."""
RECENT_STRIDES = 10
"""Number of strides over which the error is averaged after that, by exponential weights."""
LEAST_ERROR = 0.15
"""Least root mean square of the error that a loose sensor has, m/s; usual ones are 0.05 to 0.2 (recordings)."""
UNUSUAL, USUAL = 2.5, 1.5
"""Ratios of the error to the usual one, of the loose sensor at least, and of the other foot at most.

On the 46 recordings of both feet that are long enough it reaches 2.1 while that of the other foot is below 1.5."""
MOST_OF_ONE = 3.0
"""Largest ratio of the squared error of one stride to the least of a loose sensor that counts.

Four strides or more have to show it then; the one after a gap in the samples ends with any velocity."""
LOOSE = Finding(
    Defect.LOOSE, "the sensor moves while the foot stands, and did not before: it came loose. Fix it to the shoe"
)


@define
class LandingErrors:
    """The velocity errors of one foot at its stances."""

    count: int = 0
    usual: float = 0.0
    """Mean square of the error over the first strides, (m/s)^2."""
    recent: float = 0.0
    """Mean square of the error over the recent strides, (m/s)^2."""
    reported: bool = False

    def add(self, square: float) -> None:
        """Add the squared error of a stride, (m/s)^2; one stride alone cannot show a loose sensor."""
        self.count += 1
        if self.count <= FIRST_STRIDES:
            self.usual += (square - self.usual) / self.count
            self.recent = self.usual
        else:
            most = MOST_OF_ONE * max(UNUSUAL * UNUSUAL * self.usual, LEAST_ERROR * LEAST_ERROR)
            self.recent += (min(square, most) - self.recent) / RECENT_STRIDES

    def exceeds(self, ratio: float) -> bool:
        """Return whether the recent error is more than `ratio` times the usual one."""
        return self.recent > ratio * ratio * self.usual


@stateful
class Looseness(Part):
    """Reports a sensor that came loose, once for a device; from then on its strides are degraded.

    It needs both feet, and a sensor that was fixed for `FIRST_STRIDES` strides. Latency: 4 to 30 strides, the fewer the
    more it swings."""

    needs_samples = True
    idle = True

    feet: PerFoot[LandingErrors] = state(factory=lambda: per_foot(LandingErrors))

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a stride of the foot; return the event if its sensor came loose."""
        found: list[PartOutput] = []
        for event in events:
            if not isinstance(event, StrideTaken) or view is None or view.after is None:
                continue
            this, other = self.feet[event.foot], self.feet[OTHER[event.foot]]
            this.add(dot(view.after.velocity_error, view.after.velocity_error))
            compares = min(this.count, other.count) >= FIRST_STRIDES + RECENT_STRIDES and not this.reported
            is_unusual = this.recent > LEAST_ERROR * LEAST_ERROR and this.exceeds(UNUSUAL)
            if compares and is_unusual and not other.exceeds(USUAL):
                this.reported = True
                found.append(LOOSE.event(event.foot, event.t, event.known_at))
        return found

    def reset(self, site: Site) -> None:
        """Forget a foot whose device or clock is another one."""
        if site.foot is not None:
            self.feet[site.foot] = LandingErrors()
