"""What everything that a wearer has beside the two feet is made of: parts, in an order, with one contract.

A recipe has its parts as a tuple. What a foot or a link says reaches them in that order, and what a part says reaches
those after it, also at the end of a session. Nothing is written back into a foot: a correction is a value that a part
returns (`Shift`, `HeightShift`, `Replacement`), and the wearer applies it.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import ClassVar, Protocol, Self

from ..calibration import Calibration
from ..events import ActivityChanged, Event, FlightClimbed, LiftRidden, StrideTaken, TurnMade
from ..events.happening import Happening
from ..foot.view import FootPose, FootView
from ..foot.world import Covariance3
from ..types import Activity, Foot, Layout, Sample, Site, Vec3
from ..types.attrs import frozen


@frozen
class Shift:
    """The foot, which is flat, heads `yaw` rad further from here on and stands `by` m off, world frame."""

    foot: Foot
    yaw: float
    by: Vec3


@frozen
class HeightShift:
    """The wearer is `above` m higher than the feet's tracks say, known with this variance, m^2; until the next one."""

    above: float
    variance: float


@frozen
class Replacement:
    """`by` takes the place of `event`, which a part before this one has said of the same sample."""

    event: Event
    by: Event


@frozen
class ClockUnsettled:
    """The times of a site's samples up to `until`, s, cannot be compared with another site's; None: all can."""

    site: Site
    until: float | None


@frozen
class LayoutReported:
    """The device at a site says itself where its cells are, and with it whose foot it is on; a calibration does not."""

    site: Site
    layout: Layout


@frozen
class Position:
    """Where the wearer is: world frame, m, with covariance xx, xy, xz, yy, yz, zz in m^2, at `t` s."""

    t: float
    position: Vec3
    covariance: Covariance3


PartOutput = Happening | Shift | HeightShift | Replacement
"""What a part may say: events, an app's own too, and corrections."""
PartInput = Event | ClockUnsettled | LayoutReported
MOVEMENTS = (StrideTaken, ActivityChanged, LiftRidden, FlightClimbed, TurnMade)
"""After these it is said where the wearer is, to the parts that follow it (`Part.needs_position`)."""


class Part(Protocol):
    """A part of the body that does nothing. Derive from it, as a plain record (`@define`), and say what you do.

    Of each sample of a foot a part first gets its view, if it declares `needs_samples`, then every event of it: the
    foot's, and those of the parts before. Times are s. Nothing here may raise, whatever comes, keep more the longer it
    is fed, or read a clock or random numbers.
    """

    __slots__ = ()

    needs_samples: ClassVar[bool] = False
    """It needs samples: `feed` is called."""
    idle: bool = False
    """For the moment `feed` would do nothing with a sample of which nothing came and that has no air pressure, so it is
    not called with it. True for good, or a field that changes in `receive`, in `reset` and in `feed`."""
    sites: ClassVar[tuple[Site, ...]] = ()
    """Sites above the ankle whose samples it needs: `feed_limb` is called."""
    needs_position: ClassVar[bool] = False
    """It needs to know where the wearer is (WearerMoved) after a stride, a turn, a ride or a flight."""

    def calibrated(self, calibration: Calibration) -> Self:
        """The part to be used, given what is known of this wearer; called once, before anything else."""
        return self

    def ready(self) -> None:
        """A wearer is new, or goes on from a saved state. What must be read from a file is read now: `feed` and
        `receive` import nothing and open nothing."""
        return

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Something was said. What follows from it."""
        return ()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A foot has used a sample. What follows from it."""
        return ()

    def feed_limb(self, sample: Sample) -> Sequence[PartOutput]:
        """A sample of one of `sites`. What follows from it."""
        return ()

    def finish(self, now: float) -> Sequence[PartOutput]:
        """No more comes, and it is `now`: what was held back."""
        return ()

    def reset(self, site: Site) -> None:
        """The clock of a site's samples restarts, or another device is worn there."""
        return


class TrackPart(Part):
    """The part that says where the wearer is. A recipe has one, and one only."""

    __slots__ = ()

    @abstractmethod
    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Where the wearer is, of where the feet are that were heard of; None before any sample."""


class ActivityPart(Part):
    """The part that says what the wearer does. A recipe has one, and one only."""

    __slots__ = ()

    activity: Activity
    """The newest that it said, final or not; UNKNOWN before any."""
