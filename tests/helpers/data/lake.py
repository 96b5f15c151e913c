"""A walk round a lake by feet that drift, and sessions that have walked a part of it."""

from __future__ import annotations

from functools import cache
from math import hypot, pi

import numpy as np

from solepath import Session
from solepath.emulate import Route, sampled
from solepath.emulate.walk import SampledWalk
from solepath.lab.emulated.heading_walks import insoles_of
from solepath.types import Foot


@cache
def loop() -> SampledWalk:
    """Return a walk of 180 m round a lake, back to where it began, and 40 m on, by feet that drift."""
    route = Route(speed=1.4).stand(2.0).walk(15.0).turn(pi, 24.0).walk(15.0).turn(pi, 24.0)
    return sampled(route.walk(40.0).stop(2.0), insoles=insoles_of(9), seed=9)


def fed(walk: SampledWalk, until: float, session: Session | None = None, since: float = 0.0) -> Session:
    session = Session() if session is None else session
    session.feed([sample for sample in walk.samples if since <= sample.t < until])
    return session


def middle(walk: SampledWalk, t: float) -> tuple[float, float]:
    """Return where the wearer truly is, in the session's world frame."""
    places = [walk.truth.pose(foot, t).position[0, :2] - walk.truth.pose(foot, 0.0).position[0, :2] for foot in Foot]
    x, y = 0.5 * (places[0] + places[1])
    return float(x), float(y)


def error(walk: SampledWalk, session: Session) -> float:
    assert session.position is not None
    x, y = middle(walk, session.position.t)
    return hypot(session.position.position[0] - x, session.position.position[1] - y)


@cache
def back_time(walk: SampledWalk) -> float:
    """Return when the wearer is closest to the start after the loops, s."""
    times = np.arange(0.6 * walk.truth.duration, walk.truth.duration, 0.1)
    return float(times[int(np.argmin([hypot(*middle(walk, float(t))) for t in times]))])


@cache
def packed_back() -> bytes:
    return fed(loop(), back_time(loop())).pack()


def session_back() -> Session:
    """Return the session of a wearer who is back where the walk started."""
    return Session.unpack(packed_back())


def off_by(session: Session, x: float, y: float) -> tuple[float, float]:
    assert session.position is not None
    return (session.position.position[0] + x, session.position.position[1] + y)


@cache
def passing_times() -> tuple[float, float]:
    """Return when the wearer of the loop is 10 m from the start, and when they pass the same place again, s."""
    walk = loop()
    first = next(t for t in np.arange(0.0, 30.0, 0.05) if middle(walk, float(t))[0] > 10.0)
    x, y = middle(walk, float(first))
    times = np.arange(first + 60.0, walk.truth.duration, 0.05)
    again = min(times, key=lambda t: hypot(middle(walk, float(t))[0] - x, middle(walk, float(t))[1] - y))
    return float(first), float(again)
