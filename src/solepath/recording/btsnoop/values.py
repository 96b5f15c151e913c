"""A log as values of attributes, each with its device."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from attrs import define, field, frozen

from ..errors import RecordingError, Report
from .att import FROM_CLIENT, AttValue, Conversation
from .hci import Controller, HciConnection, LinkChange, Pdu
from .records import read_records


@frozen
class Value:
    """One value of a log.

    `t`: us since 1970. `device`: the address of the server, or another name that identifies it."""

    t: int
    link: HciConnection
    device: str
    att_value: AttValue


@define
class ValueListener:
    """Reads all values of a log, in order, with the starts and ends of the connections.

    `types`: UUID by device and attribute handle, as discovered so far. It outlives a connection, since hosts remember
    what they discovered once and do not ask again."""

    path: Path
    report: Report
    flaws: Counter[str] = field(factory=Counter)
    types: dict[str, dict[int, str]] = field(factory=dict)
    _conversations: dict[tuple[int, bool], Conversation] = field(factory=dict)
    """Conversations by connection and whether the peer is the server."""

    def listen(self, progress: Callable[[int], None] | None = None) -> Iterator[Value | LinkChange]:
        """Yield the values and changes of connections.

        RecordingError, after everything before it, for a log that cannot be used."""
        controller = Controller(self.flaws)
        t, failure = 0, None
        try:
            for record in read_records(self.path, report=self.report, flaws=self.flaws, progress=progress):
                t = record.t
                for item in controller.feed(record):
                    match item:
                        case Pdu():
                            yield from self._pdu(item)
                        case LinkChange():
                            if not item.connected:
                                yield from self._finish(t, item.link, controller.own(item.link.adapter))
                            yield item
        except RecordingError as error:
            failure = error
        for link in controller.links():
            yield from self._finish(t, link, controller.own(link.adapter))
        if failure is not None:
            raise failure

    def _pdu(self, pdu: Pdu) -> Iterator[Value]:
        # the peer is the server when the host sends as a client, or the peer as a server
        of_peer = pdu.sent == (bool(pdu.data) and pdu.data[0] in FROM_CLIENT)
        device = pdu.link.peer if of_peer else pdu.own
        conversation = self._conversations.get((pdu.link.number, of_peer))
        if conversation is None:
            types = self.types.setdefault(device, {})
            conversation = self._conversations[pdu.link.number, of_peer] = Conversation(types, self.flaws)
        yield from (Value(pdu.t, pdu.link, device, one) for one in conversation.feed(pdu.data))

    def _finish(self, t: int, link: HciConnection, own: str) -> Iterator[Value]:
        for of_peer, device in ((True, link.peer), (False, own)):
            conversation = self._conversations.pop((link.number, of_peer), None)
            if conversation is not None:
                yield from (Value(t, link, device, one) for one in conversation.finish())
