"""Decoding of HCI packets to connections and attribute protocol PDUs (Bluetooth Core, vol 4 part E; vol 3 part A).

HCI has about two hundred commands and events. Only those are decoded that give the peer of a connection handle, or end
a connection. An L2CAP PDU is reassembled from the ACL packets that contain its pieces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from attrs import define, field, frozen
from construct import Bytes, GreedyBytes, Int8ul, Int16ul, Struct

from ...wire.error import WireError
from ...wire.fields import Fields, parse_whole
from .records import HciRecord, RecordKind

COMMAND = Struct("opcode" / Int16ul, "size" / Int8ul, "parameters" / GreedyBytes)
EVENT = Struct("code" / Int8ul, "size" / Int8ul, "parameters" / GreedyBytes)
LE_CONNECTION_COMPLETE = Struct(
    "subevent" / Int8ul,
    "status" / Int8ul,
    "handle" / Int16ul,
    "role" / Int8ul,
    "peer_type" / Int8ul,
    "peer" / Bytes(6),
    "rest" / GreedyBytes,
)
"""Format of the common start of the event's three versions; intervals and other addresses follow."""
DISCONNECTION_COMPLETE = Struct("status" / Int8ul, "handle" / Int16ul, "reason" / Int8ul)
READ_ADDRESS_COMPLETE = Struct("packets" / Int8ul, "opcode" / Int16ul, "status" / Int8ul, "address" / Bytes(6))
ACL_HEADER = Fields("<HH")
"""Format of the header of an ACL packet: handle (12 bits) with flags, length."""
L2CAP_HEADER = Fields("<HH")
"""Format of the header of an L2CAP PDU: length, channel."""

RESET, READ_BD_ADDR, LE_SET_RANDOM_ADDRESS = 0x0C03, 0x1009, 0x2005
DISCONNECTED, COMMAND_COMPLETE, LE_META = 0x05, 0x0E, 0x3E
CONNECTION_SUBEVENTS = {0x01: 19, 0x0A: 31, 0x29: 34}
"""Size of the parameters of LE Connection Complete, Enhanced v1 and Enhanced v2, bytes, by subevent code."""
HANDLE_MASK = 0x0FFF
"""Mask of a connection handle; the other bits are flags, or reserved."""
CONTINUING_FRAGMENT = 1
"""Packet boundary flag of an ACL packet that continues a PDU."""
ATT_CHANNEL = 4
"""L2CAP channel of the attribute protocol."""
MOST_CONNECTIONS = 100
"""Largest number of connections at once, chosen by hand; a damaged log may claim any number."""
FIRST_DYNAMIC_CHANNEL = 0x40
"""First of the L2CAP channels that are opened on request, for example for the enhanced attribute protocol (EATT)."""


@define
class HciConnection:
    """The record of one connection."""

    number: int
    """Index among the connections of the log, from 0."""
    adapter: int
    """Number of the host's Bluetooth adapter."""
    handle: int
    """Number by which the adapter names the connection."""
    address: str
    """Address of the peer; "" if the connection is older than the log."""
    pieces: dict[bool, bytearray] = field(factory=dict)
    """Incomplete L2CAP PDUs; the key is True for a PDU that the host sends."""

    @property
    def peer(self) -> str:
        """Name of the peer: its address, or the connection handle if the address is unknown."""
        return self.address or f"connection-{self.handle:#06x}" + (f"-hci{self.adapter}" if self.adapter else "")


@frozen
class ConnectionChange:
    """The start or the end of a connection."""

    t: int
    """Time of the change, us since 1970."""
    connection: HciConnection
    """Connection that started or ended."""
    connected: bool
    """True for the start."""


@frozen
class Pdu:
    """One PDU of the attribute protocol."""

    t: int
    """Time of the PDU, us since 1970."""
    connection: HciConnection
    sent: bool
    """True if the host sent it."""
    data: bytes
    own_address: str
    """Address of the host; "" if the log does not have it."""


def address_text(octets: bytes) -> str:
    """Return an address as text, which starts with the last of `octets` as sent, the most significant one."""
    return ":".join(f"{octet:02X}" for octet in reversed(octets))


@define
class Controller:
    """The decoder of a log's records, which knows the connections of all adapters.

    `flaws` counts records that could not be decoded."""

    flaws: Counter[str]
    _connections: dict[tuple[int, int], HciConnection] = field(factory=dict)
    """Connections by adapter and handle; the one that has been silent longest is first."""
    _public_addresses: dict[int, str] = field(factory=dict)
    _random_addresses: dict[int, str] = field(factory=dict)
    _connection_count: int = 0

    def feed(self, record: HciRecord) -> Iterator[ConnectionChange | Pdu]:
        """Yield the changes of connections and the attribute protocol PDUs of one record."""
        if record.kind is not RecordKind.OTHER and not record.whole:
            self.flaws["records that the logger cut short"] += 1
        try:
            match record.kind:
                case RecordKind.COMMAND if record.whole:
                    yield from self._handle_command(record)
                case RecordKind.EVENT if record.whole:
                    yield from self._handle_event(record)
                case RecordKind.ACL:
                    yield from self._handle_acl(record)
        except WireError:
            self.flaws["records that are not HCI"] += 1

    def _handle_command(self, record: HciRecord) -> Iterator[ConnectionChange]:
        command = parse_whole(COMMAND, record.data)
        if command.opcode == RESET:
            for key in [key for key in self._connections if key[0] == record.adapter]:
                yield ConnectionChange(record.t, self._connections.pop(key), False)
        elif command.opcode == LE_SET_RANDOM_ADDRESS and len(command.parameters) == 6:
            self._random_addresses[record.adapter] = address_text(command.parameters)

    def _handle_event(self, record: HciRecord) -> Iterator[ConnectionChange]:
        event = parse_whole(EVENT, record.data)
        parameters = event.parameters
        if event.size != len(parameters):
            self.flaws["records that are not HCI"] += 1
        elif event.code == LE_META and parameters and len(parameters) == CONNECTION_SUBEVENTS.get(parameters[0]):
            complete = parse_whole(LE_CONNECTION_COMPLETE, parameters)
            if complete.status == 0:
                handle = complete.handle & HANDLE_MASK
                yield from self._remove_connection(record.t, (record.adapter, handle))
                yield from self._make_room(record.t)
                connection = self._add_connection(record.adapter, handle, address_text(complete.peer))
                yield ConnectionChange(record.t, connection, True)
        elif event.code == DISCONNECTED:
            disconnection = parse_whole(DISCONNECTION_COMPLETE, parameters)
            if disconnection.status == 0:
                yield from self._remove_connection(record.t, (record.adapter, disconnection.handle & HANDLE_MASK))
        elif event.code == COMMAND_COMPLETE and len(parameters) == READ_ADDRESS_COMPLETE.sizeof():
            completed = parse_whole(READ_ADDRESS_COMPLETE, parameters)
            if completed.opcode == READ_BD_ADDR and completed.status == 0:
                self._public_addresses[record.adapter] = address_text(completed.address)

    def _add_connection(self, adapter: int, handle: int, address: str) -> HciConnection:
        connection = HciConnection(self._connection_count, adapter, handle, address)
        self._connections[adapter, handle] = connection
        self._connection_count += 1
        return connection

    def _make_room(self, t: int) -> Iterator[ConnectionChange]:
        """End the connection that has been silent longest if there are MOST_CONNECTIONS."""
        if len(self._connections) >= MOST_CONNECTIONS:
            self.flaws[f"connections beyond {MOST_CONNECTIONS}, each of which ended the longest silent one"] += 1
            yield from self._remove_connection(t, next(iter(self._connections)))

    def _remove_connection(self, t: int, key: tuple[int, int]) -> Iterator[ConnectionChange]:
        connection = self._connections.pop(key, None)
        if connection is not None:
            yield ConnectionChange(t, connection, False)

    def _handle_acl(self, record: HciRecord) -> Iterator[ConnectionChange | Pdu]:
        if len(record.data) < 4:
            self.flaws["records that are not HCI"] += 1
            return
        handle_and_flags, size = ACL_HEADER.parse(record.data)
        handle, boundary, body = handle_and_flags & HANDLE_MASK, handle_and_flags >> 12 & 3, record.data[4:]
        connection = self._connections.pop((record.adapter, handle), None)
        if connection is None:
            yield from self._make_room(record.t)
            connection = self._add_connection(record.adapter, handle, "")
        self._connections[record.adapter, handle] = connection  # as the newest
        if len(body) != size:
            if record.whole:
                self.flaws["records that are not HCI"] += 1
            self._discard_pieces(connection, record.sent)
            return
        if boundary != CONTINUING_FRAGMENT:
            self._discard_pieces(connection, record.sent)
            connection.pieces[record.sent] = bytearray()
        pieces = connection.pieces.get(record.sent)
        if pieces is None:
            self.flaws["pieces of packets whose beginning is missing"] += 1
            return
        pieces += body
        if len(pieces) < 4:
            return
        size, channel = L2CAP_HEADER.parse(bytes(pieces[:4]))
        if len(pieces) > 4 + size:
            self._discard_pieces(connection, record.sent)
        elif len(pieces) == 4 + size:
            del connection.pieces[record.sent]
            if channel == ATT_CHANNEL:
                yield Pdu(record.t, connection, record.sent, bytes(pieces[4:]), self.get_own_address(record.adapter))
            elif channel >= FIRST_DYNAMIC_CHANNEL and connection.address:
                self.flaws["packets of channels that are not followed (EATT perhaps)"] += 1

    def _discard_pieces(self, connection: HciConnection, sent: bool) -> None:
        if connection.pieces.pop(sent, None) is not None:
            self.flaws["packets of which a piece is missing"] += 1

    def get_own_address(self, adapter: int) -> str:
        """Return the address that the adapter shows to peers; "" if it is unknown."""
        return self._random_addresses.get(adapter) or self._public_addresses.get(adapter, "")

    def list_connections(self) -> list[HciConnection]:
        """Return the connections that have not ended."""
        return list(self._connections.values())
