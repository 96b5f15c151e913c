"""One wearer: samples of all sites in, events out. What a session does once packets have become samples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import deepcopy
from typing import TYPE_CHECKING, Any, TypeVar

from ..body.part import (
    MOVEMENTS,
    ClockUnsettled,
    HeightShift,
    LayoutReported,
    Part,
    PartOutput,
    Position,
    Replacement,
    Shift,
    TrackPart,
)
from ..calibration import Calibration
from ..events import ClockReset, Event, LayoutKnown, Limitation, SampleRejected, StrideTaken, WearerMoved
from ..foot.pressure.sole import Sole
from ..foot.rejection import rejected, with_sound_attitude, wrong_time
from ..foot.settings import FootSettings
from ..foot.tracker import FootTracker
from ..foot.view import FootView
from ..recipes import Recipe, part_class
from ..types import OTHER, Foot, Sample, Site
from ..types.attrs import MADE_AGAIN, NOT_SAVED, define, field, frozen

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan

_Key = TypeVar("_Key")
_Held = TypeVar("_Held")
_Calibrated = TypeVar("_Calibrated")


@frozen
class WearerSettings:
    """What a session is begun with."""

    recipe: Recipe
    """Read only: others may hold it too."""
    calibration: Calibration
    poses: bool = False
    """The feet emit FootMoved; WearerMoved after a stride."""
    pressures: bool = False
    """FootPressed with every sample of cells."""
    plan: int | None = None
    """Fingerprint of the floor plan, with which the recipe's place part is one of the wearer's; None without one."""


@define
class WearerParts:
    """Trackers of the feet, and the parts of the body that the recipe has, in their order."""

    settings: WearerSettings
    parts: list[Part] = field(init=False, metadata=MADE_AGAIN)
    """In the order in which they hear of what is said."""
    sampled: tuple[Part, ...] = field(default=(), init=False, metadata=NOT_SAVED)
    """Of these the ones that need, for the moment, a sample of which nothing came."""
    feet: dict[Foot, FootTracker] = field(factory=dict, init=False, metadata=MADE_AGAIN)
    height: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """By how much the wearer is higher than the feet's tracks say, m, and the variance of that, m^2."""
    unsettled: dict[Site, float | None] = field(factory=dict, init=False)
    """The newest ClockUnsettled of each site."""
    unused: list[Site] = field(factory=list, init=False)
    """Sites whose samples the recipe has no use for; said once."""

    def __attrs_post_init__(self) -> None:
        settings = self.settings
        parts: list[Part] = [*settings.recipe.parts]
        if settings.plan is not None:
            parts.append(settings.recipe.place or part_class("Particles")())
        self.parts = [deepcopy(part).calibrated(settings.calibration) for part in parts]

    def walks_on(self, plan: IndexedPlan | None) -> None:
        """For a wearer who is new or restored: the floor plan, which is never saved, is there from now on."""
        for part in self.parts:
            part.ready()
            if hasattr(part, "plan"):
                part.plan = plan
        self._choose()

    def _choose(self) -> None:
        self.sampled = tuple([part for part in self.parts if part.needs_samples and not part.idle])

    def feed(self, sample: Sample, scale_is_said: bool) -> list[Event]:
        """A sample of any site. `scale_is_said`: by its link, which knows the range, so the foot need not."""
        if sample.quat is not None:
            sample = with_sound_attitude(sample)
        foot = sample.site.foot
        if foot is None:
            return self._limb(sample)
        known = self.feet.get(foot)
        tracker = self._tracker(foot) if known is None else known
        if scale_is_said:
            tracker.scale_reported = True
        events = tracker.feed(sample)
        if tracker.t is None:  # it could not be used: nothing is known of this foot yet
            return events
        if known is None:
            self._keep(tracker)
        if events and isinstance(events[0], SampleRejected):
            return events
        t, known_at = sample.t, sample.known_at
        known_at = t if known_at is None or known_at < t else known_at
        if tracker.seen_at is None or t > tracker.seen_at:
            tracker.seen_at = t
        if not events and sample.air_pressure is None:  # so it is with nearly all samples
            view = tracker.view(sample, known_at, (), False, None)
            for part in self.sampled:
                if said := part.feed(view):
                    self._take(said, events)
                    self._flow(events, view, known_at, 1 + next(k for k, one in enumerate(self.parts) if one is part))
                    break
        else:
            stride = any([isinstance(event, StrideTaken) for event in events])
            other = self.feet.get(OTHER[foot])
            view = tracker.view(sample, known_at, tuple(events), stride, None if other is None else other.seen_at)
            moved = self._flow(events, view, known_at)
            if moved is not None and self.settings.poses and stride:
                events.append(moved)
        if sample.pressure:
            if self.settings.pressures:
                pressed = tracker.sole.make_event(t, known_at, sample.pressure)
                if pressed is not None:
                    events.append(pressed)
            tracker.sole.insole.cells = ()
        return events

    def receive(self, site: Site, event: Event) -> list[Event]:
        """What a link says, and what follows from it."""
        if isinstance(event, ClockReset):
            self._reset_parts(site)
        foot = site.foot
        if foot is not None and isinstance(event, LayoutKnown):
            tracker = self._tracker(foot)
            tracker.set_layout(event.layout)
            self._keep(tracker)
            for part in self.parts:
                part.receive(LayoutReported(site, event.layout))
        elif foot is not None and isinstance(event, ClockReset):
            self._tracker(foot).reset()
        events = [event]
        self._flow(events, None, event.known_at)
        return events

    def unsettle(self, site: Site, until: float | None) -> None:
        """The times of a site's samples up to `until`, s, are not to be compared with another's."""
        self.unsettled[site] = until
        for part in self.parts:
            part.receive(ClockUnsettled(site, until))
        self._choose()

    def reset(self, site: Site) -> None:
        """Another device is worn there from now on."""
        self._reset_parts(site)
        if site.foot is not None and site.foot in self.feet:
            self.feet[site.foot].reset()

    def finish(self, now: float) -> list[Event]:
        """No more samples come: what the parts held back, which those after them hear of. `now`: s."""
        events: list[Event] = []
        self._flow(events, None, now, finishing=True)
        return events

    def _flow(
        self, events: list[Event], view: FootView | None, known_at: float, first: int = 0, *, finishing: bool = False
    ) -> WearerMoved | None:
        """Let the parts, from number `first` on, hear in their order of `view` and `events`; what they say is added.
        Returns where the wearer is after it, if a part wanted to know."""
        moved = None
        for part in self.parts[first:]:
            heard = tuple(events)
            if part.needs_position and moved is None and any([isinstance(event, MOVEMENTS) for event in heard]):
                moved = self._moved(known_at)
            if view is not None and part.needs_samples and (said := part.feed(view)):
                self._take(said, events)
            if type(part).receive is not Part.receive:
                for event in heard:
                    if said := part.receive(event):
                        self._take(said, events)
            if moved is not None and part.needs_position:
                self._take(part.receive(moved), events)
            if finishing:
                self._take(part.finish(known_at), events)
        self._choose()
        if moved is None and self.settings.poses and any([isinstance(event, StrideTaken) for event in events]):
            moved = self._moved(known_at)
        return moved

    def _take(self, said: Sequence[PartOutput], events: list[Any]) -> None:
        """What a part said: events, an app's own too, are added to those of the sample, corrections are applied."""
        for one in said:
            if isinstance(one, Shift):
                self.feet[one.foot].shift(one.yaw, one.by)
            elif isinstance(one, HeightShift):
                self.height = (one.above, one.variance)
            elif isinstance(one, Replacement):
                events[:] = [one.by if event is one.event else event for event in events]
            else:
                events.append(one)

    def _moved(self, known_at: float) -> WearerMoved | None:
        here = self.position
        if here is None:
            return None
        t, place, covariance = here.t, here.position, here.covariance
        return WearerMoved(t=t, known_at=max(t, known_at), position=place, covariance=covariance)

    def _limb(self, sample: Sample) -> list[Event]:
        """A sample from above the ankle: for the parts that have a use for it."""
        wrong = wrong_time(sample)
        if wrong is not None:
            return [rejected(sample, wrong, None)]
        site, t, known_at = sample.site, sample.t, sample.known_at
        known_at = t if known_at is None or known_at < t else known_at
        events: list[Event] = []
        parts = [part for part in self.parts if site in part.sites]
        for part in parts:
            self._take(part.feed_limb(sample), events)
        if not parts and site not in self.unused:
            self.unused.append(site)
            what = f"recipe {self.settings.recipe.name} has no use for a sensor at the {site.value}"
            events.append(Limitation(t=t, known_at=known_at, site=site, what=what))
        return events

    def _reset_parts(self, site: Site) -> None:
        for part in self.parts:
            part.reset(site)
        self._choose()

    @property
    def position(self) -> Position | None:
        """As the recipe's track has it, at the height that its parts find; None before any sample."""
        poses = {foot: pose for foot, tracker in self.feet.items() if (pose := tracker.pose) is not None}
        track = next((part for part in self.parts if isinstance(part, TrackPart)), None)
        found = None if track is None else track.position(poses)
        above, variance = self.height
        if found is None or (above == 0.0 and variance == 0.0):
            return found
        x, y, z = found.position
        xx, xy, xz, yy, yz, zz = found.covariance
        return Position(found.t, (x, y, z + above), (xx, xy, xz, yy, yz, zz + variance))

    def ask(self, name: str) -> Any:
        """What the first part that has something of this name says of it; None where none has."""
        return next((getattr(part, name) for part in self.parts if hasattr(part, name)), None)

    def _tracker(self, foot: Foot) -> FootTracker:
        """The foot's own tracker, or a new one that nobody holds yet."""
        tracker = self.feet.get(foot)
        if tracker is None:
            recipe, known = self.settings.recipe, self.settings.calibration
            settings = FootSettings(self.settings.poses, recipe.needs_pressure)
            detector, corrector, cues, insole = deepcopy(
                (recipe.detector, recipe.corrector, recipe.cues, recipe.insole)
            )
            tracker = FootTracker(
                foot,
                _calibrated(detector, known, foot),
                _calibrated(corrector, known, foot),
                settings,
                cues=_calibrated(cues, known, foot),
                sole=Sole(foot, _calibrated(insole, known, foot), settings),
            )
            layout = known.insole(foot).layout
            if layout is not None:
                tracker.sole.set_calibrated_layout(layout)
        return tracker

    def _keep(self, tracker: FootTracker) -> None:
        if tracker.foot not in self.feet:
            self.feet = in_order({**self.feet, tracker.foot: tracker}, Foot)


def in_order(held: dict[_Key, _Held], keys: Iterable[_Key]) -> dict[_Key, _Held]:
    """The same in the order of the enum: what is done site by site must not depend on who was heard first."""
    return {key: held[key] for key in keys if key in held}


def _calibrated(part: _Calibrated, known: Calibration, foot: Foot) -> _Calibrated:
    """The part of a foot with what is known that concerns it."""
    calibrated = getattr(part, "calibrated", None)
    return part if calibrated is None else calibrated(foot, known)
