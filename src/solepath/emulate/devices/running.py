"""An emulated sensor of the Bluetooth Running Speed and Cadence Service: protocol/running.md from the sensor's side."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, inf

from attrs import Factory, define, evolve

from ...link.profile import FIRMWARE, standard_uuid
from ...wire.error import WireError
from ...wire.running import (
    DISTANCE_UNIT,
    RscFeature,
    RscMeasurement,
    RscOperation,
    RscRequest,
    RscResponse,
    RscResult,
    build_feature,
    build_location,
    build_measurement,
    build_response,
    parse_request,
)
from .attributes import NOTIFY, READ, AttCode, AttError, Characteristic, Service, device_information, information
from .peripheral import Peripheral, Placement
from .running_meter import RunningSource

SERVICE = standard_uuid(0x1814)
FEATURE = RscFeature(stride_length=True, distance=True, running=True)
TOP_OF_SHOE = 1
"""Location of the emulated sensor."""
INTERVAL = 1.0
"""Time between two measurements, s."""
_SERVICES = (
    Service(
        SERVICE,
        (
            Characteristic(standard_uuid(0x2A53), "rsc/measurement", NOTIFY),
            Characteristic(standard_uuid(0x2A54), "rsc/feature", READ),
            Characteristic(standard_uuid(0x2A5D), "rsc/location", READ),
            Characteristic(standard_uuid(0x2A55), "rsc/control", frozenset({"write", "indicate"})),
        ),
    ),
    Service(
        FIRMWARE.service,
        (*information("manufacturer", "model"), Characteristic(FIRMWARE.characteristic, FIRMWARE.name, READ)),
    ),
)


@define(eq=False)
class _Responses:
    """A ValueSource of the responses of the control point, each sent as soon as it is there."""

    sent: list[tuple[float, bytes]] = Factory(list)

    def first_number_from(self, t: float) -> int:
        return sum([due < t for due, _ in self.sent])  # whole numbers

    def due(self, number: int) -> float:
        return self.sent[number][0] if number < len(self.sent) else inf

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (self.sent[number][1],)


class RunningPeripheral(Peripheral):
    """A sensor that serves what `source` measures, once a second while a host is subscribed.

    `distance_offset` is what is added to the distance of the source, m, after a host has set the distance."""

    def __init__(self, source: RunningSource, placement: Placement, name: str = "solepath RSC") -> None:
        super().__init__(placement, name, _SERVICES, (SERVICE,))
        self.source = source
        self.distance_offset = 0.0
        self._responses = _Responses()
        self._device_information = device_information("1.0", manufacturer="solepath", model="emulated RSC sensor")

    def walk_from(self, started_at: float) -> None:
        self.source.restart()
        self.distance_offset = 0.0
        super().walk_from(started_at)

    def measure(self, t: float) -> RscMeasurement:
        """Return the measurement at `t` s of the walk, with the distance that the host knows."""
        measurement = self.source.measure(t)
        distance = max(0.0, (measurement.distance or 0.0) + self.distance_offset)
        return evolve(measurement, distance=distance)

    def start(self, t: float) -> None:
        self.flow("rsc/measurement", self, t)
        self.flow("rsc/control", self._responses, t)

    def stop(self) -> None:
        self._responses.sent.clear()

    def value(self, channel: str, t: float) -> bytes:
        match channel:
            case "rsc/feature":
                return build_feature(FEATURE)
            case "rsc/location":
                return build_location(TOP_OF_SHOE)
        return self._device_information[channel]

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        if not self.is_subscribed(channel):
            raise AttError(AttCode.NOT_SUBSCRIBED)
        try:
            request = parse_request(value)
        except WireError:
            operation, result = (value[0] if value else 0), RscResult.INVALID
        else:
            operation, result = request.operation, self._apply(request, t)
        self._responses.sent.append((t, build_response(RscResponse(operation, result))))

    def _apply(self, request: RscRequest, t: float) -> RscResult:
        if request.operation != RscOperation.SET_DISTANCE or request.value is None:
            return RscResult.NOT_SUPPORTED
        self.distance_offset += request.value / DISTANCE_UNIT - (self.measure(t).distance or 0.0)
        return RscResult.SUCCESS

    # the ValueSource of the measurements

    def first_number_from(self, t: float) -> int:
        return max(0, ceil(t / INTERVAL))

    def due(self, number: int) -> float:
        return number * INTERVAL

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        return (build_measurement(self.measure(self.due(number))),)
