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
    """First byte of a PDU (protocol data unit), as far as its content is decoded here.

    The PDUs of a client are even, those of a server odd."""

    ERROR = 0x01
    MTU_REQUEST = 0x02
    MTU_RESPONSE = 0x03
    FIND_INFORMATION = 0x04
    INFORMATION = 0x05
    READ_BY_TYPE = 0x08
    VALUES_BY_TYPE = 0x09
    READ = 0x0A
    VALUE = 0x0B
    READ_BLOB = 0x0C
    BLOB = 0x0D
    WRITE = 0x12
    WRITTEN = 0x13
    PREPARE_WRITE = 0x16
    NOTIFICATION = 0x1B
    INDICATION = 0x1D
    CONFIRMATION = 0x1E
    NOTIFICATIONS = 0x23
    WRITE_COMMAND = 0x52


LAST_REQUEST = 0x20
"""Last PDU of a client that the server answers; the client waits for the answer before its next request."""
DECLARATION_TYPE = "00002803-0000-1000-8000-00805f9b34fb"
"""Type of an attribute that declares a characteristic."""
MOST_TYPES = 500
"""Largest number of attributes of a device whose types are kept; chosen by hand, ten times those of a SensorTag."""
SMALLEST_MTU = 23
"""Smallest MTU (size of the largest PDU), which holds until client and server agree on another, bytes."""

PDU = Struct("opcode" / Int8ul, "body" / GreedyBytes)
HANDLE_VALUE = Struct("handle" / Int16ul, "value" / GreedyBytes)
MTU = Struct("mtu" / Int16ul, Terminated)
BODIES: dict[int, Any] = {
    AttOpcode.ERROR: Struct("request" / Int8ul, "handle" / Int16ul, "code" / Int8ul, Terminated),
    AttOpcode.MTU_REQUEST: MTU,
    AttOpcode.MTU_RESPONSE: MTU,
    AttOpcode.INFORMATION: Struct(
        "format" / Int8ul,
        "entries"
        / GreedyRange(Struct("handle" / Int16ul, "type" / Bytes(lambda context: 2 if context._.format == 1 else 16))),
        Terminated,
    ),
    AttOpcode.READ_BY_TYPE: Struct("first" / Int16ul, "last" / Int16ul, "type" / GreedyBytes),
    AttOpcode.VALUES_BY_TYPE: Struct(
        "size" / Int8ul,
        "entries" / GreedyRange(Struct("handle" / Int16ul, "value" / Bytes(this._.size - 2))),
        Terminated,
    ),
    AttOpcode.READ: Struct("handle" / Int16ul, Terminated),
    AttOpcode.READ_BLOB: Struct("handle" / Int16ul, "offset" / Int16ul, Terminated),
    AttOpcode.WRITE: HANDLE_VALUE,
    AttOpcode.WRITE_COMMAND: HANDLE_VALUE,
    AttOpcode.NOTIFICATION: HANDLE_VALUE,
    AttOpcode.INDICATION: HANDLE_VALUE,
    AttOpcode.NOTIFICATIONS: Struct(
        "entries" / GreedyRange(Struct("handle" / Int16ul, "value" / Prefixed(Int16ul, GreedyBytes))), Terminated
    ),
}
"""Format of the bodies of the PDUs whose content is used."""
DECLARATION = Struct("properties" / Int8ul, "handle" / Int16ul, "type" / GreedyBytes)


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


def is_from_client(data: bytes) -> bool:
    """Return whether a PDU is one that a client sends."""
    return bool(data) and data[0] % 2 == 0


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
    _request: tuple[int, Any] = (0, None)
    """Opcode and body of the request that waits for its answer; 0 for none."""
    _partial_read: AttValue | None = None
    """First part of a value that is read in several requests."""
    _values: list[AttValue] = field(factory=list)

    def feed(self, data: bytes) -> list[AttValue]:
        """Return the values in one PDU of the client or the server."""
        self._values = []
        try:
            pdu = parse_whole(PDU, data)
            if is_from_client(data):
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

    def _add(self, operation: AttOperation, entry: Any) -> None:
        self._values.append(AttValue(operation, entry.handle, entry.value))

    def _handle_client_pdu(self, opcode: int, data: bytes) -> None:
        body: Any = parse_whole(BODIES[opcode], data) if opcode in BODIES else None
        if opcode == AttOpcode.WRITE_COMMAND:
            self._add(AttOperation.WRITTEN, body)
        if opcode == AttOpcode.PREPARE_WRITE:
            self.flaws["long writes, which are passed over"] += 1
        if opcode <= LAST_REQUEST and opcode != AttOpcode.CONFIRMATION:
            read = self._partial_read
            is_rest = read is not None and opcode == AttOpcode.READ_BLOB
            if read is None or not is_rest or (body.handle, body.offset) != (read.handle, len(read.value)):
                self._end_read()
            self._request = opcode, body

    def _handle_server_pdu(self, opcode: int, data: bytes) -> None:
        if opcode in (AttOpcode.NOTIFICATION, AttOpcode.INDICATION):
            self._add(AttOperation.NOTIFIED, parse_whole(BODIES[opcode], data))
            return
        if opcode == AttOpcode.NOTIFICATIONS:
            for entry in parse_whole(BODIES[opcode], data).entries:
                self._add(AttOperation.NOTIFIED, entry)
            return
        (request, request_body), self._request = self._request, (0, None)
        if not request:
            return  # the request came before the log started
        match opcode, request:
            case AttOpcode.ERROR, _:
                if parse_whole(BODIES[opcode], data).request == AttOpcode.WRITE:
                    self.flaws["writes that were rejected"] += 1
                self._end_read()
            case AttOpcode.MTU_RESPONSE, AttOpcode.MTU_REQUEST:
                self.mtu = max(SMALLEST_MTU, min(parse_whole(MTU, data).mtu, request_body.mtu))
            case AttOpcode.INFORMATION, AttOpcode.FIND_INFORMATION:
                for entry in parse_whole(BODIES[opcode], data).entries:
                    self._add_type(entry.handle, entry.type)
            case AttOpcode.VALUES_BY_TYPE, AttOpcode.READ_BY_TYPE:
                self._add_found(request_body.type, parse_whole(BODIES[opcode], data).entries)
            case (AttOpcode.VALUE, AttOpcode.READ) | (AttOpcode.BLOB, AttOpcode.READ_BLOB):
                self._add_read(request_body.handle, data, is_first=request == AttOpcode.READ)
            case AttOpcode.WRITTEN, AttOpcode.WRITE:
                self._add(AttOperation.WRITTEN, request_body)

    def _add_found(self, kind: bytes, entries: Any) -> None:
        """Add the types in an answer: those of the characteristics that it declares, or `kind` for its values."""
        is_declaration = uuid_text(kind) == DECLARATION_TYPE
        for entry in entries:
            if is_declaration:
                declared = parse_whole(DECLARATION, entry.value)
                self._add_type(declared.handle, declared.type)
            else:
                self._add_type(entry.handle, kind)
                self._add(AttOperation.READ, entry)

    def _add_type(self, handle: int, octets: bytes) -> None:
        kind = uuid_text(octets)
        if handle in self.types or len(self.types) < MOST_TYPES:
            self.types[handle] = kind
        else:
            self.flaws[f"types of more than {MOST_TYPES} attributes of a device, left out"] += 1

    def _add_read(self, handle: int, data: bytes, *, is_first: bool) -> None:
        """Store the value read so far, and end the read unless the answer filled the MTU."""
        read = self._partial_read
        if not is_first and read is None:
            return
        value = data if is_first or read is None else read.value + data
        self._partial_read = AttValue(AttOperation.READ, handle, value)
        if len(data) < self.mtu - 1 or len(value) >= LONGEST_VALUE:
            self._end_read()

    def _end_read(self) -> None:
        if self._partial_read is not None:
            self._values.append(self._partial_read)
            self._partial_read = None
