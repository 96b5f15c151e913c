"""Emulated SensorTags obey the writes that their protocols know, and reject others with the codes of the device."""

from __future__ import annotations

from typing import Any

import pytest
from benches import error_code, played, start, worn

from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.link.devices import cc2541, cc2650
from solepath.wire.fields import parse_whole

# the CC2650


def parse(channel: str, value: bytes) -> Any:
    return parse_whole({**cc2650.FORMATS, **cc2541.FORMATS}[channel], value)


def movements(tag: Peripheral, until: float) -> list[tuple[float, Any]]:
    return [(t, parse("cc2650/movement", o.value)) for t, o in played(tag, until, "cc2650/movement")]


def configured(config: bytes, device: CC2650) -> Peripheral:
    tag = start(worn(device), "cc2650/movement")
    tag.write("cc2650/movement-period", b"\x0a", 0.0)
    tag.write("cc2650/movement-config", config, 0.0)
    return tag


@pytest.mark.parametrize(
    ("rate", "written", "taken"),
    [(10.0, 0x0A, 10), (10.0, 0x05, 10), (10.0, 0x00, 10), (10.0, 0x64, 100), (10.0, 0xFF, 255), (50.0, 0x02, 2)],
)
def test_a_period_is_kept_and_one_below_the_firmwares_is_raised(rate: float, written: int, taken: int) -> None:
    tag = configured(b"\x7f\x02", CC2650(rate=rate, ppm=0.0))
    tag.write("cc2650/movement-period", bytes([written]), 0.0)
    assert tag.read("cc2650/movement-period", 0.0) == bytes([taken])
    times = [t for t, _ in movements(tag, 11.0)]
    for one, following in zip(times, times[1:], strict=False):
        assert following - one == pytest.approx(0.01 * taken)
    assert len(times) == pytest.approx(1100 / taken, abs=1.0)


APPLICATION_ERROR: dict[Device, list[tuple[str, bytes, int]]] = {
    Insole(): [
        ("insole/control", b"", 0x81),
        ("insole/control", b"\x00", 0x80),
        ("insole/control", b"\x01\x00", 0x81),
        ("insole/control", b"\x03\x00\x00", 0x81),
        ("insole/control", b"\x04\x01\x00\x05", 0x82),
    ],
    CC2650(): [
        ("cc2650/movement-config", b"\x7f", 0x0D),
        ("cc2650/movement-period", b"\x0a\x00", 0x0D),
        ("cc2650/barometer-config", b"\x02", 0x80),
    ],
    CC2541(): [
        ("cc2541/accelerometer-config", b"\x04", 0x80),
        ("cc2541/gyroscope-config", b"\x08", 0x80),
        ("cc2541/barometer-config", b"", 0x0D),
        ("cc2541/gyroscope-period", b"\x0a\x0a", 0x0D),
        ("cc2541/barometer-calibration", b"\x00", 0x03),
    ],
}


@pytest.mark.parametrize("device", APPLICATION_ERROR, ids=lambda device: type(device).__name__)
def test_values_of_wrong_length_or_meaning_are_rejected_with_the_codes_of_the_device(device: Device) -> None:
    tag = start(worn(device))
    for channel, value, code in APPLICATION_ERROR[device]:
        assert error_code(tag, channel, value) == code, (channel, value)


# the CC2541


def test_coefficients_can_be_read_after_they_were_fetched_and_not_before() -> None:
    tag = start(worn(CC2541()), "cc2541/barometer")
    assert error_code(tag, "cc2541/barometer-calibration") == 0x02
    tag.write("cc2541/barometer-config", b"\x02", 0.0)
    assert not played(tag, 3.0), "fetching does not switch it on"
    read = parse("cc2541/barometer-calibration", tag.read("cc2541/barometer-calibration", 3.0) or b"")
    calibration = cc2541.BarometerCalibration(*[read[f"c{n}"] for n in range(1, 9)])
    tag.write("cc2541/barometer-config", b"\x01", 3.0)
    raw = [parse("cc2541/barometer", o.value) for _, o in played(tag, 8.0)]
    received = [calibration.pascal(one.temperature, one.pressure) for one in raw]
    assert len(received) in (4, 5, 6)
    assert received == pytest.approx([101325.0] * len(received), abs=300.0)
    tag.disconnected(8.0)
    tag.connected(9.0, 23)
    assert error_code(tag, "cc2541/barometer-calibration", now=9.0) == 0x02
