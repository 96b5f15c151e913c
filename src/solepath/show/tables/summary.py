"""A tally in words."""

from __future__ import annotations

from statistics import median

from ...recording import printable
from ...types import Foot, Site, Turn, WalkingMode
from ..tally import DATED, Tally
from .gait import gait_lines
from .table import milliseconds, number, table


def summary(tally: Tally, *, title: str, seconds: float) -> str:
    """The summary of one recording; `seconds` is the wall time that it took."""
    lines = [f"{title}: {tally.duration:.1f} s"]
    feet = [foot for foot in Foot if foot in tally.feet]
    if feet:
        header = ["foot", "samples", "Hz", "steps", "distance m", "heel-strikes", "foot-flats", "heel-offs", "toe-offs"]
        rows = []
        for foot in feet:
            one = tally.feet[foot]
            counts = (one.heel_strikes, one.foot_flats, one.heel_offs, one.toe_offs)
            told = [foot.value, str(one.samples), number(one.rate, 1), str(one.steps), number(one.distance)]
            rows.append([*told, *map(str, counts)])
        lines += ["", table(header, rows), ""]
    else:
        lines.append("nothing was heard of either foot")
    for foot in feet:
        one = tally.feet[foot]
        if one.gaps:
            lines.append(f"{foot.value}: {one.gaps} gaps in the samples, {one.gap_time:.2f} s in all")
        if one.degraded:
            lines.append(f"{foot.value}: {one.degraded} of {one.steps} steps degraded by missing or saturated samples")
    lines += _together(tally)
    lines += did(tally)
    if gait := gait_lines(tally.gait):
        lines += ["", *gait]
    lines += worn(tally)
    lines += link_health(tally)
    lines += latency(tally)
    lines += [f"limitation, {printable(what)}" for what in tally.limitations]
    lines += [f"suspect scale, {printable(what)}" for what in tally.suspects]
    samples = sum(one.samples for one in tally.feet.values())
    if seconds > 0.0 and samples:
        pace = f", {1e6 * seconds / samples:.0f} us a sample"
        lines.append(f"computed in {seconds:.2f} s: {tally.duration / seconds:.0f} times as fast as walked{pace}")
    return "\n".join(lines)


def _together(tally: Tally) -> list[str]:
    """What came of both feet together; nothing when the recipe looks at each by itself."""
    lines = []
    if (fused := tally.fused) is not None:
        lines.append(f"both feet fused: {number(fused.distance)} m, at the end by the {fused.chosen.value} foot's path")
    if tally.modes:
        modes = ", ".join(f"{mode.value} {tally.modes[mode]}" for mode in WalkingMode if tally.modes[mode])
        lines.append(f"{tally.modes.total()} touchdowns: {modes}")
    return lines


def did(tally: Tally) -> list[str]:
    """What the wearer did, a line for each kind; nothing where nothing was told."""
    lines = []
    if tally.last is not None and (lasted := tally.timeline.lasted(tally.last)):
        lines.append("activities: " + ", ".join(f"{what.value} {number(t, 0)} s" for what, t in lasted.items()))
    for counted, one in ((tally.flights, "flight"), (tally.rides, "lift ride")):
        ways = [f"{counted[up]} {'up' if up else 'down'}" for up in (True, False) if counted[up]]
        if ways:
            lines.append(f"{one}s: {', '.join(ways)}")
    if tally.turns:
        turns = ", ".join(f"{turn.value} {tally.turns[turn]}" for turn in Turn if tally.turns[turn])
        lines.append(f"turns: {turns}")
    return lines


def worn(tally: Tally) -> list[str]:
    """What is wrong with how it is worn, a line each; nothing when all is well."""
    silent = {foot: tally.silences[foot] for foot in Foot if tally.silences[foot]}
    return [*tally.worn, *(f"{foot.value}: silent {n} times while the other walked on" for foot, n in silent.items())]


def link_health(tally: Tally) -> list[str]:
    """What the links did wrong, a line each; nothing when all went well."""
    lines = []
    if lost := tally.lost.total():
        share = f" of {lost + tally.came}" if tally.came else ""
        lines.append(f"{lost}{share} packets lost")
    for kind in ("packets", "samples"):
        reasons = {reason: count for (what, reason), count in tally.rejected.items() if what == kind}
        if reasons:
            detail = ", ".join(f"{reason} {count}" for reason, count in sorted(reasons.items()))
            lines.append(f"{sum(reasons.values())} {kind} rejected ({detail})")
    if tally.clock_resets:
        lines.append(f"{tally.clock_resets} clock resets")
    if tally.stale:
        lines.append(f"{tally.stale} times a stream fell silent")
    if tally.restarts:
        lines.append(f"{tally.restarts} times a stream froze and was set up again")
    if tally.dropped:
        lines.append(f"{tally.dropped} packets dropped: they came faster than they could be used")
    for site in Site:
        if tally.connections[site] > 1:
            lines.append(f"{site.words}: connected {tally.connections[site]} times")
    lines += [f"trouble, {printable(what)}" for what in tally.troubles]
    return lines


def latency(tally: Tally) -> list[str]:
    """How long after they happened the gait events were known, the radio's time included; nothing without any."""
    known = [f"{name} {milliseconds(median(tally.delays[name]))} ms" for name in DATED.values() if name in tally.delays]
    return [f"known after it happened, median: {', '.join(known)}"] if known else []
