"""Emulated walks for tests of the report: events of whole sessions, each computed once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from walks import insoles, run_session, samples

from solepath.emulate.routes.route import Route
from solepath.events import Event
from solepath.show.report import Report

ROUTES = {
    "walk": Route().stand(1.5).walk(40.0, 1.3).stop(1.0),
    "slow": Route().stand(1.5).walk(25.0, 0.9).stop(1.0),
    "run": Route().stand(1.5).jog(50.0, 3.0).stop(1.0),
    "standing": Route().stand(20.0),
}


@cache
def events_of(name: str) -> tuple[Event, ...]:
    """Return all events of a session with motion sensors on an emulated route."""
    return tuple(run_session(samples(ROUTES[name], cells=0, rate=100.0), poses=True, pressures=True))


@cache
def pressed_events() -> tuple[Event, ...]:
    """Return all events of a session with insoles on an emulated walk."""
    return tuple(run_session(insoles(ROUTES["walk"], cells=24).packets, poses=True, pressures=True))


def report_of(events: Sequence[Event], **more: object) -> Report:
    report = Report("walk.jsonl", recipe="default", version="1.0", **more)  # type: ignore[arg-type]
    report.take(None, events)
    return report
