"""Contracts of the part for activities, for any samples."""

from __future__ import annotations

import json
from functools import cache

import pytest
from attrs import evolve
from views import fed
from walks import of, samples

from solepath import Session
from solepath.body.activity.activities import Activities
from solepath.body.activity.foot_blocks import FEATURES, FORCE_FEATURES
from solepath.body.activity.motion import MOTIONS, load_released_model
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import ActivityChanged, Event, StrideTaken
from solepath.foot.cues.gait_cues import GaitCues
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
from solepath.saving import codec as machine
from solepath.types import Foot, Sample, Site


class WornPart:
    """The part with both feet's trackers, as a session holds them."""

    def __init__(self) -> None:
        self.part = Activities()
        self.feet = {foot: FootTracker(foot, Cycle(), ErrorStateFilter(), GaitCues()) for foot in Foot}

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


def test_after_a_long_gap_nobody_knows_what_was_done_in_it() -> None:
    worn = WornPart()
    events: list[Event] = []
    for t_offset in (0.0, 60.0):
        for sample in walk():
            events += worn.feed(Sample(t=sample.t + t_offset, site=sample.site, acc=sample.acc, gyro=sample.gyro))
    assert "UNKNOWN" in [event.activity.name for event in events if isinstance(event, ActivityChanged)]


ROUTE = Route().stand(3.0).walk(12.0, 1.3).stairs(8).walk(6.0).stand(4.0).walk(8.0, 1.0).jog(12.0).stop(3.0)


def test_a_sample_that_ends_a_stride_leaves_activities_to_the_next_sample() -> None:
    session, has_stride, changes = Session(), set[bool](), 0
    for sample in samples(ROUTE, cells=0):
        events = session.feed(sample)
        changed, ended = [any([isinstance(event, kind) for event in events]) for kind in (ActivityChanged, StrideTaken)]
        assert not (changed and ended)
        has_stride.add(ended)
        changes += changed
    assert has_stride == {True, False} and changes > 10


@pytest.mark.parametrize("rate", [25.0, 100.0])
def test_no_activity_begins_after_the_sample_that_shows_it(rate: float) -> None:
    session, changes = Session(), 0
    for sample in [one for one in samples(ROUTE, cells=0, rate=rate) if one.site is Site.LEFT_FOOT]:
        changed = of(ActivityChanged, session.feed(sample))
        assert all([event.t <= sample.t and event.known_at <= sample.known_at for event in changed]), changed
        changes += len(changed)
    assert changes > 10


def test_no_activity_is_known_before_the_stride_that_shows_it() -> None:
    session, changes, stride_known_at = Session(), 0, 0.0
    for sample in samples(ROUTE, cells=0):
        late = 0.4 if sample.site is Site.LEFT_FOOT else 0.0
        events = session.feed(evolve(sample, known_at=sample.t + late))
        changed = [event for event in of(ActivityChanged, events) if not event.final]
        assert all([event.known_at >= stride_known_at for event in changed]), changed
        changes += stride_known_at > sample.known_at and bool(changed)
        stride_known_at = max([event.known_at for event in of(StrideTaken, events)], default=0.0)
    assert changes > 0


def test_strides_in_every_sample_do_not_keep_activities_from_being_judged() -> None:
    worn, (taken, *_) = WornPart(), of(StrideTaken, Session().feed(samples(ROUTE, cells=0)))
    found, sizes = list[Event](), list[int]()
    for sample in walk():
        stride = evolve(taken, t=sample.t, known_at=sample.t, t_start=sample.t - 0.1, t_end=sample.t)
        found += fed(worn.part, worn.feet[Foot.LEFT], evolve(sample, site=Site.LEFT_FOOT), [stride])
        sizes.append(len(worn.saved()))
    assert of(ActivityChanged, found) and max(sizes) < 2.0 * sizes[len(sizes) // 2]


def test_each_feature_has_a_curve_for_each_motion_with_and_without_a_gyroscope() -> None:
    model = load_released_model()
    assert (tuple(model.gyroscope), tuple(model.alone)) == (FEATURES, FORCE_FEATURES)
    for curve in (*model.gyroscope.values(), *model.alone.values()):
        assert sorted(set(curve.values)) == list(curve.values) and len(curve.odds) == len(curve.values)
        assert {len(row) for row in curve.odds} == {len(MOTIONS)}


def test_a_value_that_nobody_has_learnt_says_no_more_than_the_last_one_that_somebody_has() -> None:
    for name, curve in load_released_model().gyroscope.items():
        for value, odds in [(-1e9, curve.odds[0]), (1e9, curve.odds[-1]), *zip(curve.values, curve.odds, strict=True)]:
            before, after, share = curve.between(value)
            assert (before if share < 0.5 else after) == odds and share in (0.0, 1.0), name


def test_a_foot_without_a_gyroscope_is_judged_by_its_accelerometer_alone() -> None:
    reported = set[str]()
    for gyroscope in (True, False):
        worn = WornPart()
        samples = [one if gyroscope else Sample(t=one.t, site=one.site, acc=one.acc) for one in walk()]
        events = [event for sample in samples for event in worn.feed(sample)]
        reported |= {event.activity.name for event in events if isinstance(event, ActivityChanged)}
        assert "WALKING" in {event.activity.name for event in events if isinstance(event, ActivityChanged)}
    assert "RUNNING" not in reported
