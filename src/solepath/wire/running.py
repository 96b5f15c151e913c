"""Values of the Bluetooth Running Speed and Cadence Service, 0x1814 (protocol/running.md)."""

from __future__ import annotations

from enum import IntEnum

from construct import GreedyRange, If, Int8ul, Int16ul, Int32ul, Struct, Terminated, this

from ..events import Rejection
from ..types.attrs import frozen
from .error import WireError
from .fields import Definition, build_whole, malformed, parse_whole, to_counts

SPEED_UNIT, LENGTH_UNIT, DISTANCE_UNIT = 256, 100, 10
"""Counts for one m/s of speed, and for one m of stride length and of distance."""
_LENGTH_FLAG, _DISTANCE_FLAG, _RUNNING_FLAG = 0x01, 0x02, 0x04

_MEASUREMENT = Struct(
    "flags" / Int8ul,
    "speed" / Int16ul,
    "cadence" / Int8ul,
    "stride_length" / If(this.flags & _LENGTH_FLAG, Int16ul),
    "distance" / If(this.flags & _DISTANCE_FLAG, Int32ul),
    Terminated,
)
_FEATURE = Struct("flags" / Int16ul, Terminated)
_LOCATION = Struct("location" / Int8ul, Terminated)
_REQUEST = Struct("operation" / Int8ul)
_SET_DISTANCE = Struct("operation" / Int8ul, "value" / Int32ul, Terminated)
_SET_LOCATION = Struct("operation" / Int8ul, "value" / Int8ul, Terminated)
_PLAIN = Struct("operation" / Int8ul, Terminated)
_WITH_VALUE: dict[int, Definition] = {1: _SET_DISTANCE, 3: _SET_LOCATION}
"""Definition of each request that has a value, by the number of its operation."""
_RESPONSE = Struct("code" / Int8ul, "operation" / Int8ul, "result" / Int8ul, "locations" / GreedyRange(Int8ul))
_RESPONSE_CODE = 0x10
MAX_LOCATIONS = 17
"""Largest number of locations in a response: the service names so many, 0 to 16."""


@frozen
class RscMeasurement:
    """One notification of 2A53: speed and cadence now."""

    speed: float
    """Speed, m/s, in steps of 1/256, at most 255.996."""
    cadence: int
    """Steps of both feet, 1/min, at most 255 (some sensors count one foot only: protocol/running.md)."""
    stride_length: float | None = None
    """Stride length, m, in steps of 0.01, at most 655.35; None if it is not sent."""
    distance: float | None = None
    """Distance since the sensor was reset, m, in steps of 0.1; None if it is not sent."""
    running: bool = False
    """True while running, False while walking; a sensor that cannot tell the two apart always sends False."""
    reserved: int = 0
    """Bits 3 to 7 of the flags as a number; a receiver ignores them."""


@frozen
class RscFeature:
    """The value of 2A54: what a sensor can do."""

    stride_length: bool
    """True if it sends the stride length."""
    distance: bool
    """True if it sends the total distance, which can then be set."""
    running: bool
    """True if it distinguishes walking and running."""
    calibration: bool = False
    """True if it can be calibrated by the host."""
    locations: bool = False
    """True if it may be worn at several places."""
    reserved: int = 0
    """Bits 5 to 15 as a number; a receiver ignores them."""


class RscOperation(IntEnum):
    """Operations of the control point 2A55."""

    SET_DISTANCE = 1
    START_CALIBRATION = 2
    SET_LOCATION = 3
    LIST_LOCATIONS = 4


class RscResult(IntEnum):
    """Results of the control point 2A55."""

    SUCCESS = 1
    NOT_SUPPORTED = 2
    INVALID = 3
    FAILED = 4


_RESULTS = frozenset(int(result) for result in RscResult)


@frozen
class RscRequest:
    """A request that a host writes to the control point."""

    operation: int
    """Number of the operation, an RscOperation or one that is not known."""
    value: int | None = None
    """New distance in 0.1 m for SET_DISTANCE, location for SET_LOCATION; None for other operations."""


@frozen
class RscResponse:
    """A response that a sensor indicates on the control point."""

    operation: int
    """Number of the operation that was requested."""
    result: int
    """Result of the operation, a number of RscResult."""
    locations: tuple[int, ...] = ()
    """Locations at which the sensor may be worn, for LIST_LOCATIONS."""


def parse_measurement(data: bytes) -> RscMeasurement:
    """Return the content of a measurement; WireError when the bytes do not fit."""
    raw = parse_whole(_MEASUREMENT, bytes(data))
    length, distance = raw.stride_length, raw.distance
    return RscMeasurement(
        speed=raw.speed / SPEED_UNIT,
        cadence=raw.cadence,
        stride_length=None if length is None else length / LENGTH_UNIT,
        distance=None if distance is None else distance / DISTANCE_UNIT,
        running=bool(raw.flags & _RUNNING_FLAG),
        reserved=raw.flags >> 3,
    )


def build_measurement(measurement: RscMeasurement) -> bytes:
    """Return the bytes of a measurement, whose numbers are rounded; ValueError when one does not fit the format."""
    length, distance = measurement.stride_length, measurement.distance
    flags = (_LENGTH_FLAG if length is not None else 0) | (_DISTANCE_FLAG if distance is not None else 0)
    flags |= (_RUNNING_FLAG if measurement.running else 0) | measurement.reserved << 3
    numbers = {
        "flags": flags,
        "speed": to_counts(measurement.speed, SPEED_UNIT),
        "cadence": measurement.cadence,
        "stride_length": None if length is None else to_counts(length, LENGTH_UNIT),
        "distance": None if distance is None else to_counts(distance, DISTANCE_UNIT),
    }
    return build_whole(_MEASUREMENT, numbers)


def parse_feature(data: bytes) -> RscFeature:
    """Return the content of a feature value; WireError when the bytes do not fit."""
    flags = parse_whole(_FEATURE, bytes(data)).flags
    length, distance, running, calibration, locations = (bool(flags >> bit & 1) for bit in range(5))
    return RscFeature(length, distance, running, calibration, locations, flags >> 5)


def build_feature(feature: RscFeature) -> bytes:
    """Return the bytes of a feature value; ValueError when the reserved bits do not fit."""
    bits = (feature.stride_length, feature.distance, feature.running, feature.calibration, feature.locations)
    flags = feature.reserved << 5
    for bit, is_set in enumerate(bits):
        flags |= int(is_set) << bit
    return build_whole(_FEATURE, {"flags": flags})


def parse_location(data: bytes) -> int:
    """Return the number of the place at which a sensor is worn (2A5D); WireError when it is not one byte."""
    location: int = parse_whole(_LOCATION, bytes(data)).location
    return location


def build_location(location: int) -> bytes:
    """Return the byte of a place; ValueError when it does not fit."""
    return build_whole(_LOCATION, {"location": location})


def parse_request(data: bytes) -> RscRequest:
    """Return a request to the control point; WireError when the bytes do not fit its operation."""
    data = bytes(data)
    operation = parse_whole(_REQUEST, data[:1]).operation
    parsed = parse_whole(_definition(operation), data)
    return RscRequest(operation, parsed.get("value"))


def build_request(request: RscRequest) -> bytes:
    """Return the bytes of a request; ValueError when the value does not fit the operation."""
    if (request.value is None) != (_definition(request.operation) is _PLAIN):
        raise ValueError(f"operation {request.operation} with the value {request.value}")
    return build_whole(_definition(request.operation), {"operation": request.operation, "value": request.value})


def _definition(operation: int) -> Definition:
    return _WITH_VALUE.get(operation, _PLAIN)


def parse_response(data: bytes) -> RscResponse:
    """Return a response of the control point; WireError when the bytes do not fit."""
    data = bytes(data)
    if len(data) > 3 + MAX_LOCATIONS:
        raise WireError(Rejection.OVERSIZED, f"{len(data) - 3} locations, at most {MAX_LOCATIONS}")
    raw = parse_whole(_RESPONSE, data)
    if raw.code != _RESPONSE_CODE:
        raise malformed(f"response code {raw.code:#04x}")
    if raw.result not in _RESULTS:
        raise malformed(f"result {raw.result}")
    return RscResponse(raw.operation, raw.result, tuple(raw.locations))


def build_response(response: RscResponse) -> bytes:
    """Return the bytes of a response; ValueError when it does not fit the format."""
    if response.result not in _RESULTS or len(response.locations) > MAX_LOCATIONS:
        raise ValueError(f"result {response.result}, {len(response.locations)} locations")
    numbers = {"code": _RESPONSE_CODE, "operation": response.operation, "result": response.result}
    return build_whole(_RESPONSE, numbers | {"locations": list(response.locations)})
