"""What straight ways teach about the drift of the heading in a session, and what turns nothing."""

from __future__ import annotations

from solepath import Session
from solepath.body.fuse.both_feet import BothFeet
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import DefectFound, Event, LiftRidden, StrideTaken
from solepath.lab.emulated.heading_walks import heading_route, insoles_of, wearer_of

STRONG_LANDING = 10
"""Seed of a wearer whose sensors are cut off in nearly every stride."""


def fed(walk: SampledWalk) -> tuple[BothFeet, Session, list[Event]]:
    session = Session()
    events = [event for sample in walk.samples for event in session.feed(sample)]
    (part,) = [part for part in session._state.wearer.parts if isinstance(part, BothFeet)]
    return part, session, events


def test_a_wearer_whose_peaks_are_cut_off_still_shows_the_drift() -> None:
    route = heading_route("right_angles", STRONG_LANDING, lambda length, seconds: length >= 300.0)
    walk = sampled(route, wearer=wearer_of(STRONG_LANDING), insoles=insoles_of(STRONG_LANDING), seed=STRONG_LANDING)
    part, _, events = fed(walk)
    strides = [event for event in events if isinstance(event, StrideTaken)]
    assert sum(stride.degraded for stride in strides) > 0.8 * len(strides)
    assert part.common.drift_variance(0.0) < 0.5 * BothFeet().common.drift_variance(0.0)


def test_a_ride_in_a_lift_is_no_moving_ground_and_turns_nothing() -> None:
    route = Route().stand(3).walk(30, 1.3).lift(9.0).walk(30, 1.3).stop(2)
    walk = sampled(route, seed=4)
    _, session, events = fed(walk)
    assert [event for event in events if isinstance(event, LiftRidden)] != []
    assert [event for event in events if isinstance(event, DefectFound)] == []
    here = session.position
    assert here is not None
    assert abs(here.position[1]) < 1.0 and abs(here.position[0] - 60.0) < 1.0
