"""What emulated devices send is decoded to what their wearer truly did."""

import numpy as np
import pytest

from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.link.decoder import Decoder
from solepath.types import Foot, Sample, Site

ROUTE = Route().stand(3.0).walk(15.0, 1.2).stop(3.0)


def decoded(walk: EmulatedWalk) -> tuple[list[Sample], list[object]]:
    decoder = Decoder(site=Site.LEFT_FOOT)
    out: list[object] = []
    for packet in walk.packets:
        out += decoder.feed(packet)
    out += decoder.finish()
    return [o for o in out if isinstance(o, Sample)], [o for o in out if not isinstance(o, Sample)]


@pytest.mark.parametrize(
    ("device", "rate"),
    [
        (Insole(), 100.0),
        (Insole(cells=24, rate=30.0, batch=3), 30.0),
        (Insole(cells=99, mtu=65, quaternion=True), 100.0),
        (CC2650(), 10.0),
        (CC2650(rate=50.0), 50.0),
        (CC2541(), 10.0),
        (CC2541(rate=20.0), 20.0),
    ],
)
def test_decoded_samples_have_the_true_rate_and_feel_the_true_motion(device: Device, rate: float) -> None:
    walk = emulate(ROUTE, devices={Site.LEFT_FOOT: device}, radio=Radio(latency=0.001, jitter=0.002), seed=4)
    samples, _ = decoded(walk)
    t = np.array([s.t for s in samples])
    assert len(t) == pytest.approx((walk.truth.duration - 0.05) * rate, abs=0.02 * rate * walk.truth.duration + 3)
    assert np.median(np.diff(t)) == pytest.approx(1.0 / rate, rel=0.01)
    true = walk.walker.kinematics(Foot.LEFT, t, device.mounting)
    sway = np.array([s.gyro for s in samples])[:, 1]
    best = max(np.corrcoef(sway, np.interp(t - lag, t, true.rate[:, 1]))[0, 1] for lag in np.arange(0.0, 0.02, 0.004))
    assert best > (
        0.97 if rate >= 30.0 else 0.85
    )  # a SensorTag saturates in swing, and its accelerometer sets the time
    rest = np.array([s.acc for s in samples if s.t < 2.0])
    assert np.linalg.norm(rest, axis=1).mean() == pytest.approx(9.81, rel=0.2)


def test_decoded_pressure_is_the_true_load() -> None:
    walk = emulate(ROUTE, devices={Site.LEFT_FOOT: Insole()}, radio=Radio(latency=0.0, jitter=0.0), seed=4)
    samples, _ = decoded(walk)
    load = np.array([sum(s.pressure or ()) for s in samples])
    true = walk.walker.loads.total(Foot.LEFT, np.array([s.t for s in samples]))
    swing = load[true == 0.0].mean()  # what the shoe itself presses
    assert 20.0 < swing < 80.0
    assert np.corrcoef(load, true)[0, 1] > 0.999
    assert np.abs(load - swing - true).mean() < 15.0
