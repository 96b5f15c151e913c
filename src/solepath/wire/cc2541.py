"""CC2541 SensorTag (protocol/cc2541.md): each sensor has a characteristic of its own; raw counts, raw sensor axes."""

from __future__ import annotations

from typing import Any

from attrs import frozen
from construct import BitsInteger, BitStruct, Flag, Int8ul, Struct, Terminated

from .fields import Fields, Record, Switch, build_whole, malformed, parse_whole

Counts = tuple[int, int, int]
Axes = tuple[bool, bool, bool]


@frozen
class Accelerometer:
    """One notification of the KXTJ9: x, y, z in i8 counts. What a count is worth depends on range and firmware."""

    acc: Counts


@frozen
class AccelerometerConfig:
    """What AA12 holds: 0 off, 1 on (2 g where ranges are known), 2 4 g, 3 8 g."""

    code: int


@frozen
class Gyroscope:
    """One notification of the IMU-3000: x, y, z in i16 counts."""

    gyro: Counts


@frozen
class GyroscopeConfig:
    """Which axes (x, y, z) are on."""

    axes: Axes


@frozen
class Magnetometer:
    """One notification of the MAG3110: x, y, z in i16 counts."""

    mag: Counts


@frozen
class MagnetometerConfig:
    """What AA32 holds: whether the magnetometer measures."""

    on: bool


@frozen
class Cc2541Barometer:
    """One notification of the T5400, uncompensated: `temperature` i16, `pressure` u16. Needs BarometerCalibration."""

    temperature: int
    pressure: int


@frozen
class Cc2541BarometerConfig:
    """What AA42 holds: 0 off, 1 on, 2 fetch the coefficients so that AA43 can be read."""

    code: int


@frozen
class BarometerCalibration:
    """The T5400's coefficients, read from AA43 after writing 2 to AA42: c1 to c4 unsigned, c5 to c8 signed."""

    c1: int
    c2: int
    c3: int
    c4: int
    c5: int
    c6: int
    c7: int
    c8: int

    def celsius(self, raw: Cc2541Barometer) -> float:
        """Temperature in degrees Celsius: c1 t / 2^24 + c2 / 2^10."""
        return self.c1 * raw.temperature / 2**24 + self.c2 / 2**10

    def pascal(self, raw: Cc2541Barometer) -> float:
        """Air pressure in Pa: (S p + O) / 2^14, where S = c3 + c4 t / 2^17 + c5 t^2 / 2^34 and
        O = c6 2^14 + c7 t / 2^3 + c8 t^2 / 2^19."""
        t = raw.temperature
        sensitivity = self.c3 + self.c4 * t / 2**17 + self.c5 * t * t / 2**34
        offset = self.c6 * 2**14 + self.c7 * t / 2**3 + self.c8 * t * t / 2**19
        return (sensitivity * raw.pressure + offset) / 2**14


@frozen
class Cc2541Keys:
    """What is pressed. The bits are not those of the CC2650: here the right key is bit 0."""

    left: bool = False
    right: bool = False
    side: bool = False

    @property
    def down(self) -> tuple[str, ...]:
        """The names of those that are pressed."""
        return tuple(name for name in ("left", "right", "side") if getattr(self, name))


_ACCELEROMETER = Record(Accelerometer, Struct("acc" / Fields("<3b"), Terminated))
_ACCELEROMETER_CONFIG = Record(AccelerometerConfig, Struct("code" / Int8ul, Terminated))
_GYROSCOPE = Record(Gyroscope, Struct("gyro" / Fields("<3h"), Terminated))
_GYROSCOPE_CONFIG = Struct(
    "bits" / BitStruct("reserved" / BitsInteger(5), "z" / Flag, "y" / Flag, "x" / Flag),
    Terminated,
)
_MAGNETOMETER = Record(Magnetometer, Struct("mag" / Fields("<3h"), Terminated))
_MAGNETOMETER_CONFIG = Record(MagnetometerConfig, Struct("on" / Switch(), Terminated))
_BAROMETER = Struct("raw" / Fields("<hH", Cc2541Barometer), Terminated)
_BAROMETER_CONFIG = Record(Cc2541BarometerConfig, Struct("code" / Int8ul, Terminated))
_BAROMETER_CALIBRATION = Struct("coefficients" / Fields("<4H4h", BarometerCalibration), Terminated)
_KEYS = Struct(
    "bits" / BitStruct("reserved" / BitsInteger(5), "side" / Flag, "left" / Flag, "right" / Flag),
    Terminated,
)


def parse_accelerometer(data: bytes) -> Accelerometer:
    """AA11, 3 bytes. WireError when `data` is not that."""
    accelerometer: Accelerometer = parse_whole(_ACCELEROMETER, bytes(data))
    return accelerometer


def build_accelerometer(accelerometer: Accelerometer) -> bytes:
    """The bytes of `accelerometer`. ValueError when a count is not an i8."""
    return build_whole(_ACCELEROMETER, accelerometer)


def parse_accelerometer_config(data: bytes) -> AccelerometerConfig:
    """AA12, 1 byte, 0 to 3. WireError when `data` is not that."""
    config: AccelerometerConfig = parse_whole(_ACCELEROMETER_CONFIG, bytes(data))
    if config.code > 3:
        raise malformed(f"accelerometer configuration {config.code}")
    return config


def build_accelerometer_config(config: AccelerometerConfig) -> bytes:
    """The byte of `config`. ValueError unless it is 0 to 3."""
    if not 0 <= config.code <= 3:
        raise ValueError(f"accelerometer configuration {config.code}")
    return build_whole(_ACCELEROMETER_CONFIG, config)


def parse_gyroscope(data: bytes) -> Gyroscope:
    """AA51, 6 bytes. WireError when `data` is not that."""
    gyroscope: Gyroscope = parse_whole(_GYROSCOPE, bytes(data))
    return gyroscope


def build_gyroscope(gyroscope: Gyroscope) -> bytes:
    """The bytes of `gyroscope`. ValueError when a count is not an i16."""
    return build_whole(_GYROSCOPE, gyroscope)


def parse_gyroscope_config(data: bytes) -> GyroscopeConfig:
    """AA52, 1 byte, an axis mask. WireError when `data` is not that."""
    bits: Any = parse_whole(_GYROSCOPE_CONFIG, bytes(data)).bits
    if bits.reserved:
        raise malformed("bits above the three axes are set")
    return GyroscopeConfig((bits.x, bits.y, bits.z))


def build_gyroscope_config(config: GyroscopeConfig) -> bytes:
    """The byte of `config`."""
    x, y, z = config.axes
    return build_whole(_GYROSCOPE_CONFIG, {"bits": {"reserved": 0, "x": x, "y": y, "z": z}})


def parse_magnetometer(data: bytes) -> Magnetometer:
    """AA31, 6 bytes. WireError when `data` is not that."""
    magnetometer: Magnetometer = parse_whole(_MAGNETOMETER, bytes(data))
    return magnetometer


def build_magnetometer(magnetometer: Magnetometer) -> bytes:
    """The bytes of `magnetometer`. ValueError when a count is not an i16."""
    return build_whole(_MAGNETOMETER, magnetometer)


def parse_magnetometer_config(data: bytes) -> MagnetometerConfig:
    """AA32, 1 byte, 0 or 1. WireError when `data` is not that."""
    config: MagnetometerConfig = parse_whole(_MAGNETOMETER_CONFIG, bytes(data))
    return config


def build_magnetometer_config(config: MagnetometerConfig) -> bytes:
    """The byte of `config`."""
    return build_whole(_MAGNETOMETER_CONFIG, config)


def parse_barometer(data: bytes) -> Cc2541Barometer:
    """AA41, 4 bytes. WireError when `data` is not that."""
    barometer: Cc2541Barometer = parse_whole(_BAROMETER, bytes(data)).raw
    return barometer


def build_barometer(barometer: Cc2541Barometer) -> bytes:
    """The bytes of `barometer`. ValueError when a value does not fit."""
    return build_whole(_BAROMETER, {"raw": barometer})


def parse_barometer_config(data: bytes) -> Cc2541BarometerConfig:
    """AA42, 1 byte, 0 to 2. WireError when `data` is not that."""
    config: Cc2541BarometerConfig = parse_whole(_BAROMETER_CONFIG, bytes(data))
    if config.code > 2:
        raise malformed(f"barometer configuration {config.code}")
    return config


def build_barometer_config(config: Cc2541BarometerConfig) -> bytes:
    """The byte of `config`. ValueError unless it is 0 to 2."""
    if not 0 <= config.code <= 2:
        raise ValueError(f"barometer configuration {config.code}")
    return build_whole(_BAROMETER_CONFIG, config)


def parse_barometer_calibration(data: bytes) -> BarometerCalibration:
    """AA43, 16 bytes. WireError when `data` is not that."""
    calibration: BarometerCalibration = parse_whole(_BAROMETER_CALIBRATION, bytes(data)).coefficients
    return calibration


def build_barometer_calibration(calibration: BarometerCalibration) -> bytes:
    """The bytes of `calibration`. ValueError when a coefficient does not fit."""
    return build_whole(_BAROMETER_CALIBRATION, {"coefficients": calibration})


def parse_keys(data: bytes) -> Cc2541Keys:
    """FFE1 of a CC2541, 1 byte. WireError when `data` is not that."""
    bits: Any = parse_whole(_KEYS, bytes(data)).bits
    if bits.reserved:
        raise malformed("bits above the side key are set")
    return Cc2541Keys(left=bits.left, right=bits.right, side=bits.side)


def build_keys(keys: Cc2541Keys) -> bytes:
    """The byte of `keys`."""
    bits = {"reserved": 0, "side": keys.side, "left": keys.left, "right": keys.right}
    return build_whole(_KEYS, {"bits": bits})
