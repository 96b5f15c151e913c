"""Judges how well a walk was measured, in words: good, look at, do not use.

Limits without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from xml.etree.ElementTree import Element

from attrs import frozen

from ....events import Defect, DefectFound
from ....types import SITE_OF_FOOT, Foot, Site
from ....walk.walk import Walk
from ...tables.gait import MIN_STRIDES
from ...tables.summary import missing_words, wear_lines
from ...tables.table import counted, times
from ..markup import add, whole_sentences

GOOD_GAP_SHARE, MAX_GAP_SHARE = 0.01, 0.25
"""Share of time without samples up to which a recording is complete, and above which its figures should not be used."""


class QualityVerdict(Enum):
    """A judgement of one part of the measurement; the value is its word."""

    GOOD = "good"
    NOTE = "note"
    LOOK = "look at"
    STOP = "do not use"


@frozen
class Judgement:
    """The verdict on one part of the measurement, and what was found."""

    part: str
    verdict: QualityVerdict
    words: str
    concern: str = ""
    """Concern to check before the figures are used; "" if the part is good."""


@frozen(kw_only=True)
class MeasuredWalk:
    """All that is judged."""

    walk: Walk
    found: int
    """Number of gait cycles of both feet."""
    used: int
    """Number of them in the means."""
    duration: float
    """Duration of the recording, s."""
    defects: Mapping[tuple[Site, Defect], DefectFound]
    clocks_compared: bool
    """True if the gait means have a value that compares the times of the feet."""
    calibrated: bool


def judgements(walked: MeasuredWalk) -> list[Judgement]:
    """Return the judgement of each part that there is anything to say about."""
    if not walked.walk.known_feet:
        return []
    parts = [judge(walked) for judge in (_strides, _samples, _clocks, _plausibility, _wear, _calibration)]
    return [part for part in parts if part is not None]


def overall(parts: Sequence[Judgement]) -> str:
    """Return the worst verdict in words."""
    verdicts = [part.verdict for part in parts]
    if QualityVerdict.STOP in verdicts:
        return "do not use before it is checked"
    looks = verdicts.count(QualityVerdict.LOOK)
    return f"look at {counted(looks, 'point')}" if looks else "good"


def quality_box(parent: Element, parts: Sequence[Judgement]) -> None:
    """Add a list of the parts, each with its verdict in a word of its own colour."""
    box = add(parent, "dl", class_="quality")
    for part in parts:
        row = add(box, "div")
        name = add(row, "dt")
        add(name, "span", part.part)
        add(name, "strong", part.verdict.value, class_=f"verdict {part.verdict.name.lower()}")
        add(row, "dd", part.words)


def _strides(walked: MeasuredWalk) -> Judgement:
    if not walked.found:
        return Judgement("strides", QualityVerdict.LOOK, "No stride was found.", "no strides")
    words = f"{walked.used} of {counted(walked.found, 'stride')} are steady and count."
    if walked.used >= MIN_STRIDES:
        return Judgement("strides", QualityVerdict.GOOD, words)
    words += f" Figures settle with {MIN_STRIDES} (Galna et al. 2013)."
    return Judgement("strides", QualityVerdict.LOOK, words, "few strides")


def _samples(walked: MeasuredWalk) -> Judgement:
    missing, worst = [], 0.0
    for foot in walked.walk.known_feet:
        link = walked.walk.links.get(SITE_OF_FOOT[foot])
        if link is not None and (words := missing_words(link)):
            absent = link.absent_time / walked.duration if walked.duration > 0.0 else 0.0
            worst = max(worst, link.missing_share, absent)
            missing.append(f"{foot} foot {words}")
    silences = walked.walk.silences.total()
    if silences:
        missing.append(f"a foot was silent {times(silences)} while the other walked on")
    if not missing:
        return Judgement("samples", QualityVerdict.GOOD, "No sample is missing.")
    verdict = QualityVerdict.GOOD if worst <= GOOD_GAP_SHARE and not silences else QualityVerdict.LOOK
    verdict = QualityVerdict.STOP if worst > MAX_GAP_SHARE else verdict
    return Judgement("samples", verdict, f"{'; '.join(missing)}.", "missing samples")


def _clocks(walked: MeasuredWalk) -> Judgement | None:
    part = "clocks"
    for (_, defect), event in walked.defects.items():
        if defect is Defect.CLOCKS:
            words = " ".join(whole_sentences([f"{event.site.words}: {event.what}"]))
            return Judgement(part, QualityVerdict.LOOK, words, "the clocks of the feet")
    resets = sum([link.clock_resets for link in walked.walk.links.values()])  # whole numbers
    if resets:
        return Judgement(part, QualityVerdict.LOOK, f"A sensor's clock restarted {times(resets)}.", "restarted clocks")
    if len(walked.walk.known_feet) < len(Foot) or not walked.found:
        return None
    if walked.clocks_compared:
        return Judgement(part, QualityVerdict.GOOD, "The times of both feet fit together.")
    words = "The times of the feet could not be compared."
    return Judgement(part, QualityVerdict.LOOK, words, "the clocks of the feet")


def _plausibility(walked: MeasuredWalk) -> Judgement:
    part, found = "plausibility", [one for key, one in walked.defects.items() if key[1] is not Defect.CLOCKS]
    if not found:
        return Judgement(part, QualityVerdict.GOOD, "Nothing contradicts itself or physics.")
    verdict = QualityVerdict.STOP if any(one.spoils for one in found) else QualityVerdict.LOOK
    words = whole_sentences([f"{one.site.words}: {one.defect.value}" for one in found])
    concern = "data that cannot be right" if verdict is QualityVerdict.STOP else "data that are less accurate"
    return Judgement(part, verdict, f"{' '.join(words)} What to do is under Sensors and links.", concern)


def _wear(walked: MeasuredWalk) -> Judgement | None:
    lines = [line for line in walked.walk.wear_problems if line in wear_lines(walked.walk)]
    return (
        Judgement("wearing", QualityVerdict.LOOK, " ".join(whole_sentences(lines)), "how the sensors are worn")
        if lines
        else None
    )


def _calibration(walked: MeasuredWalk) -> Judgement:
    if walked.calibrated:
        return Judgement("calibration", QualityVerdict.GOOD, "One of this wearer, these shoes or sensors was used.")
    return Judgement("calibration", QualityVerdict.NOTE, "No calibration was given: the sensors' own scale is used.")
