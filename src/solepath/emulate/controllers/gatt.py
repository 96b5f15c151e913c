"""A device's attributes as bumble serves them, and what it advertises of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

from bumble import att, core, data_types
from bumble.core import AdvertisingData
from bumble.device import Connection, Device
from bumble.gatt import (
    GATT_CHARACTERISTIC_USER_DESCRIPTION_DESCRIPTOR,
    Characteristic,
    CharacteristicValue,
    Descriptor,
    Service,
)
from bumble.gatt_server import Server
from bumble.profiles.gap import GenericAccessService

from ..devices import attributes as emulated
from ..devices.peripheral import Peripheral

_STANDARD = ("0000180a", "0000180f")
"""Services that the Bluetooth SIG describes: their characteristics need no description."""


class Answers(Protocol):
    """Who answers the requests to a channel. The channel comes first, since it is bound when the table is made."""

    async def read(self, channel: str, link: Connection) -> bytes:
        """The value, or att.ATT_Error."""

    async def write(self, channel: str, link: Connection, value: bytes) -> None:
        """Obeys, or att.ATT_Error."""

    def subscribe(self, channel: str, link: Connection, notify: bool, indicate: bool) -> None:
        """The CCCD of the channel was written."""


class AttributeServer(Server):
    """bumble's, but that it leaves the program's logging alone.

    bumble says with `logging.debug` that there is no (more) attribute of some type, which happens in every discovery,
    and that function sets up the root logger of a program that has not done so itself.
    """

    def on_att_read_by_type_request(self, bearer: att.Bearer, request: att.ATT_Read_By_Type_Request) -> None:
        first, last = request.starting_handle, request.ending_handle
        found = any(each.type == request.attribute_type and first <= each.handle <= last for each in self.attributes)
        if found or not 0 < first <= last:
            super().on_att_read_by_type_request(bearer, request)
            return
        refusal = att.ATT_Error_Response(
            request_opcode_in_error=request.op_code,
            attribute_handle_in_error=first,
            error_code=att.ATT_ATTRIBUTE_NOT_FOUND_ERROR,
        )
        self.send_response(bearer, refusal)


def short_or_long(uuid: str) -> core.UUID:
    """16 bits where the UUID is one of the Bluetooth SIG's."""
    if emulated.is_short(uuid):
        return core.UUID.from_16_bits(int(uuid[4:8], 16))
    return core.UUID(uuid)


def advertisement(name: str, services: Sequence[str]) -> bytes:
    """31 bytes at most: services, name, and flags if there is room (they may be left out: Core supplement, A 1.3)."""
    uuids = [short_or_long(uuid) for uuid in services]
    short = [uuid for uuid in uuids if len(uuid.to_pdu_bytes()) == 2]
    long = [uuid for uuid in uuids if len(uuid.to_pdu_bytes()) == 16]
    said: list[core.DataType] = []
    if short:
        said.append(data_types.IncompleteListOf16BitServiceUUIDs(short))
    if long:
        said.append(data_types.IncompleteListOf128BitServiceUUIDs(long))
    said.append(data_types.CompleteLocalName(name))
    flags = AdvertisingData.Flags.LE_GENERAL_DISCOVERABLE_MODE | AdvertisingData.Flags.BR_EDR_NOT_SUPPORTED
    full = bytes(AdvertisingData([data_types.Flags(flags), *said]))
    return full if len(full) <= emulated.ADVERTISEMENT else bytes(AdvertisingData(said))


def furnish(device: Device, said: Peripheral, answers: Answers) -> dict[str, Characteristic[bytes]]:
    """Gives the bumble device the attributes of `said`; returns them by channel."""
    served: dict[str, Characteristic[bytes]] = {}
    device.gatt_server = AttributeServer(device)
    device.add_service(GenericAccessService(said.name))
    for service in said.services:
        characteristics = []
        for each in service.characteristics:
            described = not service.uuid.startswith(_STANDARD)
            served[each.channel] = _characteristic(each, described, answers)
            characteristics.append(served[each.channel])
        device.add_service(Service(short_or_long(service.uuid), characteristics))
    return served


def _characteristic(said: emulated.Characteristic, described: bool, answers: Answers) -> Characteristic[bytes]:
    properties = Characteristic.Properties(0)
    for name in said.properties:
        properties |= Characteristic.Properties[name.upper().replace("-", "_")]
    description = Descriptor(
        GATT_CHARACTERISTIC_USER_DESCRIPTION_DESCRIPTOR, att.Attribute.READABLE, said.channel.encode()
    )
    served: Characteristic[bytes] = Characteristic(
        short_or_long(said.uuid),
        properties,
        att.Attribute.READABLE | att.Attribute.WRITEABLE,  # the device itself says what is not permitted
        CharacteristicValue(read=partial(answers.read, said.channel), write=partial(answers.write, said.channel)),
        [description] if described else [],
    )
    subscribed: Callable[[Connection, bool, bool], None] = partial(answers.subscribe, said.channel)
    served.on(Characteristic.EVENT_SUBSCRIPTION, subscribed)
    return served
