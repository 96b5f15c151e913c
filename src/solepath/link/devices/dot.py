"""Movella DOT, formerly Xsens DOT (protocol/dot.md), in its mode "rate quantities".

It sends acceleration and angular velocity at 60 Hz, with the device's time in us. dot_orientation.py has its mode
"orientation". Source: Movella DOT BLE Service Specification, document XD0506P, revision C, July 2023. It was never
tried on hardware."""

from __future__ import annotations

from math import isfinite, radians
from typing import Any

from construct import Bytes, Const, ExprValidator, Int8ul, Int16ul, Int32ul, OneOf, Struct, Terminated

from ...types.vector import GRAVITY
from ...wire.fields import Fields, Hex
from ..driver import Driver, Known, Measured, Reading
from ..profile import Access, Channel, Profile, Write

RATES_MODE = 21
"""Number of the payload mode: timestamp, acceleration, angular velocity."""
OUTPUT_RATES = (1, 4, 10, 12, 15, 20, 30, 60, 120)
"""Output rates, Hz; 120 Hz is possible only for recording in the device."""
RATE_BIT = 0x10
"""Bit of the field `visit` that says that the output rate is set."""
ACC_RANGE_END, GYRO_RANGE_END = 0.99 * 16.0 * GRAVITY, 0.99 * radians(2000.0)
"""Values that count as saturated, m/s^2 and rad/s: 99 % of the range (Movella DOT User Manual).

The device's calibration may reduce the value at the end of the range."""


def uuid(short: int) -> str:
    """Return the full UUID of a 16-bit id of the device."""
    return f"1517{short:04x}-4947-11e9-8646-d663bd873d93"


def all_finite(values: Any, _: Any) -> bool:
    """Return whether all values are finite."""
    return all(map(isfinite, values))


def _is_rate_allowed(rate: int, context: Any) -> bool:
    return rate in OUTPUT_RATES or not context.visit & RATE_BIT


PROFILE = Profile(
    name="dot",
    names=("Movella DOT", "Xsens DOT"),
    services=(),
    channels=(
        Channel("dot/rates", uuid(0x2000), uuid(0x2003), Access.NOTIFY),
        Channel("dot/control", uuid(0x2000), uuid(0x2001), Access.WRITE),
        Channel("dot/device-control", uuid(0x1000), uuid(0x1002), Access.WRITE),
        Channel("dot/battery", uuid(0x3000), uuid(0x3001), Access.NOTIFY),
    ),
    setup=(
        Write("dot/device-control", b"\x10" + bytes(23) + b"\x3c\x00" + bytes(6)),  # 60 Hz, the most that it streams
        Write("dot/control", bytes([1, 1, RATES_MODE])),
    ),
    reads=("dot/battery",),
    nominal_rate=60.0,
    streams=("dot/rates",),
    stale_after=1.0,
)

FORMATS = {
    "dot/rates": Struct(
        "ticks" / Int32ul,
        "acc" / ExprValidator(Fields("<3f"), all_finite),
        "gyro" / ExprValidator(Fields("<3f"), all_finite),
        Const(bytes(12)),
        Terminated,
    ),
    "dot/control": Struct(
        "type" / OneOf(Int8ul, [1]),
        "action" / OneOf(Int8ul, [0, 1]),
        "mode" / OneOf(Int8ul, [*range(1, 8), *range(16, 27)]),
        Terminated,
    ),
    "dot/device-control": Struct(
        "visit" / Int8ul,
        "identifying" / Int8ul,
        "power" / Int8ul,
        "timeouts" / Fields("<4B"),
        "tag_length" / Int8ul,
        "tag" / Hex(Bytes(16)),
        "rate" / ExprValidator(Int16ul, _is_rate_allowed),
        "filter" / Int8ul,
        "reserved" / Hex(Bytes(5)),
        Terminated,
    ),
    "dot/battery": Struct("percent" / OneOf(Int8ul, range(101)), "charging" / OneOf(Int8ul, [0, 1]), Terminated),
}


def _rates(value: Any, known: Known) -> Reading:
    x, y, z = value.gyro
    gyro = (radians(x), radians(y), radians(z))
    saturated = max(map(abs, value.acc)) >= ACC_RANGE_END or max(map(abs, gyro)) >= GYRO_RANGE_END
    return Reading((Measured(value.acc, gyro, saturated=saturated),), ticks=value.ticks)


def _control(value: Any, known: Known) -> Reading:
    """Read a write that starts or stops a mode; the device is silent when stopped, or when it sends another mode."""
    return Reading(silent=value.action == 0 or value.mode != RATES_MODE)


def device_control(value: Any, known: Known) -> Reading:
    """Return a Reading with the output rate if the value sets the rate, else an empty Reading."""
    return Reading(rate=float(value.rate)) if value.visit & RATE_BIT else Reading()


def battery(value: Any, known: Known) -> Reading:
    """Return a Reading with the battery level."""
    return Reading(battery=value.percent / 100.0)


DRIVER = Driver(
    PROFILE,
    FORMATS,
    readers={
        "dot/rates": _rates,
        "dot/control": _control,
        "dot/device-control": device_control,
        "dot/battery": battery,
    },
    tick_rate=1e6,
    tick_modulus=1 << 32,
)
