"""Gathers what the head of a report says: how far and how long the wearer walked and ran, and the measures of it."""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum

from attrs import frozen

from ....body.gait.means import GaitParameters
from ....types import Activity
from ....walk.walk import Walk
from ..content import ReportContent
from ..measures import Measure, run_measures, walk_measures
from ..walk_summary import SWING_TIME, FootDifference, distance_in, foot_differences, gait_spans


@frozen(kw_only=True)
class Bout:
    """A walk or a run of a recording: its duration and distance, with its measures."""

    duration: float
    """Duration, s."""
    distance: float | None
    """Distance, m; None if it is not known."""
    strides: int
    """Number of gait cycles of both feet."""
    measures: list[Measure]


@frozen(kw_only=True)
class Facts:
    """Facts of a walk that the head of its report shows."""

    recording: Walk
    calibrated: bool
    """True if the session had a calibration."""
    duration: float
    """Duration of the recording, s."""
    stood: bool
    """True if the wearer stood, by the activities."""
    means: list[GaitParameters]
    """Means of walking and of running, of those that there are."""
    walk: Bout | None
    run: Bout | None
    differences: Mapping[str, FootDifference]
    all_measures: list[Measure]
    """Measures of walking and of running."""

    @property
    def kind(self) -> str:
        """Word of the title, for what the wearer did for longer: "Walk", "Run" or "Recording"."""
        if self.walk is None or (self.run is not None and self.run.duration > self.walk.duration):
            return "Recording" if self.run is None else "Run"
        return "Walk"

    @property
    def measures(self) -> list[Measure]:
        """Large figures, of walking, or of running if the wearer only ran."""
        return [one for one in self.all_measures if one.is_of_run is (self.kind == "Run")][:5] or self.all_measures[:5]

    @property
    def difference_words(self) -> str:
        """Asymmetry in words; "" if it is not known."""
        swing = self.differences.get(SWING_TIME)
        if swing is None:
            return ""
        certain = f"{'right' if swing.value > 0.0 else 'left'} longer"
        words = certain if swing.is_certain else "within the error of measurement"
        return f"of swing time, \N{PLUS-MINUS SIGN} {100.0 * swing.half_width:.1f}; {words}"


def facts_of(report: ReportContent) -> Facts:
    """Return what the head of a report shows."""
    walk, clock = report.walk, report.clock
    walking, running = walk.gait.of(False), walk.gait.of(True)
    differences = foot_differences(list(walk.newest_cycles), walking)
    swing = differences.get(SWING_TIME)
    interval = None if swing is None else (100.0 * swing.value, 100.0 * swing.half_width)
    measures = {
        False: [] if walking is None else walk_measures(walking, interval),
        True: [] if running is None else run_measures(running),
    }
    activities = walk.timeline.spans(clock.end)
    cycles = [one for found in walk.cycles.values() for one in found]
    distances = {foot: list(pairs) for foot, pairs in walk.distances.items()}
    bouts = {}
    for is_run, spans in gait_spans(activities, cycles).items():
        duration, distance = fsum([end - start for start, end in spans]), distance_in(spans, distances) or None
        strides = len([one for one in cycles if any([start <= one.t <= end for start, end in spans])])
        if duration > 0.0 and (strides or distance):
            bouts[is_run] = Bout(duration=duration, distance=distance, strides=strides, measures=measures[is_run])
    return Facts(
        recording=walk,
        calibrated=report.calibrated,
        duration=walk.covered_time.total or clock.end - clock.start,
        stood=any([activity is Activity.STANDING for _, _, activity in activities]),
        means=[means for means in (walking, running) if means is not None],
        walk=bouts.get(False),
        run=bouts.get(True),
        differences=differences,
        all_measures=measures[False] + measures[True],
    )
