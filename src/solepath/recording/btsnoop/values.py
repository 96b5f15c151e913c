"""Reading of a log as values of attributes, each with its device: HCI packets, connections, L2CAP, attributes.

HCI has about two hundred commands and events (Bluetooth Core, vol 4 part E; vol 3 part A). Only those are decoded that
give the peer of a connection handle, or end a connection. An L2CAP PDU is reassembled from the ACL packets that contain
its pieces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from attrs import define, field, frozen
from construct import Bytes, GreedyBytes, Int8ul, Int16ul, Prefixed, Struct, Terminated

from ...wire.error import WireError
from ...wire.fields import Fields, malformed, parse_whole
from ..errors import RecordingError, Report
from .att import AttValue, Conversation, is_from_client
from .records import HciRecord, RecordKind, read_records

COMMAND = Struct("opcode" / Int16ul, "size" / Int8ul, "parameters" / GreedyBytes)
EVENT = Struct("code" / Int8ul, "parameters" / Prefixed(Int8ul, GreedyBytes), Terminated)
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
TWO_NUMBERS = Fields("<HH")
"""Header of an ACL packet (handle with flags, length), and of an L2CAP PDU (length, channel)."""
HEADER_SIZE = 4
"""Size of both headers, bytes."""

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
MOST_DEVICES = 500
"""Largest number of devices of a log that are examined, chosen by hand; they are those that the host connected to."""


@define(eq=False)
class HciConnection:
    """The record of one connection."""

    adapter: int
    """Number of the host's Bluetooth adapter."""
    handle: int
    """Number by which the adapter names the connection."""
    address: str
    """Address of the peer; "" if the connection is older than the log."""
    pieces: dict[bool, bytearray] = field(factory=dict)
    """Incomplete L2CAP PDUs; the key is True for a PDU that the host sends."""
    conversations: dict[bool, tuple[str, Conversation]] = field(factory=dict)
    """Address of the server and decoder of what it says; the key is True if the peer is the server."""

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
class LoggedValue:
    """One value of a log."""

    t: int
    """Time of the value, us since 1970."""
    connection: HciConnection
    device: str
    """Address of the server, or its HciConnection.peer if unknown."""
    att_value: AttValue


Item = LoggedValue | ConnectionChange


def address_text(octets: bytes) -> str:
    """Return an address as text, which starts with the last of `octets` as sent, the most significant one."""
    return octets[::-1].hex(":").upper()


@define
class ValueListener:
    """Reads all values of a log in order, with the starts and ends of the connections."""

    path: Path
    report: Report
    flaws: Counter[str] = field(factory=Counter)
    """Counts of the parts of the log that could not be used, by kind."""
    types: dict[str, dict[int, str]] = field(factory=dict)
    """Discovered UUIDs by device and attribute handle. They remain valid after a connection, because a host stores them
    and does not repeat the discovery."""
    _connections: dict[tuple[int, int], HciConnection] = field(factory=dict)
    """Connections by adapter and handle; the one that has been silent longest is first."""
    _addresses: dict[tuple[int, int], str] = field(factory=dict)
    """Addresses of the host, by adapter and the code of the command that set or asked for them."""

    def listen(self, progress: Callable[[int], None] | None = None) -> Iterator[Item]:
        """Yield the values and the changes of connections; RecordingError at damage, after all items before it."""
        t, failure = 0, None
        try:
            for record in read_records(self.path, report=self.report, flaws=self.flaws, progress=progress):
                t = record.t
                if record.kind is not RecordKind.OTHER and not record.whole:
                    self.flaws["records that the logger cut short"] += 1
                try:
                    yield from self._feed(record)
                except WireError:
                    self.flaws["records that are not HCI"] += 1
        except RecordingError as error:
            failure = error
        for connection in self._connections.values():
            yield from _finish(t, connection)
        if failure is not None:
            raise failure

    def _feed(self, record: HciRecord) -> Iterator[Item]:
        match record.kind:
            case RecordKind.COMMAND if record.whole:
                command = parse_whole(COMMAND, record.data)
                if command.opcode == RESET:
                    yield from self._end(record.t, [key for key in self._connections if key[0] == record.adapter])
                elif command.opcode == LE_SET_RANDOM_ADDRESS and len(command.parameters) == 6:
                    self._addresses[record.adapter, LE_SET_RANDOM_ADDRESS] = address_text(command.parameters)
            case RecordKind.EVENT if record.whole:
                yield from self._feed_event(record)
            case RecordKind.ACL:
                yield from self._feed_acl(record)

    def _feed_event(self, record: HciRecord) -> Iterator[Item]:
        event = parse_whole(EVENT, record.data)
        parameters, adapter = event.parameters, record.adapter
        if event.code == LE_META and parameters and len(parameters) == CONNECTION_SUBEVENTS.get(parameters[0]):
            complete = parse_whole(LE_CONNECTION_COMPLETE, parameters)
            if complete.status == 0:
                key = adapter, complete.handle & HANDLE_MASK
                yield from self._end(record.t, [key])
                yield from self._make_room(record.t)
                connection = self._connections[key] = HciConnection(*key, address_text(complete.peer))
                yield ConnectionChange(record.t, connection, True)
        elif event.code == DISCONNECTED:
            disconnection = parse_whole(DISCONNECTION_COMPLETE, parameters)
            if disconnection.status == 0:
                yield from self._end(record.t, [(adapter, disconnection.handle & HANDLE_MASK)])
        elif event.code == COMMAND_COMPLETE and len(parameters) == READ_ADDRESS_COMPLETE.sizeof():
            completed = parse_whole(READ_ADDRESS_COMPLETE, parameters)
            if completed.opcode == READ_BD_ADDR and completed.status == 0:
                self._addresses[adapter, READ_BD_ADDR] = address_text(completed.address)

    def _make_room(self, t: int) -> Iterator[Item]:
        """End the connection that has been silent longest if there are MOST_CONNECTIONS."""
        if len(self._connections) >= MOST_CONNECTIONS:
            self.flaws[f"connections beyond {MOST_CONNECTIONS}, each of which ended the longest silent one"] += 1
            yield from self._end(t, [next(iter(self._connections))])

    def _end(self, t: int, keys: Iterable[tuple[int, int]]) -> Iterator[Item]:
        """End the connections that there are of these, after the values that they left incomplete."""
        for key in keys:
            if (connection := self._connections.pop(key, None)) is not None:
                yield from _finish(t, connection)
                yield ConnectionChange(t, connection, False)

    def _feed_acl(self, record: HciRecord) -> Iterator[Item]:
        if len(record.data) < HEADER_SIZE:
            raise malformed("no header")
        flags, size = TWO_NUMBERS.parse(record.data)
        key, body, sent = (record.adapter, flags & HANDLE_MASK), record.data[HEADER_SIZE:], record.sent
        connection = self._connections.pop(key, None)
        if connection is None:
            yield from self._make_room(record.t)
            connection = HciConnection(*key, "")
        self._connections[key] = connection  # as the newest
        if len(body) != size:
            self._discard_pieces(connection, sent)
            if record.whole:
                raise malformed("another size than its header says")
            return
        if flags >> 12 & 3 != CONTINUING_FRAGMENT:
            self._discard_pieces(connection, sent)
            connection.pieces[sent] = bytearray()
        pieces = connection.pieces.get(sent)
        if pieces is None:
            self.flaws["pieces of packets whose beginning is missing"] += 1
            return
        pieces += body
        size, channel = (
            TWO_NUMBERS.parse(bytes(pieces[:HEADER_SIZE])) if len(pieces) >= HEADER_SIZE else (len(pieces), 0)
        )
        if len(pieces) > HEADER_SIZE + size:
            self._discard_pieces(connection, sent)
        elif len(pieces) == HEADER_SIZE + size:
            del connection.pieces[sent]
            if channel == ATT_CHANNEL:
                yield from self._feed_pdu(record, connection, bytes(pieces[HEADER_SIZE:]))
            elif channel >= FIRST_DYNAMIC_CHANNEL and connection.address:
                self.flaws["packets of channels that are not followed (EATT perhaps)"] += 1

    def _discard_pieces(self, connection: HciConnection, sent: bool) -> None:
        if connection.pieces.pop(sent, None) is not None:
            self.flaws["packets of which a piece is missing"] += 1

    def _feed_pdu(self, record: HciRecord, connection: HciConnection, data: bytes) -> Iterator[LoggedValue]:
        # the peer is the server if the host sends a PDU of a client, or the peer a PDU of a server
        peer_is_server = record.sent == is_from_client(data)
        if peer_is_server not in connection.conversations:
            own = (self._addresses.get((record.adapter, code)) for code in (LE_SET_RANDOM_ADDRESS, READ_BD_ADDR))
            device = connection.peer if peer_is_server else next(filter(None, own), "")
            if device not in self.types and len(self.types) >= MOST_DEVICES:
                self.flaws[f"packets of more than {MOST_DEVICES} devices, left out"] += 1
                return
            types = self.types.setdefault(device, {})
            connection.conversations[peer_is_server] = device, Conversation(types, self.flaws)
        device, conversation = connection.conversations[peer_is_server]
        yield from [LoggedValue(record.t, connection, device, value) for value in conversation.feed(data)]


def _finish(t: int, connection: HciConnection) -> Iterator[LoggedValue]:
    """Yield what the end of a connection leaves incomplete, the values of the peer first."""
    for _, (device, conversation) in sorted(connection.conversations.items(), key=lambda one: not one[0]):
        yield from [LoggedValue(t, connection, device, value) for value in conversation.finish()]
