"""Counts what a session was fed and what it reported, for all who show it.

    observer = Observer()
    observer.take(packet, session.feed(packet))
    observer.take(None, session.finish())

Terminal, summary, page and report read from it. links.py defines what counts as lost or rejected, and what a rate is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from math import inf

from attrs import define, field

from ..body.gait.means import GaitMeans
from ..events import (
    ActivityChanged,
    CellsFailed,
    ClockReset,
    Event,
    FeetSwapped,
    FlightClimbed,
    FootFlat,
    FootMoved,
    FootPressed,
    FootSilent,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    InsoleNeverUnloads,
    LiftRidden,
    Limitation,
    LinkTrouble,
    PacketRejected,
    SampleRejected,
    ScaleSuspect,
    StrideFused,
    StrideTaken,
    ToeOff,
    TouchedDown,
    TurnMade,
)
from ..link.decoder import Decoder
from ..types import SITE_OF_FOOT, Foot, Packet, Phase, Sample, Site, Turn, Vec3, WalkingMode
from .links import SET_BACK, CoveredTime, LinkLedger, is_frame_fragment, is_sample_channel
from .places import PlaceCounts
from .timeline import Timeline
from .track import LiveTrack
from .valid import has_valid_numbers

GAIT_EVENTS: dict[type[Event], str] = {
    HeelStrike: "heel-strike",
    FootFlat: "foot-flat",
    HeelOff: "heel-off",
    ToeOff: "toe-off",
}
"""Events that start the phases of a foot, with their names."""
REJECTIONS = (PacketRejected, SampleRejected)
"""Events that change nothing, and are no sign that time passes either."""
ALL_STRIDES = 10**9
"""More strides than anybody takes, so that the means are over all of them."""
MOST_NAMED_CELLS = 8
"""Cells that a sentence names one by one at the most."""
MOST_SENTENCES = 100
"""Different sentences of one kind that are kept; later ones are not."""
MOST_CHANGES = 2000
"""Changes of activity that are kept; of more, the shortest activities are left out."""


@define
class FootCounts:
    """Counts of one foot from the start until now."""

    strides: int = 0
    """Number of final strides."""
    degraded: int = 0
    """Number of final strides with missing or saturated samples."""
    distance: float = 0.0
    """Sum of the stride lengths, m."""
    events: Counter[type[Event]] = field(factory=Counter)
    """Number of final events of each kind in GAIT_EVENTS."""
    phase: Phase | None = None
    position: Vec3 | None = None
    """Live position, world frame, m."""


@define
class Observer:
    """Counts over a session from its start until now.

    The session is made with `poses=True`. Memory is bounded. An event that holds a number that is not finite is left
    out."""

    items: int = 0
    """Packets and samples that were fed, used or not."""
    now: float = -inf
    """Latest known moment, s; after a clock was set back, by that clock."""
    time: CoveredTime = field(factory=CoveredTime)
    """Time from the first to the last packet or sample that was used, s. Packets count by their arrival, samples that
    never were packets by their own time."""
    links: dict[Site, LinkLedger] = field(factory=dict)
    """Ledger of every site of which anything came."""
    feet: dict[Foot, FootCounts] = field(factory=dict)
    track: LiveTrack = field(factory=LiveTrack)
    timeline: Timeline = field(factory=Timeline)
    """Activities of the wearer over time."""
    gait: GaitMeans = field(factory=GaitMeans)
    """Means of all steady strides, with equal weights."""
    recent_gait: GaitMeans = field(factory=GaitMeans)
    """Means of the steady strides as `Session.gait` has them: old strides fade."""
    places: PlaceCounts = field(factory=PlaceCounts)
    fused: StrideFused | None = None
    """The last StrideFused: how far the wearer went by both feet."""
    modes: Counter[WalkingMode] = field(factory=Counter)
    """Number of touchdowns in each walking mode."""
    flights: Counter[bool] = field(factory=Counter)
    """Number of flights of stairs upwards (True) and downwards (False)."""
    rides: Counter[bool] = field(factory=Counter)
    """Number of rides in a lift upwards (True) and downwards (False)."""
    turns: Counter[Turn] = field(factory=Counter)
    delays: dict[type[Event], Counter[int]] = field(factory=lambda: {kind: Counter() for kind in GAIT_EVENTS})
    """For each gait event, how often it was known so many tenths of a millisecond after it happened."""
    limitations: list[str] = field(factory=list)
    """Limitations of the session; each sentence stands once, here and in the three lists that follow."""
    suspect_scales: list[str] = field(factory=list)
    """Sentences on accelerometers whose scale cannot be right."""
    wear_problems: list[str] = field(factory=list)
    """Sentences on how sensors are worn wrongly, or on faulty cells."""
    troubles: list[str] = field(factory=list)
    """Sentences on what the receiver could not do."""
    silences: Counter[Foot] = field(factory=Counter)
    """Number of times at which nothing came of a foot while the other one walked on."""
    _other_decoders: dict[Site, Decoder] = field(factory=dict)
    """Decoders that count the samples of sites that are not feet, since a session reports nothing of them."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add what the session was fed and the events that it returned for it.

        An item of None means that nothing came: time passed or the session ended."""
        self.count_item(item, events)
        for event in events:
            self.add(event)

    def count_item(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Count the item alone, the first half of `take`; `events` say whether it was used, and `add` takes them."""
        if item is None:
            return
        self.items += 1
        rejection = PacketRejected if isinstance(item, Packet) else SampleRejected
        if any([isinstance(event, rejection) for event in events]):
            return
        self.time.add(item.t)
        self.advance(item.t)
        if isinstance(item, Sample):
            self.link(item.site).add_sample(item.t, item.t if item.known_at is None else item.known_at)
            return
        has_samples = any([isinstance(event, FootMoved | FootPressed) for event in events])
        if is_sample_channel(item.channel) and (has_samples or not is_frame_fragment(item)):
            self.link(item.site).add_packet(item.t)
        if item.site.foot is None:
            decoder = self._other_decoders.setdefault(item.site, Decoder(item.site))
            for one in decoder.feed(item):
                if isinstance(one, Sample):
                    self.link(item.site).add_sample(one.t, item.t)

    def advance(self, now: float) -> None:
        """Advance the time to `now` s on the clock of the packets, whether or not anything came."""
        if self.now < now < inf:
            self.now = now

    def add(self, event: Event) -> bool:
        """Add the next event of the session, in the order of reporting; return False when it is left out."""
        if not has_valid_numbers(event):
            return False
        if not isinstance(event, REJECTIONS):
            self.advance(event.known_at)
        match event:
            case FootMoved(t=t, known_at=known_at, foot=foot, position=position):
                one, link = self.foot(foot), self.link(SITE_OF_FOOT[foot])
                one.phase, one.position = event.phase, position
                link.add_sample(t, known_at)
                link.has_motion = True
                self.track.add(foot, position[0], position[1])
            case FootPressed(t=t, known_at=known_at, foot=foot):
                link = self.link(SITE_OF_FOOT[foot])
                link.add_sample(t, known_at)
                link.has_pressure = True
            case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                self._phase(event)
            case _:
                site = getattr(event, "site", None)
                if site is not None:
                    self.link(site).add_event(event)
                self._count(event)
                self._note(event)
                self.places.add(event)
        return True

    def link(self, site: Site) -> LinkLedger:
        """Return the ledger of a site, a new one where there is none."""
        found = self.links.get(site)
        if found is None:
            found = self.links[site] = LinkLedger(counted=site.foot is not None)
        return found

    def foot(self, foot: Foot) -> FootCounts:
        """Return the counts of a foot, new ones where there are none."""
        return self.feet.setdefault(foot, FootCounts())

    def _phase(self, event: HeelStrike | FootFlat | HeelOff | ToeOff) -> None:
        if event.final:
            self.foot(event.foot).events[type(event)] += 1
            self.delays[type(event)][round(1e4 * (event.known_at - event.t))] += 1

    def _count(self, event: Event) -> None:
        match event:
            case StrideTaken(final=True):
                one = self.foot(event.foot)
                one.strides += 1
                one.degraded += event.degraded
                one.distance += event.length
            case GaitCycleMeasured():
                self.gait.add(event, ALL_STRIDES)
                self.recent_gait.add(event)
            case ClockReset(known_at=known_at) if known_at < self.now - SET_BACK:
                self.now = known_at
            case ActivityChanged():
                self.timeline.add(event, MOST_CHANGES)
            case StrideFused(final=True):
                self.fused = event
            case TouchedDown(mode=mode, final=True):
                self.modes[mode] += 1
            case FlightClimbed(up=up, final=True):
                self.flights[up] += 1
            case LiftRidden(up=up, final=True):
                self.rides[up] += 1
            case TurnMade(turn=turn, final=True) if turn is not None:
                self.turns[turn] += 1
            case FootSilent(foot=foot):
                self.silences[foot] += 1
            case _:
                pass

    def _note(self, event: Event) -> None:
        """Keep a sentence on a fault, once."""
        match event:
            case LinkTrouble(site=site, what=what):
                _add_once(self.troubles, f"{site.words}: {what}")
            case Limitation(site=site, what=what):
                _add_once(self.limitations, what if site is None else f"{site.words}: {what}")
            case ScaleSuspect(site=site, magnitude=magnitude, suggestion=suggestion):
                more = f": {suggestion}" if suggestion else ""
                _add_once(self.suspect_scales, f"{site.words}: |acc| is {magnitude:.2f} m/s^2 at rest{more}")
            case CellsFailed(site=site, fault=fault, cells=cells):
                _add_once(self.wear_problems, f"{site.words}: {_cell_words(cells)} {fault.value}, left out")
            case InsoleNeverUnloads(site=site):
                _add_once(
                    self.wear_problems, f"{site.words}: the insole never unloads; phases come from the inertial sensor"
                )
            case FeetSwapped():
                _add_once(self.wear_problems, "the feet look swapped: what comes as the left one is like a right one")
            case _:
                pass

    @property
    def known_feet(self) -> list[Foot]:
        """Feet of which anything is known."""
        return [foot for foot in Foot if foot in self.feet or self.samples(foot)]

    def samples(self, foot: Foot) -> int:
        """Return the number of samples of a foot that were used."""
        link = self.links.get(SITE_OF_FOOT[foot])
        return 0 if link is None else link.samples


def _add_once(sentences: list[str], one: str) -> None:
    if one not in sentences and len(sentences) < MOST_SENTENCES:
        sentences.append(one)


def _cell_words(numbers: tuple[int, ...]) -> str:
    """Return the cells in words: their numbers, or how many they are when there are too many to name."""
    if len(numbers) > MOST_NAMED_CELLS:
        return f"{len(numbers)} cells"
    return f"cell{'s' * (len(numbers) > 1)} {', '.join(map(str, numbers))}"
