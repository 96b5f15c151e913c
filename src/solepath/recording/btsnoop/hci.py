"""HCI packets to connections and PDUs of the attribute protocol (Bluetooth Core, vol 4 part E; vol 3 part A).

Of the two hundred commands and events only a few matter here: those that give the peer of a connection handle, and the
end of a connection. L2CAP PDUs are reassembled from the ACL packets that carry their pieces."""

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
"""Common start of the legacy event and both enhanced ones; intervals and other addresses follow."""
DISCONNECTION_COMPLETE = Struct("status" / Int8ul, "handle" / Int16ul, "reason" / Int8ul)
READ_ADDRESS_COMPLETE = Struct("packets" / Int8ul, "opcode" / Int16ul, "status" / Int8ul, "address" / Bytes(6))
ACL = Fields("<HH")
"""Header of an ACL packet: handle (12 bits) with flags, length."""
L2CAP = Fields("<HH")
"""Header of an L2CAP PDU: length, channel."""

RESET, READ_BD_ADDR, LE_SET_RANDOM_ADDRESS = 0x0C03, 0x1009, 0x2005
DISCONNECTED, COMMAND_COMPLETE, LE_META = 0x05, 0x0E, 0x3E
CONNECTION_SUBEVENTS = {0x01: 19, 0x0A: 31, 0x29: 34}
"""Size of the parameters of LE Connection Complete, Enhanced v1 and Enhanced v2, bytes."""
HANDLE_BITS = 0x0FFF
"""Mask of a connection handle; the other bits are flags, or reserved."""
CONTINUING = 1
ATT_CHANNEL = 4
DYNAMIC_CHANNELS = 0x40
"""First of the channels that are opened for a purpose, the enhanced attribute protocol among them."""


@define
class HciConnection:
    """One connection, from its start (or the log's) to its end (or the log's).

    `number`: counted through the log. `address`: the peer's; "" when the connection is older than the log."""

    number: int
    adapter: int
    handle: int
    address: str
    pieces: dict[bool, bytearray] = field(factory=dict)
    """Incomplete L2CAP PDUs, by whether they are sent."""

    @property
    def peer(self) -> str:
        """Name of the peer: its address, or the connection handle where the address is unknown."""
        return self.address or f"connection-{self.handle:#06x}" + (f"-hci{self.adapter}" if self.adapter else "")


@frozen
class LinkChange:
    """A connection that starts at `t`, us since 1970, or ends."""

    t: int
    link: HciConnection
    connected: bool


@frozen
class Pdu:
    """One PDU of the attribute protocol. `own`: the local host's address, "" when the log does not have it."""

    t: int
    link: HciConnection
    sent: bool
    data: bytes
    own: str


def address_text(octets: bytes) -> str:
    """Return an address in its usual form: the most significant octet, which is sent last, in front."""
    return ":".join(f"{octet:02X}" for octet in reversed(octets))


@define
class Controller:
    """The connections of a log's adapters, record by record. `flaws` counts records that were not understood."""

    flaws: Counter[str]
    _links: dict[tuple[int, int], HciConnection] = field(factory=dict)
    _public: dict[int, str] = field(factory=dict)
    _random: dict[int, str] = field(factory=dict)
    _count: int = 0

    def feed(self, record: HciRecord) -> Iterator[LinkChange | Pdu]:
        """Yield the changes of connections and the PDUs of one record."""
        if record.kind is not RecordKind.OTHER and not record.whole:
            self.flaws["records that the logger cut short"] += 1
        try:
            match record.kind:
                case RecordKind.COMMAND if record.whole:
                    yield from self._command(record)
                case RecordKind.EVENT if record.whole:
                    yield from self._event(record)
                case RecordKind.ACL:
                    yield from self._acl(record)
        except WireError:
            self.flaws["records that are not HCI"] += 1

    def _command(self, record: HciRecord) -> Iterator[LinkChange]:
        command = parse_whole(COMMAND, record.data)
        if command.opcode == RESET:
            for key in [key for key in self._links if key[0] == record.adapter]:
                yield LinkChange(record.t, self._links.pop(key), False)
        elif command.opcode == LE_SET_RANDOM_ADDRESS and len(command.parameters) == 6:
            self._random[record.adapter] = address_text(command.parameters)

    def _event(self, record: HciRecord) -> Iterator[LinkChange]:
        event = parse_whole(EVENT, record.data)
        parameters = event.parameters
        if event.size != len(parameters):
            self.flaws["records that are not HCI"] += 1
        elif event.code == LE_META and parameters and len(parameters) == CONNECTION_SUBEVENTS.get(parameters[0]):
            complete = parse_whole(LE_CONNECTION_COMPLETE, parameters)
            if complete.status == 0:
                handle = complete.handle & HANDLE_BITS
                yield from self._remove_link(record, handle)
                yield LinkChange(record.t, self._add_link(record, handle, address_text(complete.peer)), True)
        elif event.code == DISCONNECTED:
            disconnection = parse_whole(DISCONNECTION_COMPLETE, parameters)
            if disconnection.status == 0:
                yield from self._remove_link(record, disconnection.handle & HANDLE_BITS)
        elif event.code == COMMAND_COMPLETE and len(parameters) == READ_ADDRESS_COMPLETE.sizeof():
            completed = parse_whole(READ_ADDRESS_COMPLETE, parameters)
            if completed.opcode == READ_BD_ADDR and completed.status == 0:
                self._public[record.adapter] = address_text(completed.address)

    def _add_link(self, record: HciRecord, handle: int, address: str) -> HciConnection:
        link = self._links[record.adapter, handle] = HciConnection(self._count, record.adapter, handle, address)
        self._count += 1
        return link

    def _remove_link(self, record: HciRecord, handle: int) -> Iterator[LinkChange]:
        link = self._links.pop((record.adapter, handle), None)
        if link is not None:
            yield LinkChange(record.t, link, False)

    def _acl(self, record: HciRecord) -> Iterator[Pdu]:
        if len(record.data) < 4:
            self.flaws["records that are not HCI"] += 1
            return
        head, size = ACL.parse(record.data)
        handle, boundary, body = head & HANDLE_BITS, head >> 12 & 3, record.data[4:]
        link = self._links.get((record.adapter, handle))
        if link is None:
            link = self._add_link(record, handle, "")
        if len(body) != size:
            if record.whole:
                self.flaws["records that are not HCI"] += 1
            self._discard_pieces(link, record.sent)
            return
        if boundary != CONTINUING:
            self._discard_pieces(link, record.sent)
            link.pieces[record.sent] = bytearray()
        pieces = link.pieces.get(record.sent)
        if pieces is None:
            self.flaws["pieces of packets whose beginning is missing"] += 1
            return
        pieces += body
        if len(pieces) < 4:
            return
        size, channel = L2CAP.parse(bytes(pieces[:4]))
        if len(pieces) > 4 + size:
            self._discard_pieces(link, record.sent)
        elif len(pieces) == 4 + size:
            del link.pieces[record.sent]
            if channel == ATT_CHANNEL:
                yield Pdu(record.t, link, record.sent, bytes(pieces[4:]), self.own(record.adapter))
            elif channel >= DYNAMIC_CHANNELS and link.address:
                self.flaws["packets of channels that are not followed (EATT perhaps)"] += 1

    def _discard_pieces(self, link: HciConnection, sent: bool) -> None:
        """Discard the pieces of a PDU that will not be completed."""
        if link.pieces.pop(sent, None) is not None:
            self.flaws["packets of which a piece is missing"] += 1

    def own(self, adapter: int) -> str:
        """Return the address by which peers know the adapter; "" when it is unknown."""
        return self._random.get(adapter) or self._public.get(adapter, "")

    def links(self) -> list[HciConnection]:
        """Return the present connections."""
        return list(self._links.values())
