"""Does the work of `solepath live` and `solepath record` after their options are read."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AsyncExitStack, contextmanager
from pathlib import Path

from attrs import define

from ...ble import Devices, scan
from ...ble.record import start_keys
from ...calibration import Calibration
from ...events import Event
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ...recipes import Recipe
from ...recording import PacketWriter, RecordingError, os_error_text, printable
from ...session import Session
from ...show.observer import Observer
from ...show.output import TrackFiles
from ...show.page.scene.scene import Scene
from ...show.tables.summary import place_lines, status, summary
from ...types import Packet
from ..common.failure import Failure, is_installed, note
from ..common.loop import unless_stopped
from ..common.view import PageAddress, newtons_of, serve_page
from .backend import backend_of, packets_until
from .devices import SCAN_TIME, choose_devices, listening_time, named_devices

MAX_HELD = 10_000
"""Largest number of packets and of events that are kept before a sensor sends: a quarter of an hour of ticks."""


async def listen(
    options: argparse.Namespace,
    recipe: Recipe,
    calibration: Calibration | None,
    plan: IndexedPlan | None,
    start: Start | None,
    address: PageAddress | None,
    stop: asyncio.Event,
) -> int:
    """Receive until `stop` is set or the time is over; return the exit status."""
    devices = named_devices(options)
    session = Session(
        recipe, calibration=calibration, poses=True, pressures=address is not None, floorplan=plan, start=start
    )
    observer = Observer()
    scene: Scene | None = None
    async with AsyncExitStack() as stack:
        files = LiveFiles(options.record, options.out, places=plan is not None, force=options.force)
        stack.callback(files.discard)
        seconds = listening_time(options)
        async with unless_stopped(stop):
            backend = await stack.enter_async_context(backend_of(options.via))
            if not devices:
                print(f"looking for sensors for {SCAN_TIME:g} s ...", flush=True)
                devices = choose_devices(await scan(SCAN_TIME, backend=backend), options.profile)
            packets = await stack.enter_async_context(Devices(devices, backend=backend, pair=options.pair))
        if address is not None:
            floor_plan, newtons = None if plan is None else plan.plan, newtons_of(calibration)
            scene = Scene("Live", recipe.name, "live", plan=floor_plan, newtons=newtons, observer=observer)
            await stack.enter_async_context(serve_page(scene, address))
        live = LiveSession(session, observer if scene is None else scene, files)
        end_hint = "Ctrl-C ends" if seconds is None else f"{seconds:g} s"
        try:
            with show_state(observer, end_hint) as report:
                async for packet in packets_until(packets, stop, seconds):
                    live.take(packet)
                    report()
                    if files.failure is not None:
                        break
        except asyncio.CancelledError:
            note("interrupted")
        finally:
            live.finish()
    print(summary(observer, title=f"recipe {recipe.name}", seconds=0.0))  # 0: no line on the speed
    if plan is not None:
        print("\n".join(place_lines(observer.places)))
    if files.failure is not None:
        raise Failure(files.failure)
    if files.unchanged:
        names = " and ".join([printable(str(path)) for path in files.unchanged])
        raise Failure(f"no sensor sent anything: {names} {'is' if len(files.unchanged) == 1 else 'are'} unchanged")
    if options.record:
        print(f"recorded in {printable(str(options.record))}")
    if options.out:
        print(f"written to {printable(str(options.out))}")
    return 0


@define
class LiveSession:
    """A session that is shown and written while it runs: `collector` and `files` get its packets and events."""

    session: Session
    collector: Observer | Scene
    files: LiveFiles

    def take(self, packet: Packet) -> None:
        """Feed the next packet to the session; write and show the packet and its events."""
        self.files.write_packet(packet)
        self._show(packet, self.session.feed(packet))

    def finish(self) -> None:
        """Finish the session, write and show its last events, and close the files."""
        self._show(None, self.session.finish())
        self.files.close()

    def _show(self, packet: Packet | None, events: list[Event]) -> None:
        self.collector.take(packet, events)
        for event in events:
            self.files.write_event(event)


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
                raise Failure(str(error)) from None

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
    if isinstance(error, RecordingError):
        return str(error)
    return f"{error.filename}: {os_error_text(error)}" if error.filename else os_error_text(error)


REPORT_INTERVAL = 5.0
"""Time between two reports when the state is printed as lines, s; chosen by hand."""


@contextmanager
def show_state(observer: Observer, end_hint: str) -> Iterator[Callable[[], None]]:
    """Yield a function that shows the state of the session, as a picture in a terminal if rich is installed.

    Otherwise it prints lines every REPORT_INTERVAL s. `end_hint`, the picture's title, says when the session ends."""
    if sys.stdout.isatty() and is_installed("rich"):
        from rich.console import Console

        from ...show.tables.terminal import screen

        with screen(Console()) as terminal_screen:
            yield lambda: terminal_screen.show(observer, end_hint)
        return
    started: float | None = None
    due = REPORT_INTERVAL

    def report() -> None:
        nonlocal started, due
        started = observer.now if started is None else started
        if observer.now - started >= due:
            due += REPORT_INTERVAL
            print("\n".join(f"{observer.now - started:6.1f} s  {line}" for line in status(observer)), flush=True)

    yield report
