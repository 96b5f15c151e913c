"""Reading of a log as values of attributes, each with its device."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from attrs import define, field, frozen

from ..errors import RecordingError, Report
from .att import FROM_CLIENT, AttValue, Conversation
from .hci import ConnectionChange, Controller, HciConnection, Pdu
from .records import read_records

MOST_DEVICES = 500
"""Largest number of devices of a log that are examined, chosen by hand; they are those that the host connected to."""


@frozen
class LoggedValue:
    """One value of a log."""

    t: int
    """Time of the value, us since 1970."""
    connection: HciConnection
    device: str
    """Address of the server, or its HciConnection.peer if unknown."""
    att_value: AttValue


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
    _conversations: dict[tuple[int, bool], Conversation] = field(factory=dict)
    """Conversations by number of the connection and by role of the peer, which is True if it is the server."""

    def listen(self, progress: Callable[[int], None] | None = None) -> Iterator[LoggedValue | ConnectionChange]:
        """Yield the values and the changes of connections; RecordingError at damage, after all items before it."""
        controller = Controller(self.flaws)
        t, failure = 0, None
        try:
            for record in read_records(self.path, report=self.report, flaws=self.flaws, progress=progress):
                t = record.t
                for item in controller.feed(record):
                    match item:
                        case Pdu():
                            yield from self._feed_pdu(item)
                        case ConnectionChange():
                            if not item.connected:
                                yield from self._finish_connection(
                                    t, item.connection, controller.get_own_address(item.connection.adapter)
                                )
                            yield item
        except RecordingError as error:
            failure = error
        for connection in controller.list_connections():
            yield from self._finish_connection(t, connection, controller.get_own_address(connection.adapter))
        if failure is not None:
            raise failure

    def _feed_pdu(self, pdu: Pdu) -> Iterator[LoggedValue]:
        # the peer is the server if the host sends a PDU of a client, or the peer a PDU of a server
        peer_is_server = pdu.sent == (bool(pdu.data) and pdu.data[0] in FROM_CLIENT)
        device = pdu.connection.peer if peer_is_server else pdu.own_address
        conversation = self._conversations.get((pdu.connection.number, peer_is_server))
        if conversation is None:
            if device not in self.types and len(self.types) >= MOST_DEVICES:
                self.flaws[f"packets of more than {MOST_DEVICES} devices, left out"] += 1
                return
            types = self.types.setdefault(device, {})
            conversation = self._conversations[pdu.connection.number, peer_is_server] = Conversation(types, self.flaws)
        yield from (LoggedValue(pdu.t, pdu.connection, device, att_value) for att_value in conversation.feed(pdu.data))

    def _finish_connection(self, t: int, connection: HciConnection, own_address: str) -> Iterator[LoggedValue]:
        for peer_is_server, device in ((True, connection.peer), (False, own_address)):
            conversation = self._conversations.pop((connection.number, peer_is_server), None)
            if conversation is not None:
                yield from (LoggedValue(t, connection, device, att_value) for att_value in conversation.finish())
