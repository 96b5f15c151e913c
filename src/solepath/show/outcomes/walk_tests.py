"""The six-minute walk, and the timed up and go in total, from the events of a session.

A distance is the mean of what both feet went, stride by stride, turns included: along a corridor there and back it is
the length of the corridor for each crossing, and a little more for each turn that is walked in a bend. A stride counts
with the share of its swing that lies in the time of the test. While the sensor of a foot sends nothing, the distance is
that of the other foot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import fsum, inf
from typing import NamedTuple

from attrs import field, frozen

from ...events import Event, GaitCycleMeasured, StrideTaken, TurnMade
from ...types import Foot, Turn
from .absences import Absences
from .bouts import MAX_BREAK, count_contacts, mean_of, walking_bouts

SIX_MINUTES, MINUTE = 360.0, 60.0
"""Duration of the test, and of the parts in which its course is given, s (ATS 2002)."""
MAX_UNMEASURED_SHARE = 0.01
"""Share of the time of a test in which no foot is measured, up to which its distance is the whole one.

It is the share up to which a report calls the samples good; one per cent of 450 m is a seventh of the smallest change
that matters."""


@frozen(kw_only=True)
class SixMinuteWalk:
    """A six-minute walk test (ATS 2002, Am. J. Respir. Crit. Care Med. 166) by foot-worn sensors."""

    t_start: float
    """Time at which the test starts, s."""
    duration: float
    """Duration that was measured, s: 360, or less when the recording ends before."""
    distance: float | None
    """Distance walked while a foot was measured, m: the mean of the feet that were; None when no stride was taken."""
    foot_distances: Mapping[Foot, float]
    """Distance of each foot that was measured all the time, m."""
    minutes: tuple[float | None, ...]
    """Distances walked in each whole minute, m; None for one that was not wholly measured.

    There is none when no stride was taken."""
    steps: int
    """Number of initial contacts of both feet while a foot was measured."""
    stops: int
    """Number of times that nobody walked for more than 3 s: breaks between walking bouts, from the start to the end."""
    stopped_time: float
    """Sum of the durations of these stops, s."""
    about_turns: int | None
    """Number of turns about, as at the ends of a corridor; None when no stride was taken."""
    degraded: int
    """Number of strides that are degraded; they count like the others."""
    unmeasured_time: float = 0.0
    """Time in which the sensors of all feet sent nothing, s; the distance lacks what was walked in it."""
    alone_times: Mapping[Foot, float] = field(factory=dict)
    """Time in which this foot alone was measured, of feet of which both were at other times, s."""

    @property
    def complete(self) -> bool:
        """True if the recording holds all six minutes."""
        return self.duration >= SIX_MINUTES

    @property
    def measured(self) -> bool:
        """True if a foot was measured all the time, but for one per cent of it."""
        return is_measured(self.unmeasured_time, self.duration)

    @property
    def speed(self) -> float | None:
        """Distance over duration, stops included, m/s."""
        return self.distance and self.distance / self.duration

    @property
    def cadence(self) -> float:
        """Steps a minute over the whole duration, stops included."""
        return 60.0 * self.steps / self.duration

    @property
    def distance_index(self) -> float | None:
        """Change of the distance from the first to the sixth minute, as a share of the first; None without six minutes.

        It is the distance walked index of Leone et al. 2016 (Neurorehabil. Neural Repair 30), who name -0.15 or less
        walking-related motor fatigue in people with multiple sclerosis."""
        first, *_, sixth = self.minutes if len(self.minutes) == 6 else (None, None)
        return sixth / first - 1.0 if first and sixth is not None else None


@frozen
class TimedUpAndGo:
    """A timed up and go (Podsiadlo and Richardson 1991, J. Am. Geriatr. Soc. 39), timed by an observer's two marks.

    The total is the time between the marks. It is not divided into standing up, walking, turning and sitting down: from
    a foot, which stays where it is, sitting to standing cannot be seen."""

    t_start: float
    """Time that was marked for "go", s."""
    t_stop: float
    """Time that was marked for sitting again, s."""
    steps: int
    """Number of initial contacts of both feet between the marks."""
    walking_time: float | None
    """Time from the first toe-off between the marks to the last initial contact, s; None when no stride was taken."""
    distance: float | None
    """Mean distance of the feet between the marks, m: 6 m for the usual 3 m there and back; None without strides."""
    unmeasured_time: float = 0.0
    """Time between the marks in which the sensors of all feet sent nothing, s; what was walked in it is lacking."""

    @property
    def measured(self) -> bool:
        """True if a foot was measured all the time, but for one per cent of it."""
        return is_measured(self.unmeasured_time, self.duration)

    @property
    def duration(self) -> float:
        """Time between the marks, s: the outcome of the test."""
        return self.t_stop - self.t_start


def is_measured(unmeasured_time: float, duration: float) -> bool:
    """Return whether this time without any foot, of a duration, both s, may be left out of account."""
    return unmeasured_time <= MAX_UNMEASURED_SHARE * duration


def six_minute_walk(
    events: Sequence[Event], start: float | None = None, end: float | None = None
) -> SixMinuteWalk | None:
    """Return the six-minute walk from events GaitCycleMeasured, StrideTaken and TurnMade, and those of absences.py.

    `start` is the time at which an observer said go, s; without it the walk starts with the first toe-off of the first
    walking bout. `end` is the time at which the recording ends, s; without it that of the last event. None if there is
    no walking bout to start from, or nothing was recorded after the start."""
    bouts, swings, absences = walking_bouts(events), _swings(events), Absences.of(events)
    if start is None:
        if not bouts:
            return None
        contact = bouts[0].t_start
        start = min(
            [swing.lifted for swing in swings if contact - MAX_BREAK <= swing.lifted < contact], default=contact
        )
    last = max([event.t for event in events], default=start) if end is None else end
    duration = min(last - start, SIX_MINUTES)
    if duration <= 0.0:
        return None
    stop = start + duration
    edges = [start, *[t for bout in bouts for t in (bout.t_start, bout.t_end)], stop]
    breaks = [(max(a, start), min(b, stop)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    lengths = [b - a - absences.time_without_strides(a, b) for a, b in breaks]
    stops = [length for length in lengths if length > MAX_BREAK]
    distances = _foot_distances(swings, start, stop)
    starts = [start + k * MINUTE for k in range(int(duration // MINUTE))] if distances else []
    minutes = [
        _distance(swings, absences, t, t + MINUTE) if is_measured(absences.time(t, t + MINUTE), MINUTE) else None
        for t in starts
    ]
    turns = [event for event in events if isinstance(event, TurnMade) and event.turn is Turn.ABOUT]
    return SixMinuteWalk(
        t_start=start,
        duration=duration,
        distance=_distance(swings, absences, start, stop),
        foot_distances={foot: one for foot, one in distances.items() if not absences.time_of(foot, start, stop)},
        minutes=tuple(minutes),
        steps=_count_steps(events, absences, start, stop),
        stops=len(stops),
        stopped_time=fsum(stops),
        about_turns=len([turn for turn in turns if start <= turn.t <= stop]) if distances else None,
        degraded=len([one for one in swings if one.stride.degraded and start < one.stride.t_end <= stop]),
        unmeasured_time=absences.time(start, stop),
        alone_times=absences.alone_times(start, stop),
    )


def timed_up_and_go(events: Sequence[Event], start: float, stop: float) -> TimedUpAndGo:
    """Return the timed up and go between two marks of an observer, s; raise ValueError when they are not in order."""
    if not start < stop:
        raise ValueError(f"timed_up_and_go: start must be before stop, got {start} and {stop}")
    swings, absences = _swings(events), Absences.of(events)
    within = [swing for swing in swings if start <= swing.lifted and swing.landed <= stop]
    walked = max([swing.landed for swing in within]) - min([swing.lifted for swing in within]) if within else None
    steps, distance = _count_steps(events, absences, start, stop), _distance(swings, absences, start, stop)
    return TimedUpAndGo(start, stop, steps, walked, distance, absences.time(start, stop))


def whole_walk(events: Sequence[Event]) -> tuple[int | None, float | None]:
    """Return the number of initial contacts of a recording, and the distance, m: the mean of the feet's distances.

    Neither is known where no foot was measured for more than one per cent of the time."""
    absences, times = Absences.of(events), [event.t for event in events]
    if times and not is_measured(absences.time(min(times), max(times)), max(times) - min(times)):
        return None, None
    return _count_steps(events, absences, -inf, inf), _distance(_swings(events), absences, -inf, inf)


def _count_steps(events: Iterable[Event], absences: Absences, start: float, stop: float) -> int:
    cycles = [event for event in events if isinstance(event, GaitCycleMeasured)]
    counts = [
        count_contacts([cycle for cycle in cycles if cycle.foot not in absent], a, b)
        for a, b, absent in absences.parts(start, stop)
    ]
    return sum(counts)  # whole numbers


class _Swing(NamedTuple):
    """A stride with the times at which the foot left the ground and came down, s."""

    stride: StrideTaken
    lifted: float
    landed: float


def _swings(events: Iterable[Event]) -> list[_Swing]:
    """Return the final strides; those without toe-off or heel-strike swing from foot-flat to foot-flat."""
    swings = []
    for stride in events:
        if isinstance(stride, StrideTaken) and stride.final:
            lifted, landed = stride.t_toe_off, stride.t_heel_strike
            if lifted is None or landed is None or not lifted < landed:
                lifted, landed = stride.t_start, stride.t_end
            swings.append(_Swing(stride, lifted, landed))
    return swings


def _distance(swings: Sequence[_Swing], absences: Absences, start: float, stop: float) -> float | None:
    """Return how far the wearer went between two times, m: the mean of the feet that were measured; None without."""
    found = []
    for a, b, absent in absences.parts(start, stop):
        distances = _foot_distances([swing for swing in swings if swing.stride.foot not in absent], a, b)
        found.append(mean_of(distances.values()))
    return None if all([one is None for one in found]) else fsum([one or 0.0 for one in found])


def _foot_distances(swings: Sequence[_Swing], start: float, stop: float) -> dict[Foot, float]:
    """Return how far each foot went between two times, m; only feet that took a stride in the events."""
    parts: dict[Foot, list[float]] = {}
    for stride, lifted, landed in swings:
        covered = min(stop, landed) - max(start, lifted)
        share = max(0.0, covered / (landed - lifted)) if landed > lifted else float(start < landed <= stop)
        parts.setdefault(stride.foot, []).append(share * stride.length)
    return {foot: fsum(parts[foot]) for foot in Foot if foot in parts}
