"""Movella DOT, formerly Xsens DOT (protocol/dot.md), in its mode "rate quantities". Never tried on hardware.

It sends acceleration and angular velocity at 60 Hz with the device's own microseconds. dot_orientation.py is its mode
"orientation". Source: Movella DOT BLE Service Specification, document XD0506P, revision C, July 2023."""

from __future__ import annotations

from math import isfinite, radians
from typing import Any

from construct import Bytes, Const, ExprValidator, Int8ul, Int16ul, Int32ul, OneOf, Struct, Terminated

from ...types.vector import GRAVITY
from ...wire.fields import Fields, Hex
from ..driver import Driver, Known, Measured, Reading
from ..profile import Access, Channel, Profile, Write

RATES = 21
"""Number of the payload mode: timestamp, acceleration, angular velocity."""
OUTPUT_RATES = (1, 4, 10, 12, 15, 20, 30, 60, 120)
"""Output rates, Hz; the last only for recording in the device."""
VISIT_RATE = 0x10
"""Bit that marks the output rate as a value to be set."""
FULL_ACC, FULL_GYRO = 0.99 * 16.0 * GRAVITY, 0.99 * radians(2000.0)
"""Ends of the ranges (Movella DOT User Manual), m/s^2 and rad/s, less what calibration may take off."""


def uuid(short: int) -> str:
    """Return the full UUID of a 16-bit id of the device."""
    return f"1517{short:04x}-4947-11e9-8646-d663bd873d93"


def all_finite(values: Any, _: Any) -> bool:
    """Return whether all values are finite."""
    return all(map(isfinite, values))


def _rate_allowed(rate: int, context: Any) -> bool:
    return rate in OUTPUT_RATES or not context.visit & VISIT_RATE


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
        Write("dot/control", bytes([1, 1, RATES])),
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
        "rate" / ExprValidator(Int16ul, _rate_allowed),
        "filter" / Int8ul,
        "reserved" / Hex(Bytes(5)),
        Terminated,
    ),
    "dot/battery": Struct("percent" / OneOf(Int8ul, range(101)), "charging" / OneOf(Int8ul, [0, 1]), Terminated),
}


def _rates(sent: Any, known: Known) -> Reading:
    x, y, z = sent.gyro
    gyro = (radians(x), radians(y), radians(z))
    saturated = max(map(abs, sent.acc)) >= FULL_ACC or max(map(abs, gyro)) >= FULL_GYRO
    return Reading((Measured(sent.acc, gyro, saturated=saturated),), ticks=sent.ticks)


def _control(sent: Any, known: Known) -> Reading:
    return Reading(silent=sent.action == 0 or sent.mode != RATES)


def device_control(sent: Any, known: Known) -> Reading:
    """Read the output rate, where the value sets it."""
    return Reading(rate=float(sent.rate)) if sent.visit & VISIT_RATE else Reading()


def battery(sent: Any, known: Known) -> Reading:
    """Read the battery level."""
    return Reading(battery=sent.percent / 100.0)


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
