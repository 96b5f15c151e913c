"""Counting what a session says, for a summary."""

from __future__ import annotations

from collections import Counter

from attrs import define, field

from ..body.gait.means import GaitMeans
from ..events import (
    ActivityChanged,
    CellsFailed,
    ClockReset,
    Connected,
    Event,
    FeetSwapped,
    FlightClimbed,
    FootFlat,
    FootMoved,
    FootSilent,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    InsoleNeverUnloads,
    LiftRidden,
    Limitation,
    LinkTrouble,
    PacketRejected,
    PacketsDropped,
    PacketsLost,
    SampleGap,
    SampleRejected,
    ScaleSuspect,
    StreamRestarted,
    StreamStale,
    StrideFused,
    StrideTaken,
    ToeOff,
    TouchedDown,
    TurnMade,
)
from ..link.known import KINDS
from ..types import Foot, Packet, Phase, Sample, Site, Turn, Vec3, WalkingMode
from ..wire.error import WireError
from ..wire.fragment import is_fragment, parse_fragment
from .timeline import Timeline

DATED: dict[type[Event], str] = {
    HeelStrike: "heel-strike",
    FootFlat: "foot-flat",
    HeelOff: "heel-off",
    ToeOff: "toe-off",
}
"""The events of a foot's phases, and what they are called."""


EVER = 10**9
"""More strides than anybody takes."""
NAMED = 8
"""Cells that are named one by one."""
MOST_DELAYS = 10_000
"""Of one kind: later ones are not kept."""


def streamed(channel: str) -> bool:
    """Whether samples come on this channel, so that packets of it are counted as come or lost."""
    kind = KINDS.get(channel.partition("/")[0])
    return kind is not None and channel in kind.profile.streams


def whole(packet: Packet) -> bool:
    """Whether a packet of samples, in pieces perhaps, is whole with this one."""
    if not streamed(packet.channel):
        return False
    if packet.channel != "insole/frame" or not is_fragment(packet.data):
        return True
    try:
        return parse_fragment(packet.data).last
    except WireError:
        return False


def _cells(numbers: tuple[int, ...]) -> str:
    """Cells in words: their numbers, or how many they are where nobody would read them all."""
    if len(numbers) > NAMED:
        return f"{len(numbers)} cells"
    return f"cell{'s' * (len(numbers) > 1)} {', '.join(map(str, numbers))}"


@define
class FootTally:
    """What became known of one foot. Lengths in m, times in s."""

    samples: int = 0
    """Samples that were fed, or, of packets, those with a position."""
    first: float | None = None
    last: float | None = None
    gaps: int = 0
    gap_time: float = 0.0
    """From the last sample before to the first after, summed over the gaps."""
    steps: int = 0
    degraded: int = 0
    distance: float = 0.0
    """Sum of the stride lengths."""
    heel_strikes: int = 0
    foot_flats: int = 0
    heel_offs: int = 0
    toe_offs: int = 0
    phase: Phase | None = None
    position: Vec3 | None = None

    def seen(self, t: float) -> None:
        self.samples += 1
        self.first = t if self.first is None else self.first
        self.last = t

    @property
    def rate(self) -> float | None:
        """Samples a second outside gaps."""
        if self.first is None or self.last is None or self.samples < 2:
            return None
        span, intervals = self.last - self.first - self.gap_time, self.samples - 1 - self.gaps
        return intervals / span if span > 0.0 and intervals > 0 else None


@define
class Tally:
    """Counts over a whole recording, or so far."""

    feet: dict[Foot, FootTally] = field(factory=dict)
    packets: int = 0
    came: int = 0
    """Of them, those with samples that were used."""
    first: float | None = None
    last: float | None = None
    lost: Counter[Site] = field(factory=Counter)
    rejected: Counter[tuple[str, str]] = field(factory=Counter)
    """By ("packets" | "samples", reason)."""
    clock_resets: int = 0
    stale: int = 0
    connections: Counter[Site] = field(factory=Counter)
    dropped: int = 0
    """Packets that nobody took in time."""
    restarts: int = 0
    troubles: list[str] = field(factory=list)
    delays: dict[str, list[float]] = field(factory=dict)
    """By gait event: how long after it happened each one was known, s; of the first `MOST_DELAYS`."""
    limitations: list[str] = field(factory=list)
    suspects: list[str] = field(factory=list)
    fused: StrideFused | None = None
    """The last one: how far the wearer came by both feet."""
    modes: Counter[WalkingMode] = field(factory=Counter)
    """Touchdowns by the walking mode that they were in."""
    timeline: Timeline = field(factory=Timeline)
    """What the wearer did when."""
    flights: Counter[bool] = field(factory=Counter)
    """Flights of stairs: upwards (True) and downwards."""
    rides: Counter[bool] = field(factory=Counter)
    """Rides in a lift, as well."""
    turns: Counter[Turn] = field(factory=Counter)
    gait: GaitMeans = field(factory=lambda: GaitMeans(memory=EVER))
    """Of all steady strides, none fading."""
    worn: list[str] = field(factory=list)
    """What is wrong with how sensors are worn, or with their cells; each once."""
    silences: Counter[Foot] = field(factory=Counter)

    @property
    def duration(self) -> float:
        return 0.0 if self.first is None or self.last is None else self.last - self.first

    def foot(self, foot: Foot) -> FootTally:
        return self.feet.setdefault(foot, FootTally())

    def fed(self, t: float) -> None:
        """Something with the time `t` was fed, s."""
        self.first = t if self.first is None else min(self.first, t)
        self.last = t if self.last is None else max(self.last, t)

    def fed_packet(self, packet: Packet) -> None:
        self.fed(packet.t)
        self.packets += 1
        self.came += whole(packet)

    def fed_sample(self, sample: Sample) -> None:
        self.fed(sample.t)
        if (foot := sample.site.foot) is not None:
            self.foot(foot).seen(sample.t)

    def add(self, event: Event) -> None:
        name = DATED.get(type(event))
        if name is not None and event.final and len(known := self.delays.setdefault(name, [])) < MOST_DELAYS:
            known.append(event.known_at - event.t)
        match event:
            case FootMoved():
                one = self.foot(event.foot)
                one.phase, one.position = event.phase, event.position
                if self.packets:
                    one.seen(event.t)
            case StrideTaken(final=True):
                one = self.foot(event.foot)
                one.steps += 1
                one.degraded += event.degraded
                one.distance += event.length
            case HeelStrike(foot=foot, final=True):
                self.foot(foot).heel_strikes += 1
            case FootFlat(foot=foot, final=True):
                self.foot(foot).foot_flats += 1
            case HeelOff(foot=foot, final=True):
                self.foot(foot).heel_offs += 1
            case ToeOff(foot=foot, final=True):
                self.foot(foot).toe_offs += 1
            case SampleGap(site=site, duration=duration) if site.foot is not None:
                self.foot(site.foot).gaps += 1
                self.foot(site.foot).gap_time += duration
            case PacketRejected(reason=reason, channel=channel):
                self.came -= streamed(channel) and self.came > 0
                self.rejected["packets", reason.value] += 1
            case SampleRejected(reason=reason):
                self.rejected["samples", reason.value] += 1
            case PacketsLost(site=site, count=count):
                self.lost[site] += count
            case ClockReset():
                self.clock_resets += 1
            case StreamStale():
                self.stale += 1
            case Connected(site=site):
                self.connections[site] += 1
            case PacketsDropped(count=count):
                self.dropped += count
            case StreamRestarted():
                self.restarts += 1
            case LinkTrouble(site=site, what=what):
                told = f"{site.words}: {what}"
                if told not in self.troubles:
                    self.troubles.append(told)
            case Limitation(site=site, what=what):
                self.limitations.append(what if site is None else f"{site.words}: {what}")
            case ScaleSuspect(site=site, magnitude=magnitude, suggestion=suggestion):
                told = f": {suggestion}" if suggestion else ""
                self.suspects.append(f"{site.words}: |acc| is {magnitude:.2f} m/s^2 at rest{told}")
            case GaitCycleMeasured():
                self.gait.hear(event)
            case StrideFused(final=True):
                self.fused = event
            case TouchedDown(mode=mode, final=True):
                self.modes[mode] += 1
            case ActivityChanged():
                self.timeline.add(event)
            case FlightClimbed(up=up, final=True):
                self.flights[up] += 1
            case LiftRidden(up=up, final=True):
                self.rides[up] += 1
            case TurnMade(turn=turn, final=True) if turn is not None:
                self.turns[turn] += 1
            case CellsFailed(site=site, fault=fault, cells=cells):
                self._wrong(f"{site.words}: {_cells(cells)} {fault.value}, left out")
            case InsoleNeverUnloads(site=site):
                self._wrong(f"{site.words}: the insole never unloads; phases come from the inertial sensor")
            case FeetSwapped():
                self._wrong("the feet look swapped: what comes as the left one is like a right one")
            case FootSilent(foot=foot):
                self.silences[foot] += 1
            case _:
                pass

    def _wrong(self, told: str) -> None:
        if told not in self.worn:
            self.worn.append(told)
