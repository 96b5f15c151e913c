"""Turns events into the sentences of a page's log, for a wearer or a clinician."""

from __future__ import annotations

from math import degrees

from attrs import define, field

from ....events import (
    ActivityChanged,
    BatteryLevel,
    CellsFailed,
    ClockReset,
    Connected,
    DefectFound,
    Disconnected,
    Event,
    FeetSwapped,
    FlightClimbed,
    FootResumed,
    FootSilent,
    InsoleNeverUnloads,
    LiftRidden,
    Limitation,
    LinkTrouble,
    PacketsDropped,
    PlaceLost,
    PlanContradicted,
    PositionRejected,
    StreamRestarted,
    StreamResumed,
    StreamStale,
    TrackRevised,
    TurnMade,
)
from ....recording import printable
from ....types import SITE_OF_FOOT, Activity, Turn
from ....walk.walk import Walk
from ..messages import rounded
from .links import fault_words
from .lists import RecentItems
from .reports import outcome_words

MAX_LINES = 50
LOW_BATTERY = 0.15
"""Charge, 0 to 1, at or below which the log reports the battery; chosen by hand."""
TURNS = {Turn.LEFT: "turned left", Turn.RIGHT: "turned right", Turn.ABOUT: "turned about"}

LogLine = tuple[float | None, str, str]
"""(t, kind, sentence), t in s."""


@define
class SceneLog:
    """The log of a page: the newest MAX_LINES sentences on events."""

    lines: RecentItems[LogLine] = field(factory=lambda: RecentItems(MAX_LINES))

    def add_event(self, event: Event, walk: Walk) -> None:
        """Add the line of an event, if it has one and the log does not say the same already.

        `walk` has not counted the event yet."""
        line = sentence(event)
        if line is None:
            return
        if isinstance(event, FootSilent) and walk.link(SITE_OF_FOOT[event.foot]).state(walk.now) != "ok":
            return
        if isinstance(event, BatteryLevel):
            level = walk.link(event.site).battery
            if level is not None and level <= LOW_BATTERY:
                return
        self.add(event.t, *line)

    def add(self, t: float, kind: str, text: str) -> None:
        """Add a line on what happened at `t`, s; `kind` is as in `sentence`."""
        self.lines.add((rounded(t), kind, text))


def sentence(event: Event) -> tuple[str, str] | None:
    """Return (kind, sentence) for an event that has a line in the log; None for any other.

    `kind` is "fault" (until somebody acts, results are wrong or absent), "wear" (they are only less accurate), "link",
    "gait", "place" or "here"."""
    line = _link(event) or _wear(event) or _gait(event)
    return None if line is None else (line[0], printable(line[1], 300))


def _link(event: Event) -> tuple[str, str] | None:
    match event:
        case Connected(site=site, name=name):
            return "link", f"{site.words}: connected{f', {name}' if name else ''}"
        case Disconnected(site=site):
            return "fault", f"{site.words}: the connection is lost"
        case StreamStale(site=site, silent_for=seconds):
            return "fault", f"{site.words}: nothing has come for {seconds:.1f} s"
        case StreamResumed(site=site, silent_for=seconds):
            return "link", f"{site.words}: data come again after {seconds:.1f} s"
        case StreamRestarted(site=site):
            return "link", f"{site.words}: the data had stopped, the sensor was set up again"
        case ClockReset(site=site, restarted=restarted):
            return "wear", f"{site.words}: {'the sensor has restarted' if restarted else 'its clock has jumped'}"
        case PacketsDropped(site=site, count=count):
            return "wear", f"{site.words}: {count} packet{'s' * (count != 1)} came too fast to be used"
        case LinkTrouble(site=site, what=what):
            return "fault", f"{site.words}: {what}"
        case BatteryLevel(site=site, level=level) if level <= LOW_BATTERY:
            return "wear", f"{site.words}: the battery is at {100.0 * level:.0f} %"
        case _:
            return None


def _wear(event: Event) -> tuple[str, str] | None:
    match event:
        case DefectFound(site=site, what=what):
            return "fault" if event.needs_action else "wear", f"{site.words}: {what}"
        case Limitation(site=site, what=what):
            return "wear", what if site is None else f"{site.words}: {what}"
        case CellsFailed(site=site):
            return "wear", f"{site.words}: {fault_words(event)}; left out from now on"
        case InsoleNeverUnloads(site=site):
            return "wear", f"{site.words}: the insole is never without load; the shoe may be too tight for it"
        case FeetSwapped():
            return "fault", "the insoles may be swapped: what comes as the left foot looks like a right one"
        case FootSilent(foot=foot):
            return "fault", f"{foot} foot: nothing comes while the other foot walks on"
        case FootResumed(foot=foot, silent_for=seconds):
            return "link", f"{foot} foot: samples again after {seconds:.1f} s"
        case _:
            return None


def _gait(event: Event) -> tuple[str, str] | None:
    match event:
        case TurnMade(turn=turn, angle=angle, final=True) if turn is not None:
            return "gait", f"{TURNS[turn]} by {abs(degrees(angle)):.0f} degrees"
        case FlightClimbed(up=up, steps=strides, height=height, final=True):
            direction = "up" if up else "down"
            return "gait", f"stairs {direction}: {strides} stride{'s' * (strides != 1)}, {abs(height):.1f} m"
        case ActivityChanged(activity=Activity.ELEVATOR_UP | Activity.ELEVATOR_DOWN as activity, final=True):
            return "gait", f"in a lift that goes {'up' if activity is Activity.ELEVATOR_UP else 'down'}"
        case LiftRidden(up=up, height=height, final=True):
            height_text = "" if height is None else f", {abs(height):.1f} m"
            return "gait", f"lift {'up' if up else 'down'}{height_text}"
        case PlaceLost(what=what) | PlanContradicted(what=what):
            return "place", what
        case TrackRevised() | PositionRejected():
            return "here", outcome_words(event)
        case _:
            return None
