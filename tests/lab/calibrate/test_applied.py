"""A session corrects the samples of a calibrated sensor before any recipe gets them."""

from __future__ import annotations

import numpy as np
import pytest
from attrs import evolve
from walks import of, samples

from solepath import Calibration, Foot, HeelStrike, Sample, Session, StrideTaken, recipes
from solepath.calibration import HeadingCalibration, SensorCalibration
from solepath.calibration.records import TriadCalibration, merged, stale_feet

NO_SIGMA = ((0.0,) * 9, (0.0, 0.0, 0.0))
SENSOR = SensorCalibration(
    TriadCalibration((1.02, 0.01, 0.0, 0.01, 0.97, 0.0, 0.0, 0.0, 1.01), (0.1, -0.2, 0.3), *NO_SIGMA),
    TriadCalibration((0.98, 0.02, 0.0, 0.0, 1.03, -0.01, 0.01, 0.0, 1.0), (0.02, 0.01, -0.03), *NO_SIGMA),
)
CALIBRATION = Calibration(sensors={Foot.LEFT: SENSOR})
WALK = samples(rate=50.0)


def read(sample: Sample) -> Sample:
    """Return what the sensor would have read where the sample is true."""
    values = []
    for true, triad in ((sample.acc, SENSOR.acc), (sample.gyro, SENSOR.gyro)):
        reading = np.linalg.solve(np.array(triad.matrix).reshape(3, 3), np.array(true)) + triad.bias
        values.append(tuple(reading.tolist()))
    return evolve(sample, acc=values[0], gyro=values[1])


@pytest.mark.parametrize("name", ["default", "walking-modes", "footstep-tracker"])
def test_every_recipe_gets_the_corrected_samples(name: str) -> None:
    readings = [read(one) if one.site.foot is Foot.LEFT else one for one in WALK]
    corrected = [SENSOR.correct(one) if one.site.foot is Foot.LEFT else one for one in readings]
    session, plain = Session(recipes.by_name(name), calibration=CALIBRATION), Session(recipes.by_name(name))
    events = session.feed(readings) + session.finish()
    assert events == plain.feed(corrected) + plain.finish()
    assert of(HeelStrike, events) or of(StrideTaken, events)


def test_a_session_goes_on_with_its_correction_after_a_snapshot_and_packed() -> None:
    whole = Session(calibration=CALIBRATION)
    whole.feed(WALK[:300])
    saved, packed = Session.restore(whole.snapshot()), Session.unpack(whole.pack())
    assert whole.feed(WALK[300:]) == saved.feed(WALK[300:]) == packed.feed(WALK[300:])


def test_what_was_learnt_without_the_correction_is_forgotten() -> None:
    heading = HeadingCalibration(0.001, 0.0, 1e-3, 1e-3)
    known = Calibration(headings=dict.fromkeys(Foot, heading), drift=dict.fromkeys(Foot, (0.01, 0.0)))
    result = merged(known, CALIBRATION)
    assert stale_feet(known, CALIBRATION) == [Foot.LEFT]
    assert list(result.headings) == list(result.drift) == [Foot.RIGHT]
    assert result.sensors == CALIBRATION.sensors and stale_feet(result, CALIBRATION) == []
    assert merged(result, Calibration(headings={Foot.LEFT: heading})).headings[Foot.LEFT] == heading
