"""What straight ways teach about the drift of the heading in a session, and what turns nothing."""

from __future__ import annotations

from cmath import rect

import pytest

from solepath import Session
from solepath.body.fuse.both_feet import BothFeet
from solepath.body.fuse.common_error import NO_MOVE, CommonError
from solepath.body.fuse.straight_ways import DriftHypothesis, StraightWays
from solepath.calibration import HeadingCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Event, StrideTaken
from solepath.types import Foot
from solepath.types.attrs import evolve
from solepath_lab.emulated.heading_walks import heading_route, insoles_of, wearer_of

STRONG_LANDING = 10
"""Seed of a wearer whose sensors are cut off in nearly every stride."""


def fed(walk: SampledWalk) -> tuple[BothFeet, Session, list[Event]]:
    session = Session()
    events = [event for sample in walk.samples for event in session.feed(sample)]
    (part,) = [part for part in session._state.parts if isinstance(part, BothFeet)]
    return part, session, events


@pytest.mark.long
def test_a_wearer_whose_peaks_are_cut_off_still_shows_the_drift() -> None:
    route = heading_route("right_angles", STRONG_LANDING, lambda length, seconds: length >= 300.0)
    walk = sampled(route, wearer=wearer_of(STRONG_LANDING), insoles=insoles_of(STRONG_LANDING), seed=STRONG_LANDING)
    part, _, events = fed(walk)
    strides = [event for event in events if isinstance(event, StrideTaken)]
    assert sum(stride.degraded for stride in strides) > 0.8 * len(strides)
    assert part.common.drift_variance(0.0) < 0.5 * BothFeet().common.drift_variance(0.0)


def test_a_calibration_is_dropped_although_the_strides_have_no_duration() -> None:
    """Clocks of the feet that are apart can give stretches that start and end at one time."""
    walk = sampled(Route().stand(2.0).walk(4.0).stop(1.0), seed=3)
    stride = next(event for event in fed(walk)[2] if isinstance(event, StrideTaken))
    ways, common, found = StraightWays(), CommonError(), []
    known = dict.fromkeys(Foot, HeadingCalibration(0.006, 0.0, 1e-4, 1e-4))
    common.use_calibration(known)
    ways.use_calibration(known)
    for k in range(400):
        turn = 1.0 if k % 40 == 39 else 0.0
        foot = (Foot.LEFT, Foot.RIGHT)[k % 2]
        one = evolve(stride, foot=foot, t_start=4.0, t_end=5.0, heading_change=turn)
        direction = 0.003 * (k % 40)
        _, sentence = ways.add_stride(one, 1.0, rect(1.3, direction), common)
        found += [sentence] if sentence is not None else []
    assert len(found) == 1 and "does not fit this walk" in found[0]


def test_a_calibration_that_has_turned_the_track_far_is_dropped_without_turning_it_back() -> None:
    """The equations are linear: the covariance says how wrong the track may be instead."""
    ways, common = StraightWays(), CommonError()
    known = dict.fromkeys(Foot, HeadingCalibration(0.02, 0.0, 1e-4, 1e-4))
    common.use_calibration(known)
    ways.use_calibration(known)
    ways.moved = [[30.0, 60.0, 100.0] for _ in ways.moved]
    move = ways._drop((0.02, 0.0, 0.02, 0.0), DriftHypothesis(-0.02, 1e-6), common)
    assert move == NO_MOVE and common.heading_sigma > 1.0 and ways.calibrated is None
