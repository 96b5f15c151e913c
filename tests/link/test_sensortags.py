"""Decoding of SensorTag packets to samples in SI units, by the CC2650's configuration and the CC2541's firmware."""

from __future__ import annotations

import pytest
from decoded import LEFT, acc_packet, feed, gyro_packet, packet
from walks import of

from solepath.events import Limitation
from solepath.link.decoder import Decoder
from solepath.link.devices.cc2541 import counts_per_g
from solepath.types import Sample
from solepath.types.vector import GRAVITY
from solepath.wire.fields import build_text


@pytest.mark.parametrize(
    ("firmware", "code", "expected"),
    [
        ("1.5 (Oct 23 2013)", 1, 64),
        ("1.5 (Oct 23 2013)", 2, 32),
        ("1.5 (Oct 23 2013)", 3, 16),
        ("1.4 (Jul 12 2013)", 3, 64),
        ("", 3, 16),
        ("", 1, 64),
    ],
)
def test_the_scale_goes_by_firmware_and_range(firmware: str, code: int, expected: int) -> None:
    assert counts_per_g(firmware, code) == expected
    decoder = Decoder(site=LEFT)
    if firmware:
        feed(decoder, packet(0.0, "device/firmware", build_text(firmware)))
    feed(decoder, packet(0.0, "cc2541/accelerometer-config", bytes([code])))
    outputs = feed(decoder, acc_packet(1.0, (0, 0, expected)), gyro_packet(1.05))
    assert outputs[0].acc == pytest.approx((0.0, 0.0, GRAVITY))


def test_a_gyroscope_that_stops_does_not_stop_the_samples() -> None:
    decoder = Decoder(site=LEFT)
    outputs = []
    for k in range(30):
        outputs += feed(decoder, acc_packet(1.0 + 0.1 * k))
        if k < 10:
            outputs += feed(decoder, gyro_packet(1.04 + 0.1 * k))
    samples = of(Sample, outputs)
    assert len(samples) == 30
    assert [sample.gyro is None for sample in samples] == [False] * 11 + [True] * 19
    assert max(sample.known_at - sample.t for sample in samples) < 0.31
    assert samples[-1].known_at == samples[-1].t


def test_an_accelerometer_that_stops_leaves_the_gyroscope() -> None:
    decoder = Decoder(site=LEFT)
    outputs = feed(decoder, acc_packet(1.0), *[gyro_packet(1.04 + 0.1 * k) for k in range(20)])
    samples = of(Sample, outputs)
    assert samples[0].acc is not None
    assert all(sample.acc is None and sample.gyro is not None for sample in samples[1:])
    assert len(samples) == 18


def test_a_barometer_without_calibration_is_reported_once() -> None:
    decoder = Decoder(site=LEFT)
    raw = bytes.fromhex("b2eec584")
    [limitation] = feed(decoder, packet(1.0, "cc2541/barometer", raw), packet(2.0, "cc2541/barometer", raw))
    assert isinstance(limitation, Limitation)
    calibration = bytes.fromhex("81b2f863febe4e8d591bc607c4f66ddb")
    feed(decoder, packet(3.0, "cc2541/barometer-calibration", calibration))
    [sample] = feed(decoder, packet(4.0, "cc2541/barometer", raw))
    assert sample.air_pressure == pytest.approx(100960.5, abs=0.1)
