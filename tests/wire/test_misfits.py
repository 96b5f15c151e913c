"""What the wire refuses to write: ValueError, before a byte of it is sent."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from attrs import evolve

from solepath.types import Cell, Foot
from solepath.wire import cc2541, cc2650, device, fragment, insole, insole_control, insole_info, period
from solepath.wire.error import WireError

SAMPLE = insole.InsoleSample((1, 2), (0, 0, 0, 0, 0, 0))
FRAME = insole.InsoleFrame(Foot.LEFT, 1, 2, 3, 4, (SAMPLE,))
INFO = insole_info.InsoleInfo(Foot.LEFT, 1, 2, 32768, 327, 0.5, 0.25, 0.125, 0.27, (Cell(0.1, 0.0),), "1")


def frame_of(*samples: insole.InsoleSample) -> insole.InsoleFrame:
    return evolve(FRAME, samples=samples)


MISFITS: dict[str, tuple[Callable[[Any], bytes], Any]] = {
    "a frame without samples": (insole.build_frame, frame_of()),
    "a frame of empty samples": (insole.build_frame, frame_of(insole.InsoleSample(()))),
    "a cell over 4095": (insole.build_frame, frame_of(insole.InsoleSample((4096,)))),
    "a cell under 0": (insole.build_frame, frame_of(insole.InsoleSample((-1,)))),
    "129 cells": (insole.build_frame, frame_of(insole.InsoleSample((0,) * 129))),
    "samples of different cells": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, cells=(1,)))),
    "samples of different sensors": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, imu=None))),
    "an angular rate over i16": (insole.build_frame, frame_of(evolve(SAMPLE, imu=(0, 0, 0, 0, 0, 32768)))),
    "a frame over 512 bytes": (insole.build_frame, frame_of(*[SAMPLE] * 40)),
    "256 samples": (insole.build_frame, frame_of(*[insole.InsoleSample((1,))] * 256)),
    "a sequence over u16": (insole.build_frame, evolve(FRAME, sequence=65536)),
    "a sequence under 0": (insole.build_frame, evolve(FRAME, sequence=-1)),
    "ticks over u32": (insole.build_frame, evolve(FRAME, ticks=2**32)),
    "an interval of zero": (insole.build_frame, evolve(FRAME, interval=0)),
    "a layout over u8": (insole.build_frame, evolve(FRAME, layout=256)),
    "fragment id 7": (fragment.build_fragment, fragment.Fragment(7, False, 0, b"a")),
    "fragment index 16": (fragment.build_fragment, fragment.Fragment(0, False, 16, b"a")),
    "an empty fragment": (fragment.build_fragment, fragment.Fragment(0, False, 0, b"")),
    "a fragment over 512 bytes": (fragment.build_fragment, fragment.Fragment(0, False, 0, bytes(512))),
    "a cell behind the heel": (insole_info.build_info, evolve(INFO, cells=(Cell(-0.001, 0.0),))),
    "a cell half a metre ahead": (insole_info.build_info, evolve(INFO, cells=(Cell(0.5, 0.0),))),
    "a cell far to the left": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.205),))),
    "a cell nowhere": (insole_info.build_info, evolve(INFO, cells=(Cell(float("nan"), 0.0),))),
    "a cell as large as a table": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.0, 1.0),))),
    "129 cells in info": (insole_info.build_info, evolve(INFO, cells=(Cell(0.1, 0.0),) * 129)),
    "128 cells of different areas": (
        insole_info.build_info,
        evolve(INFO, cells=tuple(Cell(0.1, 0.0, n / 10_000_000) for n in range(128))),
    ),
    "a firmware name that does not fit": (insole_info.build_info, evolve(INFO, firmware="n" * 256)),
    "a scale that is no number": (insole_info.build_info, evolve(INFO, acc_scale=float("nan"))),
    "a scale under 0": (insole_info.build_info, evolve(INFO, gyro_scale=-1.0)),
    "a scale beyond binary32": (insole_info.build_info, evolve(INFO, pressure_scale=1e300)),
    "a tick rate of zero": (insole_info.build_info, evolve(INFO, tick_rate=0)),
    "a length over u16": (insole_info.build_info, evolve(INFO, length=7.0)),
    "set interval to zero": (insole_control.build_control, insole_control.SetInterval(0)),
    "set interval over u16": (insole_control.build_control, insole_control.SetInterval(65536)),
    "resend nothing": (insole_control.build_control, insole_control.Resend(0, 0)),
    "resend 256": (insole_control.build_control, insole_control.Resend(0, 256)),
    "a movement count over i16": (
        cc2650.build_movement,
        cc2650.Movement((0, 0, 32768), (0, 0, 0), (0, 0, 0)),
    ),
    "a range of 3 g": (cc2650.build_movement_config, cc2650.MovementConfig(range=3)),
    "a temperature over i24": (cc2650.build_barometer, cc2650.Cc2650Barometer(83886.08, 0.0)),
    "a pressure over u24": (cc2650.build_barometer, cc2650.Cc2650Barometer(0.0, 2.0**24)),
    "a pressure under 0": (cc2650.build_barometer, cc2650.Cc2650Barometer(0.0, -1.0)),
    "an infinite pressure": (cc2650.build_barometer, cc2650.Cc2650Barometer(0.0, float("inf"))),
    "an acceleration over i8": (cc2541.build_accelerometer, cc2541.Accelerometer((0, 0, 128))),
    "range code 4": (cc2541.build_accelerometer_config, cc2541.AccelerometerConfig(4)),
    "an angular rate under i16": (cc2541.build_gyroscope, cc2541.Gyroscope((-32769, 0, 0))),
    "a field over i16": (cc2541.build_magnetometer, cc2541.Magnetometer((32768, 0, 0))),
    "barometer code 3": (cc2541.build_barometer_config, cc2541.Cc2541BarometerConfig(3)),
    "a raw pressure under 0": (cc2541.build_barometer, cc2541.Cc2541Barometer(0, -1)),
    "a signed c1": (
        cc2541.build_barometer_calibration,
        cc2541.BarometerCalibration(-1, 0, 0, 0, 0, 0, 0, 0),
    ),
    "101 percent": (device.build_battery, 101),
    "an empty firmware revision": (device.build_firmware, ""),
    "a long firmware revision": (device.build_firmware, "n" * 513),
    "no period": (period.build_period, 0.0),
    "a period over 2.55 s": (period.build_period, 2.56),
    "a period that is no number": (period.build_period, float("nan")),
}


@pytest.mark.parametrize("case", MISFITS)
def test_what_does_not_fit_is_refused_when_written(case: str) -> None:
    build, record = MISFITS[case]
    with pytest.raises(ValueError) as caught:
        build(record)
    assert not isinstance(caught.value, WireError)


def test_seventeen_fragments_are_refused() -> None:
    data = insole.build_frame(frame_of(insole.InsoleSample((0,) * 96)))
    with pytest.raises(ValueError, match="16 fragments"):
        fragment.split(data, len(data) // 17, 0)
