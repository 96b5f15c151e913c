"""The contract of body parts: the parts of a recipe that do not belong to one foot.

A recipe has its parts in a tuple. What a foot, a link or a person reports reaches the parts in the order of the tuple,
by `Part.feed` alone. The output of a part reaches the parts after it, also at the end of a session. Parts never write
into a foot. A part returns a correction as a value (`Shift`, `HeightShift`, `Replacement`), and the wearer applies
it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Protocol, Self

from ..calibration import Calibration
from ..events import ActivityChanged, EscalatorRidden, Event, FlightClimbed, LiftRidden, StrideTaken, TurnMade
from ..events.happening import BaseEvent
from ..foot.view import FootPose, FootView
from ..foot.world import Covariance3
from ..types import Activity, Foot, Layout, Sample, Site, Vec3
from ..types.attrs import frozen

if TYPE_CHECKING:
    from ..floorplan.plan import Start


@frozen
class Shift:
    """A correction of the position and the heading of a foot that is flat on the ground."""

    foot: Foot
    yaw: float
    """Angle that is added to the foot's heading, rad."""
    by: Vec3
    """Vector that is added to the foot's position, world frame, m."""


@frozen
class HeightShift:
    """A correction of the wearer's height that holds until the next one."""

    above: float
    """Height that is added to the heights of the feet, m."""
    variance: float
    """Variance of `above`, m^2."""


@frozen
class Replacement:
    """A correction that replaces `event`, which an earlier part has returned for the same sample, with `by`."""

    event: Event
    by: Event


@frozen
class LayoutReported:
    """A notice that the device at a site has reported its cell layout, which is that of a left or a right insole.

    A layout that comes from a calibration, or that was guessed, is not reported this way."""

    site: Site
    layout: Layout


@frozen
class ClockUnsettled:
    """A notice that the times of a site cannot be compared with those of other sites yet (link/clock.py).

    It comes with each packet as long as the clock of the site's device is not settled, and once when it is."""

    site: Site
    until: float | None
    """Time up to which the times of the site cannot be compared, s; None when all can."""


@frozen
class StartGiven:
    """A notice of the wearer's first place on the floor plan, before any sample, if the app gives one."""

    start: Start


@frozen
class LimbSampled:
    """A notice of a sample from above the ankle; only a part that names its site in `Part.sites` receives it."""

    sample: Sample


@frozen
class Position:
    """The position of the wearer at one time."""

    t: float
    """Time of the position, s."""
    position: Vec3
    """Position in the world frame, m."""
    covariance: Covariance3
    """Covariance of `position`: xx, xy, xz, yy, yz, zz, m^2."""
    heading_sigma: float | None = None
    """Standard deviation of the angle by which the whole track may be turned, rad; None if it is not known."""
    north: tuple[float, float] | None = None
    """Direction of magnetic north in the world frame, counter-clockwise from x, and its standard deviation, rad.

    None without magnetometers in the feet, and until turns have proven them (docs/device.md)."""


PartOutput = BaseEvent | Shift | HeightShift | Replacement
"""Everything that a part may return: corrections and events, including events of an app."""
Notice = LayoutReported | ClockUnsettled | StartGiven | LimbSampled
"""What parts are told and an app is not."""
PartInput = Event | Notice
"""Everything that a part may receive."""
Inputs = Sequence[PartInput]
Outputs = Sequence[PartOutput]
MOVEMENTS = (StrideTaken, ActivityChanged, LiftRidden, EscalatorRidden, FlightClimbed, TurnMade)
"""Events after which the wearer's position is given to the parts that follow (`Part.needs_position`)."""


class Part(Protocol):
    """A body part that does nothing: derive a plain record (`@define`) from it and override its methods.

    Times are in s. No method may raise an exception for any input, use memory that grows with time, or read a clock or
    random numbers."""

    __slots__ = ()

    needs_samples: ClassVar[bool] = False
    """Flag: the part needs the samples of the feet, so `feed` is called for samples without events too."""
    idle: bool = False
    """Flag: a sample with neither events nor air pressure would do nothing, so `feed` is not called for it.

    It is either always true, or a field that changes only in `feed` and `reset`."""
    sites: ClassVar[tuple[Site, ...]] = ()
    """Sites of limbs whose samples the part needs, each as a `LimbSampled`."""
    notices: ClassVar[tuple[type[Notice], ...]] = ()
    """Kinds of notices that the part needs; what `feed` returns for one of them is not used.

    A `LimbSampled` comes for the part's `sites` without being named here, and what `feed` returns for it is used."""
    needs_position: ClassVar[bool] = False
    """Flag: WearerMoved with the wearer's position comes after the events, if one of `MOVEMENTS` is among them."""

    def calibrated(self, calibration: Calibration) -> Self:
        """Return the part for a wearer with this calibration; called once, before any other method."""
        return self

    def ready(self) -> None:
        """Load the files that the part needs; called for a new wearer and for a wearer restored from a saved state.

        `feed` must import nothing and open no file, but for what the first sample or event of a new kind needs (a
        compass, a reported position)."""
        return

    def with_heading(self, heading: float) -> Self | None:
        """Return the part for a wearer who starts with this heading, rad, left positive, in the world of all sensors.

        None if the part has no use for it."""
        return None

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Take the events that became known, in their order, and return the outputs that follow from them.

        The events of the parts before are among them. `view` is that of the foot after the sample that brought them;
        None for events that no sample brought, as those of a link or a person. A sample without events is fed to parts
        that need samples and are not idle."""
        return ()

    def finish(self, now: float) -> Outputs:
        """Return the outputs that were held back, because the data ends at `now`, s."""
        return ()

    def reset(self, site: Site) -> None:
        """Reset what depends on the clock or the device of a site, because one of them has changed.

        After a change of the clock, `feed` gets a ClockReset; after one of the device nothing follows."""
        return


class TrackPart(Part):
    """The part that reports the wearer's position; a recipe has exactly one."""

    __slots__ = ()

    @abstractmethod
    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the wearer's position from the poses of the feet that have samples; None before any sample."""


class ActivityPart(Part):
    """The part that reports the wearer's activity; a recipe has exactly one."""

    __slots__ = ()

    @property
    @abstractmethod
    def activity(self) -> Activity:
        """Newest activity that was reported, final or not; UNKNOWN before any."""
