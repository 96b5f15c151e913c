"""Judges how well a walk was measured, in words: good, look at, do not use.

Limits without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from enum import Enum
from xml.etree.ElementTree import Element

from attrs import evolve, frozen

from ....events import Defect
from ....recipes import DEFAULT
from ....types import SITE_OF_FOOT, Foot
from ...findings import FLAWS, Concern, missing_words, texts
from ...tables.gait import MIN_STRIDES, strides_of
from ...tables.svg import add
from ...tables.table import counted, times
from ..markup import whole_sentences
from .facts import Facts

GOOD_GAP_SHARE, MAX_GAP_SHARE = 0.01, 0.25
"""Share of time without samples up to which a recording is complete, and above which its figures should not be used."""

GOOD_DEGRADED_SHARE, MAX_DEGRADED_SHARE = 0.05, 0.5
"""Share of a foot's strides that are degraded up to which they are good, and above which most figures are wrong."""
BEFORE = "walk before"
"""Part that says how well an earlier walk was measured, with which this one is compared."""
FORM = "Bias (95 % limits; ICC) of"
ACCURACY = {
    (True, False): (
        f"{FORM} 1822 to 1888 cycles labelled by hand: stride time -8 ms (-192 to 177; 0.80), stance 8 ms "
        "(-171 to 187; 0.79), swing -16 ms (-98 to 66; 0.63), double support 2.3 points (-6.1 to 10.8; 0.74)",
        "; of 409 on a treadmill: stride length -1.2 cm (-14.8 to 12.3; 0.65)",
    ),
    (False, True): (
        f"{FORM} 774 to 787 cycles by force, cells alone: stride time -3 ms (-100 to 95; 0.90), stance -28 ms "
        "(-132 to 76; 0.78), swing 25 ms (-10 to 60; 0.85), double support -4.3 points (-9.3 to 0.7; 0.66)",
        "",
    ),
    (True, True): (
        f"{FORM} only 10 to 12 cycles by another insole's program: stride time 5 ms (-15 to 24; 0.99), stance 22 ms "
        "(-16 to 59; 0.92), swing -17 ms (-39 to 5; 0.71), double support 2.8 points (0.4 to 5.3; 0.25)",
        ", stride length -0.7 cm (-11.9 to 10.4; 0.73)",
    ),
}
"""Agreement with references of times, and of stride length, by whether there are motion sensors and cells.

`solepath-lab agreement DIR`: ipol_10m_uturn and tripod_treadmill, gaitpdb_vgrf, moticon_pressed (docs/accuracy.md)."""


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


def judgements(facts: Facts, before: Facts | None = None, concerning: Collection[str] | None = None) -> list[Judgement]:
    """Return the judgement of each part that there is anything to say about; the walk `before` is one of them.

    Of a test, `concerning` names the parts that concern its result; what there is to say about others is a note."""
    if not facts.report.walk.known_feet:
        return []
    found = {
        "gait cycles": _gait_cycles(facts),
        "samples": _samples(facts),
        "strides": _strides(facts),
        "clocks": _clocks(facts),
        "plausibility": _plausibility(facts),
        "wearing": _wear(facts),
        "calibration": _calibration(facts),
        BEFORE: None if before is None else _before(judgements(before, None, concerning)),
        "accuracy": _accuracy(facts),
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
    row = "<div class='{}'><dt><span>{}</span><strong class='verdict {}'>{}</strong></dt><dd>{}</dd></div>"
    for part in parts:
        kind = "whole" if part.part in (BEFORE, "accuracy") else ""
        add(box, row, kind, part.part, part.verdict.name.lower(), part.verdict.value, part.words)


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
    return verdict, " ".join(whole_sentences(missing)) or "No sample is missing.", "missing samples"


def _strides(facts: Facts) -> Found | None:
    """Return the judgement of the strides that are wrong: they are in no mean, but in the distance."""
    walk = facts.report.walk
    counts = {foot: walk.feet[foot] for foot in walk.measured_feet if foot in walk.feet and walk.feet[foot].strides}
    if not counts:
        return None
    degraded = [f"{one.degraded} of {one.strides} of the {foot} foot" for foot, one in counts.items() if one.degraded]
    if not degraded:
        return GOOD, "No stride is degraded.", ""
    worst = max([one.degraded / one.strides for one in counts.values()])
    causes = [words for flaw, words in FLAWS.items() if any([one.flaws[flaw] for one in counts.values()])]
    verdict = STOP if worst > MAX_DEGRADED_SHARE else LOOK if worst > GOOD_DEGRADED_SHARE else GOOD
    return verdict, f"Degraded: {', '.join(degraded)} ({', '.join(causes)}).", "degraded strides"


def _before(parts: Sequence[Judgement]) -> Found | None:
    """Return the judgement of the walk before, which is something to look at: figures of this walk do not need it."""
    wrong = [part for part in parts if part.verdict in (LOOK, STOP)]
    if not wrong:
        return (GOOD, "There is nothing to look at.", "") if parts else None
    concerns = ", ".join([part.concern for part in wrong])
    return LOOK, " ".join([part.words for part in wrong]), f"the walk before ({concerns})"


def _accuracy(facts: Facts) -> Found | None:
    """Return how figures of this recipe and these sensors agreed with references; None for runs and without sensors."""
    links = [link for site, link in facts.report.walk.links.items() if site.foot is not None]
    kind = any([link.has_motion for link in links]), any([link.has_pressure for link in links])
    walked = [means for means in facts.means if not means.running]
    if not walked or kind not in ACCURACY:
        return None
    if facts.report.recipe != DEFAULT.name:
        return NOTE, "Not measured for this recipe.", ""
    times, length = ACCURACY[kind]
    return NOTE, f"{times}{length if walked[0].both.stride_length is not None else ''}.", ""


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
        strides = sum([counts.degraded for counts in facts.report.walk.feet.values()])  # whole numbers
        but = " but in degraded strides" if strides else ""
        return GOOD, f"Nothing contradicts itself or physics{but}.", ""
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
