"""Puts into words what is wrong with a recording: the one list that summary, run.json, page, report and check show."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum

from attrs import evolve, frozen

from ..events import (
    CellFault,
    CellsFailed,
    DefectFound,
    Event,
    FeetSwapped,
    Flaw,
    FootSilent,
    InsoleNeverUnloads,
    Limitation,
    LinkTrouble,
)
from ..events.foot import LONGEST_HARMLESS_GAP
from ..recording import printable
from ..types import SITE_OF_FOOT, Site
from ..walk.links import LinkLedger
from ..walk.walk import Walk, site_of
from .tables.table import counted, times

MAX_NAMED_CELLS = 8
"""Largest number of cells that a sentence names one by one; chosen by hand."""
MAX_LENGTH = 2000
"""Largest number of characters of a sentence that are shown; chosen by hand."""
SHORTEST_ABSENCE = 0.05
"""Shortest absence that is written, s; a shorter one would be written as 0.0 s."""


class Concern(Enum):
    """What a finding is about; findings are in this order."""

    DATA = 0
    """Data contradict themselves or physics."""
    WEAR = 1
    """How sensors are worn, their cells, and a foot that sends nothing."""
    LINK = 2
    """What did not arrive, or was not used."""
    STRIDES = 3
    """Strides that are degraded."""
    LIMITATION = 4
    """What the session does without."""


CELLS = {
    CellFault.DEAD: ("shows no load", "show no load"),
    CellFault.STUCK: ("shows one value all the time", "show one value all the time"),
    CellFault.SATURATED: ("stays at the end of its range", "stay at the end of their range"),
    CellFault.MISSING: ("sends no number", "send no number"),
}
"""Words for a fault of one cell, and of several."""
SENTENCES: dict[type[Event], tuple[Concern, bool, str]] = {
    DefectFound: (Concern.DATA, True, "{0.what}"),
    CellsFailed: (
        Concern.WEAR, False, "{1}. They are left out from now on: have the insole repaired; its other cells count."
    ),
    InsoleNeverUnloads: (
        Concern.WEAR, False,
        "the insole is never without load. The phases come from the inertial sensor: loosen the shoe, or lay the "
        "insole in again.",
    ),
    FeetSwapped: (
        Concern.WEAR, True,
        "the insoles may be swapped: what comes as the left foot looks like a right one. Stop, and put each sensor on "
        "its own foot.",
    ),
    FootSilent: (
        Concern.WEAR, True,
        "nothing comes while the other foot walks on{2}. See whether the sensor is switched on, charged and near.",
    ),
    LinkTrouble: (Concern.LINK, True, "{0.what}"),
    Limitation: (Concern.LIMITATION, False, "{0.what}"),
}  # fmt: skip
"""Concern of each event that says what is wrong, whether results are wrong until somebody acts, and the sentences."""
FLAWS = {
    Flaw.GAP: f"a gap of more than {1e3 * LONGEST_HARMLESS_GAP:.0f} ms",
    Flaw.RANGE: "values at the end of a range",
    Flaw.TWO_STRIDES: "two strides in one",
    Flaw.IMPOSSIBLE: "a speed or a height that cannot be",
    Flaw.DEFECT: "data that cannot be right",
}
"""Words for what makes a stride wrong."""


@frozen
class Finding:
    """Something that is wrong with a recording, or that is missing in it."""

    code: str
    """Name of the defect, or of what else was found, such as "axes" or "foot_silent"."""
    site: Site | None
    """Site of the sensor; None for both feet, or for the whole session."""
    what: str
    """Sentences for the wearer, without the site: what is wrong, and what to do about it."""
    concern: Concern
    act: bool = False
    """True if results are wrong until somebody acts."""
    event: Event | None = None
    """Event that says it; None for what was counted."""

    @property
    def text(self) -> str:
        """Sentences with the site, for a line of text."""
        return self._with_site(self.what)

    @property
    def brief(self) -> str:
        """First sentence with the site, without a full stop."""
        return self._with_site(self.what.partition(". ")[0])

    def _with_site(self, words: str) -> str:
        return printable(words if self.site is None else f"{self.site.words}: {words}", MAX_LENGTH)


def finding_of(event: Event, count: int = 1) -> Finding | None:
    """Return what an event that came so many times says is wrong; None for an event that says nothing of the kind."""
    if (sentences := SENTENCES.get(type(event))) is None:
        return None
    concern, act, words = sentences
    code, cells = re.sub(r"\B([A-Z])", r"_\1", type(event).__name__).lower(), ""
    if isinstance(event, DefectFound):
        code, act = event.defect.name.lower(), event.needs_action
    if isinstance(event, CellsFailed):
        several, numbers = len(event.cells) > 1, ", ".join(map(str, event.cells))
        named = f"{len(event.cells)} cells" if len(event.cells) > MAX_NAMED_CELLS else f"cell{'s' * several} {numbers}"
        cells = f"{named} {CELLS[event.fault][several]}"
    what = words.format(event, cells, f" ({times(count)})" if count > 1 else "")
    return Finding(code, site_of(event), what, concern, act, event)


def findings(walk: Walk) -> list[Finding]:
    """Return what is wrong with a walk, in the order of `Concern`."""
    sentences = [finding_of(fault.event, fault.count) for fault in walk.faults.values()]
    found = [_beside(one, walk) for one in sentences if one is not None]
    for site, link in links_of(walk):
        found += [Finding(code, site, what, Concern.LINK) for code, what in _of_link(link, walk.now) if what]
    for foot, counts in walk.feet.items():
        flaws = [f"{words} in {counts.flaws[flaw]}" for flaw, words in FLAWS.items() if counts.flaws[flaw]]
        what = f"{counts.degraded} of {counted(counts.strides, 'stride')} degraded: {', '.join(flaws)}"
        found += [Finding("strides_degraded", SITE_OF_FOOT[foot], what, Concern.STRIDES)] if counts.degraded else []
    return sorted(found, key=lambda one: one.concern.value)


def texts(walk: Walk, *concerns: Concern) -> list[str]:
    """Return the findings of some concerns as lines of text."""
    return [one.text for one in findings(walk) if one.concern in concerns]


def links_of(walk: Walk) -> list[tuple[Site, LinkLedger]]:
    """Return the ledgers of the links in the order of Site."""
    return [(site, walk.links[site]) for site in Site if site in walk.links]


def missing_words(link: LinkLedger, now: float) -> str:
    """Return how many samples of a link are missing, and how long its sensor was absent until `now`, s; else ""."""
    words = []
    if link.missing:
        share = f"{100.0 * link.missing_share:.1f} %, {link.missing_time:.2f} s"
        words.append(f"{link.missing} of {counted(link.taken, 'sample')} missing ({share})")
    if (absent := link.absent_time(now)) >= SHORTEST_ABSENCE:
        words.append(f"absent for {absent:.1f} s")
    return ", ".join(words)


def _beside(one: Finding, walk: Walk) -> Finding:
    """Return a finding as it is beside the others: a wrong scale comes before the choice of another range."""
    fault, _, advice = one.what.partition(": choose a larger ")
    codes = [other.defect.name for other in walk.found_defects if other.site is one.site]
    is_scaled = advice and "WRONG_SCALE" in codes and "accelerometer" in fault
    return evolve(one, what=f"{fault}: correct its scale first") if is_scaled else one


def _of_link(link: LinkLedger, now: float) -> Iterator[tuple[str, str]]:
    """Yield code and words of each figure of a link; no words for none."""
    yield "samples_missing", missing_words(link, now)
    for kind in ("packet", "sample"):
        reasons = {reason: count for (what, reason), count in link.rejected.items() if what == f"{kind}s"}
        detail = ", ".join([f"{reason} {count}" for reason, count in sorted(reasons.items())])
        yield f"{kind}s_rejected", f"{counted(sum(reasons.values()), kind)} rejected ({detail})" if detail else ""
    for code, count, words in (
        ("clock_reset", link.clock_resets, "the clock was reset {}"),
        ("stream_stale", link.silences, "the stream fell silent {}"),
        ("stream_restarted", link.restarts, "the stream froze and was set up again {}"),
    ):
        yield code, words.format(times(count)) if count else ""
    dropped = f"{counted(link.dropped, 'packet')} dropped: too many came to be used in time"
    yield "packets_dropped", dropped if link.dropped else ""
    yield "connected", f"connected {times(link.connections)}" if link.connections > 1 else ""
