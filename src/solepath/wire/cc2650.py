"""CC2650 SensorTag (protocol/cc2650.md): movement, its configuration, barometer and keys, in raw sensor axes."""

from __future__ import annotations

from math import isfinite
from typing import Any

from attrs import frozen
from construct import BitsInteger, BitStruct, ByteSwapped, Flag, Int24sl, Int24ul, Struct, Terminated

from .fields import Fields, Record, Switch, build_whole, malformed, parse_whole

Counts = tuple[int, int, int]
Axes = tuple[bool, bool, bool]


@frozen
class Movement:
    """One notification of the MPU-9250: x, y, z of each sensor in i16 counts, as the part gives them."""

    gyro: Counts
    acc: Counts
    mag: Counts


@frozen
class MovementConfig:
    """Which axes (x, y, z) are on, and the accelerometer's range in g: 2, 4, 8 or 16.

    With `wake_on_motion` the tag is silent while it lies still.
    """

    gyro_axes: Axes = (True, True, True)
    acc_axes: Axes = (True, True, True)
    mag: bool = True
    wake_on_motion: bool = False
    range: int = 2


@frozen
class Cc2650Barometer:
    """One notification of the BMP280, compensated by the tag: degrees Celsius in steps of 0.01, Pa in steps of 1."""

    temperature: float
    pressure: float


@frozen
class Cc2650BarometerConfig:
    """What AA42 holds: whether the barometer measures."""

    on: bool


@frozen
class Cc2650Keys:
    """What is pressed: the left (user) and right (power) button; `reed` is closed by a magnet."""

    left: bool = False
    right: bool = False
    reed: bool = False

    @property
    def down(self) -> tuple[str, ...]:
        """The names of those that are pressed."""
        return tuple(name for name in ("left", "right", "reed") if getattr(self, name))


_MOVEMENT = Record(
    Movement,
    Struct("gyro" / Fields("<3h"), "acc" / Fields("<3h"), "mag" / Fields("<3h"), Terminated),
)

_MOVEMENT_CONFIG = Struct(
    "bits"
    / ByteSwapped(
        BitStruct(
            "reserved" / BitsInteger(6),
            "range" / BitsInteger(2),
            "wake_on_motion" / Flag,
            "mag" / Flag,
            "acc_x" / Flag,
            "acc_y" / Flag,
            "acc_z" / Flag,
            "gyro_x" / Flag,
            "gyro_y" / Flag,
            "gyro_z" / Flag,
        )
    ),
    Terminated,
)
"""From the high bit of the second byte down to the low bit of the first."""

_BAROMETER = Struct("temperature" / Int24sl, "pressure" / Int24ul, Terminated)

_BAROMETER_CONFIG = Record(Cc2650BarometerConfig, Struct("on" / Switch(), Terminated))

_KEYS = Struct(
    "bits"
    / BitStruct(
        "reserved" / BitsInteger(5),
        "reed" / Flag,
        "right" / Flag,
        "left" / Flag,
    ),
    Terminated,
)


def parse_movement(data: bytes) -> Movement:
    """AA81, 18 bytes. WireError when `data` is not that."""
    movement: Movement = parse_whole(_MOVEMENT, bytes(data))
    return movement


def build_movement(movement: Movement) -> bytes:
    """The bytes of `movement`. ValueError when a count is not an i16."""
    return build_whole(_MOVEMENT, movement)


def parse_movement_config(data: bytes) -> MovementConfig:
    """AA82, 2 bytes. WireError when `data` is not that, or bits are set that mean nothing."""
    bits: Any = parse_whole(_MOVEMENT_CONFIG, bytes(data)).bits
    if bits.reserved:
        raise malformed("bits above the range are set; is the byte order wrong?")
    return MovementConfig(
        gyro_axes=(bits.gyro_x, bits.gyro_y, bits.gyro_z),
        acc_axes=(bits.acc_x, bits.acc_y, bits.acc_z),
        mag=bits.mag,
        wake_on_motion=bits.wake_on_motion,
        range=2 << bits.range,
    )


def build_movement_config(config: MovementConfig) -> bytes:
    """The bytes of `config`. ValueError when the range is none of 2, 4, 8 and 16."""
    if config.range not in (2, 4, 8, 16):
        raise ValueError(f"a range of {config.range} g, there are 2, 4, 8 and 16")
    gyro_x, gyro_y, gyro_z = config.gyro_axes
    acc_x, acc_y, acc_z = config.acc_axes
    bits = {
        "reserved": 0,
        "range": config.range.bit_length() - 2,
        "wake_on_motion": config.wake_on_motion,
        "mag": config.mag,
        "acc_x": acc_x,
        "acc_y": acc_y,
        "acc_z": acc_z,
        "gyro_x": gyro_x,
        "gyro_y": gyro_y,
        "gyro_z": gyro_z,
    }
    return build_whole(_MOVEMENT_CONFIG, {"bits": bits})


def parse_barometer(data: bytes) -> Cc2650Barometer:
    """AA41, 6 bytes. WireError when `data` is not that."""
    parsed = parse_whole(_BAROMETER, bytes(data))
    return Cc2650Barometer(parsed.temperature / 100, float(parsed.pressure))


def build_barometer(barometer: Cc2650Barometer) -> bytes:
    """The bytes nearest to `barometer`. ValueError when it is not finite or does not fit in 24 bits."""
    if not (isfinite(barometer.temperature) and isfinite(barometer.pressure)):
        raise ValueError(f"{barometer} is not finite")
    counts = {"temperature": round(barometer.temperature * 100), "pressure": round(barometer.pressure)}
    return build_whole(_BAROMETER, counts)


def parse_barometer_config(data: bytes) -> Cc2650BarometerConfig:
    """AA42, 1 byte, 0 or 1. WireError when `data` is not that."""
    config: Cc2650BarometerConfig = parse_whole(_BAROMETER_CONFIG, bytes(data))
    return config


def build_barometer_config(config: Cc2650BarometerConfig) -> bytes:
    """The byte of `config`."""
    return build_whole(_BAROMETER_CONFIG, config)


def parse_keys(data: bytes) -> Cc2650Keys:
    """FFE1 of a CC2650, 1 byte. WireError when `data` is not that."""
    bits: Any = parse_whole(_KEYS, bytes(data)).bits
    if bits.reserved:
        raise malformed("bits above the reed switch are set")
    return Cc2650Keys(left=bits.left, right=bits.right, reed=bits.reed)


def build_keys(keys: Cc2650Keys) -> bytes:
    """The byte of `keys`."""
    bits = {"reserved": 0, "reed": keys.reed, "right": keys.right, "left": keys.left}
    return build_whole(_KEYS, {"bits": bits})
