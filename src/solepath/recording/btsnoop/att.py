"""Decoding of the attribute protocol in a log: UUIDs of the handles, and the values notified, read and written.

Source: Bluetooth Core, vol 3 part F, 3.4. The peer is the server, as in the log of a phone. Services are not decoded,
because the UUID of a characteristic identifies it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from enum import IntEnum
from typing import Any

from attrs import define, frozen
from construct import Bytes, GreedyBytes, GreedyRange, Int8ul, Int16ul, Prefixed, Struct, Switch, this

from ...wire.error import WireError
from ...wire.fields import LONGEST_VALUE, malformed, parse_whole
from .devices import AttOperation, LoggedDevice


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
SMALLEST_MTU = 23
"""Smallest MTU (size of the largest PDU), which holds until client and server agree on another, bytes."""

HANDLE_VALUE = Struct("handle" / Int16ul, "value" / GreedyBytes)
MTU = Struct("mtu" / Int16ul)
TYPE = Bytes(lambda context: 2 if context._.format == 1 else 16)
BODIES: dict[int, Any] = {
    AttOpcode.ERROR: Struct("request" / Int8ul, "handle" / Int16ul, "code" / Int8ul),
    AttOpcode.MTU_REQUEST: MTU,
    AttOpcode.MTU_RESPONSE: MTU,
    AttOpcode.INFORMATION: Struct(
        "format" / Int8ul, "entries" / GreedyRange(Struct("handle" / Int16ul, "type" / TYPE))
    ),
    AttOpcode.READ_BY_TYPE: Struct("first" / Int16ul, "last" / Int16ul, "type" / GreedyBytes),
    AttOpcode.VALUES_BY_TYPE: Struct(
        "size" / Int8ul, "entries" / GreedyRange(Struct("handle" / Int16ul, "value" / Bytes(this._.size - 2)))
    ),
    AttOpcode.READ: Struct("handle" / Int16ul),
    AttOpcode.READ_BLOB: Struct("handle" / Int16ul, "offset" / Int16ul),
    AttOpcode.WRITE: HANDLE_VALUE,
    AttOpcode.WRITE_COMMAND: HANDLE_VALUE,
    AttOpcode.NOTIFICATION: HANDLE_VALUE,
    AttOpcode.INDICATION: HANDLE_VALUE,
    AttOpcode.NOTIFICATIONS: GreedyRange(Struct("handle" / Int16ul, "value" / Prefixed(Int16ul, GreedyBytes))),
}
"""Format of the bodies of the PDUs whose content is used."""
PDU = Struct("opcode" / Int8ul, "body" / Switch(this.opcode, BODIES, GreedyBytes))
DECLARATION = Struct("properties" / Int8ul, "handle" / Int16ul, "type" / GreedyBytes)


@frozen
class AttValue:
    """One value of an attribute, and the operation that transferred it."""

    operation: AttOperation
    handle: int
    """Handle of the attribute, a number from 1."""
    value: bytes


def is_from_client(data: bytes | bytearray) -> bool:
    """Return whether a PDU is one that a client sends."""
    return bool(data) and data[0] % 2 == 0


def uuid_text(octets: bytes) -> str:
    """Return a UUID of 16 or 128 bits as complete text in lower case; WireError for another size."""
    if len(octets) == 2:
        return f"0000{octets[1]:02x}{octets[0]:02x}-0000-1000-8000-00805f9b34fb"
    if len(octets) != 16:
        raise malformed(f"a UUID of {len(octets)} bytes")
    digits = octets[::-1].hex()
    return "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:]))


@define
class Conversation:
    """The decoder of the PDUs between the host and a device on one connection."""

    device: LoggedDevice
    flaws: Counter[str]
    """Counts of PDUs that could not be decoded, by kind."""
    mtu: int = SMALLEST_MTU
    """Size of the largest PDU that client and server agreed on, bytes."""
    _request: tuple[int, Any] = (0, None)
    """Opcode and body of the request that waits for its answer; 0 for none."""
    _read: AttValue | None = None
    """First part of a value that is read in several requests."""

    def feed(self, data: bytes) -> Iterator[AttValue]:
        """Yield the values in one PDU of the host or the device."""
        try:
            pdu = parse_whole(PDU, data)
            yield from (self._feed_request if is_from_client(data) else self._feed_answer)(pdu.opcode, pdu.body)
        except WireError:
            self.flaws["PDUs that are not of the attribute protocol"] += 1

    def end_read(self) -> Iterator[AttValue]:
        """Yield the value of a read that is incomplete, as far as it was read."""
        if self._read is not None:
            yield self._read
        self._read = None

    def _feed_request(self, opcode: int, body: Any) -> Iterator[AttValue]:
        if opcode == AttOpcode.WRITE_COMMAND:
            yield AttValue(AttOperation.WRITTEN, body.handle, body.value)
        if opcode == AttOpcode.PREPARE_WRITE:
            self.flaws["long writes, which are passed over"] += 1
        if opcode <= LAST_REQUEST and opcode != AttOpcode.CONFIRMATION:
            rest = (body.handle, body.offset) if opcode == AttOpcode.READ_BLOB else None
            if self._read is not None and rest != (self._read.handle, len(self._read.value)):
                yield from self.end_read()
            self._request = opcode, body

    def _feed_answer(self, opcode: int, body: Any) -> Iterator[AttValue]:
        if opcode in (AttOpcode.NOTIFICATION, AttOpcode.INDICATION, AttOpcode.NOTIFICATIONS):
            for entry in body if opcode == AttOpcode.NOTIFICATIONS else [body]:
                yield AttValue(AttOperation.NOTIFIED, entry.handle, entry.value)
            return
        (request, request_body), self._request = self._request, (0, None)
        match opcode, request:  # no request: it came before the log started
            case AttOpcode.ERROR, _:
                if request == body.request == AttOpcode.WRITE:
                    self.flaws["writes that were rejected"] += 1
                yield from self.end_read()
            case AttOpcode.MTU_RESPONSE, AttOpcode.MTU_REQUEST:
                self.mtu = max(SMALLEST_MTU, min(body.mtu, request_body.mtu))
            case AttOpcode.INFORMATION, AttOpcode.FIND_INFORMATION:
                for entry in body.entries:
                    self._add_type(entry.handle, entry.type)
            case AttOpcode.VALUES_BY_TYPE, AttOpcode.READ_BY_TYPE:
                for entry in body.entries:
                    if uuid_text(request_body.type) == DECLARATION_TYPE:
                        declared = parse_whole(DECLARATION, entry.value)
                        self._add_type(declared.handle, declared.type)
                    else:
                        self._add_type(entry.handle, request_body.type)
                        yield AttValue(AttOperation.READ, entry.handle, entry.value)
            case (AttOpcode.VALUE, AttOpcode.READ) | (AttOpcode.BLOB, AttOpcode.READ_BLOB):
                if request == AttOpcode.READ:
                    self._read = AttValue(AttOperation.READ, request_body.handle, b"")
                if self._read is not None:
                    self._read = AttValue(AttOperation.READ, request_body.handle, self._read.value + body)
                    # an answer that fills the MTU may be the first part of the value
                    if len(body) < self.mtu - 1 or len(self._read.value) >= LONGEST_VALUE:
                        yield from self.end_read()
            case AttOpcode.WRITTEN, AttOpcode.WRITE:
                yield AttValue(AttOperation.WRITTEN, request_body.handle, request_body.value)

    def _add_type(self, handle: int, octets: bytes) -> None:
        self.device.attribute(handle, self.flaws).uuid = uuid_text(octets)
