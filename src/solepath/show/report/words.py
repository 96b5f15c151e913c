"""Puts the counts of a walk into the sentences of a report."""

from __future__ import annotations

from ...recording import printable
from ...types import Foot
from ...walk.walk import Walk
from ..findings import NOTHING_RIGHT, links_of
from ..tables.summary import activity_lines
from ..tables.table import counted, duration_text, number
from .markup import whole_sentences

MAX_NAME_LENGTH = 60
"""Largest number of characters of a device's name that are shown."""
LINK_HEADER = ("sensor", "samples", "Hz", "missing", "missing, %", "absent, s", "rejected", "silent", "battery")


def overview(walk: Walk, duration: float, end: float) -> list[str]:
    """Return the sentences on the course of the recording, which lasts for `duration` until `end`, s."""
    back = "; its times go back in between" if walk.covered_time.span_count > 1 else ""
    lines = [f"the recording lasts {duration_text(duration)}{back}"]
    for foot in Foot:
        counts, cycles = walk.feet.get(foot), walk.cycles[foot].count
        if counts is not None and counts.strides:
            distance = f" over {number(counts.distance, 1)} m" if counts.distance > 0.0 else ""
            lines.append(f"the {foot} foot took {counted(counts.strides, 'stride')}{distance}")
        elif cycles:
            lines.append(f"the {foot} foot took {counted(cycles, 'gait cycle')}; how far is not known")
    if len(lines) == 1:
        lines.append("no foot took a stride" if walk.measured_feet or not walk.known_feet else NOTHING_RIGHT)
    if walk.fused is not None and walk.measured_feet == walk.known_feet:
        lines.append(f"both feet together went {number(walk.fused.distance, 1)} m")
    return whole_sentences(lines + activity_lines(walk, end))


def sensors(walk: Walk) -> str:
    """Return the sensors in one line, with the names of the devices and the kinds of their data."""
    lines = []
    for site, link in links_of(walk):
        name = f" ({printable(link.name, MAX_NAME_LENGTH)})" if link.name else ""
        kinds = " and ".join(["motion"] * link.has_motion + ["pressure"] * link.has_pressure)
        lines.append(f"{site.words}{name}{': ' if kinds else ''}{kinds}")
    return "; ".join(lines) or "no data from any"


def link_rows(walk: Walk) -> list[list[str]]:
    """Return the rows of the table of links."""
    rows = []
    for site, link in links_of(walk):
        battery = "-" if link.battery is None else f"{100.0 * link.battery:.0f} %"
        missing = str(link.missing), number(100.0 * link.missing_share, 1), number(link.absent_time(walk.now), 1)
        faults = str(link.rejected.total()), str(link.silences), battery
        rows.append([site.words, str(link.samples), number(link.rate, 1), *missing, *faults])
    return rows
