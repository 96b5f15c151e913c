"""Reading of a log as values of attributes, each with its device: HCI packets, connections, L2CAP, attributes.

HCI has about two hundred commands and events (Bluetooth Core, vol 4 part E; vol 3 part A). Only those are decoded that
give the peer of a connection handle, or end a connection. An L2CAP PDU is reassembled from the ACL packets that contain
its pieces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from attrs import define, field, frozen
from construct import Bytes, GreedyBytes, Int8ul, Int16ul, Prefixed, Struct

from ...wire.error import WireError
from ...wire.fields import parse_whole
from ..errors import RecordingError, Report
from .att import AttValue, Conversation, is_from_client
from .devices import LoggedDevice
from .records import HciRecord, RecordKind, read_records

EVENT = Struct("code" / Int8ul, "parameters" / Prefixed(Int8ul, GreedyBytes))
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
ACL = Struct("flags" / Int16ul, "data" / Prefixed(Int16ul, GreedyBytes))
PDU_HEADER = 4
"""Size of the header of an L2CAP PDU, bytes: the length of its data, and its channel."""

DISCONNECTED, LE_META = 0x05, 0x3E
CONNECTION_SUBEVENTS = (b"\x01", b"\x0a", b"\x29")
"""Subevent codes of LE Connection Complete, Enhanced v1 and Enhanced v2."""
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
CUT_SHORT = "packets that the capture cut short (a snap length, or an Android log that is Filtered)"
"""What is said of packets of which only the start was logged."""


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
    conversation: Conversation | None = None
    """Decoder of what host and peer say; None before the first PDU."""

    @property
    def peer(self) -> str:
        """Name of the peer: its address, or the connection handle if the address is unknown."""
        return self.address or f"connection-{self.handle:#06x}" + (f"-hci{self.adapter}" if self.adapter else "")


@frozen
class LoggedItem:
    """One value of a log, or the start or the end of a connection."""

    t: int
    """Time, us since 1970."""
    connection: HciConnection
    value: AttValue | None
    """Value of an attribute of the peer; None for the start or the end of the connection."""
    connected: bool = True
    """False for the end of the connection."""


@define
class ValueListener:
    """Reads all values of a log in order, with the starts and ends of the connections."""

    path: Path
    report: Report
    flaws: Counter[str] = field(factory=Counter)
    """Counts of the parts of the log that could not be used, by kind."""
    devices: dict[str, LoggedDevice] = field(factory=dict)
    """Devices by HciConnection.peer. What was discovered remains valid after a connection, because a host stores it and
    does not repeat the discovery."""
    _connections: dict[tuple[int, int], HciConnection] = field(factory=dict)
    """Connections by adapter and handle; the one that has been silent longest is first."""

    def listen(self, progress: Callable[[int], None] | None = None) -> Iterator[LoggedItem]:
        """Yield the values and the changes of connections; RecordingError at damage, after all items before it."""
        t, failure = 0, None
        try:
            for record in read_records(self.path, report=self.report, flaws=self.flaws, progress=progress):
                t = record.t
                if record.kind is not RecordKind.OTHER and not record.whole:
                    self.flaws[CUT_SHORT] += 1
                    continue
                try:
                    if record.kind is RecordKind.EVENT:
                        yield from self._feed_event(record)
                    elif record.kind is RecordKind.ACL:
                        yield from self._feed_acl(record)
                except WireError:
                    self.flaws["records that are not HCI"] += 1
        except RecordingError as error:
            failure = error
        for connection in self._connections.values():
            yield from _finish(t, connection)
        if failure is not None:
            raise failure

    def _feed_event(self, record: HciRecord) -> Iterator[LoggedItem]:
        event = parse_whole(EVENT, record.data)
        if event.code == LE_META and event.parameters[:1] in CONNECTION_SUBEVENTS:
            complete = parse_whole(LE_CONNECTION_COMPLETE, event.parameters)
            if complete.status == 0:
                key = record.adapter, complete.handle & HANDLE_MASK
                yield from self._end(record.t, key)
                # an address as sent ends with its most significant octet
                yield from self._start(record.t, key, complete.peer[::-1].hex(":").upper())
                yield LoggedItem(record.t, self._connections[key], None)
        elif event.code == DISCONNECTED:
            disconnection = parse_whole(DISCONNECTION_COMPLETE, event.parameters)
            if disconnection.status == 0:
                yield from self._end(record.t, (record.adapter, disconnection.handle & HANDLE_MASK))

    def _start(self, t: int, key: tuple[int, int], address: str) -> Iterator[LoggedItem]:
        """Start a connection; the one that has been silent longest ends if there are MOST_CONNECTIONS."""
        if len(self._connections) >= MOST_CONNECTIONS:
            self.flaws[f"connections beyond {MOST_CONNECTIONS}, each of which ended the longest silent one"] += 1
            yield from self._end(t, next(iter(self._connections)))
        self._connections[key] = HciConnection(*key, address)

    def _end(self, t: int, key: tuple[int, int]) -> Iterator[LoggedItem]:
        """End a connection if there is one, after the value that it left incomplete."""
        if (connection := self._connections.pop(key, None)) is not None:
            yield from _finish(t, connection)
            yield LoggedItem(t, connection, None, connected=False)

    def _feed_acl(self, record: HciRecord) -> Iterator[LoggedItem]:
        packet = parse_whole(ACL, record.data)
        key = record.adapter, packet.flags & HANDLE_MASK
        if key not in self._connections:
            yield from self._start(record.t, key, "")
        connection = self._connections[key] = self._connections.pop(key)  # as the newest
        sent, continues = record.sent, packet.flags >> 12 & 3 == CONTINUING_FRAGMENT
        if sent is None:  # the capture does not say it: the host is the client, and pieces follow their beginning
            sent = next(reversed(connection.pieces), False) if continues else is_from_client(packet.data[PDU_HEADER:])
        if not continues:
            self._discard_pieces(connection, sent)
            connection.pieces[sent] = bytearray()
        pieces = connection.pieces.get(sent)
        if pieces is None:
            self.flaws["pieces of packets whose beginning is missing"] += 1
            return
        pieces += packet.data
        missing = PDU_HEADER + int.from_bytes(pieces[:2], "little") - len(pieces)
        if missing < 0:
            self._discard_pieces(connection, sent)
        elif missing == 0:
            del connection.pieces[sent]
            channel = int.from_bytes(pieces[2:PDU_HEADER], "little")
            # the peer is the server if the host sends a PDU of a client, or the peer a PDU of a server
            if channel == ATT_CHANNEL and sent == is_from_client(pieces[PDU_HEADER:]):
                yield from self._feed_pdu(record.t, connection, bytes(pieces[PDU_HEADER:]))
            elif channel >= FIRST_DYNAMIC_CHANNEL and connection.address:
                self.flaws["packets of channels that are not followed (EATT perhaps)"] += 1

    def _discard_pieces(self, connection: HciConnection, sent: bool) -> None:
        if connection.pieces.pop(sent, None) is not None:
            self.flaws["packets of which a piece is missing"] += 1

    def _feed_pdu(self, t: int, connection: HciConnection, data: bytes) -> Iterator[LoggedItem]:
        if connection.peer not in self.devices and len(self.devices) >= MOST_DEVICES:
            self.flaws[f"packets of more than {MOST_DEVICES} devices, left out"] += 1
            return
        device = self.devices.setdefault(connection.peer, LoggedDevice(connection.peer))
        if connection.conversation is None:
            connection.conversation = Conversation(device, self.flaws)
        yield from [LoggedItem(t, connection, value) for value in connection.conversation.feed(data)]


def _finish(t: int, connection: HciConnection) -> Iterator[LoggedItem]:
    """Yield the value that the end of a connection leaves incomplete."""
    if connection.conversation is not None:
        yield from [LoggedItem(t, connection, value) for value in connection.conversation.end_read()]
