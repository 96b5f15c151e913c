"""Inertial cues: times of heel-strike, foot-flat and toe-off, and the middle of an impact."""

from __future__ import annotations

from statistics import median

import pytest
from walks import of

from solepath import Foot, Sample, Session, ToeOff
from solepath.emulate import Route, Walker
from solepath.events import HeelStrike
from solepath.types.vector import GRAVITY


def walked(speed: float, rate: float = 100.0, far: float = 15.0) -> tuple[Walker, list[Sample]]:
    walker = Walker(Route().stand(2).walk(far, speed).stop(2), seed=5)
    return walker, [Sample(s.t, s.site, s.acc, s.gyro) for s in walker.samples(Foot.LEFT, rate)]


@pytest.mark.parametrize("speed", [0.9, 1.7])
def test_without_cells_toe_off_and_heel_strike_are_seen_by_how_the_foot_turns(speed: float) -> None:
    walker, samples = walked(speed)
    events = Session().feed(samples)
    truth = walker.truth().feet[Foot.LEFT]
    for kind, true_times in ((ToeOff, truth.toe_offs), (HeelStrike, truth.heel_strikes)):
        detected = [event.t for event in events if isinstance(event, kind)]
        assert len(detected) == len(true_times)
        offsets = [a - b for a, b in zip(detected, true_times, strict=True)]
        assert abs(median(offsets)) < 0.045, kind.__name__
        assert max(offsets) - min(offsets[1:]) < 0.2, kind.__name__


@pytest.mark.parametrize("rate", [20.0, 200.0])
def test_heel_strike_is_where_the_ground_stops_the_foot_at_any_rate(rate: float) -> None:
    walker, samples = walked(1.2, rate, 8.0)
    detected = [event.t for event in of(HeelStrike, Session().feed(samples))]
    true_times = walker.truth().feet[Foot.LEFT].heel_strikes
    assert len(detected) == len(true_times)
    # the time between two samples is the limit
    assert abs(median(a - b for a, b in zip(detected, true_times, strict=True))) < 0.015 + 0.5 / rate


@pytest.mark.parametrize("speed", [0.7, 1.8])
def test_heel_strike_and_toe_off_are_known_within_60_ms(speed: float) -> None:
    _, samples = walked(speed)
    events = Session().feed(samples)
    latencies = [event.known_at - event.t for kind in (HeelStrike, ToeOff) for event in of(kind, events)[1:-1]]
    assert len(latencies) > 10 and max(latencies) < 0.0605


def test_heel_strike_stays_where_it_is_when_the_accelerometer_clips_at_2_g() -> None:
    _, samples = walked(1.4)
    limit = 2.0 * GRAVITY

    def clipped(sample: Sample) -> Sample:
        assert sample.acc is not None
        x, y, z = (max(-limit, min(limit, value)) for value in sample.acc)
        return Sample(sample.t, sample.site, (x, y, z), sample.gyro)

    whole, cut = (of(HeelStrike, Session().feed(fed)) for fed in (samples, [clipped(sample) for sample in samples]))
    assert len(cut) == len(whole)
    assert abs(median(a.t - b.t for a, b in zip(cut, whole, strict=True))) < 0.02
