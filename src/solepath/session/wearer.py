"""One wearer: samples of all sites in, events out. What a session does once packets have become samples."""

from __future__ import annotations

from collections.abc import Iterable
from copy import deepcopy
from typing import TypeVar

from attrs import define, field

from ..body.fuse.position import Position
from ..body.gait.cycles import Strides
from ..body.gait.turns import Turns
from ..body.height.altitude import Altitude
from ..body.worn.wear import Wear
from ..calibration import Calibration
from ..events import (
    ActivityChanged,
    ClockReset,
    Event,
    FlightClimbed,
    LayoutKnown,
    LiftRidden,
    Limitation,
    SampleRejected,
    StrideTaken,
    TurnMade,
    WearerMoved,
)
from ..floorplan.index import IndexedPlan
from ..foot.pressure.sole import Sole
from ..foot.rejection import rejected, with_sound_attitude, wrong_time
from ..foot.tracker import FootTracker
from ..recipes import AnyActivity, AnyBody, AnyPlace, Recipe
from ..saving.schema import MADE_AGAIN
from ..types import Foot, Sample, Site

LEADS = (StrideTaken, ActivityChanged, LiftRidden, FlightClimbed, TurnMade)
"""What a place on a floor plan follows from."""

_Key = TypeVar("_Key")
_Held = TypeVar("_Held")
_Part = TypeVar("_Part")


@define
class WearerParts:
    """Trackers of the feet, the body that the recipe gave them, and how all of it is worn."""

    recipe: Recipe
    """Read only: others may hold it too."""
    calibration: Calibration
    poses: bool
    """The feet emit FootMoved; WearerMoved after a step."""
    pressures: bool = False
    """FootPressed with every sample of cells."""
    # state
    body: AnyBody = field(init=False)
    activity: AnyActivity = field(init=False)
    place: AnyPlace = field(init=False)
    altitude: Altitude | None = field(init=False)
    turns: Turns = field(factory=Turns, init=False)
    strides: Strides = field(factory=Strides, init=False)
    wear: Wear = field(factory=Wear, init=False)
    feet: dict[Foot, FootTracker] = field(factory=dict, init=False, metadata=MADE_AGAIN)
    unused: list[Site] = field(factory=list, init=False)
    """Sites whose samples the recipe has no use for; said once."""

    def __attrs_post_init__(self) -> None:
        self.body = _calibrated(deepcopy(self.recipe.body), self.calibration)
        self.activity = _calibrated(deepcopy(self.recipe.activity), self.calibration)
        self.place = deepcopy(self.recipe.place)
        self.altitude = deepcopy(self.recipe.altitude)

    def feed(self, sample: Sample, scale_is_said: bool, plan: IndexedPlan | None) -> list[Event]:
        """A sample of any site. `scale_is_said`: by its link, which knows the range, so the foot need not. `plan`: the
        floor plan, always the same."""
        if sample.quat is not None:
            sample = with_sound_attitude(sample)
        foot = sample.site.foot
        if foot is None:
            return self._limb(sample)
        known = self.feet.get(foot)
        tracker = self._tracker(foot) if known is None else known
        if scale_is_said:
            tracker.scale_said = True
        events = tracker.feed(sample)
        if tracker.t is None:  # it could not be used: nothing is known of this foot yet
            return events
        if known is None:
            self._keep(tracker)
        if events and isinstance(events[0], SampleRejected):
            return events
        did: list[Event] = self.activity.foot_moved(tracker, sample, events)
        if events or self.turns.under_way:
            did += self.turns.foot_moved(tracker, sample, events)
        events += self.wear.heard(tracker, sample, events)
        events += self.body.foot_moved(tracker, sample, events)
        if did:
            events += did
        altitude = self.altitude
        if altitude is not None:
            if sample.air_pressure is not None:
                altitude.breathed(tracker, sample.t, sample.air_pressure)
            if events:
                events = altitude.follow(events)
        if events or self.strides.waits:
            known_at = sample.t if sample.known_at is None else max(sample.t, sample.known_at)
            events += self.strides.foot_moved(tracker, self.feet, known_at, events, self.body)
        if plan is not None and events:
            self._follow(plan, events)
        if self.poses or self.pressures:
            self._show(tracker, sample, events)
        if sample.pressure:
            tracker.sole.insole.cells = ()
        return events

    def hear(self, site: Site, event: Event) -> None:
        """What a link says, where it matters here."""
        if isinstance(event, ClockReset):
            self._interrupt_parts(site)
        foot = site.foot
        if foot is None:
            return
        if isinstance(event, LayoutKnown):
            tracker = self._tracker(foot)
            tracker.wear(event.layout)
            self.wear.told(foot, event.layout)
            self._keep(tracker)
        elif isinstance(event, ClockReset):
            self._tracker(foot).interrupt()

    def interrupt(self, site: Site) -> None:
        """Another device is worn there from now on."""
        self._interrupt_parts(site)
        if site.foot is not None and site.foot in self.feet:
            self.feet[site.foot].interrupt()

    def finish(self, known_at: float) -> list[Event]:
        """No more samples come: what was held back. `known_at`: s, now."""
        did: list[Event] = [*self.activity.finish(known_at), *self.turns.finish(known_at)]
        if self.altitude is not None:
            did = self.altitude.follow(did)
        return did + self.strides.finish(self.feet, known_at, self.body)

    def _follow(self, plan: IndexedPlan, events: list[Event]) -> None:
        """Where on the plan `events` lead."""
        if any([isinstance(event, LEADS) for event in events]):
            here = self.position
            if here is not None:
                events += self.place.follow(plan, events, here)

    def _show(self, tracker: FootTracker, sample: Sample, events: list[Event]) -> None:
        """What is there to be drawn; last of all, since no part has a use for it."""
        known_at = sample.t if sample.known_at is None else max(sample.t, sample.known_at)
        if self.poses and any([isinstance(event, StrideTaken) for event in events]):
            here = self.position
            if here is not None:
                t, place, covariance = here.t, here.position, here.covariance
                events.append(WearerMoved(t=t, known_at=max(t, known_at), position=place, covariance=covariance))
        if self.pressures and sample.pressure:
            pressed = tracker.sole.pressed_by(sample.t, known_at, sample.pressure)
            if pressed is not None:
                events.append(pressed)

    def _interrupt_parts(self, site: Site) -> None:
        self.body.interrupt(site)
        if self.altitude is not None:
            self.altitude.interrupt(site)
        self.activity.interrupt(site)
        self.turns.interrupt(site)
        self.strides.interrupt(site)

    @property
    def position(self) -> Position | None:
        """As the recipe's body has it, at the height that the recipe finds; None before any sample."""
        found = self.body.position(self.feet)
        return found if found is None or self.altitude is None else self.altitude.placed(found)

    def _tracker(self, foot: Foot) -> FootTracker:
        """The foot's own tracker, or a new one that nobody holds yet."""
        tracker = self.feet.get(foot)
        if tracker is None:
            recipe, known = self.recipe, self.calibration
            detector, corrector, cues, insole = deepcopy(
                (recipe.detector, recipe.corrector, recipe.cues, recipe.insole)
            )
            tracker = FootTracker(
                foot,
                _calibrated(detector, known, foot),
                _calibrated(corrector, known, foot),
                self.poses,
                cues=_calibrated(cues, known, foot),
                sole=Sole(foot, _calibrated(insole, known, foot), recipe.needs_pressure),
                needs_pressure=recipe.needs_pressure,
            )
            layout = known.insole(foot).layout
            if layout is not None:
                tracker.suppose(layout)
        return tracker

    def _keep(self, tracker: FootTracker) -> None:
        if tracker.foot not in self.feet:
            self.feet = in_order({**self.feet, tracker.foot: tracker}, Foot)

    def _limb(self, sample: Sample) -> list[Event]:
        """A sample from above the ankle: the body's, if it has a use for it."""
        wrong = wrong_time(sample)
        if wrong is not None:
            return [rejected(sample, wrong, None)]
        if sample.site in self.body.sites:
            return self.body.limb_moved(sample)
        if sample.site in self.unused:
            return []
        self.unused.append(sample.site)
        known_at = sample.t if sample.known_at is None else max(sample.t, sample.known_at)
        what = f"recipe {self.recipe.name} has no use for a sensor at the {sample.site.value}"
        return [Limitation(t=sample.t, known_at=known_at, site=sample.site, what=what)]


def in_order(held: dict[_Key, _Held], keys: Iterable[_Key]) -> dict[_Key, _Held]:
    """The same in the order of the enum: what is done site by site must not depend on who was heard first."""
    return {key: held[key] for key in keys if key in held}


def _calibrated(part: _Part, known: Calibration, *foot: Foot) -> _Part:
    """The part with what is known that concerns it; `foot`: whose it is, none for a body's."""
    calibrated = getattr(part, "calibrated", None)
    return part if calibrated is None else calibrated(*foot, known)
