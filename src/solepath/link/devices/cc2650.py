"""TI CC2650 SensorTag (protocol/cc2650.md): nine axes in one notification, 10 Hz with stock firmware, no counters.

It also sends air pressure and the state of its keys."""

from __future__ import annotations

from math import radians
from typing import Any

from construct import Array, BitsInteger, BitStruct, ByteSwapped, Const, ExprAdapter, Flag, Int24sl, Int24ul, Struct
from construct import Mapping as Named

from ...types.vector import GRAVITY, scaled
from ...wire.fields import Definition, Fields
from ...wire.sensortag import ON_OFF, PERIOD, hundredths
from ..driver import FULL_SCALE_COUNTS, RANGE_END_COUNTS, Driver, Known, Measured, Reading
from ..profile import BATTERY, FIRMWARE, Access, Channel, Profile, Write, standard_uuid, ti_sensor

ACC_RANGE = 8.0
"""Full scale of the accelerometer that the profile's setup sets, g."""
GYRO_SCALE = radians(500.0 / 65536.0)
"""Gyroscope scale, rad/s per count: +-250 degrees/s (TI, CC2650 SensorTag user's guide)."""
MAG_SCALE = 4912.0 / 32760.0 * 1e-6
"""Magnetometer scale, T per count (InvenSense, MPU-9250 product specification: 4912 uT full scale, 32760 counts)."""

PROFILE = Profile(
    name="cc2650",
    names=("CC2650 SensorTag", "SensorTag 2.0"),
    services=(standard_uuid(0xAA80),),
    channels=(
        *ti_sensor("cc2650", "movement", 0xAA80),
        *ti_sensor("cc2650", "barometer", 0xAA40, period=4),
        Channel("cc2650/keys", standard_uuid(0xFFE0), standard_uuid(0xFFE1), Access.NOTIFY),
        BATTERY,
        FIRMWARE,
    ),
    setup=(
        Write("cc2650/movement-period", b"\x0a"),
        Write("cc2650/movement-config", b"\x7f\x02"),  # all axes, 8 g
        Write("cc2650/barometer-period", b"\x64"),
        Write("cc2650/barometer-config", b"\x01"),
    ),
    reads=("device/firmware", "device/battery"),
    nominal_rate=10.0,
    streams=("cc2650/movement",),
    stale_after=2.0,
)


FORMATS: dict[str, Definition] = {
    "cc2650/movement": Struct("gyro" / Fields("<3h"), "acc" / Fields("<3h"), "mag" / Fields("<3h")),
    # Bits from the high bit of the second byte to the low bit of the first byte. The six highest bits are zero, which
    # rejects a wrong byte order. Axes are x, y, z; the range is in g.
    "cc2650/movement-config": ByteSwapped(
        BitStruct(
            Const(0, BitsInteger(6)),
            "range" / Named(BitsInteger(2), {2: 0, 4: 1, 8: 2, 16: 3}),
            "wake_on_motion" / Flag,
            "mag" / Flag,
            "acc_axes" / Array(3, Flag),
            "gyro_axes" / Array(3, Flag),
        )
    ),
    "cc2650/movement-period": PERIOD,
    # Degrees Celsius and Pa, compensated by the tag (BMP280).
    "cc2650/barometer": Struct(
        "temperature" / hundredths(Int24sl),
        "pressure" / ExprAdapter(Int24ul, lambda pascal, _: float(pascal), lambda pascal, _: round(pascal)),
    ),
    "cc2650/barometer-config": Struct("on" / ON_OFF),
    "cc2650/barometer-period": PERIOD,
    # The left (user) and right (power) button; the reed switch is closed by a magnet.
    "cc2650/keys": BitStruct(Const(0, BitsInteger(5)), "reed" / Flag, "right" / Flag, "left" / Flag),
}


def _movement(value: Any, known: Known) -> Reading:
    a = known.get("acc_range", ACC_RANGE) * GRAVITY / FULL_SCALE_COUNTS
    x, y, z = value.mag
    sample = Measured(
        acc=scaled(value.acc, a) if known.get("has_acc", True) else None,
        gyro=scaled(value.gyro, GYRO_SCALE) if known.get("has_gyro", True) else None,
        # The MPU-9250's magnetometer has axes of its own: (y, x, -z) in those of its accelerometer and gyroscope.
        mag=scaled((y, x, -z), MAG_SCALE) if known.get("has_mag", True) else None,
        saturated=max(map(abs, (*value.acc, *value.gyro))) >= RANGE_END_COUNTS,
    )
    return Reading((sample,))


def _movement_config(value: Any, known: Known) -> Reading:
    """Read the sensors' configuration; with wake on motion the tag sends nothing while it lies still."""
    measures = any(value.acc_axes) or any(value.gyro_axes) or value.mag
    return Reading(
        silent=value.wake_on_motion or not measures,
        known={
            "acc_range": value.range,
            "has_acc": all(value.acc_axes),
            "has_gyro": all(value.gyro_axes),
            "has_mag": value.mag,
        },
    )


def _movement_period(value: Any, known: Known) -> Reading:
    return Reading(period=value.period)


def _barometer(value: Any, known: Known) -> Reading:
    return Reading(air_pressure=value.pressure)


def _keys(value: Any, known: Known) -> Reading:
    return Reading(keys=tuple([name for name in ("left", "right", "reed") if value[name]]))


DRIVER = Driver(
    PROFILE,
    FORMATS,
    readers={
        "cc2650/movement": _movement,
        "cc2650/movement-config": _movement_config,
        "cc2650/movement-period": _movement_period,
        "cc2650/barometer": _barometer,
        "cc2650/keys": _keys,
    },
)
