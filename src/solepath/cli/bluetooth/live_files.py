"""The files that `solepath live` and `solepath record` write while sensors send."""

from __future__ import annotations

from collections import deque
from pathlib import Path

from attrs import define

from ...ble.record import start_keys
from ...events import Event
from ...recording import PacketWriter, RecordingError
from ...show.output import TrackFiles
from ...types import Packet
from ..common.failure import Failure
from ..common.os_errors import file_error_text, in_words

MAX_HELD = 10_000
"""Largest number of packets and of events that are kept before a sensor sends: a quarter of an hour of ticks."""


@define(init=False)
class LiveFiles:
    """The files that are written while a session runs; `failure` says why writing has failed, None while it works.

    The recording is locked from the start. Files of an earlier run are replaced when a sensor sends its first packet,
    not by what the receiver itself reports; `unchanged` has those for which no sensor sent any."""

    failure: str | None
    unchanged: list[Path]
    _record: Path | None
    _out: Path | None
    _places: bool
    _packets: PacketWriter | None
    _events: TrackFiles | None
    _is_started: bool
    """Flag: a sensor has sent a packet."""
    _packets_before: deque[Packet]
    """Packets of the receiver before a recording is replaced."""
    _events_before: deque[Event]

    def __init__(self, record: Path | None, out: Path | None, *, places: bool = False, force: bool = False) -> None:
        """Open and lock the recording; `places` says that there is a floor plan, `force` that it may be replaced.

        Raise Failure when it cannot be opened."""
        self._record, self._out, self._places, self._is_started = record, out, places, False
        self.failure = self._packets = self._events = None
        self.unchanged, self._packets_before, self._events_before = [], deque(maxlen=MAX_HELD), deque(maxlen=MAX_HELD)
        if record is not None:
            try:
                self._packets = PacketWriter(record, start_keys(), replace=force)
            except RecordingError as error:
                raise Failure(in_words(error)) from None

    def write_packet(self, packet: Packet) -> None:
        """Write a packet into the recording."""
        if not self._is_started and not packet.channel.startswith("receiver/"):
            self._start()
        if self._packets is not None and self._packets.replaces and not self._is_started:
            self._packets_before.append(packet)
        else:
            self._write_packet(packet)

    def _start(self) -> None:
        self._is_started = True
        for packet in self._packets_before:
            self._write_packet(packet)
        self._packets_before.clear()
        try:
            if self._out is not None:
                self._events = TrackFiles(self._out, places=self._places)
        except OSError as error:
            self.failure = self.failure or _error_text(error)
        for event in self._events_before:
            self.write_event(event)
        self._events_before.clear()

    def _write_packet(self, packet: Packet) -> None:
        if self._packets is not None and self.failure is None:
            try:
                self._packets.write(packet)
            except RecordingError as error:
                self.failure = _error_text(error)

    def write_event(self, event: Event) -> None:
        """Write an event into the files of `out`."""
        if self._out is not None and not self._is_started:
            self._events_before.append(event)
        if self._events is not None:
            try:
                self._events.write(event)
            except OSError as error:
                self._events, self.failure = None, self.failure or _error_text(error)

    def close(self) -> None:
        """Close all files; those for which nothing came stay as they were."""
        if not self._is_started:
            if self._record is not None and self._packets is not None and self._packets.replaces:
                self.discard()
                self.unchanged.append(self._record)
            if self._out is not None:
                self.unchanged.append(self._out)
        for file in (self._packets, self._events):
            try:
                if file is not None:
                    file.close()
            except (RecordingError, OSError) as error:
                self.failure = self.failure or _error_text(error)

    def discard(self) -> None:
        """Close the recording, if it is open, and leave everything as it was if nothing was written."""
        if self._packets is not None:
            self._packets.discard()


def _error_text(error: RecordingError | OSError) -> str:
    return in_words(error) if isinstance(error, RecordingError) else file_error_text(error)
