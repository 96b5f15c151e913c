"""Rejection of records that do not fit a format, by ValueError when they are built."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from attrs import evolve

from solepath.link.devices import cc2541, cc2650
from solepath.types import Cell, Foot
from solepath.wire import device, fragment, insole, insole_control, insole_info
from solepath.wire.error import WireError
from solepath.wire.fields import build_whole

SAMPLE = insole.InsoleSample((1, 2), (0, 0, 0, 0, 0, 0))
FRAME = insole.InsoleFrame(Foot.LEFT, 1, 2, 3, 4, (SAMPLE,))
INFO = insole_info.InsoleInfo(Foot.LEFT, 1, 2, 32768, 327, 0.5, 0.25, 0.125, 0.27, (Cell(0.1, 0.0),), "1")


def frame_of(*samples: insole.InsoleSample) -> insole.InsoleFrame:
    return evolve(FRAME, samples=samples)


def tag(channel: str, **fields: Any) -> tuple[Callable[[Any], bytes], Any]:
    """Return the function that builds a value of a SensorTag's channel, and its fields."""
    return partial(build_whole, {**cc2541.FORMATS, **cc2650.FORMATS}[channel]), fields


MISFITS: dict[str, tuple[Callable[[Any], bytes], Any]] = {
    "a frame without samples": (insole.build_frame, frame_of()),
    "a frame of empty samples": (insole.build_frame, frame_of(insole.InsoleSample(()))),
    "a cell over 4095": (insole.build_frame, frame_of(insole.InsoleSample((4096,)))),
    "a cell under 0": (insole.build_frame, frame_of(insole.InsoleSample((-1,)))),
    "129 cells": (insole.build_frame, frame_of(insole.InsoleSample((0,) * 129))),
    "samples of different cells": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, cells=(1,)))),
    "samples of different sensors": (insole.build_frame, frame_of(SAMPLE, evolve(SAMPLE, imu=None))),
    "five numbers of an IMU, five of a quaternion": (
        insole.build_frame,
        frame_of(insole.InsoleSample((1,), (0,) * 5, (0,) * 5)),  # type: ignore[arg-type]
    ),
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
    "a movement count over i16": tag("cc2650/movement", gyro=(0, 0, 32768), acc=(0, 0, 0), mag=(0, 0, 0)),
    "a range of 3 g": tag(
        "cc2650/movement-config", range=3, wake_on_motion=False, mag=True, acc_axes=[True] * 3, gyro_axes=[True] * 3
    ),
    "a temperature over i24": tag("cc2650/barometer", temperature=83886.08, pressure=0.0),
    "a pressure over u24": tag("cc2650/barometer", temperature=0.0, pressure=2.0**24),
    "a pressure under 0": tag("cc2650/barometer", temperature=0.0, pressure=-1.0),
    "an infinite pressure": tag("cc2650/barometer", temperature=0.0, pressure=float("inf")),
    "an acceleration over i8": tag("cc2541/accelerometer", acc=(0, 0, 128)),
    "range code 4": tag("cc2541/accelerometer-config", code=4),
    "an angular rate under i16": tag("cc2541/gyroscope", gyro=(-32769, 0, 0)),
    "a field over i16": tag("cc2541/magnetometer", mag=(32768, 0, 0)),
    "barometer code 3": tag("cc2541/barometer-config", code=3),
    "a raw pressure under 0": tag("cc2541/barometer", temperature=0, pressure=-1),
    "a signed c1": tag("cc2541/barometer-calibration", c1=-1, c2=0, c3=0, c4=0, c5=0, c6=0, c7=0, c8=0),
    "101 percent": (device.build_battery, 101),
    "an empty firmware revision": (device.build_firmware, ""),
    "a long firmware revision": (device.build_firmware, "n" * 513),
    "no period": tag("cc2650/movement-period", period=0.0),
    "a period over 2.55 s": tag("cc2650/movement-period", period=2.56),
    "a period that is no number": tag("cc2650/movement-period", period=float("nan")),
}


@pytest.mark.parametrize("case", MISFITS)
def test_a_value_that_does_not_fit_is_rejected_when_written(case: str) -> None:
    build, record = MISFITS[case]
    with pytest.raises(ValueError) as caught:
        build(record)
    assert not isinstance(caught.value, WireError)


def test_seventeen_fragments_are_rejected() -> None:
    data = insole.build_frame(frame_of(insole.InsoleSample((0,) * 96)))
    with pytest.raises(ValueError, match="16 fragments"):
        fragment.split(data, len(data) // 17, 0)
