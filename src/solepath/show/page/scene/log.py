"""Turns events into the sentences of a page's log, for a wearer or a clinician."""

from __future__ import annotations

from math import degrees, hypot

from attrs import define, field

from ....events import (
    ActivityChanged,
    BatteryLevel,
    ClockReset,
    Connected,
    Disconnected,
    EscalatorRidden,
    Event,
    FlightClimbed,
    FootResumed,
    FootSilent,
    LiftRidden,
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
from ....types import SITE_OF_FOOT, Activity, Site, Turn
from ....walk.walk import Walk
from ...findings import Concern, finding_of
from ...tables.table import counted
from .lists import GrowingList

MAX_LINES = 50
LOW_BATTERY = 0.15
"""Charge, 0 to 1, at or below which the log reports the battery; chosen by hand."""
UP = {True: "up", False: "down"}
TURNS = {Turn.LEFT: "turned left", Turn.RIGHT: "turned right", Turn.ABOUT: "turned about"}

LINES: dict[type[Event], tuple[str, str]] = {
    Disconnected: ("fault", "the connection is lost"),
    StreamStale: ("fault", "nothing has come for {0.silent_for:.1f} s"),
    StreamResumed: ("link", "data come again after {0.silent_for:.1f} s"),
    StreamRestarted: ("link", "the data had stopped, the sensor was set up again"),
    FootResumed: ("link", "{0.foot} foot: samples again after {0.silent_for:.1f} s"),
    PlaceLost: ("place", "{0.what}"),
    PlanContradicted: ("place", "{0.what}"),
    PositionRejected: ("here", "position rejected: {0.what}"),
}
"""Kind and sentence on each event that always has one, without its sensor; `_line` has the others."""

LogLine = tuple[float, str, str]
"""(t, kind, sentence), t in s."""


@define
class SceneLog:
    """The log of a page: the newest MAX_LINES sentences on events."""

    lines: GrowingList[LogLine] = field(factory=lambda: GrowingList(MAX_LINES))

    def add_event(self, event: Event, walk: Walk) -> None:
        """Add the line of an event, if it has one and the log does not say the same already.

        `walk` has not counted the event yet."""
        line = sentence(event)
        if line is None:
            return
        if isinstance(event, FootSilent) and walk.link(SITE_OF_FOOT[event.foot]).state(walk.now) != "ok":
            return
        if isinstance(event, BatteryLevel):
            before = walk.link(event.site).battery
            if before is not None and before <= LOW_BATTERY:
                return
        self.add(event.t, *line)

    def add(self, t: float, kind: str, text: str) -> None:
        """Add a line on what happened at `t`, s; `kind` is as in `sentence`."""
        self.lines.add((round(t, 3), kind, text))


def sentence(event: Event) -> tuple[str, str] | None:
    """Return (kind, sentence) for an event that has a line in the log; None for any other.

    `kind` is "fault" (until somebody acts, results are wrong or absent), "wear" (they are only less accurate), "link",
    "gait", "place" or "here"."""
    if (finding := finding_of(event)) is not None:
        text = finding.brief if finding.concern is Concern.WEAR else finding.text
        return "fault" if finding.act else "wear", printable(text, 300)
    kind, text = LINES.get(type(event)) or _line(event)
    if not text:
        return None
    site: Site | None = getattr(event, "site", None)
    return kind, printable(("" if site is None else f"{site.words}: ") + text.format(event), 300)


def _line(event: Event) -> tuple[str, str]:
    """Return kind and sentence on an event of which it depends whether and what the log says; "" for none."""
    match event:
        case Connected(name=name):
            return "link", "connected, {0.name}" if name else "connected"
        case ClockReset(restarted=restarted):
            return "wear", "the sensor has restarted" if restarted else "its clock has jumped"
        case PacketsDropped(count=count):
            return "wear", f"{counted(count, 'packet')} came too fast to be used"
        case BatteryLevel(level=level) if level <= LOW_BATTERY:
            return "wear", f"the battery is at {100.0 * level:.0f} %"
        case TurnMade(turn=turn, angle=angle, final=True) if turn is not None:
            return "gait", f"{TURNS[turn]} by {abs(degrees(angle)):.0f} degrees"
        case FlightClimbed(up=up, steps=strides, height=height, final=True):
            return "gait", f"stairs {UP[up]}: {counted(strides, 'stride')}, {abs(height):.1f} m"
        case ActivityChanged(activity=Activity.ELEVATOR_UP | Activity.ELEVATOR_DOWN as activity, final=True):
            return "gait", f"in a lift that goes {UP[activity is Activity.ELEVATOR_UP]}"
        case LiftRidden(up=up, height=height, final=True) | EscalatorRidden(up=up, height=height, final=True):
            kind = "lift" if isinstance(event, LiftRidden) else "escalator"
            return "gait", f"{kind} {UP[up]}{'' if height is None else f', {abs(height):.1f} m'}"
        case TrackRevised(by=by, turn=angle):
            turned = counted(round(abs(degrees(angle))), "degree")
            return "here", f"track revised: moved by {hypot(*by):.1f} m, turned by {turned}"
        case _:
            return "", ""
