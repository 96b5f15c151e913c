"""Gathers what the head of a report says: the words of the first sentence, the large figures, the quality."""

from __future__ import annotations

from math import fsum

from attrs import frozen

from ....types import Activity, Foot
from ...tables.gait import strides_of
from ..content import ReportContent
from ..measures import Measure, run_measures, walk_measures
from ..walk_summary import SWING_TIME, FootDifference, distance_in, foot_differences, gait_spans
from .headline import Bout, WalkFacts
from .quality import Judgement, MeasuredWalk, judgements


@frozen(kw_only=True)
class Facts:
    """Facts of a walk that the head of its report shows."""

    walk: WalkFacts
    measures: list[Measure]
    """Large figures, of walking, or of running if the wearer only ran."""
    all_measures: list[Measure]
    """Measures of walking and of running."""
    judgements: list[Judgement]
    kind: str
    """Word of the title: "Walk", "Run" or "Recording"."""
    difference_words: str
    """Asymmetry in words; "" if it is not known."""


def facts_of(report: ReportContent) -> Facts:
    """Return what the head of a report shows."""
    walk = report.walk
    walking, running = walk.gait.of(False), walk.gait.of(True)
    differences = foot_differences(list(walk.newest_cycles), walking)
    swing = differences.get(SWING_TIME)
    interval = None if swing is None else (swing.value, swing.half_width)
    walk_figures = [] if walking is None else walk_measures(walking, interval)
    run_figures = [] if running is None else run_measures(running)
    bouts = _bouts(report, {False: walk_figures, True: run_figures})
    kind = _kind(bouts.get(False), bouts.get(True))
    walked, ran = bouts.get(False), bouts.get(True)
    parameters = [one for one in (walking, running) if one is not None]
    feet = walk.known_feet
    went = walked is not None or ran is not None
    judged = MeasuredWalk(
        walk=walk,
        found=sum([cycles.count for cycles in walk.cycles.values()]),  # whole numbers
        used=sum([strides_of(one, foot) or 0 for one in parameters for foot in Foot]),  # whole numbers
        duration=walk.covered_time.total or report.clock.end - report.clock.start,
        defects=walk.found_defects,
        clocks_compared=any(one.both.step_time is not None for one in parameters),
        calibrated=report.calibrated,
    )
    facts = WalkFacts(
        has_data=walk.event_span is not None,
        duration=judged.duration,
        stood=Activity.STANDING in walk.timeline.durations(report.clock.end),
        walk=walked,
        run=ran,
        flights=walk.flights,
        rides=walk.elevator_rides,
        only_foot=feet[0].value if len(feet) == 1 and went else "",
        differences=differences,
    )
    return Facts(
        walk=facts,
        measures=((run_figures or walk_figures) if kind == "Run" else (walk_figures or run_figures))[:5],
        all_measures=walk_figures + run_figures,
        judgements=judgements(judged),
        kind=kind,
        difference_words=_difference_words(swing),
    )


def _kind(walk: Bout | None, run: Bout | None) -> str:
    """Return the word of the title: what the wearer did for longer."""
    if walk is None or (run is not None and run.duration > walk.duration):
        return "Recording" if run is None else "Run"
    return "Walk"


def _difference_words(swing: FootDifference | None) -> str:
    if swing is None:
        return ""
    interval = f"of swing time, \N{PLUS-MINUS SIGN} {100.0 * swing.half_width:.1f}"
    if not swing.is_certain:
        return f"{interval}; within the error of measurement"
    return f"{interval}; {'right' if swing.value > 0.0 else 'left'} longer"


def _bouts(report: ReportContent, measures: dict[bool, list[Measure]]) -> dict[bool, Bout]:
    """Return what the wearer walked (False) and ran (True), of those that there were.

    Without activities, as with some recipes, it is from the first to the last gait cycle of the kind."""
    cycles = [one for cycles in report.walk.cycles.values() for one in cycles]
    activities = report.walk.timeline.spans(report.clock.end)
    distances = {foot: list(pairs) for foot, pairs in report.walk.distances.items() if len(pairs)}
    if any(activity is not Activity.UNKNOWN for _, _, activity in activities):
        spans = gait_spans(activities, cycles)
    else:
        ends = {kind: [one for one in cycles if one.running is kind] for kind in (False, True)}
        spans = {
            kind: [(min([one.t_start for one in found]), max([one.t for one in found]))] if found else []
            for kind, found in ends.items()
        }
    bouts = {}
    for running, found_spans in spans.items():
        duration = fsum([end - start for start, end in found_spans])
        strides = [one for one in cycles if any(start <= one.t <= end for start, end in found_spans)]
        distance = distance_in(found_spans, distances)
        if duration > 0.0 and (strides or distance):
            bouts[running] = Bout(
                duration=duration,
                distance=distance or None,
                strides=len(strides),
                measures={measure.name: measure for measure in measures[running]},
                prefix="run_" if running else "",
            )
    return bouts
