"""Puts the counts of a walk into words: a summary of a recording, and the present state of links and place."""

from __future__ import annotations

from collections.abc import Mapping

from ...events import Placed
from ...recording import printable
from ...types import SITE_OF_FOOT, Foot, Site, Turn, WalkingMode
from ...walk.links import LinkLedger
from ...walk.places import MAX_LISTED, PlaceCounts
from ...walk.walk import GAIT_EVENTS, FootCounts, Walk
from ..findings import Concern, findings, links_of
from .gait import gait_lines
from .table import counted, duration_text, number, table, times
from .words import activity_words, directions, turn_words

NO_DATA = "no data from either foot"


def summary(walk: Walk, *, title: str, seconds: float) -> str:
    """Return the summary of one recording; `seconds` is the wall time that computing it took."""
    duration = walk.covered_time.total
    found = findings(walk)
    lines = [f"{title}: {duration:.1f} s", *[one.line for one in found if one.concern is Concern.DATA]]
    lines += ["", _foot_table(walk), ""] if walk.known_feet else [NO_DATA]
    if (fused := walk.fused) is not None and walk.measured_feet == walk.known_feet:
        lines.append(f"both feet fused: {number(fused.distance)} m, at the end by the {fused.chosen} foot's path")
    if walk.modes:
        modes = ", ".join([f"{mode} {walk.modes[mode]}" for mode in WalkingMode if walk.modes[mode]])
        lines.append(f"{counted(walk.modes.total(), 'touchdown')}: {modes}")
    lines += activity_lines(walk, walk.now)
    if gait := gait_lines(walk):
        lines += ["", *gait]
    lines += [one.line for one in found if one.concern is not Concern.DATA]
    samples = sum([walk.samples(foot) for foot in Foot])  # whole numbers
    if seconds > 0.0 and samples:
        pace = f"{duration / seconds:.0f} times as fast as walked, {1e6 * seconds / samples:.0f} us a sample"
        lines.append(f"computed in {seconds:.2f} s: {pace}")
    return "\n".join(lines)


def _foot_table(walk: Walk) -> str:
    """Return a table of the feet."""
    names, rows = GAIT_EVENTS.values(), []
    for foot in walk.known_feet:
        counts, link = walk.feet.get(foot, FootCounts()), walk.links.get(SITE_OF_FOOT[foot], LinkLedger())
        figures, events = [str(counts.strides), number(counts.distance)], [str(counts.events[name]) for name in names]
        if not walk.has_strides(foot):  # what it cannot know is no figure of 0
            figures, events = ["-", "-"], ["-" if text == "0" else text for text in events]
        figures = ["-"] * len(figures + events) if foot in walk.spoilt_feet else figures + events
        rows.append([foot.value, str(link.samples), number(link.rate, 1), *figures])
    return table(["foot", "samples", "Hz", "strides", "distance m", *[f"{name}s" for name in names]], rows)


def activity_lines(walk: Walk, now: float) -> list[str]:
    """Return a line for activities until `now`, s, flights of stairs, lift rides and turns each, if there were any."""
    found = {
        "activities": [f"{activity_words(one)} {duration_text(t)}" for one, t in walk.timeline.durations(now).items()],
        "flights of stairs": [f"{count} {way}" for way, count in directions(walk.flights)],
        "lift rides": [f"{count} {way}" for way, count in directions(walk.elevator_rides)],
        "escalator rides": [f"{count} {way}" for way, count in directions(walk.escalator_rides)],
        "turns": [f"{walk.turns[turn]} {turn_words(turn)}" for turn in Turn if walk.turns[turn]],
    }
    return [f"{name}: {', '.join(texts)}" for name, texts in found.items() if texts]


def status(walk: Walk) -> list[str]:
    """Return a line on the link of each site, in the order of Site, and one on the place if it is known."""
    lines = [_link(site, link, walk.now) for site, link in links_of(walk)]
    return lines + ([place_line(walk.places.last)] if walk.places.last is not None else [])


def _link(site: Site, link: LinkLedger, now: float) -> str:
    parts = [
        f"{link.recent_rate(now) or 0.0:.0f} Hz",
        f"{100.0 * link.missing_share:.1f} % missing" if link.missing else "",
        "" if link.battery is None else f"battery {100.0 * link.battery:.0f} %",
        "" if link.signal is None else f"{link.signal} dBm",
        _delay(link.delays.figures),
        "disconnected" if link.state(now) == "lost" else "",
        printable(link.trouble or ""),
    ]
    return f"{site.words}: {', '.join(filter(None, parts))}"


def _delay(figures: Mapping[str, tuple[float, float]]) -> str:
    """Return the parts of the delay of contacts, median and 95th percentile; nothing while there are none."""
    parts = [f"{name} {1e3 * middle:.0f} ms (95 %: {1e3 * most:.0f})" for name, (middle, most) in figures.items()]
    return f"late by {' + '.join(parts)}" if parts else ""


def place_lines(counts: PlaceCounts) -> list[str]:
    """Return the lines about the place over a whole recording."""
    lines = [f"place: not found; {counted(counts.places, 'stride')} with several candidates"]
    if counts.first_decided is not None:
        strides, t = counts.first_decided
        share = f"one place for {counts.decided_count} of {counts.places} strides"
        lines = [f"place: found after {counted(strides, 'stride')}, at {number(t, 1)} s; {share}"]
    if counts.last is not None:
        lines.append(end_line(counts.last))
    if counts.level_starts:
        levels = ", ".join([f"{printable(name)} from {number(t, 1)} s" for t, name in counts.level_starts])
        unlisted = counts.level_changes - MAX_LISTED
        lines.append(f"decided levels: {levels}{f' and {unlisted} more' if unlisted > 0 else ''}")
    lines += [f"from {number(t, 1)} s without a place: {printable(what)}" for t, what in counts.first_losses]
    if counts.loss_count > MAX_LISTED:
        lines.append(f"and {times(counts.loss_count - MAX_LISTED)} more")
    return lines


def end_line(place: Placed) -> str:
    """Return a line with the place at the end, which says if it is not decided."""
    if place.decided:
        return f"at the end: {_where(place)}"
    there = "all on this level" if place.level_decided else "on several levels"
    weight = max([one.weight for one in place.candidates], default=0.0)
    sureness = f"{100.0 * weight:.0f} %, within {number(place.spread, 1)} m"
    others = f"{counted(len(place.candidates), 'candidate')}, {there}"
    return f"at the end: {_where(place)}, not decided: {sureness}; {others}"


def place_line(place: Placed) -> str:
    """Return a line with the wearer's present level, room and door if they have names, and position, m, plan frame."""
    heaviest, *others = place.candidates
    sureness = f", {100.0 * heaviest.weight:.0f} % sure, one of {1 + len(others)} candidates"
    return f"place: {_where(place)}{'' if place.decided else sureness}"


def _where(place: Placed) -> str:
    """Return level, room and door, the position, m, and for a decided place how far that may be off."""
    names = [f"level {printable(place.level)}"]
    names += [] if place.room is None else [printable(place.room)]
    names += [] if place.door is None else [f"at door {printable(place.door)}"]
    x, y, _ = place.position
    names.append(f"({number(x, 1)}, {number(y, 1)}) m")
    names += [f"within {number(place.spread, 1)} m"] if place.decided else []
    return ", ".join(names)
