"""Times the parts of a session: a foot's, and those of the body, in a walk and in a building."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import process_time
from typing import Any

from measure import RUNS, no_garbage_collection

from solepath import Recipe, Sample, Session
from solepath.body.checks.sensors import SensorChecks
from solepath.body.gait.turns import Turns
from solepath.body.part import ActivityPart, Part, TrackPart
from solepath.body.place.place_hypotheses import PlaceHypotheses
from solepath.body.worn.wear import Wear
from solepath.floorplan.index import IndexedPlan


class TimedPart:
    """A wrapper of a part that sums the time of its calls.

    Other fields are the part's own, and `isinstance` takes the wrapper for an instance of the part's class.
    """

    def __init__(self, part: Any) -> None:
        self.part = part
        self.total_time = 0.0
        self.calls = 0

    @property  # type: ignore[misc]
    def __class__(self) -> Any:
        return type(self.part)

    def receive(self, event: Any) -> Any:
        """Forward an event. It is a method of the class because a wearer looks for it there."""
        return self.__getattr__("receive")(event)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("part", "total_time", "calls"):
            object.__setattr__(self, name, value)
        else:
            setattr(self.part, name, value)

    def __getattr__(self, name: str) -> Any:
        what = getattr(self.part, name)
        if not callable(what):
            return what

        def timed(*arguments: Any) -> Any:
            started_at = process_time()
            try:
                return what(*arguments)
            finally:
                self.total_time += process_time() - started_at
                self.calls += 1

        return timed


SAMPLE_PARTS: dict[str, str | type[Part]] = {
    "rest": "rest",
    "detector": "detector",
    "filter": "corrector",
    "cues": "cues",
    "cells": "sole",
    "activities": ActivityPart,
    "turns": Turns,
    "checks": SensorChecks,
    "how it is worn": Wear,
    "body": TrackPart,
}
"""Parts whose share of a sample's time the table shows, by row: a field of the foot, or a class of parts."""


def part_times(items: list[Sample], make: Callable[[], Session]) -> dict[str, float]:
    """Return the microseconds a sample that each part takes, by row, without the time of the clock itself."""
    return {name: median([part_time(items, make(), what) for _ in range(RUNS)]) for name, what in SAMPLE_PARTS.items()}


def part_time(items: list[Sample], session: Session, what: str | type[Part]) -> float:
    """Return the microseconds a sample of one part; only one is timed, because a timed part slows down its readers."""
    session.feed(items[0])
    part = _time_part(session, what)
    with no_garbage_collection():
        for item in items[1:]:
            session.feed(item)
    return (part.total_time - part.calls * overhead()) / len(items) * 1e6


def _time_part(session: Session, what: str | type[Part]) -> TimedPart:
    wearer = session._state.wearer
    if isinstance(what, str):
        foot = next(iter(wearer.feet.values()))
        part = TimedPart(getattr(foot, what))
        setattr(foot, what, part)
    else:
        place = next(k for k, one in enumerate(wearer.parts) if isinstance(one, what))
        part = wearer.parts[place] = TimedPart(wearer.parts[place])
        wearer._choose_sampled()
    return part


def overhead() -> float:
    """Return the time, s, that `TimedPart` measures for a call that does nothing."""

    class Idle:
        def call(self, one: int, other: int) -> None:
            pass

    idle = TimedPart(Idle())
    for _ in range(20_000):
        idle.call(1, 2)
    return idle.total_time / idle.calls


def building_part_times(items: list[Sample], recipe: Recipe, plan: IndexedPlan) -> dict[str, float]:
    """Return the microseconds a sample of activities, turns and place on a plan, in a walk through a building."""
    kinds: dict[str, type[Part]] = {"activity": ActivityPart, "turns": Turns, "place": PlaceHypotheses}
    times: dict[str, list[float]] = {name: [] for name in kinds}
    for _ in range(RUNS):
        session = Session(recipe, floorplan=plan)
        timed_parts = {name: _time_part(session, kind) for name, kind in kinds.items()}
        with no_garbage_collection():
            for item in items:
                session.feed(item)
        for name, part in timed_parts.items():
            times[name].append(part.total_time / len(items) * 1e6)
    return {name: median(total_time) for name, total_time in times.items()}
