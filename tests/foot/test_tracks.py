"""Navigation of one foot: any mounting, bias, gaps and absent sensors."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import atan2, degrees, dist, hypot, pi, radians
from typing import Any

import pytest
from attrs import evolve
from soak import longer
from walks import LEFT, of

from solepath import (
    ActivityChanged,
    Defect,
    DefectFound,
    Foot,
    FootMoved,
    HeelStrike,
    Limitation,
    Packet,
    Recipe,
    Sample,
    SampleGap,
    Session,
    Site,
    StrideTaken,
    ToeOff,
)
from solepath.emulate import emulate
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.shoe import ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.world import FIRST_HEADING_DISTANCE
from solepath.recipes import DEFAULT
from solepath.types.vector import normalise
from solepath.wire.insole_info import build_info, parse_info

ROUTE = Route().stand(3.0).walk(20.0, 1.3).stop(2.0)
EXACT = Recipe("filter", Cycle(), ErrorStateFilter())
LINEAR = Recipe("linear", Cycle(), LinearDedrift())


@cache
def walker(seed: int = 5) -> Walker:
    return Walker(ROUTE, seed=seed)


@cache
def samples_of_walk(seed: int = 5) -> tuple[Sample, ...]:
    return tuple(walker(seed).samples(Foot.LEFT, 100.0, LSM6DSOX))


def run_session(samples: Any, recipe: Recipe = DEFAULT, **options: Any) -> list[Any]:
    session = Session(recipe, **options)
    return session.feed(list(samples)) + session.finish()


@pytest.mark.parametrize("seed", [1])
@pytest.mark.parametrize("recipe", [EXACT, LINEAR], ids=lambda recipe: recipe.name)
def test_both_correctors_track_a_walk_of_20_m(recipe: Recipe, seed: int) -> None:
    events = run_session(samples_of_walk(seed), recipe, poses=True)
    true, strides = walker(seed).truth().feet[Foot.LEFT].strides, of(StrideTaken, events)
    assert len(strides) == len(true)
    for stride, truth in zip(strides, true, strict=True):
        assert stride.t_end == pytest.approx(truth.t_end, abs=0.08)
        assert stride.length == pytest.approx(truth.length, abs=0.05)
        assert stride.height_change == pytest.approx(0.0, abs=0.05)
        assert stride.heading_change == pytest.approx(truth.heading_change, abs=0.05)
    x, y, z = of(FootMoved, events)[-1].position
    assert (x**2 + y**2) ** 0.5 == pytest.approx(20.0, rel=0.03)
    assert abs(z) < 0.5


def test_features_of_a_stride_are_those_of_a_walk() -> None:
    for stride in of(StrideTaken, run_session(samples_of_walk()))[1:-1]:
        assert 0.01 < stride.features.clearance < 0.25
        assert 2.5 < stride.features.peak_speed < 7.0
        assert radians(40) < stride.features.swing_pitch < radians(130)
        assert stride.features.contact_load is None and stride.features.cop == ()
        assert stride.t_start < stride.t_toe_off < stride.t_heel_strike <= stride.t_end


def test_a_sensor_on_the_laces_finds_the_same_strides_as_one_in_the_sole() -> None:
    mounting = Mounting(ON_INSTEP.position, normalise((0.7, 0.1, -0.4, 0.2)))
    events = run_session(walker().samples(Foot.LEFT, 100.0, LSM6DSOX, mounting=mounting))
    true = walker().truth({Foot.LEFT: mounting}).feet[Foot.LEFT].strides
    strides = of(StrideTaken, events)
    assert len(strides) == len(true)
    for stride, truth in zip(strides, true, strict=True):
        assert stride.length == pytest.approx(truth.length, rel=0.03, abs=0.02)
    assert len(of(HeelStrike, events)) == len(of(ToeOff, events)) == len(true)


BIAS = (0.02, -0.03, 0.025)


def biased(sample: Sample) -> Sample:
    x, y, z = sample.gyro
    return evolve(sample, gyro=(x + BIAS[0], y + BIAS[1], z + BIAS[2]))


def test_the_bias_of_the_gyroscope_is_learnt_while_the_wearer_stands() -> None:
    session = Session()
    session.feed([biased(sample) for sample in walker().samples(Foot.LEFT, 100.0) if sample.t < 2.9])
    assert session.feet[Foot.LEFT].rest.bias == pytest.approx(BIAS, abs=2e-3)


@pytest.mark.parametrize("recipe", [EXACT, LINEAR], ids=lambda recipe: recipe.name)
def test_after_a_rest_a_bias_does_not_bend_the_path(recipe: Recipe) -> None:
    plain, other = (
        of(StrideTaken, run_session(items, recipe))
        for items in (samples_of_walk(), [biased(sample) for sample in samples_of_walk()])
    )
    assert len(other) == len(plain)
    assert other[-1].position == pytest.approx(plain[-1].position, abs=0.1)
    assert sum(stride.heading_change for stride in other) == pytest.approx(
        sum(stride.heading_change for stride in plain), abs=0.02
    )


def test_a_turn_that_is_walked_is_not_taken_for_a_bias() -> None:
    route = Route().stand(2.0).walk(3.0, 1.2).turn(pi / 2, radius=2.0).walk(3.0).stop(1.0)
    strides = of(StrideTaken, run_session(Walker(route, seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)))
    assert sum(stride.heading_change for stride in strides) == pytest.approx(pi / 2, abs=0.06)


def test_a_wrong_scale_is_reported_once_by_the_link_that_knows_the_range() -> None:
    def wrong(packet: Packet) -> Packet:
        if packet.channel != "insole/info":
            return packet
        info = parse_info(packet.data)
        return evolve(packet, data=build_info(evolve(info, acc_scale=0.75 * info.acc_scale)))

    session = Session()
    events = session.feed([wrong(packet) for packet in emulate(Route().stand(4.0).walk(4.0), seed=1).packets])
    reported = of(DefectFound, events)
    assert {event.site for event in reported} == {Site.LEFT_FOOT, Site.RIGHT_FOOT} and len(reported) == 2
    assert {event.defect for event in reported} == {Defect.WRONG_SCALE}
    assert all(stride.degraded for stride in of(StrideTaken, events))


def test_an_accelerometer_of_the_wrong_range_is_named_and_one_a_little_off_is_put_right() -> None:
    def scaled(k: float) -> list[Sample]:
        return [evolve(s, acc=(k * s.acc[0], k * s.acc[1], k * s.acc[2])) for s in samples_of_walk()]

    reported, *_ = of(DefectFound, run_session(scaled(0.5)))
    assert reported.defect is Defect.WRONG_SCALE and "2 times the range" in reported.what
    off = run_session(scaled(1.03))
    assert of(DefectFound, off) == []
    assert [s.length for s in of(StrideTaken, off)] == pytest.approx(
        [s.length for s in of(StrideTaken, run_session(samples_of_walk()))], abs=0.02
    )


@pytest.mark.parametrize("recipe", [EXACT, LINEAR], ids=lambda recipe: recipe.name)
@pytest.mark.parametrize("length", [0.06, 0.3, 3.0])
def test_after_a_gap_the_walk_goes_on(recipe: Recipe, length: float) -> None:
    start = walker().truth().feet[Foot.LEFT].toe_offs[4] + 0.1
    events = run_session([s for s in samples_of_walk() if not start < s.t < start + length], recipe)
    (gap,) = of(SampleGap, events)
    assert gap.duration == pytest.approx(length, abs=0.02) and gap.site is LEFT
    strides = of(StrideTaken, events)
    has_gap = [stride.t_start < gap.t + gap.duration and stride.t_end > gap.t for stride in strides]
    assert [stride.degraded for stride in strides] == has_gap
    assert any(has_gap) or length > 2.0, "no stride lasts through an absence"
    true = walker().truth().feet[Foot.LEFT].strides
    after = [(s, t) for s in strides for t in true if abs(s.t_end - t.t_end) < 0.1 and t.t_start > start + length + 0.1]
    assert len(after) >= 4
    for stride, truth in after[1:]:
        assert not stride.degraded
        # linear dedrift corrects the tilt error of the gap only by gravity
        assert stride.length == pytest.approx(truth.length, abs=0.06 if recipe is EXACT else 0.10)


def test_a_saturated_sample_degrades_only_its_stride() -> None:
    swing = walker().truth().feet[Foot.LEFT].toe_offs[3] + 0.1
    strides = of(StrideTaken, run_session(evolve(s, saturated=swing < s.t < swing + 0.03) for s in samples_of_walk()))
    assert [k for k, stride in enumerate(strides) if stride.degraded] == [3]


@pytest.mark.parametrize("lacking", ["acc", "gyro"])
def test_a_foot_without_one_of_its_sensors_has_no_track_and_one_limitation(lacking: str) -> None:
    events = run_session(evolve(sample, **{lacking: None}) for sample in samples_of_walk()[:500])
    (reported,) = of(Limitation, events)
    assert {"acc": "accelerometer", "gyro": "gyroscope"}[lacking] in reported.what
    # an accelerometer alone gives the activity
    assert all(isinstance(event, ActivityChanged) for event in events if event is not reported)


@pytest.mark.parametrize("site", [Site.PELVIS])
def test_a_site_that_is_no_foot_is_one_limitation_and_changes_nothing_else(site: Site) -> None:
    others = (evolve(sample, t=sample.t + 0.004, site=site) for sample in samples_of_walk()[:-1])
    both = sorted([*samples_of_walk(), *others], key=lambda s: s.t)
    events = run_session(both)
    (reported,) = of(Limitation, events)
    assert reported.site is site and site.value in reported.what
    assert [event for event in events if event is not reported] == run_session(samples_of_walk())


def test_a_standing_foot_takes_no_stride() -> None:
    still = Walker(Route().stand(6.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    assert of(StrideTaken, run_session(still)) == []
    assert of(HeelStrike, run_session(still)) == of(ToeOff, run_session(still)) == []


@pytest.mark.parametrize("turn", [-90, 45, *longer(-45, -20, 20, 90, 135, 180)])
def test_who_turns_on_the_spot_before_the_first_step_walks_off_turned_by_that_with_both_feet(turn: int) -> None:
    walk = emulate(Route().stand(2.0).turn(radians(turn)).walk(6.0, 1.2).stand(2.0), seed=2)
    strides = [stride for stride in of(StrideTaken, run_session(walk.packets)) if stride.length > 0.5]
    for foot in Foot:
        ways = [stride.displacement for stride in strides if stride.foot is foot]
        off = [(degrees(atan2(y, x)) - turn + 180.0) % 360.0 - 180.0 for x, y, _ in ways]
        assert len(off) > 2 and max(map(abs, off)) < 6.0


@pytest.mark.parametrize("turn", [0, -90, *longer(-135, -45, 20, 90, 180)])
def test_the_live_track_does_not_jump_when_its_first_heading_becomes_final(turn: int) -> None:
    route = Route().stand(2.0).turn(radians(turn)) if turn else Route().stand(2.0)
    walk = emulate(route.walk(6.0, 1.2).stand(2.0), seed=2)
    moved = of(FootMoved, run_session(walk.packets, poses=True))
    for foot in Foot:
        track = [event.position for event in moved if event.foot is foot]
        # the first guess turns what is within some centimetres of the start; a move that was no stride is taken back
        jumps = [dist(a, b) for a, b in pairwise(track) if hypot(*a) > FIRST_HEADING_DISTANCE]
        assert max(jumps) < 0.2
