"""State of a session, and how packets, samples and what a person reports change it.

Packets become samples and events of their link, samples of a foot become events of its tracker, and all events go to
the parts of the body in the order of the recipe."""

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
    Outputs,
    Part,
    Position,
    Replacement,
    Shift,
    TrackPart,
)
from ..calibration import Calibration
from ..events import (
    ClockReset,
    DefectFound,
    Event,
    LayoutKnown,
    Limitation,
    PacketRejected,
    SampleGap,
    SampleRejected,
    StrideTaken,
    WearerMoved,
)
from ..foot.settings import FootSettings
from ..foot.view import FootView
from ..link.health import RecentLink, is_whole
from ..link.kinds import DeviceKinds
from ..recipes import Recipe, part_class
from ..types import OTHER, SITE_OF_FOOT, Foot, Packet, Quat, Sample, Site
from ..types.attrs import MADE_AGAIN, NOT_SAVED, evolve, field, frozen, state, stateful
from ..types.plain import has_floats, has_plain_values, with_floats, with_plain_values
from ..types.records import MAX_TIME
from ..types.vector import normalise
from .arguments import keep_events
from .repeats import Repeats

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..foot.tracker import FootTracker
    from ..link.decoder import Decoder

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")

JUMP, WRONG_JUMP, JUMP_TIME = 3600.0, 10.0, 2.0
"""Smallest step of `advance` that is no passing time unless JUMP_TIME goes on without packets, s; and the smallest by
which a packet that arrives before `now` shows that the step was of another clock, s, after which it is a leap too.

A program that lets time pass feeds what has arrived within a second; an hour is longer than any sensor is away from a
program that goes on. Chosen by hand."""
OTHER_CLOCK = (
    "advance was called with times of another clock than that of the packets, {:.4g} s ahead: give it the clock of "
    "Packet.t"
)
"""Limitation of an app that does so."""
VERSION = 3
"""Version of the state, increased by 1 with every release that changes state or settings; no other can be restored."""
SHORTEST_QUAT = 1e-12
"""Square of the smallest norm of an attitude quaternion that can be normalised."""


@frozen
class SessionSettings:
    """Settings of a session."""

    recipe: Recipe
    """The recipe, read only, since other sessions may share it."""
    calibration: Calibration
    poses: bool = False
    """True to emit FootMoved, and WearerMoved after a stride."""
    pressures: bool = False
    """True to emit FootPressed with every sample of cells."""
    losses: bool = False
    """True to tell each gap and each rejected packet or sample by itself."""
    impacts: bool = False
    """True to emit a HeelStrike that is not final as soon as the impact shows."""
    plan: int | None = None
    """Fingerprint of the floor plan; None without a plan, and then the recipe's place part is not used."""


@stateful
class SessionState:
    """The whole state of a session: decoders of the worn devices, trackers of the feet, and the parts of the body."""

    settings: SessionSettings = field()
    now: float | None = None
    """Newest known time, s, packets' clock; None before the first."""
    advanced: float | None = None
    """Value of `now` that `advance` has set, s; None after a packet."""
    jump: float | None = None
    """First time of a jump of `advance` that is not used yet, s; None without one."""
    jumps_are_wrong: bool = False
    """Flag: packets have contradicted `advance`, which was reported."""
    decoders: dict[Site, Decoder] = state(factory=dict)
    finished: bool = False
    parts: list[Part] = field(init=False, metadata=MADE_AGAIN)
    """Parts in the order in which they receive events."""
    awake: tuple[tuple[int, Part], ...] = state(default=(), metadata=NOT_SAVED)
    """Parts that need samples without events too, each after the number of the part that follows it.

    A part that is idle after events, a notice or a reset is left out, because only one of these wakes it."""
    feet: dict[Foot, FootTracker] = state(factory=dict, metadata=MADE_AGAIN)
    height: tuple[float, float] = (0.0, 0.0)
    """Height correction added to the tracks' z, m, positive upwards, and its variance, m^2."""
    unsettled: dict[Site, float | None] = state(factory=dict)
    """Time up to which each site's times are not comparable with another site's, s; None when they are comparable."""
    unused: list[Site] = state(factory=list)
    """Sites whose samples the recipe cannot use; reported once."""
    links: dict[Site, RecentLink] = state(factory=dict)
    """What came lately over the link of each site."""
    repeats: Repeats = state(factory=Repeats)
    """Small troubles of the links that the app has still to be told."""

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
        self._find_awake()

    def _find_awake(self) -> None:
        self.awake = tuple(
            [(number, part) for number, part in enumerate(self.parts, 1) if part.needs_samples and not part.idle]
        )

    def feed_packet(self, packet: Packet, kinds: DeviceKinds) -> list[Event]:
        """Add a packet of one of these kinds of devices; raise TypeError for one of wrong types."""
        if not has_plain_values(packet):
            packet = with_plain_values(packet)
        site = packet.site
        events: list[Event] = []
        decoder = self.decoders.get(site) or self.make_decoder(site)
        newest_arrival = decoder.newest_arrival
        items = decoder.feed(packet, kinds)
        if not decoder.used:
            # a rejected packet changes nothing, so time does not pass with it either
            self._count(site, None, 0, items)
            if site not in self.decoders:
                return [event for event in items if isinstance(event, PacketRejected)]
            self.use_items(site, items, events)
            return events
        self._count(site, packet.t, is_whole(packet, items, kinds), items)
        if site not in self.decoders:
            self.add_decoder(decoder)
        for other_site, other_decoder in self.decoders.items():
            if other_site is not site and (other_items := other_decoder.advance(packet.t, kinds)):
                self.use_items(other_site, other_items, events)
        if newest_arrival is not None and packet.t < newest_arrival:
            self.now = packet.t  # a clock that one site shows to be set back is set back for all
            for other_site, other in self.decoders.items():
                if other_site is not site and other.newest_arrival is not None and other.newest_arrival > packet.t:
                    self.use_items(other_site, other.restart_clock(packet.t), events)
        reached = self.jump or self.advanced
        if reached is not None and reached - packet.t > WRONG_JUMP:
            self.now = packet.t
            if not self.jumps_are_wrong:
                self.jumps_are_wrong = True
                what = OTHER_CLOCK.format(reached - packet.t)
                events += self.report(site, Limitation(t=packet.t, known_at=packet.t, site=None, what=what))
        self.advanced = self.jump = None
        if self.now is None or packet.t > self.now:
            self.now = packet.t
        if decoder.link is not None:
            until = decoder.link.unsettled_until
            if until != self.unsettled.get(site):
                self.unsettled[site] = until
                self.notify(ClockUnsettled(site, until))
        self.use_items(site, items, events)
        return events

    def make_decoder(self, site: Site, device: str = "") -> Decoder:
        """Return a decoder for the device of a site, which is not yet added to `decoders`."""
        from ..link.decoder import Decoder  # an app that feeds samples needs none

        return Decoder(site, device)

    def add_decoder(self, decoder: Decoder) -> None:
        """Add a decoder in the place of the one of its site."""
        self.decoders = sort_by_key({**self.decoders, decoder.site: decoder}, Site)

    def feed_sample(self, sample: Sample) -> list[Event]:
        """Add a sample; raise TypeError for one whose values are no numbers."""
        if not isinstance(sample.site, Site):
            raise TypeError(f"site of a sample is a Site, not {sample.site!r:.80}")
        if not has_floats(sample):
            sample = with_floats(sample)
        events = self._use_sample(sample)
        if events and isinstance(events[0], SampleRejected):
            self._count(sample.site, None, 0, events)
            return events
        t: float = sample.t  # declared, because the fields of a compiled Sample have any type
        known_at: float = sample.known_at
        self._count(sample.site, known_at if known_at > t else t, 0, (sample, *events))
        if self.now is None or t > self.now:
            self.now = t
        return events

    def advance(self, now: float, kinds: DeviceKinds) -> list[Event]:
        """Let time pass until `now`, s, packets' clock."""
        if self.now is not None and now - self.now > (WRONG_JUMP if self.jumps_are_wrong else JUMP):
            self.jump = now if self.jump is None or now < self.jump else self.jump
            if now - self.jump < JUMP_TIME:
                return []
        self.jump = None
        if self.now is None or now > self.now:
            self.now = self.advanced = now
        events: list[Event] = []
        for decoder in self.decoders.values():
            self.use_items(decoder.site, decoder.advance(now, kinds), events)
        return events

    def restart_clock(self, now: float) -> list[Event]:
        """Continue at `now`, s, on a clock that restarted or was set, for packets and for samples."""
        events: list[Event] = []
        for site in Site:
            decoder = self.decoders.get(site)
            if decoder is not None:
                self.use_items(site, decoder.restart_clock(now), events)
            elif site.foot in self.feet:
                reset = ClockReset(t=now, known_at=now, site=site, restarted=False)
                events += self.report(site, reset)
            else:
                self.reset(site)
        self.now = now
        return events

    def finish(self) -> list[Event]:
        """Return the events that were held back; nothing is fed after this."""
        events: list[Event] = []
        for decoder in self.decoders.values():
            self.use_items(decoder.site, decoder.finish(), events)
        if self.now is not None:
            held: list[Event] = []
            self._run_parts(held, None, self.now, finishing=True)
            events += held
        self.finished = True
        return events

    def _count(self, site: Site, arrival: float | None, packets: int, items: Iterable[object]) -> None:
        """Count packets of a site and what came of them; `arrival`, s, is None for what was rejected."""
        link, t = self.links.get(site), self.now
        if link is None:
            link = self.links[site] = RecentLink()
        if arrival is not None:
            t = link.last_arrival = arrival
        samples = missing = rejected = 0
        for item in items:
            if isinstance(item, Sample):
                samples += 1
            elif isinstance(item, SampleGap):
                missing += item.count
            elif isinstance(item, (PacketRejected, SampleRejected)):
                rejected += 1
        if t is not None:
            link.add(t, packets, samples, missing, rejected)

    def gather(self, item: Packet | Sample | None, events: list[Event], end: bool = False) -> list[Event]:
        """Return what the app is told after an item with these events; `end`: at the end, or before another clock."""
        if self.settings.losses or not (events or self.repeats.kinds):
            return events
        return self.repeats.end(events, self.now) if end else self.repeats.gather(item, events)

    def notify(self, notice: Notice) -> None:
        """Tell the parts that ask for notices of this kind."""
        for part in self.parts:
            if type(notice) in part.notices:
                part.feed((notice,), None)
        self._find_awake()

    def report(self, site: Site, event: Event) -> list[Event]:
        """Use an event of a link; return it and the events that follow from it."""
        if isinstance(event, ClockReset):
            self._reset_parts(site)
        foot = site.foot
        if isinstance(event, SampleGap) and foot in self.feet:
            self.feet[foot].gap_end = event.t + event.duration
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

    def reset(self, site: Site) -> None:
        """Reset the parts and the foot of a site where another device is worn from now on."""
        self._reset_parts(site)
        if site.foot is not None and site.foot in self.feet:
            self.feet[site.foot].reset()
            self.feet[site.foot].rest.bias_filter.forget()

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

    def use_items(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        """Pass the samples and events of a link to the feet and the parts, and add the events that follow."""
        for item in items:
            try:
                events += self._use_sample(item) if isinstance(item, Sample) else self.report(site, item)
            except Exception as error:
                if not events:
                    raise
                failure = keep_events(events, error)
                raise failure from failure.reason

    def _use_sample(self, sample: Sample) -> list[Event]:
        """Add a sample of any site and return the events."""
        if sample.quat is not None:
            sample = _with_sound_attitude(sample, sample.quat)
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
        if known_tracker is None and (tracker.t is not None or tracker.stuck.held):
            self._add_tracker(tracker)
        if tracker.t is None or (tracker.stuck.held and not events):  # the foot does not use such a sample
            return events
        t: float = sample.t  # declared, because the fields of a compiled Sample have any type
        known_at: float = sample.known_at if sample.known_at > t else t
        if tracker.viewed_at is None or t > tracker.viewed_at:
            tracker.viewed_at = t
        if not events and sample.air_pressure is None:  # nearly always
            view = tracker.view(sample, known_at, False, False, None)
            for following, part in self.awake:
                if not part.idle and (output := part.feed((), view)):
                    self._apply(output, events)
                    self._run_parts(events, view, known_at, following)
                    break
        else:
            stride = any([isinstance(event, StrideTaken) for event in events])
            other = self.feet.get(OTHER[foot])
            other_t = None if other is None else other.viewed_at
            if other is not None:
                other.gait.bearing.alone = tracker.gait.bearing.is_none
            view = tracker.view(sample, known_at, bool(events), stride, other_t)
            moved = self._run_parts(events, view, known_at)
            if moved is not None and self.settings.poses and stride:
                events.append(moved)
        if self.settings.impacts and (impact := tracker.take_impact(t, known_at)) is not None:
            events.append(impact)
        if sample.pressure and (sole := tracker.sole) is not None:
            if self.settings.pressures:
                pressed = sole.make_event(t, known_at, sample.pressure)
                if pressed is not None:
                    events.append(pressed)
            sole.insole.cells = ()
        return events

    def _feed_limb(self, sample: Sample) -> list[Event]:
        """Pass a sample from above the ankle to the parts that use it."""
        site, t = sample.site, sample.t
        if not (abs(t) <= MAX_TIME and abs(sample.known_at) <= MAX_TIME):  # also true for nan
            from ..foot.rejection import rejected, wrong_time

            if (fault := wrong_time(sample)) is not None:
                return [rejected(sample, fault, None)]
        known_at = max(t, sample.known_at)
        events: list[Event] = []
        parts = [part for part in self.parts if site in part.sites]
        for part in parts:
            was_idle = part.idle
            self._apply(part.feed((LimbSampled(sample),), None), events)
            if part.idle is not was_idle:
                self._find_awake()
        if not parts and site not in self.unused:
            self.unused.append(site)
            text = f"recipe {self.settings.recipe.name} has no use for a sensor at the {site.value}"
            events.append(Limitation(t=t, known_at=known_at, site=site, what=text))
        return events

    def _run_parts(
        self, events: list[Event], view: FootView | None, known_at: float, first: int = 0, *, finishing: bool = False
    ) -> WearerMoved | None:
        """Pass `view` and `events` to the parts from number `first` on, in order, and add what they emit.

        Returns the wearer's new position, if a part or the app needs it. When a part raises, ItemError has `events`."""
        moved = None
        try:
            for part in self.parts[first:]:
                received: Sequence[Event] = tuple(events)
                if part.needs_position and moved is None and any([isinstance(event, MOVEMENTS) for event in received]):
                    moved = self._make_moved(known_at)
                if moved is not None and part.needs_position:
                    received = (*received, moved)
                has_sample = view is not None and part.needs_samples and not (first and part.idle)
                if (received or has_sample) and (output := part.feed(received, view)):
                    self._apply(output, events)
                if finishing:
                    self._apply(part.finish(known_at), events)
        except Exception as error:
            if not events:
                raise
            raise keep_events(events, error) from error
        self._find_awake()
        if moved is None and self.settings.poses and any([isinstance(event, StrideTaken) for event in events]):
            moved = self._make_moved(known_at)
        return moved

    def _apply(self, output: Outputs, events: list[Any]) -> None:
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
                    self.feet[item.site.foot].mark_defect(item.defect)
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

    def _reset_parts(self, site: Site) -> None:
        for part in self.parts:
            part.reset(site)
        self._find_awake()

    def _tracker(self, foot: Foot) -> FootTracker:
        """Return the foot's tracker, or a new one, which is not yet added to `feet`."""
        tracker = self.feet.get(foot)
        if tracker is None:
            from ..foot.tracker import FootTracker  # an app starts without it: sensors take seconds to connect

            recipe, calibration = self.settings.recipe, self.settings.calibration
            known = calibration.insole(foot)
            settings = FootSettings(
                self.settings.poses,
                recipe.needs_pressure,
                recipe.every_stride,
                calibration.headings.get(foot),
                recipe.insole.calibrated(known),
                known.layout,
            )
            parts: Any = deepcopy((recipe.detector, recipe.corrector, recipe.cues))
            detector, corrector, cues = [
                part.calibrated(foot, calibration) if hasattr(part, "calibrated") else part for part in parts
            ]
            tracker = FootTracker(foot, detector, corrector, cues, settings)
            tracker.counts_losses = SITE_OF_FOOT[foot] not in self.decoders
        return tracker

    def _add_tracker(self, tracker: FootTracker) -> None:
        if tracker.foot not in self.feet:
            self.feet = sort_by_key({**self.feet, tracker.foot: tracker}, Foot)


def sort_by_key(values: dict[_Key, _Value], keys: Iterable[_Key]) -> dict[_Key, _Value]:
    """Return the dict in the order of `keys`, so that results do not depend on which site sent first."""
    return {key: values[key] for key in keys if key in values}


def _with_sound_attitude(sample: Sample, quat: Quat) -> Sample:
    """Return the sample with a unit quaternion, or without attitude if its quaternion has no valid norm."""
    w, x, y, z = quat
    square = w * w + x * x + y * y + z * z
    if 1.0 - 1e-9 < square < 1.0 + 1e-9:
        return sample
    is_sound = SHORTEST_QUAT < square < 1.0 / SHORTEST_QUAT  # not if it is nan
    return evolve(sample, quat=normalise(quat) if is_sound else None)
