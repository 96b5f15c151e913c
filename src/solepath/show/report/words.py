"""Puts the counts of an walk into the sentences of a report."""

from __future__ import annotations

from ...recording import printable
from ...types import Foot, Turn
from ...walk.walk import Walk
from ..tables.summary import degraded_lines, link_health, site_links, wear_lines
from ..tables.table import counted, duration_text, number
from ..tables.words import activity_words, turn_words
from .clock import ReportClock
from .markup import whole_sentences

MAX_NAME_LENGTH = 60
"""Largest number of characters of a device's name that are shown."""


def overview(walk: Walk, clock: ReportClock, cycle_counts: dict[Foot, int]) -> list[str]:
    """Return the sentences on the course of the recording.

    `cycle_counts`, the number of gait cycles of each foot, is used for a foot without a track."""
    time = walk.covered_time
    lines = [f"The recording lasts {duration_text(time.total if time.span_count else clock.end - clock.start)}."]
    if time.span_count > 1:
        lines = [f"The recording lasts {duration_text(time.total)}; its times go back in between."]
    tracked = {foot: walk.feet[foot] for foot in Foot if foot in walk.feet and walk.feet[foot].strides}
    for foot, counts in tracked.items():
        distance = f" over {number(counts.distance, 1)} m" if counts.distance > 0.0 else ""
        lines.append(f"The {foot} foot took {counted(counts.strides, 'stride')}{distance}.")
    for foot, count in cycle_counts.items():
        if count and foot not in tracked:
            lines.append(f"The {foot} foot took {counted(count, 'stride')}; how far is not known.")
    if not tracked and not any(cycle_counts.values()):
        lines.append("No foot took a stride.")
    if walk.fused is not None:
        lines.append(f"Both feet together went {number(walk.fused.distance, 1)} m.")
    durations = walk.timeline.durations(clock.end)
    if durations:
        activities = [f"{activity_words(activity)} {duration_text(t)}" for activity, t in durations.items()]
        lines.append(f"Activities: {', '.join(activities)}.")
    for up_counts, name in ((walk.flights, "Flights of stairs"), (walk.elevator_rides, "Lift rides")):
        directions = [f"{up_counts[up]} {'up' if up else 'down'}" for up in (True, False) if up_counts[up]]
        if directions:
            lines.append(f"{name}: {', '.join(directions)}.")
    turns = [f"{counted(walk.turns[turn], 'turn')} {turn_words(turn)}" for turn in Turn if walk.turns[turn]]
    if turns:
        lines.append(f"The wearer made {', '.join(turns)}.")
    return lines


def faults(walk: Walk) -> list[str]:
    """Return sentences on what is missing or wrong in sensors, their wearing and their links; none without faults."""
    return whole_sentences([*wear_lines(walk), *link_health(walk), *degraded_lines(walk)])


def sensors(walk: Walk) -> str:
    """Return the sensors in one line, with the names of the devices and the kinds of their data."""
    lines = []
    for site, link in site_links(walk):
        name = f" ({printable(link.name, MAX_NAME_LENGTH)})" if link.name else ""
        kinds = [kind for kind, present in (("motion", link.has_motion), ("pressure", link.has_pressure)) if present]
        lines.append(f"{site.words}{name}{': ' + ' and '.join(kinds) if kinds else ''}")
    return "; ".join(lines) if lines else "no data from any"


def link_rows(walk: Walk) -> list[list[str]]:
    """Return the rows of the table of links, with its header first."""
    rows = [["sensor", "samples", "Hz", "missing", "%", "s absent", "rejected", "silent", "battery"]]
    for site, link in site_links(walk):
        battery = "-" if link.battery is None else f"{100.0 * link.battery:.0f} %"
        missing = [str(link.missing), number(100.0 * link.missing_share, 1), number(link.absent_time, 1)]
        counts = [str(link.rejected.total()), str(link.silences), battery]
        rows.append([site.words, str(link.samples), number(link.rate, 1), *missing, *counts])
    return rows
