"""Two feet of one body: each stride corrects the other foot's track."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, dist, hypot, pi, remainder, sin

import pytest
import walks
from attrs import evolve

from solepath import recipes
from solepath.body.fuse.both_feet import BothFeet, BothFeetSettings
from solepath.body.fuse.error_filter import HEADING, RATE, STATES_PER_FOOT, TrackErrorFilter, X, Y
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.walk import sampled
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, StrideTaken
from solepath.lab.emulated.heading import yaw_of
from solepath.lab.emulated.heading_walks import heading_route, insoles_of, wearer_of
from solepath.saving import codec as machine
from solepath.session import Session
from solepath.types import Foot, Sample, Vec3

LONG = Route().stand(2.0).walk(40.0, 1.3).stop(1.0)
CHEAP = evolve(LSM6DSOX, gyro=evolve(LSM6DSOX.gyro, scale=0.03, cross=0.02))
"""A gyroscope that turns the strides of one foot otherwise than those of the other."""


@cache
def _samples(seed: int) -> tuple[Sample, ...]:
    walker = Walker(LONG, seed=seed)
    both = [sample for foot in Foot for sample in walker.samples(foot, 100.0, CHEAP)]
    return tuple(sorted(both, key=lambda sample: sample.t))


@cache
def _walked(part: str) -> tuple[Session, list[Event]]:
    body = {"both": BothFeet(), "mean": MeanOfFeet(), "apart": BothFeet(BothFeetSettings(feedback=False))}[part]
    session = Session(recipes.DEFAULT.exchanged(TrackPart, body))
    events = [event for sample in _samples(102) for event in session.feed(sample)]
    return session, events


def _apart(session: Session) -> float:
    """Return the distance between the feet as their body has placed them, m."""
    body = next(part for part in session._state.wearer.parts if isinstance(part, MeanOfFeet))
    left = body.left.place(session.feet[Foot.LEFT].position)
    right = body.right.place(session.feet[Foot.RIGHT].position)
    return hypot(left[0] - right[0], left[1] - right[1])


def test_feet_that_drift_apart_are_held_together() -> None:
    alone, _ = _walked("mean")
    both, _ = _walked("both")
    assert _apart(alone) > 1.2
    assert _apart(both) < 0.5
    assert both.position is not None
    assert hypot(both.position.position[0] - 40.0, both.position.position[1]) < 0.1 * 40.0


def test_a_foot_whose_steps_are_not_seen_any_more_does_not_hold_the_other_one_back() -> None:
    """Its sensor lies still, or always repeats one reading."""
    session = Session()
    for sample in _samples(102):
        stuck = sample.site.foot is Foot.LEFT and sample.t > 15.0
        session.feed(evolve(sample, acc=(0.0, 0.0, 9.81), gyro=(0.0, 0.0, 0.0)) if stuck else sample)
    alone, _ = _walked("mean")
    (x, y, _), (u, v, _) = session.feet[Foot.RIGHT].position, alone.feet[Foot.RIGHT].position
    assert hypot(x, y) > 0.95 * hypot(u, v)
    assert session.position is not None and session.position.position[0] > 0.9 * 40.0


def test_the_uncertainty_of_both_feets_place_is_the_same_in_every_direction() -> None:
    session = Session()
    for sample in _samples(102)[:1500]:
        session.feed(sample)
        here = session.position
        if here is not None:
            xx, xy, xz, yy, yz, zz = here.covariance
            assert min(xx, yy, zz) >= 0.0
            for one, other, both in ((xx, yy, xy), (xx, zz, xz), (yy, zz, yz)):
                assert both * both <= one * other * (1.0 + 1e-9)


@pytest.mark.parametrize("first_direction", [-1.0, 2.0, 3.1])
def test_a_foot_that_first_steps_aside_does_not_bend_either_track(first_direction: float) -> None:
    session = Session()
    steps: list[StrideTaken] = []
    for sample in _samples(102):
        for event in session.feed(sample):
            if isinstance(event, StrideTaken):
                steps.append(event)
                if event.foot is Foot.LEFT and event.number == 1:
                    # as if its first step, which its world frame begins along, had led there
                    session.feet[Foot.LEFT].gait.world.north = (cos(first_direction), sin(first_direction))
    assert _apart(session) < 0.5
    for foot in Foot:
        own = [step.displacement for step in steps if step.foot is foot][2:-1]
        first = atan2(own[0][1], own[0][0])
        # 40 m of this gyroscope turn a track by some degrees
        assert max(abs(remainder(atan2(y, x) - first, 2.0 * pi)) for x, y, _ in own) < 0.3


def test_corrections_make_no_stride_longer() -> None:
    _, events = _walked("both")
    _, without = _walked("mean")
    lengths, own = ([event.length for event in each if isinstance(event, StrideTaken)] for each in (events, without))
    assert lengths == pytest.approx(own, abs=0.01)


def test_without_feedback_the_feet_go_their_own_ways() -> None:
    body, events = _walked("apart")
    alone, same = _walked("mean")
    assert events == same
    assert all(body.feet[foot].position == alone.feet[foot].position for foot in Foot)


def test_a_foot_alone_is_where_its_own_track_has_it() -> None:
    session, other = Session(), Session(recipes.DEFAULT.exchanged(TrackPart, MeanOfFeet()))
    for sample in walks.samples(cells=0):
        if sample.site.foot is Foot.LEFT:
            assert session.feed(sample) == other.feed(sample)
    assert session.position is not None and other.position is not None
    assert session.position.position == other.position.position


def _agreement() -> TrackErrorFilter:
    error_filter = TrackErrorFilter()
    error_filter.start()
    x = 0.0
    for k in range(20):
        x += 0.65
        error_filter.propagate(k % 2, 0.5, 0.5, (x, 0.0), (1.3, 0.0), (1e-4, 0.0, 1e-4), False)
    return error_filter


def test_a_measured_difference_is_shared_and_never_moves_both_feet_alike() -> None:
    error_filter = _agreement()
    errors = error_filter.correct([(STATES_PER_FOOT + Y, 1.0), (Y, -1.0)], 0.1, 0.002, 16.0)
    assert errors is not None
    for one in (HEADING, RATE):
        assert errors[one] * errors[STATES_PER_FOOT + one] < 0.0
        assert abs(errors[one] + errors[STATES_PER_FOOT + one]) < 0.2 * abs(errors[one] - errors[STATES_PER_FOOT + one])


def test_a_foot_whose_stride_was_spoilt_gives_way() -> None:
    error_filter = _agreement()
    error_filter.inflate(0, 2.0)
    errors = error_filter.correct([(STATES_PER_FOOT + X, 1.0), (X, -1.0)], 1.0, 0.01, 1e12)
    assert errors is not None
    assert errors[X] < -0.8 and abs(errors[STATES_PER_FOOT + X]) < 0.1


def test_the_covariance_stays_one() -> None:
    error_filter = _agreement()
    for k in range(400):
        angle = 0.05 * k
        end = (20.0 * sin(angle), 20.0 * cos(angle))
        error_filter.propagate(
            k % 2, 0.5, 0.5, end, (1.3 * cos(angle), -1.3 * sin(angle)), (1e-4, 0.0, 1e-4), k % 37 == 0
        )
        error_filter.correct([(STATES_PER_FOOT + Y, 1.0), (Y, -1.0), (8, 1.0)], 0.03 * (-1) ** k, 0.002, 1e12)
        p = error_filter.covariance
        assert min(p[i][i] for i in range(9)) >= 0.0
        assert all(abs(p[i][j] - p[j][i]) <= 1e-9 * (1.0 + p[i][i] + p[j][j]) for i in range(9) for j in range(i))
    assert machine.load(TrackErrorFilter, machine.save(error_filter)) == error_filter


def test_a_foot_that_returns_pulls_nothing_before_it_is_aligned() -> None:
    """The right foot is silent in a bend and comes back tens of metres from where it was seen last."""
    route = Route().stand(3.0).walk(12.0, 1.3).turn(0.5 * pi, 1.0).walk(50.0, 1.3).stop(2.0)
    walk = sampled(route, seed=4)
    session, steps = Session(), [0.0]
    before: Vec3 | None = None
    for sample in walk.samples:
        if sample.site.foot is Foot.LEFT or not 8.0 < sample.t < 36.0:
            session.feed(sample)
        if sample.t > 36.0 and session.position is not None:
            here = session.position.position
            steps.append(0.0 if before is None else dist(here, before))
            before = here
    assert max(steps) < 0.5


def test_strides_that_are_usually_degraded_are_compared_and_others_are_not() -> None:
    error_filter = TrackErrorFilter()
    assert [error_filter.judge_stride(0, degraded, False) for degraded in (False, True, False)] == [False, True, False]
    assert [error_filter.judge_stride(0, True, False) for _ in range(12)][-1] is False
    assert error_filter.judge_stride(0, True, True), "a sensor that came loose is no better for being so all the time"
    assert error_filter.judge_stride(1, True, False), "the other foot has its own strides"


def test_feet_whose_peaks_are_cut_off_turn_each_other_by_little() -> None:
    """Of this wearer most strides are degraded, and now and then one is not."""
    seed = 140
    route = heading_route("any_angles", seed, lambda length, seconds: seconds >= 200.0)
    walk = sampled(route, wearer=wearer_of(seed), insoles=insoles_of(seed), seed=seed)
    session = Session()
    (part,) = [part for part in session._state.wearer.parts if isinstance(part, BothFeet)]
    first: dict[Foot, float] = {}
    degraded = []
    for event in (event for sample in walk.samples if sample.t < 175.0 for event in session.feed(sample)):
        if isinstance(event, StrideTaken):
            degraded.append(event.degraded)
            w, x, y, z = walk.truth.pose(event.foot, event.t_end).attitude[0].tolist()
            track = part.left if event.foot is Foot.LEFT else part.right
            off = yaw_of((w, x, y, z)) - yaw_of(session.feet[event.foot].attitude) - track.turn
            assert abs(remainder(off - first.setdefault(event.foot, off), 2.0 * pi)) < 0.09
    assert 0.7 * len(degraded) < sum(degraded) < len(degraded)
