"""Nordic Thingy:52 (protocol/thingy.md): nine axes at up to 200 Hz without counters, and air pressure.

Source: the published firmware, Nordic-Thingy52-FW 2.2.0 (m_motion.c, drv_motion.c, ble_tms.h, ble_tes.h). It was never
tried on hardware."""

from __future__ import annotations

from math import radians
from typing import Any

from construct import Int8ul, Int16ul, Int32sl, OneOf, Struct

from ...types.vector import GRAVITY, scaled
from ...wire.fields import Fields
from ..driver import Driver, Known, Measured, Reading
from ..profile import BATTERY, Access, Channel, Profile, Write

ACC_SCALE = GRAVITY / 1024.0
"""Accelerometer scale, m/s^2 per count."""
GYRO_SCALE = radians(1.0 / 32.0)
"""Gyroscope scale, rad/s per count."""
MAG_SCALE = 1e-6 / 16.0
"""Magnetometer scale, T per count."""
ACC_END_COUNTS, GYRO_END_COUNTS = 31 << 10, 1023 << 5
"""Largest counts that the firmware sends: 31 g and 1023 degrees/s; larger values are cut to these."""


def _uuid(short: int) -> str:
    return f"ef68{short:04x}-9b35-4933-9b10-52ffa9740042"


PROFILE = Profile(
    name="thingy",
    names=("Thingy",),
    services=(_uuid(0x0100),),
    channels=(
        Channel("thingy/motion", _uuid(0x0400), _uuid(0x0406), Access.NOTIFY),
        Channel("thingy/motion-config", _uuid(0x0400), _uuid(0x0401), Access.WRITE),
        Channel("thingy/pressure", _uuid(0x0200), _uuid(0x0202), Access.NOTIFY),
        Channel("thingy/environment-config", _uuid(0x0200), _uuid(0x0206), Access.WRITE),
        BATTERY,
    ),
    setup=(
        # pedometer 1 s, temperature 1 s, compass 100 ms, motion at 100 Hz, no wake on motion
        Write("thingy/motion-config", bytes.fromhex("e803e8036400640000")),
        # temperature 5 s, pressure 1 s, humidity and colour 5 s, gas every 60 s, its lamp off
        Write("thingy/environment-config", bytes.fromhex("8813e8038813881303000000")),
    ),
    reads=("device/battery",),
    nominal_rate=100.0,
    streams=("thingy/motion",),
    stale_after=1.0,
)

FORMATS = {
    "thingy/motion": Struct("acc" / Fields("<3h"), "gyro" / Fields("<3h"), "mag" / Fields("<3h")),
    "thingy/motion-config": Struct(
        "pedometer_ms" / OneOf(Int16ul, range(100, 5001)),
        "temperature_ms" / OneOf(Int16ul, range(100, 5001)),
        "compass_ms" / OneOf(Int16ul, range(100, 1001)),
        "rate" / OneOf(Int16ul, range(5, 201)),
        "wake_on_motion" / OneOf(Int8ul, [0, 1]),
    ),
    "thingy/pressure": Struct("hectopascal" / Int32sl, "hundredths" / OneOf(Int8ul, range(100))),
    "thingy/environment-config": Struct(
        "temperature_ms" / OneOf(Int16ul, range(100, 5001)),
        "pressure_ms" / OneOf(Int16ul, range(50, 5001)),
        "humidity_ms" / OneOf(Int16ul, range(100, 5001)),
        "colour_ms" / OneOf(Int16ul, range(200, 5001)),
        "gas_mode" / OneOf(Int8ul, [1, 2, 3]),
        "lamp" / Fields("<3B"),
    ),
}


def _motion(value: Any, known: Known) -> Reading:
    # The firmware inverts the accelerometer's signs, not the gyroscope's: accelerometer counts are positive downwards.
    x, y, z = value.acc
    sample = Measured(
        acc=scaled((-x, -y, -z), ACC_SCALE),
        gyro=scaled(value.gyro, GYRO_SCALE),
        mag=scaled(value.mag, MAG_SCALE),
        saturated=max(map(abs, value.acc)) >= ACC_END_COUNTS or max(map(abs, value.gyro)) >= GYRO_END_COUNTS,
    )
    return Reading((sample,))


def _motion_config(value: Any, known: Known) -> Reading:
    return Reading(rate=float(value.rate))


def _pressure(value: Any, known: Known) -> Reading:
    return Reading(air_pressure=100.0 * value.hectopascal + value.hundredths)


DRIVER = Driver(
    PROFILE,
    FORMATS,
    readers={"thingy/motion": _motion, "thingy/motion-config": _motion_config, "thingy/pressure": _pressure},
)
