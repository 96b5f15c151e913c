"""What a walk comes to, in words."""

from __future__ import annotations

from ...recording import printable
from ...types import Foot, Turn
from ..tables.summary import link_health, worn
from ..tables.table import number
from ..tally import Tally
from .clock import ReportClock, lasted
from .figures.activity import named
from .links import Links

CAUTION = (
    "These are measurements of foot-worn sensors, for whoever knows how to read them. They are no diagnosis and come "
    "from no medical device."
)

LONGEST_NAME = 60
"""Characters of a device's name that are shown, so that it crowds out nothing."""
TURNS = {Turn.LEFT: "to the left", Turn.RIGHT: "to the right", Turn.ABOUT: "about"}


def overview(
    tally: Tally, clock: ReportClock, begun: bool, measured: dict[Foot, int], covered: float | None = None
) -> list[str]:
    """The walk in sentences. `begun`: something was heard at all; `measured`: gait cycles of each foot, for a foot
    without a track; `covered`: how long it lasts where the clock does not tell, s."""
    if not begun:
        return ["Nothing was heard of either foot."]
    told = [f"The recording lasts {lasted(clock.end - clock.begin)}."]
    if covered is not None:
        told = [f"The recording lasts {lasted(covered)}; its times go back in between."]
    stepped = {foot: tally.feet[foot] for foot in Foot if foot in tally.feet and tally.feet[foot].steps}
    for foot, one in stepped.items():
        far = f" over {number(one.distance, 1)} m" if one.distance > 0.0 else ""
        told.append(f"The {foot.value} foot took {one.steps} stride{'s' * (one.steps != 1)}{far}.")
    for foot, count in measured.items():
        if count and foot not in stepped:
            told.append(f"The {foot.value} foot took {count} stride{'s' * (count != 1)}; how far is not known.")
    if not stepped and not any(measured.values()):
        told.append("No foot took a step.")
    if tally.fused is not None:
        told.append(f"Both feet together went {number(tally.fused.distance, 1)} m.")
    spans = tally.timeline.lasted(clock.end)
    if spans:
        told.append(f"Activities: {', '.join([f'{named(what)} {lasted(t)}' for what, t in spans.items()])}.")
    for counted, what in ((tally.flights, "Flights of stairs"), (tally.rides, "Lift rides")):
        ways = [f"{counted[up]} {'up' if up else 'down'}" for up in (True, False) if counted[up]]
        if ways:
            told.append(f"{what}: {', '.join(ways)}.")
    turns = [f"{tally.turns[turn]} {words}" for turn, words in TURNS.items() if tally.turns[turn]]
    if turns:
        told.append(f"Turns: {', '.join(turns)}.")
    return told


def wrong(tally: Tally) -> list[str]:
    """What was wrong with sensors, their wearing and their links; nothing when all is well."""
    found = [*worn(tally), *link_health(tally)]
    feet = [(foot, tally.feet[foot]) for foot in Foot if foot in tally.feet]
    found += [
        f"{foot.value} foot: in {one.degraded} of {one.steps} strides samples are missing or saturated"
        for foot, one in feet
        if one.degraded
    ]
    found += [
        f"{foot.value} foot: {one.gaps} gaps in the samples, {number(one.gap_time)} s in all"
        for foot, one in feet
        if one.gaps
    ]
    found += [f"suspect scale, {what}" for what in tally.suspects]
    return [f"{one[0].upper()}{one[1:]}." for one in found if one]


def without(tally: Tally) -> list[str]:
    """What the recipe had to do without."""
    return [f"{one[0].upper()}{one[1:]}." for one in tally.limitations if one]


def sensors(links: Links) -> str:
    """Which there were, in a line."""
    told = []
    for site, one in links.sites.items():
        named_so = f" ({printable(one.name, LONGEST_NAME)})" if one.name else ""
        what = [word for word, count in (("motion", one.moved), ("pressure", one.pressed)) if count]
        told.append(f"{site.words}{named_so}{': ' + ' and '.join(what) if what else ''}")
    return "; ".join(told) if told else "none was heard"


def link_rows(links: Links) -> list[list[str]]:
    """Rows of the table of links, and its header first."""
    rows = [["sensor", "samples", "Hz", "gaps", "s in gaps", "lost", "rejected", "silent", "battery"]]
    for site, one in links.sites.items():
        battery = "-" if one.battery is None else f"{100.0 * one.battery:.0f} %"
        count = max(one.moved, one.pressed)
        counts = [str(one.lost), str(one.rejected), str(one.silent), battery]
        rows.append([site.words, str(count), number(one.rate, 1), str(one.gaps), number(one.gap_time, 2), *counts])
    return rows
