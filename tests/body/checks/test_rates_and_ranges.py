"""Samples that are too few, smoothed, repeated, in bursts or cut off: found in emulated and in recorded walks."""

from __future__ import annotations

from pathlib import Path

import pytest
from attrs import evolve
from one_foot import clipped, run, scaled, signed, vectors
from soak import longer

from solepath import Defect, Flaw, Foot, Sample, Site
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.recording import read_samples
from solepath.types import Vec3
from solepath.types.vector import GRAVITY

WALK = Walker(Route().stand(1.5).walk(30.0, 1.3).stop(1.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
"""A walk of 30 m with an inertial sensor that has no defect."""
IN_G = vectors(acc=scaled(1.0 / GRAVITY))
"""Change of samples to specific force in g."""


def test_a_rate_at_which_no_walk_can_be_followed_is_named() -> None:
    found, _ = run(WALK[::8])
    assert Defect.LOW_RATE in {event.defect for event in found}


def averaged(samples: list[Sample], count: int) -> list[Sample]:
    """Return the samples of a sensor that averages `count` samples and sends as often as before."""

    def mean(values: list[Vec3]) -> Vec3:
        x, y, z = [sum(axis) / len(values) for axis in zip(*values, strict=True)]
        return x, y, z

    recent = [samples[max(0, i - count + 1) : i + 1] for i in range(len(samples))]
    return [
        evolve(last[-1], acc=mean([s.acc or (0.0,) * 3 for s in last]), gyro=mean([s.gyro or (0.0,) * 3 for s in last]))
        for last in recent
    ]


def test_a_sensor_that_smooths_a_step_away_is_named(data_dir: Path) -> None:
    walk = [sample for sample in read_samples(data_dir / "openshoe_loops" / "m30.npz") if sample.t < 30.0]
    assert run(averaged(walk, 5))[0] == [], "20 ms smooth nothing away"
    assert Defect.BANDWIDTH in {event.defect for event in run(averaged(walk, 50))[0]}


@pytest.mark.parametrize("speed", [0.3, 0.8])
def test_a_slow_walker_is_slow_and_not_smoothed_away(speed: float) -> None:
    walk = Walker(Route().stand(1.5).walk(12.0, speed).stop(1.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    assert run(walk)[0] == []


@pytest.mark.parametrize("seed", [301, 302, 304, 5])
def test_a_slow_runner_is_neither_smoothed_away_nor_on_other_axes(seed: int) -> None:
    route = Route().stand(3.0).jog(30.0, 2.0).stand(3.0).jog(30.0, 2.0).stop(4.0)
    for foot in Foot:
        assert run(Walker(route, seed=seed).samples(foot, 100.0, LSM6DSOX))[0] == []


@pytest.mark.parametrize("count", [3, 4])
def test_a_sensor_of_25_to_33_samples_a_second_has_axes_and_gravity_too(count: int, data_dir: Path) -> None:
    walk = [s for s in read_samples(data_dir / "gaitmap_examples" / "walk_4x10m_ic.npz") if s.site is Site.LEFT_FOOT]
    slow = averaged(walk, count)[::count]
    assert run(slow)[0] == []
    mirrored = [vectors(gyro=signed(1.0, -1.0, 1.0))(sample) for sample in slow]
    assert Defect.AXES in {event.defect for event in run(mirrored)[0]}
    assert Defect.ACC_UNIT in {event.defect for event in run([IN_G(sample) for sample in slow])[0]}


def test_samples_with_the_time_of_their_packet_are_bursts() -> None:
    bursts = [evolve(s, t=WALK[i - i % 10].t + 1e-5 * (i % 10), known_at=None) for i, s in enumerate(WALK)]
    assert [event.defect for event in run(bursts)[0]] == [Defect.BURSTS]


def test_a_range_that_a_slow_walk_hardly_reaches_spoils_a_fast_one() -> None:
    route = Route().stand(1.5).walk(15.0, 0.8).walk(40.0, 1.9).stop(1.0)
    walk = Walker(route, seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    found, strides = run([vectors(gyro=clipped(5.8))(sample) for sample in walk])
    spoiling = [event for event in found if event.defect is Defect.CLIPPED and event.spoils]
    assert len(spoiling) == 1
    later = [stride for stride in strides if stride.t_start > spoiling[0].t]
    assert len(later) >= 3 and all(stride.degraded for stride in later)


def test_strides_whose_peaks_are_within_a_small_range_are_right() -> None:
    route = Route().stand(1.5).walk(40.0, 1.9).walk(15.0, 0.7).stop(1.0)
    walk = Walker(route, seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    found, strides = run([vectors(gyro=clipped(5.8))(sample) for sample in walk])
    (spoiling,) = [event for event in found if event.defect is Defect.CLIPPED and event.spoils]
    fast = [stride.flaws for stride in strides if stride.t_start > spoiling.t and stride.length > 1.5]
    slow = [stride.flaws for stride in strides if stride.t_start > spoiling.t and stride.length < 1.2]
    assert len(fast) >= 3 and set(fast) == {(Flaw.RANGE,)}
    assert len(slow) >= 5 and set(slow) == {()}


@pytest.mark.parametrize("speed", [1.3, *longer(1.0, 1.6)])
@pytest.mark.parametrize("limit", [14.0, 16.0, 2.0 * GRAVITY])
def test_cut_off_peaks_neither_hide_wrong_times_nor_look_like_them(limit: float, speed: float) -> None:
    walk = Walker(Route().stand(1.5).walk(26.0, speed).stop(1.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    cut = [vectors(acc=clipped(limit))(sample) for sample in walk]
    assert [event.defect for event in run(cut)[0]] == [Defect.CLIPPED]
    for factor, rate in ((1.5, "higher"), (1.0 / 1.5, "lower")):
        found, _ = run([evolve(sample, t=factor * sample.t, known_at=None) for sample in cut])
        assert f"at a {rate} rate" in found[-1].what


def test_a_runner_in_g_is_in_g_and_not_in_another_range() -> None:
    jog = Walker(Route().jog(60.0, 2.8).stop(2.0), seed=102).samples(Foot.LEFT, 100.0, LSM6DSOX)
    found, _ = run([IN_G(sample) for sample in jog])
    assert Defect.ACC_UNIT in {event.defect for event in found}
    assert Defect.WRONG_SCALE not in {event.defect for event in found}
