"""Judges how well a walk was measured, in words: good, look at, do not use.

Limits without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from enum import Enum
from xml.etree.ElementTree import Element

from attrs import evolve, frozen

from ....events import Defect
from ....types import SITE_OF_FOOT, Foot
from ...findings import Concern, missing_words, texts
from ...tables.gait import MIN_STRIDES, strides_of
from ...tables.svg import add
from ...tables.table import counted, times
from ..markup import whole_sentences
from .facts import Facts

GOOD_GAP_SHARE, MAX_GAP_SHARE = 0.01, 0.25
"""Share of time without samples up to which a recording is complete, and above which its figures should not be used."""

ACCURACY = (
    "Of walks: on 1889 cycles labelled by hand, stance was 11 ms shorter than the labels (limits -189 to 168 ms) and "
    "double support 1.1 points less (-9.3 to 7.1); stride length was 1.2 cm less on a treadmill (-14.8 to 12.3 cm)."
)
"""Agreement with references (`solepath-lab agreement DIR`: ipol_10m_uturn, tripod_treadmill; docs/accuracy.md)."""


class QualityVerdict(Enum):
    """A judgement of one part of the measurement; the value is its word."""

    GOOD = "good"
    NOTE = "note"
    LOOK = "look at"
    STOP = "do not use"


GOOD, NOTE, LOOK, STOP = QualityVerdict
Found = tuple[QualityVerdict, str, str]
"""A verdict, what was found in words, and a concern to check before the figures are used; "" if the part is good."""


@frozen
class Judgement:
    """The verdict on one part of the measurement, and what was found."""

    part: str
    verdict: QualityVerdict
    words: str
    concern: str
    """Concern to check before the figures are used; "" if the part is good."""


def judgements(facts: Facts, concerning: Collection[str] | None = None) -> list[Judgement]:
    """Return the judgement of each part that there is anything to say about.

    Of a test, `concerning` names the parts that concern its result; what there is to say about others is a note."""
    if not facts.report.walk.known_feet:
        return []
    found = {
        "gait cycles": _gait_cycles(facts),
        "samples": _samples(facts),
        "clocks": _clocks(facts),
        "plausibility": _plausibility(facts),
        "wearing": _wear(facts),
        "calibration": _calibration(facts),
        "accuracy": (NOTE, ACCURACY, "") if any([not means.running for means in facts.means]) else None,
    }
    notes = [part for part in found if concerning is not None and part not in concerning]
    judged = [Judgement(part, *one) for part, one in found.items() if one is not None]
    return [evolve(one, verdict=NOTE) if one.part in notes and one.verdict in (LOOK, STOP) else one for one in judged]


def overall(parts: Sequence[Judgement]) -> str:
    """Return the worst verdict in words."""
    verdicts = [part.verdict for part in parts]
    if QualityVerdict.STOP in verdicts:
        return "do not use before it is checked"
    looks = verdicts.count(QualityVerdict.LOOK)
    return f"look at {counted(looks, 'point')}" if looks else "good"


def warning(parts: Sequence[Judgement]) -> str:
    """Return a sentence on what to check before the figures are used; "" if nothing is wrong."""
    for verdict, words in ((STOP, "Do not use the figures before this is checked"), (LOOK, "Check before use")):
        concerns = [part.concern for part in parts if part.verdict is verdict]
        if concerns:
            return f"{words}: {', '.join(concerns)}."
    return ""


def quality_box(parent: Element, parts: Sequence[Judgement]) -> None:
    """Add a list of the parts, each with its verdict in a word of its own colour."""
    box = add(parent, "<dl class='quality'/>")
    row = "<div><dt><span>{}</span><strong class='verdict {}'>{}</strong></dt><dd>{}</dd></div>"
    for part in parts:
        add(box, row, part.part, part.verdict.name.lower(), part.verdict.value, part.words)


def _gait_cycles(facts: Facts) -> Found:
    found = sum([cycles.count for cycles in facts.report.walk.cycles.values()])  # whole numbers
    used = sum([strides_of(means, foot) or 0 for means in facts.means for foot in Foot])  # whole numbers
    words = f"{used} of {counted(found, 'gait cycle')} are steady and count."
    if not found:
        return LOOK, "No gait cycle was found that counts.", "no gait cycles"
    if used >= MIN_STRIDES:
        return GOOD, words, ""
    return LOOK, f"{words} Figures settle with {MIN_STRIDES} (Galna et al. 2013).", "few gait cycles"


def _samples(facts: Facts) -> Found:
    missing, worst = [], 0.0
    for foot in facts.report.walk.known_feet:
        link = facts.report.walk.links.get(SITE_OF_FOOT[foot])
        if link is not None and (words := missing_words(link, facts.report.walk.now)):
            absent = link.absent_time(facts.report.walk.now) / facts.duration if facts.duration > 0.0 else 0.0
            worst = max(worst, link.missing_share, absent)
            missing.append(f"{foot} foot {words}")
    verdict = STOP if worst > MAX_GAP_SHARE else LOOK if worst > GOOD_GAP_SHARE else GOOD
    return verdict, f"{'; '.join(missing) or 'No sample is missing'}.", "missing samples"


def _clocks(facts: Facts) -> Found | None:
    walk, concern = facts.report.walk, "the clocks of the feet"
    for event in walk.found_defects:
        if event.defect is Defect.CLOCKS:
            return LOOK, whole_sentences([f"{event.site.words}: {event.what}"])[0], concern
    if resets := sum([link.clock_resets for link in walk.links.values()]):  # whole numbers
        return LOOK, f"A sensor's clock restarted {times(resets)}.", "restarted clocks"
    if len(walk.known_feet) < len(Foot) or not any([cycles.count for cycles in walk.cycles.values()]):
        return None
    if any([means.both.step_time is not None for means in facts.means]):
        return GOOD, "The times of both feet fit together.", ""
    return LOOK, "The times of the feet could not be compared.", concern


def _plausibility(facts: Facts) -> Found:
    found = [one for one in facts.report.walk.found_defects if one.defect is not Defect.CLOCKS]
    if not found:
        return GOOD, "Nothing contradicts itself or physics.", ""
    sentences = whole_sentences([f"{one.site.words}: {one.defect.value}" for one in found])
    words = " ".join([*sentences, "What to do is under Sensors and links."])
    if any([one.spoils for one in found]):
        return STOP, words, "data that cannot be right"
    return LOOK, words, "data that are less accurate"


def _wear(facts: Facts) -> Found | None:
    lines = texts(facts.report.walk, Concern.WEAR)
    return (LOOK, " ".join(whole_sentences(lines)), "how the sensors are worn") if lines else None


def _calibration(facts: Facts) -> Found:
    if facts.report.calibrated:
        return GOOD, "One of this wearer, these shoes or sensors was used.", ""
    return NOTE, "No calibration was given: the sensors' own scale is used.", ""
