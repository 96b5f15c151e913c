"""Decoding of the attribute protocol in a log: UUIDs of the handles, and the values notified, read and written.

Source: Bluetooth Core, vol 3 part F, 3.4. In a phone's log the peer is the server; in the log of a device's own host
the host is the server. Services are not decoded, because the UUID of a characteristic identifies it."""

from __future__ import annotations

from collections import Counter
from enum import Enum, IntEnum
from typing import Any
from uuid import UUID

from attrs import define, field, frozen
from construct import Bytes, GreedyBytes, GreedyRange, Int8ul, Int16ul, Prefixed, Struct, Terminated, this

from ...wire.error import WireError
from ...wire.fields import LONGEST_VALUE, malformed, parse_whole


class AttOpcode(IntEnum):
    """First byte of a PDU (protocol data unit), as far as it is decoded here."""

    ERROR = 0x01
    MTU_REQUEST = 0x02
    MTU_RESPONSE = 0x03
    FIND_INFORMATION = 0x04
    INFORMATION = 0x05
    FIND_BY_VALUE = 0x06
    READ_BY_TYPE = 0x08
    VALUES_BY_TYPE = 0x09
    READ = 0x0A
    VALUE = 0x0B
    READ_BLOB = 0x0C
    BLOB = 0x0D
    READ_SEVERAL = 0x0E
    READ_BY_GROUP = 0x10
    WRITE = 0x12
    WRITTEN = 0x13
    PREPARE_WRITE = 0x16
    EXECUTE_WRITE = 0x18
    NOTIFICATION = 0x1B
    INDICATION = 0x1D
    CONFIRMATION = 0x1E
    READ_SEVERAL_VARIABLE = 0x20
    NOTIFICATIONS = 0x23
    WRITE_COMMAND = 0x52
    SIGNED_WRITE_COMMAND = 0xD2


REQUESTS = frozenset({
    AttOpcode.MTU_REQUEST, AttOpcode.FIND_INFORMATION, AttOpcode.FIND_BY_VALUE, AttOpcode.READ_BY_TYPE,
    AttOpcode.READ, AttOpcode.READ_BLOB, AttOpcode.READ_SEVERAL, AttOpcode.READ_BY_GROUP, AttOpcode.WRITE,
    AttOpcode.PREPARE_WRITE, AttOpcode.EXECUTE_WRITE, AttOpcode.READ_SEVERAL_VARIABLE,
})  # fmt: skip
"""PDUs of a client that the server answers; the client waits for the answer before its next request."""
FROM_CLIENT = REQUESTS | {AttOpcode.WRITE_COMMAND, AttOpcode.CONFIRMATION, AttOpcode.SIGNED_WRITE_COMMAND}
"""PDUs of a client: requests, and commands and confirmations, which are not answered."""

DECLARATION_TYPE = "00002803-0000-1000-8000-00805f9b34fb"
"""Type of an attribute that declares a characteristic."""
MOST_TYPES = 500
"""Largest number of attributes of a device whose types are kept; chosen by hand, ten times those of a SensorTag."""
SMALLEST_MTU = 23
"""Smallest MTU (size of the largest PDU), which holds until client and server agree on another, bytes."""

PDU = Struct("opcode" / Int8ul, "body" / GreedyBytes)
ERROR_RESPONSE = Struct("request" / Int8ul, "handle" / Int16ul, "code" / Int8ul, Terminated)
MTU = Struct("mtu" / Int16ul, Terminated)
HANDLE = Struct("handle" / Int16ul, Terminated)
HANDLE_VALUE = Struct("handle" / Int16ul, "value" / GreedyBytes)
BLOB_REQUEST = Struct("handle" / Int16ul, "offset" / Int16ul, Terminated)
TYPE_REQUEST = Struct("first" / Int16ul, "last" / Int16ul, "type" / GreedyBytes)
REQUEST_BODIES: dict[int, Any] = {
    AttOpcode.MTU_REQUEST: MTU,
    AttOpcode.READ_BY_TYPE: TYPE_REQUEST,
    AttOpcode.READ: HANDLE,
    AttOpcode.READ_BLOB: BLOB_REQUEST,
    AttOpcode.WRITE: HANDLE_VALUE,
}
"""Format of the bodies of the requests whose answers are used."""


INFORMATION = Struct(
    "format" / Int8ul,
    "entries"
    / GreedyRange(Struct("handle" / Int16ul, "type" / Bytes(lambda context: 2 if context._.format == 1 else 16))),
    Terminated,
)
TYPE_RESPONSE = Struct(
    "size" / Int8ul, "entries" / GreedyRange(Struct("handle" / Int16ul, "value" / Bytes(this._.size - 2))), Terminated
)
DECLARATION = Struct("properties" / Int8ul, "handle" / Int16ul, "type" / GreedyBytes)
SEVERAL_VALUES = Struct(
    "entries" / GreedyRange(Struct("handle" / Int16ul, "value" / Prefixed(Int16ul, GreedyBytes))), Terminated
)


class AttOperation(Enum):
    """Operation that transferred a value."""

    NOTIFIED = "notified"
    READ = "read"
    WRITTEN = "written"


@frozen
class AttValue:
    """One value of an attribute, and the operation that transferred it."""

    operation: AttOperation
    handle: int
    """Handle of the attribute, a number from 1."""
    value: bytes


def uuid_text(octets: bytes) -> str:
    """Return a UUID of 16 or 128 bits as complete text in lower case; WireError for another size."""
    if len(octets) == 2:
        return f"0000{octets[1]:02x}{octets[0]:02x}-0000-1000-8000-00805f9b34fb"
    if len(octets) != 16:
        raise malformed(f"a UUID of {len(octets)} bytes")
    return str(UUID(bytes=octets[::-1]))


@define
class Conversation:
    """The decoder of the PDUs between one client and one server on one connection."""

    types: dict[int, str]
    """Discovered UUIDs by handle, shared by all conversations with this server."""
    flaws: Counter[str]
    """Counts of PDUs that could not be decoded, by kind."""
    mtu: int = SMALLEST_MTU
    """Size of the largest PDU that client and server agreed on, bytes."""
    _request: tuple[int, Any] | None = None
    """Request that waits for its answer."""
    _partial_read: AttValue | None = None
    """First part of a value that is read in several requests."""
    _values: list[AttValue] = field(factory=list)

    def feed(self, data: bytes) -> list[AttValue]:
        """Return the values in one PDU of the client or the server."""
        self._values = []
        try:
            pdu = parse_whole(PDU, data)
            if pdu.opcode in FROM_CLIENT:
                self._handle_client_pdu(pdu.opcode, pdu.body)
            else:
                self._handle_server_pdu(pdu.opcode, pdu.body)
        except WireError:
            self.flaws["PDUs that are not of the attribute protocol"] += 1
        return self._values

    def finish(self) -> list[AttValue]:
        """Return the value of a read that the end of the connection left incomplete, as far as it was read."""
        self._values = []
        self._end_read()
        return self._values

    def _handle_client_pdu(self, opcode: int, body: bytes) -> None:
        if opcode == AttOpcode.WRITE_COMMAND:
            parsed = parse_whole(HANDLE_VALUE, body)
            self._values.append(AttValue(AttOperation.WRITTEN, parsed.handle, parsed.value))
        if opcode == AttOpcode.PREPARE_WRITE:
            self.flaws["long writes, which are passed over"] += 1
        if opcode not in REQUESTS:
            return
        request_body: Any = parse_whole(REQUEST_BODIES[opcode], body) if opcode in REQUEST_BODIES else None
        partial = self._partial_read
        continues_read = (
            opcode == AttOpcode.READ_BLOB
            and partial is not None
            and (request_body.handle, request_body.offset) == (partial.handle, len(partial.value))
        )
        if not continues_read:
            self._end_read()
        self._request = opcode, request_body

    def _handle_server_pdu(self, opcode: int, body: bytes) -> None:
        match opcode:
            case AttOpcode.NOTIFICATION | AttOpcode.INDICATION:
                parsed = parse_whole(HANDLE_VALUE, body)
                self._values.append(AttValue(AttOperation.NOTIFIED, parsed.handle, parsed.value))
                return
            case AttOpcode.NOTIFICATIONS:
                for parsed in parse_whole(SEVERAL_VALUES, body).entries:
                    self._values.append(AttValue(AttOperation.NOTIFIED, parsed.handle, parsed.value))
                return
        if self._request is None:
            return  # the request came before the log started
        request, request_body = self._request
        self._request = None
        match opcode, request:
            case AttOpcode.ERROR, _:
                if parse_whole(ERROR_RESPONSE, body).request == AttOpcode.WRITE:
                    self.flaws["writes that were rejected"] += 1
                self._end_read()
            case AttOpcode.MTU_RESPONSE, AttOpcode.MTU_REQUEST:
                self.mtu = max(SMALLEST_MTU, min(parse_whole(MTU, body).mtu, request_body.mtu))
            case AttOpcode.INFORMATION, AttOpcode.FIND_INFORMATION:
                for entry in parse_whole(INFORMATION, body).entries:
                    self._add_type(entry.handle, uuid_text(entry.type))
            case AttOpcode.VALUES_BY_TYPE, AttOpcode.READ_BY_TYPE:
                self._add_types(uuid_text(request_body.type), parse_whole(TYPE_RESPONSE, body))
            case AttOpcode.VALUE, AttOpcode.READ:
                self._add_read(request_body.handle, body)
            case AttOpcode.BLOB, AttOpcode.READ_BLOB if self._partial_read is not None:
                self._add_read(request_body.handle, self._partial_read.value + body, len(body))
            case AttOpcode.WRITTEN, AttOpcode.WRITE:
                self._values.append(AttValue(AttOperation.WRITTEN, request_body.handle, request_body.value))

    def _add_types(self, kind: str, answer: Any) -> None:
        """Add the types in an answer: those of the characteristics that it declares, or `kind` for its values."""
        for entry in answer.entries:
            if kind == DECLARATION_TYPE:
                declared = parse_whole(DECLARATION, entry.value)
                self._add_type(declared.handle, uuid_text(declared.type))
            else:
                self._add_type(entry.handle, kind)
                self._values.append(AttValue(AttOperation.READ, entry.handle, entry.value))

    def _add_type(self, handle: int, kind: str) -> None:
        if handle in self.types or len(self.types) < MOST_TYPES:
            self.types[handle] = kind
        else:
            self.flaws[f"types of more than {MOST_TYPES} attributes of a device, left out"] += 1

    def _add_read(self, handle: int, value: bytes, newest_size: int | None = None) -> None:
        """Store the value read so far, and end the read unless the last answer filled the MTU.

        `newest_size`: size of the last answer, bytes; None if it was the first."""
        self._partial_read = AttValue(AttOperation.READ, handle, value)
        size = len(value) if newest_size is None else newest_size
        if size < self.mtu - 1 or len(value) >= LONGEST_VALUE:
            self._end_read()

    def _end_read(self) -> None:
        if self._partial_read is not None:
            self._values.append(self._partial_read)
            self._partial_read = None
