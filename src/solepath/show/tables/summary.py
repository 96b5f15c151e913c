"""Puts the counts of an walk into words: a summary of a recording, and the present state of links and place."""

from __future__ import annotations

from collections import Counter
from statistics import median

from ...events import Placed
from ...recording import printable
from ...types import SITE_OF_FOOT, Foot, Site, Turn, WalkingMode
from ...walk.links import LinkLedger
from ...walk.places import MAX_LISTED, PlaceCounts
from ...walk.walk import GAIT_EVENTS, FootCounts, Walk
from .gait import gait_lines
from .table import counted, duration_text, milliseconds, number, table, times
from .words import activity_words, turn_words

NO_DATA = "no data from either foot"
SHORTEST_ABSENCE = 0.05
"""Shortest absence that is written, s; a shorter one would be written as 0.0 s."""


def summary(walk: Walk, *, title: str, seconds: float) -> str:
    """Return the summary of one recording; `seconds` is the wall time that computing it took."""
    duration = walk.covered_time.total
    lines = [f"{title}: {duration:.1f} s"]
    lines += [f"DEFECT, {printable(what)}" for what in walk.defects]
    lines += _foot_table(walk)
    lines += _fused_feet(walk)
    lines += activity_lines(walk)
    if gait := gait_lines(walk.gait):
        lines += ["", *gait]
    lines += wear_lines(walk)
    lines += link_health(walk)
    lines += latency(walk)
    lines += [f"limitation, {printable(what)}" for what in walk.limitations]
    samples = sum([walk.samples(foot) for foot in Foot])
    if seconds > 0.0 and samples:
        pace = f", {1e6 * seconds / samples:.0f} us a sample"
        lines.append(f"computed in {seconds:.2f} s: {duration / seconds:.0f} times as fast as walked{pace}")
    return "\n".join(lines)


def _foot_table(walk: Walk) -> list[str]:
    """Return a table of the feet, and lines about missing samples."""
    if not walk.known_feet:
        return [NO_DATA]
    header = ["foot", "samples", "Hz", "strides", "distance m", *[f"{name}s" for name in GAIT_EVENTS.values()]]
    rows = []
    for foot in walk.known_feet:
        counts = walk.feet.get(foot, FootCounts())
        link = walk.links.get(SITE_OF_FOOT[foot], LinkLedger())
        row = [f"{foot}", str(link.samples), number(link.rate, 1), str(counts.strides), number(counts.distance)]
        rows.append([*row, *[str(counts.events[name]) for name in GAIT_EVENTS.values()]])
    return ["", table(header, rows), "", *degraded_lines(walk)]


def degraded_lines(walk: Walk) -> list[str]:
    """Return a line for each foot with degraded strides."""
    feet = [(foot, walk.feet.get(foot, FootCounts())) for foot in walk.known_feet]
    return [f"{foot}: {one.degraded} of {one.strides} strides degraded" for foot, one in feet if one.degraded]


def missing_words(link: LinkLedger) -> str:
    """Return how many samples of a link are missing, and how long its sensor was absent; "" if neither is so."""
    words = []
    if link.missing:
        share = f"{100.0 * link.missing_share:.1f} %, {link.missing_time:.2f} s"
        words.append(f"{link.missing} of {counted(link.taken, 'sample')} missing ({share})")
    if link.absent_time >= SHORTEST_ABSENCE:
        words.append(f"absent for {link.absent_time:.1f} s")
    return ", ".join(words)


def fused_stride(walk: Walk) -> list[str]:
    """Return lines about the last fused stride: distance (12), similarity (9), error index (10), coefficient (11).

    The numbers are those of Chen et al. 2019. The list is empty if the recipe does not fuse strides."""
    fused = walk.fused
    if fused is None:
        return []
    return [
        f"both feet: {number(fused.distance)} m by the {fused.chosen} foot; "
        f"last stride {number(fused.stride_length)} m",
        f"  similarity {number(fused.similarity)}, error index {number(fused.error_index)} m/s, "
        f"own share {number(fused.coefficient)}",
    ]


def _fused_feet(walk: Walk) -> list[str]:
    """Return the lines about the fused track and the walking modes; none if the recipe treats each foot by itself."""
    lines = []
    if (fused := walk.fused) is not None:
        lines.append(f"both feet fused: {number(fused.distance)} m, at the end by the {fused.chosen} foot's path")
    if walk.modes:
        modes = ", ".join(f"{mode} {walk.modes[mode]}" for mode in WalkingMode if walk.modes[mode])
        lines.append(f"{counted(walk.modes.total(), 'touchdown')}: {modes}")
    return lines


def activity_lines(walk: Walk) -> list[str]:
    """Return a line for activities, flights of stairs, elevator rides and turns each, if there were any."""
    lines = []
    if durations := walk.timeline.durations(walk.now):
        activities = [f"{activity_words(activity)} {duration_text(t)}" for activity, t in durations.items()]
        lines.append(f"activities: {', '.join(activities)}")
    for counts, name in ((walk.flights, "flight"), (walk.elevator_rides, "lift ride")):
        directions = [f"{counts[up]} {'up' if up else 'down'}" for up in (True, False) if counts[up]]
        if directions:
            lines.append(f"{name}s: {', '.join(directions)}")
    if walk.turns:
        turns = [f"{walk.turns[turn]} {turn_words(turn)}" for turn in Turn if walk.turns[turn]]
        lines.append(f"turns: {', '.join(turns)}")
    return lines


def wear_lines(walk: Walk) -> list[str]:
    """Return a line for each fault in how sensors are worn; none without faults."""
    silent = {foot: walk.silences[foot] for foot in Foot if walk.silences[foot]}
    return [
        *walk.wear_problems,
        *(f"{foot}: silent {times(n)} while the other walked on" for foot, n in silent.items()),
    ]


def site_links(walk: Walk) -> list[tuple[Site, LinkLedger]]:
    """Return the ledgers of all sites in the order of Site."""
    return [(site, walk.links[site]) for site in Site if site in walk.links]


def link_health(walk: Walk) -> list[str]:
    """Return a line for each kind of fault of the links; none without faults."""
    lines, links = [], list(walk.links.values())
    lines += [f"{site.words}: {words}" for site, link in site_links(walk) if (words := missing_words(link))]
    rejected = sum([link.rejected for link in links], Counter[tuple[str, str]]())
    for kind in ("packet", "sample"):
        reasons = {reason: count for (what, reason), count in rejected.items() if what == f"{kind}s"}
        if reasons:
            detail = ", ".join(f"{reason} {count}" for reason, count in sorted(reasons.items()))
            lines.append(f"{counted(sum(reasons.values()), kind)} rejected ({detail})")
    if resets := sum([link.clock_resets for link in links]):
        lines.append(counted(resets, "clock reset"))
    if silences := sum([link.silences for link in links]):
        lines.append(f"a stream fell silent {times(silences)}")
    if restarts := sum([link.restarts for link in links]):
        lines.append(f"a stream froze and was set up again {times(restarts)}")
    if dropped := sum([link.dropped for link in links]):
        lines.append(f"{counted(dropped, 'packet')} dropped: too many came to be used in time")
    for site, link in site_links(walk):
        if link.connections > 1:
            lines.append(f"{site.words}: connected {times(link.connections)}")
    lines += [f"trouble, {printable(what)}" for what in walk.troubles]
    return lines


def latency(walk: Walk) -> list[str]:
    """Return a line with the median latency of each gait event, radio included; none without events."""
    medians = {name: median(counts.elements()) for name, counts in walk.latencies.items() if counts}
    texts = [f"{name} {milliseconds(1e-4 * tenths)} ms" for name, tenths in medians.items()]
    return [f"known after it happened, median: {', '.join(texts)}"] if texts else []


def status(walk: Walk) -> list[str]:
    """Return a line on the link of each site, in the order of Site, and one on the place if it is known."""
    lines = [_link(site, link, walk.now) for site, link in site_links(walk)]
    place = walk.places.last
    return lines if place is None else [*lines, place_line(place)]


def _link(site: Site, link: LinkLedger, now: float) -> str:
    parts = [f"{site.words}: {link.recent_rate(now) or 0.0:.0f} Hz"]
    if link.missing:
        parts.append(f"{100.0 * link.missing_share:.1f} % missing")
    if link.battery is not None:
        parts.append(f"battery {100.0 * link.battery:.0f} %")
    if link.signal is not None:
        parts.append(f"{link.signal} dBm")
    if link.state(now) == "lost":
        parts.append("disconnected")
    if link.trouble:
        parts.append(printable(link.trouble))
    return ", ".join(parts)


def place_lines(counts: PlaceCounts) -> list[str]:
    """Return the lines about the place over a whole recording."""
    lines = []
    if counts.first_decided is not None:
        strides, t = counts.first_decided
        share = f"; one place for {counts.decided_count} of {counts.places} strides"
        lines.append(f"place: found after {counted(strides, 'stride')}, at {number(t, 1)} s{share}")
    else:
        lines.append(f"place: not found; {counted(counts.places, 'stride')} with several candidates")
    if counts.last is not None:
        x, y, _ = counts.last.position
        position = f"({number(x, 1)}, {number(y, 1)}) m"
        count = len(counts.last.candidates)
        uncertainty = f", one of {count} candidates" if count > 1 else f", within {number(counts.last.spread, 1)} m"
        lines.append(f"at the end: {_level_and_room(counts.last)}, {position}{uncertainty}")
    if counts.level_starts:
        levels = ", ".join([f"{printable(name)} from {number(t, 1)} s" for t, name in counts.level_starts])
        unlisted = counts.level_changes - MAX_LISTED
        lines.append(f"levels: {levels}{f' and {unlisted} more' if unlisted > 0 else ''}")
    lines += [f"from {number(t, 1)} s without a place: {printable(what)}" for t, what in counts.first_losses]
    if counts.loss_count > MAX_LISTED:
        lines.append(f"and {times(counts.loss_count - MAX_LISTED)} more")
    return lines


def place_line(place: Placed) -> str:
    """Return a line with the wearer's present level, room and door if they have names, and position, m, plan frame."""
    x, y, _ = place.position
    count = len(place.candidates)
    text = f"place: {_level_and_room(place)}, ({number(x, 1)}, {number(y, 1)}) m"
    if count == 1:
        return f"{text}, within {number(place.spread, 1)} m"
    return f"{text}, {100.0 * place.candidates[0].weight:.0f} % sure, one of {count} candidates"


def _level_and_room(place: Placed) -> str:
    names = [f"level {printable(place.level)}"]
    if place.room is not None:
        names.append(printable(place.room))
    if place.door is not None:
        names.append(f"at door {printable(place.door)}")
    return ", ".join(names)
