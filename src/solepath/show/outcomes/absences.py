"""Times in which strides of a foot are missing because its sensor sent nothing.

Events SampleGap, FootSilent and StreamStale say when a sensor sent nothing. Strides are missing only where the one
before such a time and the one after it do not meet: a gap within a stride is bridged, and the stride says so. Lost
samples that are no flaw of a stride are no absence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, pairwise
from math import fsum, inf

from attrs import frozen

from ...events import Event, FootSilent, GaitCycleMeasured, SampleGap, StreamStale, StrideTaken
from ...events.link import is_harmless_loss
from ...types import Foot
from ...walk.walk import Walk
from .bouts import MAX_STRIDE_TIME

Span = tuple[float, float]
"""Start and end of a time, s."""
Absence = SampleGap | FootSilent | StreamStale
"""Event that says when a sensor sent nothing."""


@frozen
class Absences:
    """The times in which the sensor of a foot sent nothing and strides of it are missing."""

    silences: Mapping[Foot, Sequence[Span]]
    """Times without samples, by foot, s."""
    holes: Mapping[Foot, Sequence[Span]]
    """The same, longer by what is missing of the strides before and after, s."""

    @classmethod
    def of(cls, events: Sequence[Event]) -> Absences:
        """Return the absences of the feet that took strides or gait cycles in these events."""
        silences: dict[Foot, list[Span]] = {}
        holes: dict[Foot, list[Span]] = {}
        final = [one for one in events if isinstance(one, StrideTaken) and one.final]
        strides = sorted([(one.t_start, one.t_end, one.foot) for one in final], key=lambda one: one[:2])
        feet = {one.foot for one in events if isinstance(one, StrideTaken | GaitCycleMeasured)}
        for foot in [foot for foot in Foot if foot in feet]:
            own = [(a, b) for a, b, of in strides if of is foot]
            found = _spans([one for one in events if isinstance(one, Absence) and _foot_of(one) is foot], own)
            # a foot whose first stride comes later than the other's was not measured until then
            first = [(strides[0][0], own[0][0])] if own and own[0][0] - strides[0][0] > MAX_STRIDE_TIME else []
            ends = [-inf, *[t for one in own for t in one], inf]
            spaces = [(a, b) for a, b in zip(ends[::2], ends[1::2], strict=True) if a < b]
            silences[foot], holes[foot] = [*first], [*first]
            for (a, b), (low, high) in [(one, space) for one in found for space in spaces]:
                if max(a, low) < min(b, high):
                    silences[foot].append((max(a, low), min(b, high)))
                    holes[foot].append((max(a - MAX_STRIDE_TIME, low), min(b + MAX_STRIDE_TIME, high)))
        return cls(silences, holes)

    @classmethod
    def of_walk(cls, walk: Walk) -> Absences:
        """Return the absences of a walk; none of one so long that not all of its strides are kept."""
        strides, cycles = walk.strides.values(), walk.cycles.values()
        if any([kept.interval > 1 for kept in strides]):
            return cls({}, {})
        return cls.of([*chain(*strides), *chain(*cycles), *walk.absences])

    def parts(self, start: float, stop: float) -> Iterator[tuple[float, float, set[Foot]]]:
        """Yield the parts of a time, s, with the feet of which strides are missing in it."""
        yield from _parts(self.holes, start, stop)

    def time(self, start: float, stop: float) -> float:
        """Return how long no foot sent anything between two times, s."""
        return _time(self.silences, {*self.silences}, start, stop)

    def time_without_strides(self, start: float, stop: float) -> float:
        """Return how long the strides of all feet are missing between two times, s."""
        return _time(self.holes, {*self.holes}, start, stop)

    def time_of(self, foot: Foot, start: float, stop: float) -> float:
        """Return how long a foot sent nothing between two times, s."""
        return fsum([b - a for a, b, absent in _parts(self.silences, start, stop) if foot in absent])

    def alone_times(self, start: float, stop: float) -> dict[Foot, float]:
        """Return how long each foot alone was measured while the other one sent nothing, s; feet that never were."""
        times = {foot: _time(self.silences, {*self.silences} - {foot}, start, stop) for foot in self.silences}
        return {foot: time for foot, time in times.items() if time > 0.0}


def _foot_of(event: Absence) -> Foot | None:
    return event.foot if isinstance(event, FootSilent) else event.site.foot


def _spans(events: Sequence[Absence], strides: Sequence[Span]) -> list[Span]:
    """Return the times without samples of a foot; the last one has no end if nothing of the foot comes after it."""
    lasting = [one for one in events if isinstance(one, SampleGap) and not is_harmless_loss(one)]
    gaps = [(one.t, one.t + one.duration) for one in lasting]
    last = max([end for _, end in (*gaps, *strides)], default=-inf)
    silences = [(one.known_at - one.silent_for, one.known_at) for one in events if not isinstance(one, SampleGap)]
    return [*gaps, *[(start, inf) for start, known_at in silences if last < known_at]]


def _parts(spans: Mapping[Foot, Sequence[Span]], start: float, stop: float) -> Iterator[tuple[float, float, set[Foot]]]:
    edges = {t for own in spans.values() for span in own for t in span if start < t < stop}
    for a, b in pairwise([start, *sorted(edges), stop]):
        yield a, b, {foot for foot, own in spans.items() if any([low <= a and b <= high for low, high in own])}


def _time(spans: Mapping[Foot, Sequence[Span]], feet: set[Foot], start: float, stop: float) -> float:
    """Return for how long exactly these feet are in a span between two times, s."""
    return fsum([b - a for a, b, absent in _parts(spans, start, stop) if feet and absent == feet])
