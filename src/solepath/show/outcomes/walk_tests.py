"""The six-minute walk, and the timed up and go in total, from the events of a session.

A distance is the mean of what both feet went, stride by stride, turns included: along a corridor there and back it is
the length of the corridor for each crossing, and a little more for each turn that is walked in a bend. A stride counts
with the share of its swing that lies in the time of the test."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import fsum

from attrs import frozen

from ...events import Event, GaitCycleMeasured, StrideTaken, TurnMade
from ...types import Foot, Turn
from .bouts import MAX_BREAK, count_contacts, mean_of, walking_bouts

SIX_MINUTES, MINUTE = 360.0, 60.0
"""Duration of the test, and of the parts in which its course is given, s (ATS 2002)."""


@frozen(kw_only=True)
class SixMinuteWalk:
    """A six-minute walk test (ATS 2002, Am. J. Respir. Crit. Care Med. 166) by foot-worn sensors."""

    t_start: float
    """Time at which the test starts, s."""
    duration: float
    """Duration that was measured, s: 360, or less when the recording ends before."""
    distance: float | None
    """Distance walked, m: the mean of the feet's distances; None when no stride was taken."""
    foot_distances: Mapping[Foot, float]
    """Distance that each foot went, m."""
    minutes: tuple[float, ...]
    """Distances walked in each whole minute, m."""
    steps: int
    """Number of initial contacts of both feet."""
    stops: int
    """Number of times that nobody walked for more than 3 s: breaks between walking bouts, from the start to the end."""
    stopped_time: float
    """Sum of the durations of these stops, s."""
    about_turns: int
    """Number of turns about, as at the ends of a corridor."""
    degraded: int
    """Number of strides that are degraded; they count like the others."""

    @property
    def complete(self) -> bool:
        """True if the recording holds all six minutes."""
        return self.duration >= SIX_MINUTES

    @property
    def speed(self) -> float | None:
        """Distance over duration, stops included, m/s."""
        return None if self.distance is None or self.duration <= 0.0 else self.distance / self.duration

    @property
    def cadence(self) -> float | None:
        """Steps a minute over the whole duration, stops included."""
        return None if self.duration <= 0.0 else 60.0 * self.steps / self.duration

    @property
    def distance_index(self) -> float | None:
        """Change of the distance from the first to the sixth minute, as a share of the first; None without six minutes.

        It is the distance walked index of Leone et al. 2016 (Neurorehabil. Neural Repair 30), who name -0.15 or less
        walking-related motor fatigue in people with multiple sclerosis."""
        if len(self.minutes) < 6 or self.minutes[0] <= 0.0:
            return None
        return self.minutes[5] / self.minutes[0] - 1.0


@frozen(kw_only=True)
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

    @property
    def duration(self) -> float:
        """Time between the marks, s: the outcome of the test."""
        return self.t_stop - self.t_start


def six_minute_walk(
    events: Sequence[Event], start: float | None = None, end: float | None = None
) -> SixMinuteWalk | None:
    """Return the six-minute walk from events GaitCycleMeasured, StrideTaken and TurnMade; other kinds are left out.

    `start` is the time at which an observer said go, s; without it the walk starts with the first toe-off of the first
    walking bout. `end` is the time at which the recording ends, s; without it that of the last event. None if there is
    no walking bout to start from, or nothing was recorded after the start."""
    bouts = walking_bouts(events)
    if start is None:
        if not bouts:
            return None
        contact = bouts[0].t_start
        start = min(
            [t for t, _ in map(_swing, _strides(events)) if contact - MAX_BREAK <= t < contact], default=contact
        )
    last = max([event.t for event in events], default=start) if end is None else end
    duration = min(last - start, SIX_MINUTES)
    if duration <= 0.0:
        return None
    stop = start + duration
    whole = int(duration // MINUTE)
    spans = [(start + k * MINUTE, start + (k + 1) * MINUTE) for k in range(whole)]
    edges = [start, *[t for bout in bouts for t in (bout.t_start, bout.t_end)], stop]
    breaks = [min(b, stop) - max(a, start) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    stops = [length for length in breaks if length > MAX_BREAK]
    distances = _foot_distances(events, start, stop)
    within = [event for event in events if isinstance(event, TurnMade) and start <= event.t <= stop]
    return SixMinuteWalk(
        t_start=start,
        duration=duration,
        distance=mean_of(distances.values()),
        foot_distances=distances,
        minutes=tuple([mean_of(_foot_distances(events, *span).values()) or 0.0 for span in spans]),
        steps=count_contacts(_cycles(events), start, stop),
        stops=len(stops),
        stopped_time=fsum(stops),
        about_turns=len([turn for turn in within if turn.turn is Turn.ABOUT]),
        degraded=len([stride for stride in _strides(events) if stride.degraded and start < stride.t_end <= stop]),
    )


def timed_up_and_go(events: Sequence[Event], start: float, stop: float) -> TimedUpAndGo:
    """Return the timed up and go between two marks of an observer, s; raise ValueError when they are not in order."""
    if not start < stop:
        raise ValueError(f"timed_up_and_go: start must be before stop, got {start} and {stop}")
    swings = [swing for swing in map(_swing, _strides(events)) if start <= swing[0] and swing[1] <= stop]
    distances = _foot_distances(events, start, stop)
    return TimedUpAndGo(
        t_start=start,
        t_stop=stop,
        steps=count_contacts(_cycles(events), start, stop),
        walking_time=max([landed for _, landed in swings]) - min([lifted for lifted, _ in swings]) if swings else None,
        distance=mean_of(distances.values()),
    )


def _cycles(events: Iterable[Event]) -> list[GaitCycleMeasured]:
    return [event for event in events if isinstance(event, GaitCycleMeasured)]


def _strides(events: Iterable[Event]) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.final]


def _swing(stride: StrideTaken) -> tuple[float, float]:
    """Return when the foot left the ground and came down, s; between its foot-flats when that was not detected."""
    toe_off, heel_strike = stride.t_toe_off, stride.t_heel_strike
    if toe_off is None or heel_strike is None or not toe_off < heel_strike:
        return stride.t_start, stride.t_end
    return toe_off, heel_strike


def _foot_distances(events: Iterable[Event], start: float, stop: float) -> dict[Foot, float]:
    """Return how far each foot went between two times, m; only feet that took a stride in the events."""
    parts: dict[Foot, list[float]] = {}
    for stride in _strides(events):
        lifted, landed = _swing(stride)
        covered = min(stop, landed) - max(start, lifted)
        share = max(0.0, covered / (landed - lifted)) if landed > lifted else float(start < landed <= stop)
        parts.setdefault(stride.foot, []).append(share * stride.length)
    return {foot: fsum(parts[foot]) for foot in Foot if foot in parts}
