"""Puts a walk into words."""

from __future__ import annotations

from ...recording import printable
from ...types import SITE_OF_FOOT, Foot, Site, Turn
from ..links import LinkLedger
from ..observer import Observer
from ..tables.summary import link_health, wear_lines
from ..tables.table import number
from .clock import ReportClock, duration_text
from .figures.activity import activity_words

CAUTION = (
    "These are measurements of foot-worn sensors, for whoever knows how to read them. They are no diagnosis and come "
    "from no medical device."
)

MAX_NAME_LENGTH = 60
"""Characters of a device's name that are shown, so that it leaves room for the rest."""
TURNS = {Turn.LEFT: "to the left", Turn.RIGHT: "to the right", Turn.ABOUT: "about"}


def overview(observer: Observer, clock: ReportClock, has_data: bool, measured: dict[Foot, int]) -> list[str]:
    """Return the walk in sentences.

    `has_data` says that anything came at all. `measured` is the number of gait cycles of each foot, for a foot without
    a track."""
    if not has_data:
        return ["Nothing was heard of either foot."]
    time = observer.covered_time
    lines = [f"The recording lasts {duration_text(time.total if time.stretch_count else clock.end - clock.start)}."]
    if time.stretch_count > 1:
        lines = [f"The recording lasts {duration_text(time.total)}; its times go back in between."]
    stepped = {foot: observer.feet[foot] for foot in Foot if foot in observer.feet and observer.feet[foot].strides}
    for foot, one in stepped.items():
        far = f" over {number(one.distance, 1)} m" if one.distance > 0.0 else ""
        lines.append(f"The {foot} foot took {one.strides} stride{'s' * (one.strides != 1)}{far}.")
    for foot, count in measured.items():
        if count and foot not in stepped:
            lines.append(f"The {foot} foot took {count} stride{'s' * (count != 1)}; how far is not known.")
    if not stepped and not any(measured.values()):
        lines.append("No foot took a step.")
    if observer.fused is not None:
        lines.append(f"Both feet together went {number(observer.fused.distance, 1)} m.")
    spans = observer.timeline.durations(clock.end)
    if spans:
        lines.append(
            f"Activities: {', '.join([f'{activity_words(what)} {duration_text(t)}' for what, t in spans.items()])}."
        )
    for counted, what in ((observer.flights, "Flights of stairs"), (observer.elevator_rides, "Lift rides")):
        ways = [f"{counted[up]} {'up' if up else 'down'}" for up in (True, False) if counted[up]]
        if ways:
            lines.append(f"{what}: {', '.join(ways)}.")
    turns = [f"{observer.turns[turn]} {words}" for turn, words in TURNS.items() if observer.turns[turn]]
    if turns:
        lines.append(f"Turns: {', '.join(turns)}.")
    return lines


def problems(observer: Observer) -> list[str]:
    """Return what was wrong with sensors, their wearing and their links; nothing when all is well."""
    found = [*wear_lines(observer), *link_health(observer)]
    found += [
        f"{foot} foot: in {one.degraded} of {one.strides} strides samples are missing or saturated"
        for foot in Foot
        if (one := observer.feet.get(foot)) is not None and one.degraded
    ]
    found += [
        f"{foot} foot: {link.gaps} gaps in the samples, {number(link.gap_time)} s in all"
        for foot in Foot
        if (link := observer.links.get(SITE_OF_FOOT[foot])) is not None and link.gaps
    ]
    found += [f"suspect scale, {what}" for what in observer.suspect_scales]
    return [f"{one[0].upper()}{one[1:]}." for one in found if one]


def limitations(observer: Observer) -> list[str]:
    """Return what the recipe had to do without."""
    return [f"{one[0].upper()}{one[1:]}." for one in observer.limitations if one]


def sensors(observer: Observer) -> str:
    """Return the sensors in one line."""
    lines = []
    for site, link in _links(observer):
        named_so = f" ({printable(link.name, MAX_NAME_LENGTH)})" if link.name else ""
        what = [word for word, there in (("motion", link.has_motion), ("pressure", link.has_pressure)) if there]
        lines.append(f"{site.words}{named_so}{': ' + ' and '.join(what) if what else ''}")
    return "; ".join(lines) if lines else "none was heard"


def link_rows(observer: Observer) -> list[list[str]]:
    """Return the rows of the table of links, with its header first."""
    rows = [["sensor", "samples", "Hz", "gaps", "s in gaps", "lost", "rejected", "silent", "battery"]]
    for site, link in _links(observer):
        battery = "-" if link.battery is None else f"{100.0 * link.battery:.0f} %"
        gaps = [str(link.gaps), number(link.gap_time, 2)]
        counts = [str(link.lost), str(link.rejected.total()), str(link.silences), battery]
        rows.append([site.words, str(link.samples), number(link.rate, 1), *gaps, *counts])
    return rows


def _links(observer: Observer) -> list[tuple[Site, LinkLedger]]:
    return [(site, observer.links[site]) for site in Site if site in observer.links]
