"""The GATT server on bumble, and the advertisement of a device."""

from __future__ import annotations

from collections.abc import Sequence

from bumble import att, core, data_types
from bumble.core import AdvertisingData
from bumble.gatt_server import Server

from ..devices import attributes as emulated


class AttributeServer(Server):
    """The GATT server of bumble, without its side effect on the program's logging.

    When a discovery finds no further attribute of a type, bumble calls `logging.debug`. That configures the root logger
    of a program that has not done so itself. This class answers such a request without bumble."""

    def on_att_read_by_type_request(self, bearer: att.Bearer, request: att.ATT_Read_By_Type_Request) -> None:
        """Answer a request for the attributes of a type, also one that finds none."""
        first, last = request.starting_handle, request.ending_handle
        found = any(each.type == request.attribute_type and first <= each.handle <= last for each in self.attributes)
        if found or not 0 < first <= last:
            super().on_att_read_by_type_request(bearer, request)
            return
        response = att.ATT_Error_Response(
            request_opcode_in_error=request.op_code,
            attribute_handle_in_error=first,
            error_code=att.ATT_ATTRIBUTE_NOT_FOUND_ERROR,
        )
        self.send_response(bearer, response)


def short_or_long(uuid: str) -> core.UUID:
    """Return the UUID, with 16 bits if the Bluetooth SIG assigned it."""
    if emulated.is_short(uuid):
        return core.UUID.from_16_bits(int(uuid[4:8], 16))
    return core.UUID(uuid)


def advertisement(name: str, services: Sequence[str]) -> bytes:
    """Return an advertisement of at most 31 bytes: services, name, and flags if they fit.

    Flags may be left out (Core supplement, A 1.3)."""
    uuids = [short_or_long(uuid) for uuid in services]
    short = [uuid for uuid in uuids if len(uuid.to_pdu_bytes()) == 2]
    long = [uuid for uuid in uuids if len(uuid.to_pdu_bytes()) == 16]
    entries: list[core.DataType] = []
    if short:
        entries.append(data_types.IncompleteListOf16BitServiceUUIDs(short))
    if long:
        entries.append(data_types.IncompleteListOf128BitServiceUUIDs(long))
    entries.append(data_types.CompleteLocalName(name))
    flags = AdvertisingData.Flags.LE_GENERAL_DISCOVERABLE_MODE | AdvertisingData.Flags.BR_EDR_NOT_SUPPORTED
    full = bytes(AdvertisingData([data_types.Flags(flags), *entries]))
    return full if len(full) <= emulated.MAX_ADVERTISEMENT_SIZE else bytes(AdvertisingData(entries))
