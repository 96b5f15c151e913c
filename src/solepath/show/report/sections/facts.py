"""Gathers what the head of a report says: how far and how long the wearer walked and ran, and the measures of it."""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum

from attrs import frozen

from ....body.gait.means import GaitParameters
from ...outcomes.absences import Absences
from ...outcomes.spread import LEFT_OUT
from ..content import ReportContent
from ..measures import Measure, measures
from ..walk_summary import SWING_TIME, FootDifference, distance_in, foot_differences, gait_spans


@frozen
class Bout:
    """A walk or a run of a recording."""

    duration: float
    """Duration, s."""
    distance: float | None
    """Distance, m; None if it is not known."""
    cycles: int
    """Number of gait cycles of both feet."""


@frozen
class Facts:
    """Facts of a walk that the head of its report shows."""

    report: ReportContent
    means: list[GaitParameters]
    """Means of walking and of running, of those that there are."""
    bouts: Mapping[bool, Bout]
    """What the wearer walked (False) and ran (True), of those that there were."""
    differences: Mapping[str, FootDifference]
    all_measures: list[Measure]
    """Measures of walking and of running."""

    @property
    def duration(self) -> float:
        """Duration of the recording, s."""
        clock = self.report.clock
        return self.report.walk.covered_time.total or clock.end - clock.start

    @property
    def kind(self) -> str:
        """Word of the title, for what the wearer did for longer: "Walk", "Run" or "Recording"."""
        if not self.bouts:
            return "Recording"
        return "Run" if max(self.bouts, key=lambda is_run: self.bouts[is_run].duration) else "Walk"

    @property
    def measures(self) -> list[Measure]:
        """Large figures, of walking, or of running if the wearer only ran."""
        return [one for one in self.all_measures if one.running is (self.kind == "Run")][:5] or self.all_measures[:5]

    @property
    def left_out(self) -> str:
        """Sentence on a large figure that is left out; "" for none."""
        swing = self.differences.get(SWING_TIME)
        return LEFT_OUT.format("asymmetry of swing time") if swing is not None and swing.is_vague else ""

    @property
    def difference_words(self) -> str:
        """Asymmetry in words; "" if it is not known, or its interval says nothing."""
        swing = self.differences.get(SWING_TIME)
        if swing is None or swing.is_vague:
            return ""
        certain = f"{'right' if swing.value > 0.0 else 'left'} longer"
        words = certain if swing.is_certain else "within the error of measurement"
        return f"of swing time, \N{PLUS-MINUS SIGN} {100.0 * swing.half_width:.1f}; {words}"


def facts_of(report: ReportContent) -> Facts:
    """Return what the head of a report shows."""
    walk = report.walk
    walking, running = walk.gait.of(False), walk.gait.of(True)
    differences = foot_differences(list(walk.newest_cycles), walking)
    swing = differences.get(SWING_TIME)
    interval = None if swing is None or swing.is_vague else (100.0 * swing.value, 100.0 * swing.half_width)
    found = [] if walking is None else measures(walking, interval)
    found += [] if running is None else measures(running)
    cycles = [one for found in walk.cycles.values() for one in found]
    distances = {foot: list(pairs) for foot, pairs in walk.distances.items() if foot in walk.measured_feet}
    bouts, absences = {}, Absences.of_walk(walk)
    for is_run, spans in gait_spans(walk.timeline.spans(report.clock.end), cycles).items():
        duration, distance = (
            fsum([end - start for start, end in spans]),
            distance_in(spans, distances, absences) or None,
        )
        count = len([one for one in cycles if any([start <= one.t <= end for start, end in spans])])
        if duration > 0.0 and (count or distance):
            bouts[is_run] = Bout(duration, distance, count)
    return Facts(report, [one for one in (walking, running) if one is not None], bouts, differences, found)
