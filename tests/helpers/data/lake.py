"""A walk round a lake by feet that drift, and sessions that have walked a part of it."""

from __future__ import annotations

from functools import cache
from math import hypot, pi

import numpy as np

from solepath import Session
from solepath.emulate import Route, sampled
from solepath.emulate.walk import SampledWalk
from solepath.emulate.wearers.curves import Array
from solepath.types import Foot
from solepath_lab.emulated.heading_walks import insoles_of


@cache
def loop() -> SampledWalk:
    """Return a walk of 180 m round a lake, back to where it began, and 40 m on, by feet that drift."""
    route = Route(speed=1.4).stand(2.0).walk(15.0).turn(pi, 24.0).walk(15.0).turn(pi, 24.0)
    return sampled(route.walk(40.0).stop(2.0), insoles=insoles_of(9), seed=9)


def fed(walk: SampledWalk, until: float, session: Session | None = None, since: float = 0.0) -> Session:
    """Return the session, or one from the start of the walk, after the samples before `until`."""
    if session is None:
        return Session.unpack(_packed(walk, until))
    session.feed([sample for sample in walk.samples if since <= sample.t < until])
    return session


@cache
def _packed(walk: SampledWalk, until: float) -> bytes:
    return fed(walk, until, Session()).pack()


def middle(walk: SampledWalk, t: float) -> tuple[float, float]:
    """Return where the wearer truly is, in the session's world frame."""
    ((x, y),) = middles(walk, np.array([t]))
    return float(x), float(y)


def middles(walk: SampledWalk, t: Array) -> Array:
    """Return where the wearer truly is at these times, in the session's world frame, (N, 2)."""
    feet = [walk.truth.pose(foot, t).position[:, :2] - walk.truth.pose(foot, 0.0).position[0, :2] for foot in Foot]
    return np.asarray(0.5 * (feet[0] + feet[1]))


def error(walk: SampledWalk, session: Session) -> float:
    assert session.position is not None
    x, y = middle(walk, session.position.t)
    return hypot(session.position.position[0] - x, session.position.position[1] - y)


@cache
def back_time(walk: SampledWalk) -> float:
    """Return when the wearer is closest to the start after the loops, s."""
    times = np.arange(0.6 * walk.truth.duration, walk.truth.duration, 0.1)
    return float(times[int(np.argmin(np.hypot(*middles(walk, times).T)))])


def session_back() -> Session:
    """Return the session of a wearer who is back where the walk started."""
    return fed(loop(), back_time(loop()))


def off_by(session: Session, x: float, y: float) -> tuple[float, float]:
    assert session.position is not None
    return (session.position.position[0] + x, session.position.position[1] + y)


@cache
def passing_times() -> tuple[float, float]:
    """Return when the wearer of the loop is 10 m from the start, and when they pass the same place again, s."""
    walk = loop()
    times = np.arange(0.0, 30.0, 0.05)
    first = float(times[int(np.argmax(middles(walk, times)[:, 0] > 10.0))])
    times = np.arange(first + 60.0, walk.truth.duration, 0.05)
    again = times[int(np.argmin(np.hypot(*(middles(walk, times) - middle(walk, first)).T)))]
    return first, float(again)
