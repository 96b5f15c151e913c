"""ORPHE INSOLE (protocol/orphe.md): inertial sensor, attitude and six pressure cells.

A notification has two or four samples, at 100 or 208 Hz, and a sequence number. Source: the maker's library
ORPHE-INSOLE.js 1.3.4 (the parser, the tests and docs/SENSOR_SPEC.md), facts only. It was never tried on hardware."""

from __future__ import annotations

from math import radians
from typing import Any

from construct import Array, Bytes, Const, ExprValidator, GreedyBytes, Int8ub, Int16ub, OneOf, Struct, Switch, this

from ...types import Foot
from ...types.vector import GRAVITY, scaled
from ...wire.fields import Definition, Fields, Hex
from ..driver import FULL_SCALE_COUNTS, RANGE_END_COUNTS, Driver, Known, Measured, Reading
from ..profile import FIRMWARE, Access, Channel, Profile, Write

RATE_BY_HEADER = {50: 208.0, 54: 208.0, 55: 208.0, 56: 100.4}
"""Samples a second, by the header (first byte) of a notification.

The maker documents 200 and 100. The inertial sensor (LSM6DSOX) has 208, and 208 was measured; but mode 4 (header 56)
gives 100.4, by the insole's clock and by the host's alike, in three recordings of 11,318 notifications of the maker."""
ACC_RANGES, GYRO_RANGES = (2.0, 4.0, 8.0, 16.0), (250.0, 500.0, 1000.0, 2000.0)
"""Full scales by their numbers in INFO, g and degrees/s."""
GYRO_SCALE = radians(35e-6)
"""Gyroscope scale, rad/s per count and per degree/s of full scale.

At 2000 degrees/s full scale a count is 0.070 degrees/s (ST, LSM6DSOX), not 2000 / 32768."""
MAX_INFO_SIZE = 32
"""Largest size of an INFO value that is accepted, bytes; the maker's tests have 20."""

_INFORMATION_SERVICE = "01a9d6b5-ff6e-444a-b266-0be75e85c064"
_OTHER_SERVICE = "db1b7aca-cda5-4453-a49b-33a53d3f0833"
_DEVICE_INFORMATION_ID = "24354f22-1c46-430e-a4ab-a1eeabbcdfc0"

PROFILE = Profile(
    name="orphe",
    names=(),
    services=(),  # another device of the maker advertises the same services
    channels=(
        Channel("orphe/values", _OTHER_SERVICE, "f3f9c7ce-46ee-4205-89ac-abe64e626c0f", Access.NOTIFY),
        Channel("orphe/info", _INFORMATION_SERVICE, _DEVICE_INFORMATION_ID, Access.READ),
        Channel("orphe/mode", _INFORMATION_SERVICE, _DEVICE_INFORMATION_ID, Access.WRITE),
        FIRMWARE,
    ),
    setup=(Write("orphe/mode", b"\x0d\x04"),),
    reads=("orphe/info", "device/firmware"),
    nominal_rate=RATE_BY_HEADER[56],
    streams=("orphe/values",),
    stale_after=1.0,
    prefixes=("INS",),
)

_QUAT, _IMU = "quat" / Fields(">4h"), ("gyro" / Fields(">3h"), "acc" / Fields(">3h"))
_PRESSURE = "pressure" / Fields(">6H")
_SAMPLES: dict[int, Definition] = {
    50: Array(4, Struct(_QUAT, *_IMU, "after_ms" / Int8ub)),
    54: Array(4, Struct(*_IMU, _PRESSURE)),
    55: Array(4, Struct(*_IMU, _PRESSURE)),
    56: Array(2, Struct(_QUAT, *_IMU, _PRESSURE)),
}


def _is_short_enough(digits: str, _: Any) -> bool:
    return len(digits) <= 2 * (MAX_INFO_SIZE - 10)  # two digits a byte, after ten bytes of other fields


FORMATS = {
    "orphe/values": Struct(
        "header" / OneOf(Int8ub, _SAMPLES),
        "serial" / Int16ub,
        "hour" / OneOf(Int8ub, range(24)),
        "minute" / OneOf(Int8ub, range(60)),
        "second" / OneOf(Int8ub, range(60)),
        "millisecond" / OneOf(Int16ub, range(1000)),
        "samples" / Switch(this.header, _SAMPLES),
        "unused" / Hex(Switch(this.header, {50: Bytes(12), 56: Bytes(32)}, default=Bytes(0))),
    ),
    "orphe/info": Struct(
        "battery" / Int8ub,
        "mount" / Int8ub,
        "unknown" / Hex(Bytes(6)),
        "acc_range" / OneOf(Int8ub, range(4)),
        "gyro_range" / OneOf(Int8ub, range(4)),
        "rest" / ExprValidator(Hex(GreedyBytes), _is_short_enough),
    ),
    "orphe/mode": Struct(Const(b"\x0d"), "mode" / OneOf(Int8ub, [1, 2, 3, 4])),
}


def _values(value: Any, known: Known) -> Reading:
    a = known.get("acc_range", 16.0) * GRAVITY / FULL_SCALE_COUNTS
    g = known.get("gyro_range", 2000.0) * GYRO_SCALE
    samples = []
    for sample in reversed(value.samples):  # the newest stands first
        samples.append(
            Measured(
                acc=scaled(sample.acc, a),
                gyro=scaled(sample.gyro, g),
                pressure=tuple(map(float, sample.pressure)) if "pressure" in sample else None,
                quat=sample.get("quat"),
                saturated=max(map(abs, (*sample.acc, *sample.gyro))) >= RANGE_END_COUNTS,
            )
        )
    ms = ((value.hour * 60 + value.minute) * 60 + value.second) * 1000 + value.millisecond
    return Reading(tuple(samples), sequence=value.serial, ticks=ms, rate=RATE_BY_HEADER[value.header])


def _info(value: Any, known: Known) -> Reading:
    ranges = {"acc_range": ACC_RANGES[value.acc_range], "gyro_range": GYRO_RANGES[value.gyro_range]}
    return Reading(foot=Foot.RIGHT if value.mount & 1 else Foot.LEFT, known=ranges)


DRIVER = Driver(
    PROFILE,
    FORMATS,
    readers={"orphe/values": _values, "orphe/info": _info},
    sequence=1 << 16,
    tick_rate=1000.0,
    tick_modulus=24 * 3600 * 1000,
    limitation="ORPHE INSOLE: pressure in counts, from six cells whose places are not known in metres",
)
