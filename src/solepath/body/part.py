"""The contract of body parts: everything that a wearer has beside the two feet.

A recipe holds its parts in a tuple. The output of a foot or of a link reaches the parts in that order. The output of a
part reaches the parts after it, also at the end of a session. Parts never write into a foot: a correction is a value
that a part returns (`Shift`, `HeightShift`, `Replacement`), and the wearer applies it."""

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
    """A correction of one foot, which is flat: heading plus `yaw` rad, position plus `by` m, world frame."""

    foot: Foot
    yaw: float
    by: Vec3


@frozen
class HeightShift:
    """A correction of the wearer's height: `above` m over the feet's tracks, variance in m^2.

    It holds until the next one."""

    above: float
    variance: float


@frozen
class Replacement:
    """A correction that puts the event `by` in the place of `event`.

    An earlier part has returned `event` for the same sample."""

    event: Event
    by: Event


@frozen
class ClockUnsettled:
    """Notice that a site's sample times up to `until`, s, cannot be compared with another site's; None: all can."""

    site: Site
    until: float | None


@frozen
class LayoutReported:
    """Notice that the device at a site has reported its cell layout, and with it the foot it is made for.

    A layout of a calibration is not reported this way."""

    site: Site
    layout: Layout


@frozen
class Position:
    """Position of the wearer at `t` s, world frame, m, with covariance xx, xy, xz, yy, yz, zz in m^2."""

    t: float
    position: Vec3
    covariance: Covariance3


PartOutput = Happening | Shift | HeightShift | Replacement
"""Everything that a part may return: events, also those of an app, and corrections."""
PartInput = Event | ClockUnsettled | LayoutReported
"""Everything that a part may receive: events, and notices of the links."""
MOVEMENTS = (StrideTaken, ActivityChanged, LiftRidden, FlightClimbed, TurnMade)
"""Events after which the wearer's position is given to the parts that follow (`Part.needs_position`)."""


class Part(Protocol):
    """A part of the body that does nothing: derive a plain record (`@define`) from it and override its methods.

    For each sample of a foot a part first gets the foot's view, if it declares `needs_samples`, and then every event of
    that sample: those of the foot and those of the parts before. Times are in s. No method may raise, whatever the
    input is, use more memory the longer it is fed, or read a clock or random numbers."""

    __slots__ = ()

    needs_samples: ClassVar[bool] = False
    """Flag of a part that needs samples: `feed` is called."""
    idle: bool = False
    """Flag of a part whose `feed` would do nothing now with a sample that has neither events nor air pressure. `feed`
    is not called with such a sample. The flag is always true, or a field that changes in `receive`, `reset` and
    `feed`."""
    sites: ClassVar[tuple[Site, ...]] = ()
    """Sites above the ankle whose samples the part needs: `feed_limb` is called."""
    needs_position: ClassVar[bool] = False
    """Flag of a part that needs the wearer's position (WearerMoved) after a stride, turn, ride or flight."""

    def calibrated(self, calibration: Calibration) -> Self:
        """Return the part to be used for a wearer with this calibration; called once, before anything else."""
        return self

    def ready(self) -> None:
        """Load the files that the part needs; called for a new wearer and for one restored from a saved state.

        `feed` and `receive` import nothing and open no file."""
        return

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Receive an event or a notice and return the outputs that follow from it."""
        return ()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Take the view of a foot after a sample and return the outputs that follow from it."""
        return ()

    def feed_limb(self, sample: Sample) -> Sequence[PartOutput]:
        """Take a sample of one of `sites` and return the outputs that follow from it."""
        return ()

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return the outputs that were held back: no more data comes, and it is `now`, s."""
        return ()

    def reset(self, site: Site) -> None:
        """Reset what depends on a site's clock or device: the clock restarts, or another device is worn there."""
        return


class TrackPart(Part):
    """The part that reports the wearer's position; a recipe has exactly one."""

    __slots__ = ()

    @abstractmethod
    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the wearer's position from the poses of the feet that gave samples; None before any sample."""


class ActivityPart(Part):
    """The part that reports the wearer's activity; a recipe has exactly one."""

    __slots__ = ()

    activity: Activity
    """The newest activity that was reported, final or not; UNKNOWN before any."""
