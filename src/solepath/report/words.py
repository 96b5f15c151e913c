"""What a walk comes to, in words."""

from __future__ import annotations

from ..tally import Tally
from ..types import Foot
from ..view.summary import did, link_health, worn
from ..view.table import number
from .activity_figure import named
from .clock import Clock, lasted
from .links import Links

CAUTION = (
    "These are measurements of foot-worn sensors, for whoever knows how to read them. They are no diagnosis and come "
    "from no medical device."
)


def overview(tally: Tally, clock: Clock, begun: bool) -> list[str]:
    """The walk in sentences. `begun`: something was heard at all."""
    if not begun:
        return ["Nothing was heard of either foot."]
    told = [f"The recording lasts {lasted(clock.end - clock.begin)}."]
    stepped = {foot: tally.feet[foot] for foot in Foot if foot in tally.feet and tally.feet[foot].steps}
    for foot, one in stepped.items():
        degraded = f", in {one.degraded} of them samples are missing or saturated" if one.degraded else ""
        far = f" over {number(one.distance, 1)} m" if one.distance > 0.0 else ""
        told.append(f"The {foot.value} foot took {one.steps} stride{'s' * (one.steps != 1)}{far}{degraded}.")
    if not stepped:
        told.append("No foot took a step.")
    if tally.fused is not None:
        told.append(f"Both feet together went {number(tally.fused.distance, 1)} m.")
    spans = tally.timeline.lasted(clock.end)
    if spans:
        told.append(f"Activities: {', '.join([f'{named(what)} {lasted(t)}' for what, t in spans.items()])}.")
    told += [f"{one[0].upper()}{one[1:]}." for one in did(tally) if not one.startswith("activities")]
    return told


def wrong(tally: Tally) -> list[str]:
    """What was wrong with sensors, their wearing and their links; nothing when all is well."""
    found = [*worn(tally), *link_health(tally)]
    found += [f"{foot.value} foot: {one.gaps} gaps in the samples, {number(one.gap_time)} s in all"
              for foot, one in tally.feet.items() if one.gaps]  # fmt: skip
    found += [f"suspect scale, {what}" for what in tally.suspects]
    return [f"{one[0].upper()}{one[1:]}." for one in found if one]


def without(tally: Tally) -> list[str]:
    """What the recipe had to do without."""
    return [f"{one[0].upper()}{one[1:]}." for one in tally.limitations if one]


def sensors(links: Links) -> str:
    """Which there were, in a line."""
    told = []
    for site, one in links.sites.items():
        named_so = f" ({one.name})" if one.name else ""
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
