"""A stance is found although the velocity drifted or was never known, and strides that merge are degraded."""

from __future__ import annotations

from functools import cache
from math import hypot, pi, sin
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve

from solepath import Foot, Sample, Session, Site, StrideTaken
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.truth import TrueStride

PULSE_TIME = 0.4
"""Duration of an error of the accelerometer before heel-strike, s."""


def drifted(sample: Sample, heel_strikes: list[float], drift: float) -> Sample:
    """Return a sample of a foot that trembles in stance, with an error of `drift` m/s before each of some contacts."""
    assert sample.acc is not None and sample.gyro is not None
    t, (ax, ay, az), (gx, gy, gz) = sample.t, sample.acc, sample.gyro
    for start in (t_contact - PULSE_TIME - 0.02 for t_contact in heel_strikes):
        if start <= t < start + PULSE_TIME:
            ax += 2.0 * drift / PULSE_TIME * sin(pi * (t - start) / PULSE_TIME) ** 2
    return evolve(sample, acc=(ax, ay, az), gyro=(gx, gy + 0.2 * sin(8.0 * pi * t), gz + 0.1 * sin(33.3 * t)))


@pytest.mark.parametrize("speed", [1.3, 1.7])
@pytest.mark.parametrize("drift", [0.5, 0.9])
@pytest.mark.soak
def test_no_two_strides_merge_after_a_swing_with_a_wrong_velocity(speed: float, drift: float) -> None:
    walker = Walker(Route().stand(2.0).walk(40.0, speed).stop(2.0), seed=3)
    true = walker.truth().strides(Foot.LEFT)
    heel_strikes = [stride.t_heel_strike for stride in true[2::3]]
    session = Session()
    samples = [drifted(sample, heel_strikes, drift) for sample in walker.samples(Foot.LEFT, 200.0, LSM6DSOX)]
    events = session.feed(samples) + session.finish()
    strides = [event for event in events if isinstance(event, StrideTaken)]
    assert len(strides) == len(true)
    for found, stride in zip(strides, true, strict=True):
        # less than the way by which the error alone moves the track: half of drift times PULSE_TIME
        assert found.length == pytest.approx(hypot(*stride.displacement[:2]), abs=0.5 * PULSE_TIME * drift)
    assert session.position is not None and abs(session.position.position[2]) < 0.05


@cache
def forty_metres() -> tuple[tuple[Sample, ...], tuple[TrueStride, ...]]:
    """Return the samples of the left foot, and its true strides."""
    walker = Walker(Route().stand(2.0).walk(40.0, 1.3).stop(2.0), seed=4)
    return tuple(walker.samples(Foot.LEFT, 50.0, LSM6DSOX)), walker.truth().strides(Foot.LEFT)


@pytest.mark.parametrize("scale", [1.0, 1.05])
@pytest.mark.parametrize("phase", [0.15, 0.6])
def test_a_recording_that_starts_in_mid_walk_has_each_stride_after_its_first_stance(phase: float, scale: float) -> None:
    walk, true = forty_metres()
    start = true[4].t_start + phase * (true[4].t_end - true[4].t_start)
    samples = [
        evolve(sample, acc=tuple(scale * a for a in sample.acc))
        for sample in walk
        if sample.t >= start and sample.acc is not None
    ]
    session = Session()
    found = [event for event in session.feed(samples) + session.finish() if isinstance(event, StrideTaken)]
    expected = [stride for stride in true if stride.t_start > start + 2.0]
    found = found[-len(expected) :]
    assert [stride.t_end for stride in found] == pytest.approx([stride.t_end for stride in expected], abs=0.25)
    for stride, truth in zip(found, expected, strict=True):
        assert stride.length == pytest.approx(hypot(*truth.displacement[:2]), rel=0.08) and not stride.degraded
    assert abs(sum(stride.height_change for stride in found)) < 0.1


@pytest.mark.parametrize("phase", [0.4])
@pytest.mark.parametrize(
    "name, key, start, longest",
    [("pyshoe_vicon/2017-12-15-18-00-13", "", 4.84, 1.5), ("ipol_10m_uturn/19-1", "_left", 13.17, 1.5)],
)
def test_a_real_walk_from_its_middle_has_no_long_stride(
    data_dir: Path, name: str, key: str, start: float, longest: float, phase: float
) -> None:
    """Strides of up to 23 m were reported after these starts; the second sensor shows 1.05 g at rest."""
    data = np.load(data_dir / f"{name}.npz")
    times = data[f"t{key}" if f"t{key}" in data else "t"]
    rows = zip(times.tolist(), data[f"acc{key}"].tolist(), data[f"gyro{key}"].tolist(), strict=True)
    samples = [
        Sample(t=t, site=Site.LEFT_FOOT, acc=tuple(acc), gyro=tuple(gyro))
        for t, acc, gyro in rows
        if start + phase <= t < start + phase + 10.0
    ]
    session = Session()
    strides = [event for event in session.feed(samples) + session.finish() if isinstance(event, StrideTaken)]
    assert len(strides) >= 6 and max(stride.length for stride in strides) < longest
