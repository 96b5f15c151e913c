"""Movella DOT, formerly Xsens DOT, in two of its modes (protocol/dot.md, protocol/dot-orientation.md).

"Rate quantities" has acceleration and angular velocity, "orientation (quaternion)" the attitude alone, which is enough
for sensors on pelvis, thighs and shanks. Both send at 60 Hz, with the device's time in us. Source: Movella DOT BLE
Service Specification, document XD0506P, revision C, July 2023. It was never tried on hardware."""

from __future__ import annotations

from math import fsum, isfinite, radians
from typing import Any

from construct import Bytes, Const, ExprValidator, Int8ul, Int16ul, Int32ul, OneOf, Struct

from ...types import Floats
from ...types.vector import GRAVITY
from ...wire.fields import Definition, Fields, Hex
from ..driver import Driver, Known, Measured, Reader, Reading
from ..profile import Access, Channel, Profile, Write

OUTPUT_RATES = (1, 4, 10, 12, 15, 20, 30, 60, 120)
"""Output rates, Hz; 120 Hz is possible only for recording in the device."""
RATE_BIT = 0x10
"""Bit of the field `visit` that says that the output rate is set."""
ACC_RANGE_END, GYRO_RANGE_END = 0.99 * 16.0 * GRAVITY, 0.99 * radians(2000.0)
"""Values that count as saturated, m/s^2 and rad/s: 99 % of the range (Movella DOT User Manual).

The device's calibration may reduce the value at the end of the range."""
MAX_LENGTH_ERROR = 0.01
"""Largest deviation of a quaternion's length from 1, which values of another mode exceed."""


def _uuid(short: int) -> str:
    return f"1517{short:04x}-4947-11e9-8646-d663bd873d93"


def _all_finite(values: Floats, _: Any) -> bool:
    return all(map(isfinite, values))


def _has_length_one(quat: Floats, _: Any) -> bool:
    # the squared length deviates from 1 by twice as much as the length
    return _all_finite(quat, None) and abs(fsum([part * part for part in quat]) - 1.0) < 2.0 * MAX_LENGTH_ERROR


def _is_rate_allowed(rate: int, context: Any) -> bool:
    return rate in OUTPUT_RATES or not context.visit & RATE_BIT


def _device_control(value: Any, known: Known) -> Reading:
    return Reading(rate=float(value.rate)) if value.visit & RATE_BIT else Reading()


def _battery(value: Any, known: Known) -> Reading:
    return Reading(battery=value.percent / 100.0)


def _driver(name: str, mode: int, stream: Channel, definition: Definition, reader: Reader) -> Driver:
    """Return the driver of a payload mode, whose number is `mode`."""
    control, device_control, battery = [f"{name}/{what}" for what in ("control", "device-control", "battery")]

    def read_control(value: Any, known: Known) -> Reading:
        """Read a write that starts or stops a mode; the device is silent when stopped, or in another mode."""
        return Reading(silent=value.action == 0 or value.mode != mode)

    profile = Profile(
        name=name,
        names=("Movella DOT", "Xsens DOT"),
        services=(),
        channels=(
            stream,
            Channel(control, _uuid(0x2000), _uuid(0x2001), Access.WRITE),
            Channel(device_control, _uuid(0x1000), _uuid(0x1002), Access.WRITE),
            Channel(battery, _uuid(0x3000), _uuid(0x3001), Access.NOTIFY),
        ),
        setup=(
            Write(device_control, b"\x10" + bytes(23) + b"\x3c\x00" + bytes(6)),  # 60 Hz, the most that it streams
            Write(control, bytes([1, 1, mode])),
        ),
        reads=(battery,),
        nominal_rate=60.0,
        streams=(stream.name,),
        stale_after=1.0,
    )
    formats = {
        stream.name: definition,
        control: Struct(
            "type" / OneOf(Int8ul, [1]),
            "action" / OneOf(Int8ul, [0, 1]),
            "mode" / OneOf(Int8ul, [*range(1, 8), *range(16, 27)]),
        ),
        device_control: Struct(
            "visit" / Int8ul,
            "identifying" / Int8ul,
            "power" / Int8ul,
            "timeouts" / Fields("<4B"),
            "tag_length" / Int8ul,
            "tag" / Hex(Bytes(16)),
            "rate" / ExprValidator(Int16ul, _is_rate_allowed),
            "filter" / Int8ul,
            "reserved" / Hex(Bytes(5)),
        ),
        battery: Struct("percent" / OneOf(Int8ul, range(101)), "charging" / OneOf(Int8ul, [0, 1])),
    }
    readers = {stream.name: reader, control: read_control, device_control: _device_control, battery: _battery}
    return Driver(profile, formats, readers, tick_rate=1e6, tick_modulus=1 << 32)


def _rates(value: Any, known: Known) -> Reading:
    x, y, z = value.gyro
    gyro = (radians(x), radians(y), radians(z))
    saturated = max(map(abs, value.acc)) >= ACC_RANGE_END or max(map(abs, gyro)) >= GYRO_RANGE_END
    return Reading((Measured(value.acc, gyro, saturated=saturated),), ticks=value.ticks)


DRIVER = _driver(
    "dot",
    21,
    Channel("dot/rates", _uuid(0x2000), _uuid(0x2003), Access.NOTIFY),
    Struct(
        "ticks" / Int32ul,
        "acc" / ExprValidator(Fields("<3f"), _all_finite),
        "gyro" / ExprValidator(Fields("<3f"), _all_finite),
        Const(bytes(12)),
    ),
    _rates,
)


def _quaternion(value: Any, known: Known) -> Reading:
    return Reading((Measured(quat=value.quat),), ticks=value.ticks)


ORIENTATION_DRIVER = _driver(
    "dot-orientation",
    5,
    Channel("dot-orientation/quaternion", _uuid(0x2000), _uuid(0x2004), Access.NOTIFY),
    Struct("ticks" / Int32ul, "quat" / ExprValidator(Fields("<4f"), _has_length_one)),
    _quaternion,
)
