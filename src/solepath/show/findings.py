"""Puts into words what is wrong with a recording: the one list that summary, run.json, page, report and check show."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum

from attrs import evolve, frozen

from ..events import (
    CellFault,
    CellsFailed,
    Defect,
    DefectFound,
    Event,
    FeetSwapped,
    Flaw,
    FootSilent,
    InsoleNeverUnloads,
    Limitation,
    LinkTrouble,
    Rejection,
)
from ..events.foot import LONGEST_HARMLESS_GAP
from ..recording import printable
from ..types import SITE_OF_FOOT, Foot, Site
from ..walk.links import LinkLedger
from ..walk.walk import FootCounts, Walk, site_of
from .tables.table import counted, times

MAX_NAMED_CELLS = 8
"""Largest number of cells that a sentence names one by one; chosen by hand."""
MAX_LENGTH = 2000
"""Largest number of characters of a sentence that are shown; chosen by hand."""
SHORTEST_ABSENCE = 0.05
"""Shortest absence that is written, s; a shorter one would be written as 0.0 s."""


LARGE_SHARE = 0.1
"""Share of a site's packets from which on those that are not used are named; chosen by hand.

The radio of `solepath demo` (3 in 100 lost, 5 in 1000 damaged) rejects 0.6 in 100, duplicates not counted, and one that
damages 5 in 100 rejects 5. A tenth is twice that: a wrong layout, a small MTU or a full queue. Only where an insole's
frames come in fragments can a radio alone reach it, since each lost or damaged fragment costs a frame: 13 in 100 at an
MTU of 104 with 10 in 100 lost and 5 damaged. The sentence then names the fragments."""
MAX_NAMED = 3
"""Largest number of channels that a sentence names; chosen by hand."""
CAUSES = {
    Rejection.TRUNCATED: "shorter than the layout of its channel: the layout (of a driver, its Struct) does not fit "
    "these bytes, they are cut on the way (by a small MTU), or a fragment of an insole's frame got lost or came too "
    "late",
    Rejection.OVERSIZED: "longer than the layout of its channel: the layout (of a driver, its Struct) does not fit "
    "these bytes, or two packets are joined",
    Rejection.CHECKSUM: "the checksum does not fit the bytes: they are damaged on the way, or of another firmware",
    Rejection.MALFORMED: "a field holds what its layout does not allow: the layout does not fit these bytes, or they "
    "are damaged on the way",
    Rejection.UNKNOWN_CHANNEL: "no known device, or not the one at this site, has this channel: check its name, and "
    "whether its driver is there",
    Rejection.WRONG_SITE: "of another site than the one it came for: check which device is where",
    Rejection.WRONG_LAYOUT: "another number of pressure cells than the insole's layout has: check its firmware",
    Rejection.DUPLICATE: "it came twice: nothing is missing, but look for what sends twice",
    Rejection.LATE: "an older one came after a newer: check your queue, or what else changes the order",
    Rejection.NOT_FINITE: "a value or a time is infinite or no number: check what computes it",
    Rejection.ABSURD: "a value or a time that no sensor gives: check its unit and layout",
    Rejection.TIME_BACKWARDS: "its time is earlier than the one before: check the order, and that there is one clock",
    Rejection.WRONG_DEVICE: "another device sends for this site: check which is where (Session.bind lets it)",
}
"""The likely causes, in words, of each reason for which a packet or a sample is rejected (docs/events.md)."""
NO_STEADY = (
    "no gait cycle is steady, so that there are no means: steady ones are neither first nor last of a walk, nor in a "
    "turn, on stairs or degraded"
)
NOT_COMPARED = "the times of the feet could not be compared: step time and double support are left out"
NOTHING_RIGHT = "the data of no foot can be right, so nothing of the walk is counted"
ADVICE = "a device of your own needs its driver: --driver FILE.py (docs/device.md)"


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


KINDS = {Concern.DATA: "DEFECT, ", Concern.LIMITATION: "limitation, "}
"""Words before the lines of findings."""
CELLS = {
    CellFault.DEAD: ("shows no load", "show no load"),
    CellFault.STUCK: ("shows one value all the time", "show one value all the time"),
    CellFault.SATURATED: ("stays at the end of its range", "stay at the end of their range"),
    CellFault.INVERTED: (
        "falls under load, as if wired the other way round",
        "fall under load, as if wired the other way round",
    ),
    CellFault.NOISY: ("jumps from sample to sample, as an open input", "jump from sample to sample, as open inputs"),
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
    Flaw.GAP: f"a gap of more than {1e3 * LONGEST_HARMLESS_GAP:.0f} ms and two samples",
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
    def line(self) -> str:
        """The text as a line among others, with the kind of the finding."""
        return f"{KINDS.get(self.concern, '')}{self.text}"

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
    found = [*reported(walk), *[Finding(one.code, None, one.what, Concern.LINK, one.act) for one in walk.remarks]]
    for site, link in links_of(walk):
        found += [Finding(code, site, what, Concern.LINK, act) for code, what, act in _of_link(link, walk.now) if what]
    for foot in walk.known_feet:
        counts = walk.feet.get(foot, FootCounts())
        if foot not in walk.measured_feet:
            found.append(Finding("foot_left_out", SITE_OF_FOOT[foot], _left_out(walk), Concern.STRIDES))
        flaws = [f"{words} in {counts.flaws[flaw]}" for flaw, words in FLAWS.items() if counts.flaws[flaw]]
        what = f"{counts.degraded} of {counted(counts.strides, 'stride')} degraded: {', '.join(flaws)}"
        found += [Finding("strides_degraded", SITE_OF_FOOT[foot], what, Concern.STRIDES)] if counts.degraded else []
    found += [Finding(code, None, what, Concern.STRIDES) for code, what in _withheld(walk)]
    return sorted(found, key=lambda one: one.concern.value)


def _withheld(walk: Walk) -> Iterator[tuple[str, str]]:
    """Yield code and words of what is known of no gait cycle, though there are some."""
    means = [one for one in (walk.gait.of(False), walk.gait.of(True)) if one is not None]
    if not means and any([cycles.count for cycles in walk.cycles.values()]):
        yield "no_steady_cycle", NO_STEADY
    has_both = any([len(one.feet) == len(Foot) for one in means]) and not [one for one in means if one.both.step_time]
    if has_both and Defect.CLOCKS not in [one.defect for one in walk.found_defects]:
        yield "feet_not_compared", NOT_COMPARED


def _left_out(walk: Walk) -> str:
    """Return what it means for the figures of a walk that the data of a foot cannot be right."""
    others = [foot for foot in walk.measured_feet]
    return (
        f"left out of strides, gait and distance, which are those of the {others[0]} foot alone"
        if others
        else NOTHING_RIGHT
    )


def reported(walk: Walk, *, now: bool = False) -> list[Finding]:
    """Return what events of a walk say is wrong: all of it, or what holds `now`."""
    faults = [fault for fault in walk.faults.values() if fault.holds or not now]
    sentences = [finding_of(fault.event, fault.count) for fault in faults]
    return [_beside(one, walk) for one in sentences if one is not None and not _is_explained(one, walk)]


def _is_explained(one: Finding, walk: Walk) -> bool:
    """Return whether another defect is the cause: of strides that cannot be, or of a height that air contradicts."""
    causes = [other for other in walk.found_defects if other.site is one.site and other.spoils]
    if one.code == Defect.IMPOSSIBLE_MOTION.name.lower():
        return any([other.defect is not Defect.IMPOSSIBLE_MOTION for other in causes])
    return one.code == Defect.AIR_PRESSURE.name.lower() and len(causes) > 0


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


def _of_link(link: LinkLedger, now: float) -> Iterator[tuple[str, str, bool]]:
    """Yield code and words of each figure of a link, "" for none, and whether somebody must act on it."""
    yield "samples_missing" if link.missing else "sensor_absent", missing_words(link, now), False
    is_unknown = link.unknown.total() > (0.0 if link.rejected_all else LARGE_SHARE * link.packets)
    names = ", ".join([printable(name, 80) for name, _ in link.unknown.most_common(MAX_NAMED)])
    unknown = (
        f"{link.unknown.total()} of {link.packets} packets are of a channel that no known device has, or not the one "
        f"at this site ({names}): {ADVICE}"
    )
    yield "channel_unknown", unknown if is_unknown else "", True
    for kind in ("packet", "sample"):
        reasons = {Rejection(reason): count for (what, reason), count in link.rejected.items() if what == f"{kind}s"}
        if is_unknown:
            reasons.pop(Rejection.UNKNOWN_CHANNEL, None)
        words = ", ".join(sorted([f"{reason.value} {count}" for reason, count in reasons.items()]))
        rejected, lost = sum(reasons.values()), sum(reasons.values()) - reasons.get(Rejection.DUPLICATE, 0)
        total = link.packets if kind == "packet" else link.samples + rejected
        if lost > LARGE_SHARE * total or (lost and link.rejected_all):
            used = f"only {total - lost} of {total} {kind}s"
            used = f"none of its {total} {kind}s" if lost >= total else used
            chief = max(reasons, key=lambda one: reasons[one] * (one is not Rejection.DUPLICATE))
            yield f"{kind}s_rejected", f"{used} can be used ({words}); {chief.value} means {CAUSES[chief]}", True
        else:
            yield f"{kind}s_rejected", f"{counted(rejected, kind)} rejected ({words})" if words else "", False
    for code, count, text in (
        ("clock_reset", link.clock_resets, "the clock was reset {}"),
        ("stream_stale", link.silences, "the stream fell silent {}"),
        ("stream_restarted", link.restarts, "the stream froze and was set up again {}"),
        ("connected", link.connections - 1, "connected again {}"),
    ):
        yield code, text.format(times(count)) if count > 0 else "", False
    dropped = f"{counted(link.dropped, 'packet')} dropped: too many came to be used in time"
    yield "packets_dropped", dropped if link.dropped else "", False
