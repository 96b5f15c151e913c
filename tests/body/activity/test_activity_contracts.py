"""Contracts of the part for activities, for any samples."""

from __future__ import annotations

import json
from functools import cache
from math import cos, sin

from hypothesis import given, settings
from hypothesis import strategies as st
from views import fed

from solepath import Session
from solepath.body.activity.activities import Activities, ActivitiesSettings
from solepath.body.activity.blocks.features import FEATURE_COUNT, FIRST_GYRO_FEATURE
from solepath.body.activity.blocks.motion import MOTIONS, from_json, load_released_model
from solepath.body.activity.blocks.votes import log_probabilities, motion_votes, strangeness
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import ActivityChanged, Event
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
from solepath.lab.train.activities_net import to_json
from solepath.saving import codec as machine
from solepath.types import SITE_OF_FOOT, Foot, Sample, Site

number = st.floats(-1e9, 1e9) | st.floats(-30.0, 30.0)
vector = st.tuples(number, number, number)
moments = st.tuples(
    st.sampled_from([0.0, 1e-6, 0.01, 0.1, 0.4, 2.0, 90.0, 1e5]),
    st.sampled_from(Foot),
    st.none() | vector,
    st.none() | vector,
    st.none() | st.floats(0.0, 2e5),
    st.integers(0, 40),
)


class WornPart:
    """The part with both feet's trackers, as a session holds them."""

    def __init__(self) -> None:
        self.part = Activities()
        self.feet = {foot: FootTracker(foot, Cycle(), ErrorStateFilter()) for foot in Foot}

    def feed(self, sample: Sample) -> list[Event]:
        tracker = self.feet[Foot.LEFT if sample.site is Site.LEFT_FOOT else Foot.RIGHT]
        return fed(self.part, tracker, sample, tracker.feed(sample))

    def saved(self) -> str:
        return json.dumps(machine.save(self.part), allow_nan=False, separators=(",", ":"))

    def restore(self) -> None:
        self.part = machine.load(Activities, json.loads(self.saved()))


@cache
def walk() -> tuple[Sample, ...]:
    route = Route().stand(2.0).walk(5.0, 1.3).stairs(4).walk(2.0).stand(2.0)
    walker = Walker(route, seed=3)
    return tuple(sorted([one for foot in Foot for one in walker.samples(foot, 25.0, LSM6DSOX)], key=lambda one: one.t))


@given(st.lists(moments, max_size=60))
@settings(max_examples=25)
def test_whatever_the_samples_are_events_come_in_their_time_and_the_state_can_be_saved(rows: list[tuple]) -> None:  # type: ignore[type-arg]
    worn, t = WornPart(), 0.0
    for dt, foot, acc, gyro, pressure, repetitions in rows:
        for _ in range(repetitions):
            t += dt
            sample = Sample(t=t, site=SITE_OF_FOOT[foot], acc=acc, gyro=gyro, air_pressure=pressure)
            for event in worn.feed(sample):
                assert event.known_at >= event.t
    worn.restore()
    assert all(event.known_at >= event.t for event in worn.part.finish(t))


def test_after_a_long_gap_nobody_knows_what_was_done_in_it() -> None:
    worn = WornPart()
    events: list[Event] = []
    for t_offset in (0.0, 60.0):
        for sample in walk():
            events += worn.feed(Sample(t=sample.t + t_offset, site=sample.site, acc=sample.acc, gyro=sample.gyro))
    assert "UNKNOWN" in [event.activity.name for event in events if isinstance(event, ActivityChanged)]


def test_a_clock_that_restarts_is_followed() -> None:
    worn = WornPart()
    for sample in walk():
        worn.feed(Sample(t=sample.t + 1000.0, site=sample.site, acc=sample.acc, gyro=sample.gyro))
    for foot, tracker in worn.feet.items():
        tracker.reset()
        worn.part.reset(SITE_OF_FOOT[foot])
    events = [event for sample in walk() for event in worn.feed(sample)]
    assert events and all(event.t < 100.0 for event in events)


@given(st.lists(st.floats(-5.0, 5.0), min_size=FEATURE_COUNT, max_size=FEATURE_COUNT))
@settings(max_examples=30)
def test_the_probabilities_of_the_network_add_up_to_one(features: list[float]) -> None:
    from math import exp, isclose

    model = load_released_model()
    likely = log_probabilities(model.whole, features)
    assert len(likely) == len(MOTIONS) and isclose(sum(exp(one) for one in likely), 1.0, rel_tol=1e-9)
    assert strangeness(model, features) >= 0.0


def test_a_foot_without_a_gyroscope_is_judged_by_its_accelerometer_alone() -> None:
    model, acc = load_released_model(), [0.1] * FIRST_GYRO_FEATURE
    rest = FEATURE_COUNT - FIRST_GYRO_FEATURE - 1
    unknown = motion_votes(model, [[*acc, 0.0, *[0.0] * rest]])
    assert unknown == motion_votes(model, [[*acc, 0.0, *[0.3] * (rest - 11), *[0.0] * 11]])
    assert unknown != motion_votes(model, [[*acc, 1.0, *[0.3] * (rest - 11), *[0.0] * 11]])


def test_a_model_goes_through_its_file_and_a_snapshot() -> None:
    model = load_released_model()
    assert from_json(json.loads(json.dumps(to_json(model)))) == model
    part = Activities(ActivitiesSettings(model))
    assert machine.load(Activities, machine.save(part)) == part


@given(st.sampled_from([3.0, 5.6, 8.0]), st.floats(2.0, 10.0), st.sampled_from([4, 7, 11]))
@settings(max_examples=5)
def test_at_the_end_nothing_is_left_open_and_what_is_final_is_likely(rate: float, amplitude: float, span: int) -> None:
    """One foot that moves and rests by turns, as no foot that was learnt from does."""
    session, events = Session(), list[Event]()
    for k in range(1200):
        t = k / 20
        moves = 0.0 if int(t) // span % 2 else max(0.0, sin(rate * t))
        acc = (amplitude * moves * cos(2 * rate * t), 0.0, 9.81 + 0.6 * amplitude * moves * sin(3 * rate * t))
        events += session.feed(Sample(t, Site.RIGHT_FOOT, acc, (0.0, 4.0 * moves * cos(rate * t), 0.0)))
    live: list[ActivityChanged] = []
    for event in [*events, *session.finish()]:
        if isinstance(event, ActivityChanged):
            if event.revises is not None:
                assert event.revises in [before.t for before in live if not before.final]
                live = [before for before in live if before.t < event.revises]
            live.append(event)
    assert live and all(event.final for event in live)
    assert all(event.probability is not None and event.probability > 0.05 for event in live)
