"""Processing of one wearer's samples, of all sites, into events."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import deepcopy
from typing import TYPE_CHECKING, Any, TypeVar

from ..body.part import (
    MOVEMENTS,
    ClockUnsettled,
    HeightShift,
    LayoutReported,
    LimbSampled,
    Notice,
    Part,
    PartOutput,
    Position,
    Replacement,
    Shift,
    TrackPart,
)
from ..calibration import Calibration
from ..events import ClockReset, DefectFound, Event, LayoutKnown, Limitation, SampleRejected, StrideTaken, WearerMoved
from ..foot.pressure.sole import Sole
from ..foot.rejection import rejected, with_sound_attitude, wrong_time
from ..foot.settings import FootSettings
from ..foot.tracker import FootTracker
from ..foot.view import FootView
from ..recipes import Recipe, part_class
from ..types import OTHER, Foot, Sample, Site
from ..types.attrs import MADE_AGAIN, NOT_SAVED, define, evolve, field, frozen

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")
_Calibrated = TypeVar("_Calibrated")


@frozen
class WearerSettings:
    """Settings of a session."""

    recipe: Recipe
    """The recipe, read only, since other sessions may share it."""
    calibration: Calibration
    poses: bool = False
    """True to emit FootMoved, and WearerMoved after a stride."""
    pressures: bool = False
    """True to emit FootPressed with every sample of cells."""
    plan: int | None = None
    """Fingerprint of the floor plan; None without a plan, and then the recipe's place part is not used."""


@define
class WearerParts:
    """Trackers of the feet, and the body parts of the recipe in their order."""

    settings: WearerSettings
    parts: list[Part] = field(init=False, metadata=MADE_AGAIN)
    """Parts in the order in which they receive events."""
    sampled: tuple[Part, ...] = field(default=(), init=False, metadata=NOT_SAVED)
    """Parts that currently need every sample, also samples without events."""
    feet: dict[Foot, FootTracker] = field(factory=dict, init=False, metadata=MADE_AGAIN)
    height: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Height correction added to the tracks' z, m, positive upwards, and its variance, m^2."""
    unsettled: dict[Site, float | None] = field(factory=dict, init=False)
    """Time up to which each site's times are not comparable with another site's, s; None when they are comparable."""
    unused: list[Site] = field(factory=list, init=False)
    """Sites whose samples the recipe cannot use; reported once."""

    def __attrs_post_init__(self) -> None:
        settings = self.settings
        parts: list[Part] = [*settings.recipe.parts]
        if settings.plan is not None:
            parts.append(settings.recipe.place or part_class("Particles")())
        self.parts = [deepcopy(part).calibrated(settings.calibration) for part in parts]

    def set_plan(self, plan: IndexedPlan | None) -> None:
        """Set the floor plan, which is never saved, of a new or restored wearer."""
        for part in self.parts:
            part.ready()
            if hasattr(part, "plan"):
                part.plan = plan
        self._choose_sampled()

    def _choose_sampled(self) -> None:
        self.sampled = tuple([part for part in self.parts if part.needs_samples and not part.idle])

    def feed(self, sample: Sample) -> list[Event]:
        """Add a sample of any site and return the events."""
        if sample.quat is not None:
            sample = with_sound_attitude(sample)
        foot = sample.site.foot
        if foot is None:
            return self._feed_limb(sample)
        if (correction := self.settings.calibration.sensors.get(foot)) is not None:
            sample = correction.correct(sample)
        known_tracker = self.feet.get(foot)
        tracker = self._tracker(foot) if known_tracker is None else known_tracker
        events = tracker.feed(sample)
        if events and isinstance(events[0], SampleRejected):
            if events[0].defect is not None:
                self._run_parts(events, None, events[0].known_at)
            return events
        if tracker.t is None:  # the foot does not use such a sample, and has no other yet
            return events
        if known_tracker is None:
            self._add_tracker(tracker)
        t: float = sample.t  # declared, because the fields of a compiled Sample have any type
        known_at: float = sample.known_at if sample.known_at > t else t
        if tracker.viewed_at is None or t > tracker.viewed_at:
            tracker.viewed_at = t
        if not events and sample.air_pressure is None and sample.range is None:  # nearly always
            view = tracker.view(sample, known_at, False, False, None)
            for part in self.sampled:
                if not part.idle and (output := part.feed((), view)):  # it may be idle since the sample before
                    self._apply(output, events)
                    number = next(number for number, one in enumerate(self.parts) if one is part)
                    self._run_parts(events, view, known_at, number + 1)
                    break
        else:
            stride = any([isinstance(event, StrideTaken) for event in events])
            other = self.feet.get(OTHER[foot])
            other_t = None if other is None else other.viewed_at
            view = tracker.view(sample, known_at, bool(events), stride, other_t)
            moved = self._run_parts(events, view, known_at)
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
        """Use an event of a link; return it and the events that follow from it."""
        if isinstance(event, ClockReset):
            self._reset_parts(site)
        foot = site.foot
        if foot is not None and isinstance(event, LayoutKnown):
            tracker = self._tracker(foot)
            tracker.set_layout(event.layout)
            self._add_tracker(tracker)
            self.notify(LayoutReported(site, event.layout))
        elif foot is not None and isinstance(event, ClockReset):
            self._tracker(foot).reset()
        events = [event]
        self._run_parts(events, None, event.known_at)
        return events

    def unsettle(self, site: Site, until: float | None) -> None:
        """Mark the times of a site's samples up to `until`, s, as not comparable with another site's."""
        self.unsettled[site] = until
        self.notify(ClockUnsettled(site, until))

    def notify(self, notice: Notice) -> None:
        """Tell the parts what no app is told."""
        for part in self.parts:
            part.feed((notice,), None)

    def reset(self, site: Site) -> None:
        """Reset the parts and the foot of a site where another device is worn from now on."""
        self._reset_parts(site)
        if site.foot is not None and site.foot in self.feet:
            self.feet[site.foot].reset()
            self.feet[site.foot].rest.bias_filter.forget()

    def finish(self, now: float) -> list[Event]:
        """Return the events that the parts held back; no more samples come after `now`, s."""
        events: list[Event] = []
        self._run_parts(events, None, now, finishing=True)
        return events

    def _run_parts(
        self, events: list[Event], view: FootView | None, known_at: float, first: int = 0, *, finishing: bool = False
    ) -> WearerMoved | None:
        """Pass `view` and `events` to the parts from number `first` on, in order, and add what they emit.

        Returns the wearer's new position, if a part or the app needs it."""
        moved = None
        for part in self.parts[first:]:
            received: Sequence[Event] = tuple(events)
            if part.needs_position and moved is None and any([isinstance(event, MOVEMENTS) for event in received]):
                moved = self._make_moved(known_at)
            if moved is not None and part.needs_position:
                received = (*received, moved)
            if received or (view is not None and part.needs_samples):
                self._apply(part.feed(received, view), events)
            if finishing:
                self._apply(part.finish(known_at), events)
        self._choose_sampled()
        if moved is None and self.settings.poses and any([isinstance(event, StrideTaken) for event in events]):
            moved = self._make_moved(known_at)
        return moved

    def _apply(self, output: Sequence[PartOutput], events: list[Any]) -> None:
        """Add the emitted events, also those that an app defines, to `events`, and apply the corrections."""
        for item in output:
            if isinstance(item, Shift):
                self.feet[item.foot].shift(item.yaw, item.by)
            elif isinstance(item, HeightShift):
                self.height = (item.above, item.variance)
            elif isinstance(item, Replacement):
                events[:] = [item.by if event is item.event else event for event in events]
            else:
                if isinstance(item, DefectFound) and item.spoils and item.site.foot in self.feet:
                    self.feet[item.site.foot].spoil()
                events.append(item)

    def _make_moved(self, known_at: float) -> WearerMoved | None:
        position = self.position
        if position is None:
            return None
        t = position.t
        return WearerMoved(
            t=t, known_at=max(t, known_at),
            position=position.position, covariance=position.covariance,
            heading_sigma=position.heading_sigma, north=position.north,
        )  # fmt: skip

    def _feed_limb(self, sample: Sample) -> list[Event]:
        """Pass a sample from above the ankle to the parts that use it."""
        fault = wrong_time(sample)
        if fault is not None:
            return [rejected(sample, fault, None)]
        site, t = sample.site, sample.t
        known_at = sample.known_at if sample.known_at > t else t
        events: list[Event] = []
        parts = [part for part in self.parts if site in part.sites]
        for part in parts:
            self._apply(part.feed((LimbSampled(sample),), None), events)
        if not parts and site not in self.unused:
            self.unused.append(site)
            text = f"recipe {self.settings.recipe.name} has no use for a sensor at the {site.value}"
            events.append(Limitation(t=t, known_at=known_at, site=site, what=text))
        return events

    def _reset_parts(self, site: Site) -> None:
        for part in self.parts:
            part.reset(site)
        self._choose_sampled()

    @property
    def position(self) -> Position | None:
        """Position by the recipe's track, with the height correction of its parts; None before any sample."""
        poses = {foot: pose for foot, tracker in self.feet.items() if (pose := tracker.pose) is not None}
        track = next((part for part in self.parts if isinstance(part, TrackPart)), None)
        tracked = None if track is None else track.position(poses)
        height, variance = self.height
        if tracked is None or (height == 0.0 and variance == 0.0):
            return tracked
        x, y, z = tracked.position
        xx, xy, xz, yy, yz, zz = tracked.covariance
        return evolve(tracked, position=(x, y, z + height), covariance=(xx, xy, xz, yy, yz, zz + variance))

    def find_attribute(self, name: str) -> Any:
        """Return the attribute `name` of the first part that has it; None if no part has it."""
        return next((getattr(part, name) for part in self.parts if hasattr(part, name)), None)

    def _tracker(self, foot: Foot) -> FootTracker:
        """Return the foot's tracker, or a new one, which is not yet added to `feet`."""
        tracker = self.feet.get(foot)
        if tracker is None:
            recipe, calibration = self.settings.recipe, self.settings.calibration
            settings = FootSettings(self.settings.poses, recipe.needs_pressure, calibration.headings.get(foot))
            detector, corrector, cues, insole = deepcopy(
                (recipe.detector, recipe.corrector, recipe.cues, recipe.insole)
            )
            tracker = FootTracker(
                foot,
                _calibrated(detector, calibration, foot),
                _calibrated(corrector, calibration, foot),
                settings,
                cues=_calibrated(cues, calibration, foot),
                sole=Sole(foot, _calibrated(insole, calibration, foot), settings),
            )
            layout = calibration.insole(foot).layout
            if layout is not None:
                tracker.sole.set_calibrated_layout(layout)
        return tracker

    def _add_tracker(self, tracker: FootTracker) -> None:
        if tracker.foot not in self.feet:
            self.feet = sort_by_key({**self.feet, tracker.foot: tracker}, Foot)


def sort_by_key(values: dict[_Key, _Value], keys: Iterable[_Key]) -> dict[_Key, _Value]:
    """Return the dict in the order of `keys`, so that results do not depend on which site sent first."""
    return {key: values[key] for key in keys if key in values}


def _calibrated(part: _Calibrated, calibration: Calibration, foot: Foot) -> _Calibrated:
    """Return the part with the foot's calibration, or unchanged if it has no `calibrated`."""
    calibrated = getattr(part, "calibrated", None)
    return part if calibrated is None else calibrated(foot, calibration)
