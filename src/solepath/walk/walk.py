"""One walk: counts and keeps what a session was fed and what it reported, for every kind of output.

    walk = Walk()
    walk.take(packet, session.feed(packet))
    walk.take(None, session.finish())

Terminal, summary, files, page, report, outcomes and scores all read it; links.py defines the figures of links. An item
is a packet or a sample. Its events show whether it was used, so the session tells each trouble by itself
(`Session(losses=True)`); of other sessions, what was received is not exact. Numbers without a source were chosen by
hand and not swept."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Sequence
from math import inf

from attrs import define, evolve, field, frozen

from ..body.gait.means import GaitMeans, as_found
from ..events import (
    ActivityChanged,
    CellsFailed,
    ClockReset,
    Connected,
    DefectFound,
    EscalatorRidden,
    Event,
    FeetSwapped,
    Flaw,
    FlightClimbed,
    FootFlat,
    FootMoved,
    FootPressed,
    FootResumed,
    FootSilent,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    InsoleNeverUnloads,
    LayoutKnown,
    LiftRidden,
    Limitation,
    LinkTrouble,
    PacketRejected,
    Placed,
    PlaceLost,
    SampleGap,
    SampleRejected,
    StreamStale,
    StrideFused,
    StrideTaken,
    ToeOff,
    TouchedDown,
    TurnMade,
    WearerMoved,
)
from ..link.decoder import Decoder
from ..link.health import is_frame_fragment, is_sample_channel
from ..link.kinds import BUILT_IN_KINDS, DeviceKinds
from ..types import SITE_OF_FOOT, Foot, Packet, Phase, Sample, Site, Turn, Vec2, Vec3, WalkingMode
from ..types.attrs import NOT_SAVED
from .links import NO_DEVICE, SET_BACK_TOLERANCE, CoveredTime, LinkLedger
from .places import PlaceCounts
from .soles import SoleLoads
from .thinned import T, ThinnedList
from .timeline import Timeline
from .valid import has_valid_numbers
from .way import way_of

GAIT_EVENTS: dict[type[Event], str] = {
    HeelStrike: "heel-strike",
    FootFlat: "foot-flat",
    HeelOff: "heel-off",
    ToeOff: "toe-off",
}
"""Events that start the phases of a foot, with their names."""
REJECTIONS = (PacketRejected, SampleRejected)
"""Events of packets and samples that were not used; they do not advance the time."""
UNLIMITED_STRIDES = 10**9
"""Memory of the running means, in strides, that no walk reaches, so that all strides have equal weights."""
FAULTS = (DefectFound, CellsFailed, InsoleNeverUnloads, FeetSwapped, FootSilent, LinkTrouble, Limitation)
"""Events that say what is wrong."""
MAX_FAULTS = 300
"""Largest number of different faults that are kept; later ones are left out."""
MAX_ACTIVITY_CHANGES = 2000
"""Largest number of activity changes that are kept; with more, the shortest activities are left out."""
LIMIT = 1200
"""Largest number of strides of a foot, and of other things that are kept, where a walk may last all day."""
LEAST_ABSENCE = 1.0
"""Least time without samples that is kept, s: the shortest after which a device counts as silent (Profile.stale_after);
a stride bridges a shorter one."""
MAX_CANDIDATES = 40
"""Largest number of candidates of a place; those with the largest weights are kept."""
MAX_POINTS = 1500
"""Largest number of points of a drawn line; a walk of any length has no more."""


def _of_each_foot() -> dict[Foot, ThinnedList[T]]:
    return {foot: ThinnedList() for foot in Foot}


@define
class FootCounts:
    """The counts of one foot from the start until now, or since its data were wrong.

    A foot whose data cannot be right (`Walk.spoilt_feet`) counts nothing but phases and positions."""

    strides: int = 0
    """Number of final strides."""
    degraded: int = 0
    """Number of final strides that are degraded."""
    flaws: Counter[Flaw] = field(factory=Counter)
    """Number of final strides with each flaw."""
    distance: float = 0.0
    """Sum of the stride lengths, m."""
    events: Counter[str] = field(factory=Counter)
    """Number of final events of each kind, by its name in GAIT_EVENTS."""
    phase: Phase | None = None
    start: Vec3 | None = None
    """First position, world frame, m."""
    position: Vec3 | None = None
    """Live position, world frame, m."""


@define
class Fault:
    """Something that is wrong, as the newest event says it."""

    event: Event
    """One of FAULTS."""
    count: int = 1
    """Number of events that said it."""
    holds: bool = True
    """False once another device is connected there, its clock restarts, or the foot that was silent sends again."""


@frozen
class Remark:
    """What reading a recording showed to be wrong with it, in words, before any session."""

    code: str
    """Name, such as "rows_damaged"."""
    what: str
    act: bool = False
    """True if results are wrong until somebody acts."""


@define
class Walk:
    """The counts of a session from its start until now, and what it reported.

    The session is made with `poses=True`, and with `pressures=True` for the loads of the soles. Of strides, gait
    cycles, turns and places at most `limit` of each foot are kept, evenly thinned, so that memory is bounded. With None
    all are kept, as outcomes and scores need them; with 0 none, so that a walk that is saved often is small. An event
    with a number that is not finite is left out."""

    limit: int | None = LIMIT
    keeps_all: bool = False
    """True to keep every position of the feet, gait event and activity as well, as scores need them, and the strides of
    a foot whose data cannot be right."""
    kinds: DeviceKinds | None = field(default=None, metadata=NOT_SAVED, repr=False)
    """Devices of the session (`make_kinds`); None if an app has added none."""
    item_count: int = 0
    """Number of items that were fed, used or not."""
    now: float = -inf
    """Latest known moment, s; it goes back when a clock is set back."""
    covered_time: CoveredTime = field(factory=CoveredTime)
    """Time from the first to the last used item, s: for packets by their arrivals, for samples by their own times."""
    links: dict[Site, LinkLedger] = field(factory=dict)
    """Ledger of every site that has sent anything."""
    feet: dict[Foot, FootCounts] = field(factory=dict)
    track: dict[Foot, ThinnedList[Vec2]] = field(factory=_of_each_foot)
    """Live positions of each foot, world frame, m, evenly thinned: for a small picture."""
    timeline: Timeline = field(factory=Timeline)
    """Activities of the wearer over time."""
    gait: GaitMeans = field(factory=GaitMeans)
    """Means of all steady strides, with equal weights."""
    recent_gait: GaitMeans = field(factory=GaitMeans)
    """Means of the steady strides as in `Session.gait`, in which older strides weigh less."""
    places: PlaceCounts = field(factory=PlaceCounts)
    fused: StrideFused | None = None
    """The last StrideFused: the distance walked by both feet."""
    modes: Counter[WalkingMode] = field(factory=Counter)
    """Number of touchdowns in each walking mode."""
    touchdown: TouchedDown | None = None
    """The last TouchedDown, final or not."""
    flights: Counter[bool] = field(factory=Counter)
    """Number of flights of stairs upwards (True) and downwards (False)."""
    elevator_rides: Counter[bool] = field(factory=Counter)
    """Number of elevator rides upwards (True) and downwards (False)."""
    escalator_rides: Counter[bool] = field(factory=Counter)
    """Number of rides on escalators, standing, upwards (True) and downwards (False)."""
    turns: Counter[Turn] = field(factory=Counter)
    remarks: list[Remark] = field(factory=list)
    """What is wrong with the recording as it was read; whoever reads it sets them."""
    faults: dict[str, Fault] = field(factory=dict)
    """What is wrong: a fault for each defect of a site, and for each thing that another event says."""
    strides: dict[Foot, ThinnedList[StrideTaken]] = field(factory=_of_each_foot)
    """Final strides, from foot-flat to foot-flat."""
    distances: dict[Foot, ThinnedList[tuple[float, float]]] = field(factory=_of_each_foot)
    """Pairs of the end of a stride, s, and the distance that the foot has gone until then, m."""
    cycles: dict[Foot, ThinnedList[GaitCycleMeasured]] = field(factory=_of_each_foot)
    """Gait cycles, from initial contact to initial contact."""
    newest_cycles: deque[GaitCycleMeasured] = field(factory=lambda: deque(maxlen=2 * LIMIT))
    """Newest gait cycles of both feet, in their order, from which the differences between the feet follow."""
    made_turns: ThinnedList[TurnMade] = field(factory=ThinnedList)
    absences: ThinnedList[SampleGap | FootSilent | StreamStale] = field(factory=ThinnedList)
    """Times of LEAST_ABSENCE and more in which a sensor sent nothing."""
    rides: ThinnedList[LiftRidden] = field(factory=ThinnedList)
    """Final elevator rides."""
    wearer_track: ThinnedList[WearerMoved] = field(factory=ThinnedList)
    placed: ThinnedList[Placed | PlaceLost] = field(factory=ThinnedList)
    soles: dict[Foot, SoleLoads] = field(factory=dict)
    sample_span: tuple[float, float] | None = None
    """Times of the first and the last sample that the session reported, s."""
    event_span: tuple[float, float] | None = None
    """Times of the earliest and the latest event, s."""
    positions: dict[Foot, list[FootMoved]] = field(factory=lambda: {foot: [] for foot in Foot})
    """All live positions of each foot; empty unless `keeps_all`."""
    times: dict[Foot, dict[str, list[float]]] = field(
        factory=lambda: {foot: {name: [] for name in GAIT_EVENTS.values()} for foot in Foot}
    )
    """Times of the final events of each foot, s, by their names in GAIT_EVENTS; empty unless `keeps_all`."""
    activities: list[ActivityChanged] = field(factory=list)
    """Activities in the order in which they were reported; empty unless `keeps_all`."""
    _other_decoders: dict[Site, Decoder] = field(factory=dict)
    """Decoders that count the samples of sites for whose samples the session has no event.

    These are other sites than feet, and a foot whose sensors are too few for its recipe."""

    @classmethod
    def of(cls, events: Iterable[Event]) -> Walk:
        """Return a walk of these events that keeps all; what the session was fed is not counted."""
        walk = cls(limit=None, keeps_all=True)
        for event in events:
            walk.add(event)
        return walk

    def take(self, item: Packet | Sample | None, events: Sequence[Event], returned_at: float | None = None) -> None:
        """Add an item that the session was fed, and the events that it returned at `returned_at`, s, packets' clock.

        None as the item means that nothing came: time passed or the session ended."""
        for event in events:
            self.add(event)
        self.count_item(item, events, returned_at)

    def count_item(
        self, item: Packet | Sample | None, events: Sequence[Event], returned_at: float | None = None
    ) -> None:
        """Count an item after its events, which show whether it was used and how late it was."""
        for event in events:
            if isinstance(event, HeelStrike | ToeOff) and has_valid_numbers(event):
                self.link(SITE_OF_FOOT[event.foot]).delays.add(event, returned_at)
        if item is None:
            return
        self.item_count += 1
        if isinstance(item, Packet) and item.channel.partition("/")[0] not in NO_DEVICE:
            self.link(item.site).packets += 1
        rejection = PacketRejected if isinstance(item, Packet) else SampleRejected
        if any([isinstance(event, rejection) for event in events]):
            return
        self.covered_time.add(item.t)
        self.advance(item.t)
        if isinstance(item, Sample):
            self.link(item.site).add_sample(item.t, item.t if item.known_at is None else item.known_at)
            return
        link, kinds = self.links.get(item.site), self.kinds or BUILT_IN_KINDS
        has_samples = any([isinstance(event, FootMoved | FootPressed) for event in events])
        if link is None or not (link.has_motion or link.has_pressure):
            decoder = self._other_decoders.setdefault(item.site, Decoder(item.site))
            for record in decoder.feed(item, kinds):
                if isinstance(record, Sample) and any((record.acc, record.gyro, record.pressure, record.quat)):
                    self.link(item.site).add_sample(record.t, item.t)
                    has_samples = True
        if is_sample_channel(item.channel, kinds) and (has_samples or not is_frame_fragment(item)):
            self.link(item.site).add_packet(item.t)

    def advance(self, now: float) -> None:
        """Advance the time to `now`, s, on the clock of the packets."""
        if self.now < now < inf:
            self.now = now

    def add(self, event: Event) -> bool:
        """Count the next event of the session; return False if it is left out, for a number that is not finite."""
        if not has_valid_numbers(event):
            return False
        self.count(event)
        return True

    def count(self, event: Event) -> None:
        """Count the next event of the session, all of whose numbers are finite."""
        if not isinstance(event, REJECTIONS):
            self.advance(event.known_at)
        self.event_span = _extend(self.event_span, event.t)
        match event:
            case FootMoved(t=t, known_at=known_at, foot=foot, position=position):
                counts, link = self.foot(foot), self.link(SITE_OF_FOOT[foot])
                counts.phase, counts.position = event.phase, position
                counts.start = counts.start or position
                link.add_sample(t, known_at)
                link.has_motion = True
                self.track[foot].add(position[:2], self._point_limit)
                if self.keeps_all:
                    self.positions[foot].append(event)
                self.sample_span = _extend(self.sample_span, t)
            case FootPressed(t=t, known_at=known_at, foot=foot):
                link = self.link(SITE_OF_FOOT[foot])
                link.add_sample(t, known_at)
                link.has_pressure = True
                self.sample_span = _extend(self.sample_span, t)
                if self.limit != 0:
                    self.sole(foot).add_sample(event)
            case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                self._count_gait_event(event)
            case _:
                site = getattr(event, "site", None)
                if site is not None:
                    self.link(site).add_event(event, self.now)
                self._count_event(event)
                self._add_fault(event)
                self.places.add(event)

    @property
    def _point_limit(self) -> int:
        """Largest number of points of a line that are kept."""
        return 0 if self.limit == 0 else MAX_POINTS

    def link(self, site: Site) -> LinkLedger:
        """Return the ledger of a site; it is made on first use."""
        ledger = self.links.get(site)
        if ledger is None:
            ledger = self.links[site] = LinkLedger(is_counted=site.foot is not None)
        return ledger

    def foot(self, foot: Foot) -> FootCounts:
        """Return the counts of a foot; they are made on first use."""
        counts = self.feet.get(foot)
        if counts is None:
            counts = self.feet[foot] = FootCounts()
        return counts

    def sole(self, foot: Foot) -> SoleLoads:
        """Return the loads of a foot's sole; they are made on first use."""
        return self.soles.setdefault(foot, SoleLoads())

    def _count_gait_event(self, event: HeelStrike | FootFlat | HeelOff | ToeOff) -> None:
        if event.final and self._counts(event.foot):
            name = GAIT_EVENTS[type(event)]
            self.foot(event.foot).events[name] += 1
            if self.keeps_all:
                self.times[event.foot][name].append(event.t)

    def _count_event(self, event: Event) -> None:
        match event:
            case StrideTaken() | GaitCycleMeasured() if not self._counts(event.foot):
                pass
            case StrideTaken(final=True):
                counts = self.foot(event.foot)
                counts.strides += 1
                counts.degraded += event.degraded
                counts.flaws.update(event.flaws)
                counts.distance += event.length
                self.strides[event.foot].add(event, self.limit)
                self.distances[event.foot].add((event.t, counts.distance), self.limit)
            case GaitCycleMeasured():
                self.gait.add(event, UNLIMITED_STRIDES)
                self.recent_gait.add(event)
                self.cycles[event.foot].add(event, self.limit)
                if self.limit != 0:
                    self.newest_cycles.append(event)
                    self.sole(event.foot).add_cycle(event)
            case ClockReset(known_at=known_at) if known_at < self.now - SET_BACK_TOLERANCE:
                self.now = known_at
            case ActivityChanged():
                self.timeline.add(event, None if self.keeps_all else MAX_ACTIVITY_CHANGES)
                if self.keeps_all:
                    self.activities.append(event)
            case StrideFused(final=True):
                self.fused = event
            case TouchedDown(mode=mode, final=final):
                self.touchdown = event
                if final:
                    self.modes[mode] += 1
            case FlightClimbed(up=up, final=True):
                self.flights[up] += 1
            case LiftRidden(up=up, final=True):
                self.elevator_rides[up] += 1
                self.rides.add(event, self.limit)
            case EscalatorRidden(up=up, final=True):
                self.escalator_rides[up] += 1
            case TurnMade(turn=turn, final=True):
                self.made_turns.add(event, self.limit)
                if turn is not None:
                    self.turns[turn] += 1
            case WearerMoved():
                self.wearer_track.add(event, self._point_limit)
            case Placed() | PlaceLost():
                self.placed.add(event if self.keeps_all else _with_heaviest(event), self.limit)
            case SampleGap(longest=longest) if longest >= LEAST_ABSENCE:
                self.absences.add(event, self.limit)
            case FootSilent() | StreamStale():
                self.absences.add(event, self.limit)
            case LayoutKnown(site=site, layout=layout) if site.foot is not None and self.limit != 0:
                self.sole(site.foot).layout = layout
            case _:
                pass

    def _add_fault(self, event: Event) -> None:
        """Add what is wrong, or note that it does not hold any more.

        A foot is not silent when what comes of it is rejected: its link says that."""
        if isinstance(event, FootSilent) and (link := self.link(SITE_OF_FOOT[event.foot])).still_rejects(self.now):
            link.rejected_all = True
        elif isinstance(event, FAULTS):
            names = ("defect", "fault", "cells") if isinstance(event, DefectFound | CellsFailed) else ("what",)
            key = " ".join([type(event).__name__, *[str(getattr(event, name, "")) for name in names]])
            key = f"{key} {site_of(event)}"
            if (known := self.faults.get(key)) is not None:
                self.faults[key] = Fault(event, known.count + 1)
            elif len(self.faults) < MAX_FAULTS:
                self.faults[key] = Fault(event)
            if isinstance(event, DefectFound) and event.separates_feet:
                self._withhold(event)
        elif isinstance(event, FootResumed | Connected) or isinstance(event, ClockReset) and event.restarted:
            for fault in self.faults.values():
                if site_of(fault.event) is site_of(event):
                    fault.holds &= isinstance(event, FootResumed) and not isinstance(fault.event, FootSilent)

    def _withhold(self, found: DefectFound) -> None:
        """Forget what a defect makes wrong: all of a foot whose data cannot be right, and what compares the feet."""
        if (foot := found.spoilt_foot) is not None and not self.keeps_all:
            if (counts := self.feet.get(foot)) is not None:
                self.feet[foot] = FootCounts(phase=counts.phase, start=counts.start, position=counts.position)
            self.strides[foot], self.distances[foot], self.cycles[foot] = ThinnedList(), ThinnedList(), ThinnedList()
        self.gait.withhold(found)
        self.recent_gait.withhold(found)
        for cycles in self.cycles.values():
            cycles.change(lambda cycle: as_found(cycle, found))
        for _ in range(len(self.newest_cycles)):
            self.newest_cycles.append(as_found(self.newest_cycles.popleft(), found))

    def _counts(self, foot: Foot) -> bool:
        """Return whether what a foot did counts."""
        return self.keeps_all or foot not in self.spoilt_feet

    @property
    def way(self) -> Sequence[WearerMoved | StrideTaken]:
        """Track of the wearer or, if it is not known, of the foot with the most strides, from its first step on."""
        return way_of({foot: list(kept) for foot, kept in self.strides.items()}, list(self.wearer_track))

    @property
    def spoilt_feet(self) -> list[Foot]:
        """Feet whose data cannot be right now: they give no strides, gait, distance or comparison of the feet."""
        found = [one.event for one in self.faults.values() if one.holds and isinstance(one.event, DefectFound)]
        return [foot for foot in Foot if any([one.spoilt_foot is foot for one in found])]

    @property
    def measured_feet(self) -> list[Foot]:
        """Feet that the figures of the walk are of: those with data that were right all the time."""
        spoilt = {one.spoilt_foot for one in self.found_defects}
        return [foot for foot in self.known_feet if foot not in spoilt]

    @property
    def found_defects(self) -> list[DefectFound]:
        """Newest report of each defect of each site."""
        return [fault.event for fault in self.faults.values() if isinstance(fault.event, DefectFound)]

    @property
    def is_useless(self) -> bool:
        """True if items were rejected, and no packet or sample of a sensor was used."""
        links = self.links.values()
        return any([one.rejected for one in links]) and not any([one.received or one.samples for one in links])

    @property
    def known_feet(self) -> list[Foot]:
        """Feet with any count or sample."""
        return [foot for foot in Foot if foot in self.feet or self.samples(foot)]

    def has_strides(self, foot: Foot) -> bool:
        """Return whether strides and distance of a foot can be known: pressure cells alone show contacts and no way."""
        link = self.links.get(SITE_OF_FOOT[foot])
        return link is None or link.has_motion or self.feet.get(foot, FootCounts()).strides > 0

    def samples(self, foot: Foot) -> int:
        """Return the number of used samples of a foot."""
        link = self.links.get(SITE_OF_FOOT[foot])
        return 0 if link is None else link.samples


def _with_heaviest(event: Placed | PlaceLost) -> Placed | PlaceLost:
    """Return the event with at most MAX_CANDIDATES candidates, which are in the order of their weights."""
    if isinstance(event, Placed) and len(event.candidates) > MAX_CANDIDATES:
        return evolve(event, candidates=event.candidates[:MAX_CANDIDATES])
    return event


def _extend(span: tuple[float, float] | None, t: float) -> tuple[float, float]:
    return (t, t) if span is None else (min(span[0], t), max(span[1], t))


def site_of(event: Event) -> Site | None:
    """Return the site that an event is about; None for both feet, or for the whole session."""
    foot: Foot | None = getattr(event, "foot", None)
    site: Site | None = getattr(event, "site", None) if foot is None else SITE_OF_FOOT[foot]
    return site
