"""Does the work of `solepath live` and `solepath record` after their options are read."""

from __future__ import annotations

import asyncio
import sys
from argparse import Namespace
from collections import deque
from collections.abc import AsyncIterable, AsyncIterator, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from attrs import define, field

from ...ble import DeviceConfig, Devices, scan
from ...ble.record import start_keys
from ...calibration import Calibration
from ...events import Event
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ...link.driver import Driver
from ...link.kinds import make_kinds
from ...recipes import Recipe
from ...recording import PacketWriter, RecordingError, printable
from ...session import Session
from ...session.repeats import Repeats
from ...show.output import RUN_FILE, TrackFiles
from ...show.page.body import LiveBody
from ...show.page.live_commands import position_of
from ...show.page.scene.scales import newtons_of
from ...show.page.scene.scene import Scene
from ...show.tables.summary import place_lines, status, summary
from ...types import Packet, Sample
from ...walk.walk import Walk
from ..common.failure import Failure, is_installed, note, tell
from ..common.files import TRACK_KINDS, OutputFile
from ..common.loop import unless_stopped
from ..common.os_errors import file_error_text, in_words
from ..common.own_devices import drivers_of
from ..common.run_file import write_run
from ..common.view import PageAddress, serve_page
from .backend import backend_of
from .devices import SCAN_TIME, choose_devices, listening_time, named_devices
from .live_streams import stated, stream_names_of

if TYPE_CHECKING:
    from ...recording.lsl.outlet import LslOutlets
    from ...show.page.messages import Command

MAX_HELD = 10_000
"""Largest number of packets that are kept before a sensor sends: a quarter of an hour of ticks."""
POLL_INTERVAL = 0.005
"""Time between two looks into the queues of streams, s: half of an interval at 100 Hz."""
REPORT_INTERVAL = 5.0
"""Time between two reports when the state is printed as lines, s; chosen by hand."""


async def listen(
    options: Namespace,
    recipe: Recipe,
    calibration: Calibration | None,
    plan: IndexedPlan | None,
    start: Start | None,
    address: PageAddress | None,
    stop: asyncio.Event,
) -> int:
    """Receive until `stop` is set or the time is over; return the exit status."""
    drivers = drivers_of(options)
    configs = named_devices(options, drivers)
    session = Session(
        recipe,
        calibration=calibration,
        poses=True,
        pressures=address is not None,
        losses=True,
        profiles=drivers,
        floorplan=plan,
        start=start,
    )
    walk, repeats, floor = Walk(kinds=make_kinds(drivers)), Repeats(), None if plan is None else plan.plan
    collector: Walk | Scene = walk
    async with AsyncExitStack() as stack:
        run_file = None if options.out is None else OutputFile(options.out / RUN_FILE, TRACK_KINDS[RUN_FILE])

        def describe() -> None:
            if run_file is not None:
                run_file.replace(lambda path: write_run(path, recipe, walk, options))

        files = LiveFiles(options.record, options.out, describe, places=plan is not None, replace=options.force)
        stack.callback(files.close)
        seconds = listening_time(options)
        loop = asyncio.get_running_loop()
        async with unless_stopped(stop):
            items: AsyncIterable[Packet | Sample | None]
            if stream_names_of(options):
                offset, items = await stack.enter_async_context(_stream_items(options))
            else:
                offset, items = None, await _connect(options, configs, drivers, stack)
        outlets = None if options.lsl is None else _outlets(options.lsl, offset)
        publish = _publisher_of(outlets, session)
        if address is not None:
            collector = Scene("Live", recipe.name, "live", plan=floor, newtons=newtons_of(calibration), walk=walk)
            collector.body = LiveBody(session)

            def report_position(command: Command) -> None:
                if isinstance(items, Devices):
                    items.report_position(position_of(command, floor))

            await stack.enter_async_context(serve_page(collector, address, report_position))
        end = None if seconds is None else loop.time() + seconds

        def take(item: Packet | Sample | None) -> None:
            events = session.finish() if item is None else session.feed(item)
            reported = repeats.end(events, session.now) if item is None else repeats.gather(item, events)
            files.take(item, reported)
            collector.take(item, events, None if offset is not None else loop.time())
            publish(reported)

        try:
            with show_state(walk, "Ctrl-C ends" if seconds is None else f"{seconds:g} s") as report:
                async for item in items:
                    if stop.is_set() or (end is not None and loop.time() >= end) or files.failure is not None:
                        break
                    if item is not None:
                        take(item)
                        report()
        except asyncio.CancelledError:
            note("interrupted")
        finally:
            take(None)
            files.close()
    print(summary(walk, title=f"recipe {recipe.name}", seconds=0.0))  # 0: no line on the speed
    if plan is not None:
        print("\n".join(place_lines(walk.places)))
    if outlets is not None:
        print("published: " + ", ".join([f"{count} in {options.lsl} {name}" for name, count in outlets.sent.items()]))
        outlets.close()
    if files.failure is not None:
        raise Failure(files.failure)
    names = [printable(str(path)) for path in (options.record, options.out) if path is not None]
    if names and not files.is_started:
        raise Failure(f"no sensor sent anything: {' and '.join(names)} {'is' if len(names) == 1 else 'are'} unchanged")
    if options.record:
        tell(f"recorded in {options.record}")
    if options.out:
        tell(f"written to {options.out}")
    return 0


async def _connect(
    options: Namespace, configs: list[DeviceConfig], drivers: tuple[Driver, ...], stack: AsyncExitStack
) -> Devices:
    """Return the connections to these devices, or without any to those that are in range."""
    backend = await stack.enter_async_context(backend_of(options.via))
    if not configs:
        print(f"looking for sensors for {SCAN_TIME:g} s ...", flush=True)
        configs = choose_devices(await scan(SCAN_TIME, backend=backend), options.profile, drivers)
    return await stack.enter_async_context(Devices(configs, backend=backend, pair=options.pair, profiles=drivers))


@asynccontextmanager
async def _stream_items(options: Namespace) -> AsyncIterator[tuple[float, AsyncIterator[Sample | None]]]:
    """Yield the time of LSL at which all streams are open, and their samples, with None while none comes."""
    from pylsl import local_clock

    from ...recording.lsl.inlet import LslInlet

    inlets: list[LslInlet] = []

    async def samples() -> AsyncIterator[Sample | None]:
        while True:
            for sample in sorted([one for inlet in inlets for one in inlet.pull()], key=lambda one: one.t):
                yield sample
            yield None
            await asyncio.sleep(POLL_INTERVAL)

    channels, units = stated(options)
    for site, name in stream_names_of(options).items():
        inlets.append(await asyncio.to_thread(partial(LslInlet, site, name, channels=channels, units=units)))
    start = local_clock()  # times of the session count from here
    for inlet in inlets:
        inlet.pull()
        inlet.offset = start
    yield start, samples()
    for inlet in inlets:
        if not inlet.received:
            note(f"the stream {inlet.name!r} sent nothing")
        inlet.close()


def _outlets(name: str, offset: float | None) -> LslOutlets:
    """Return the streams that publish a session; `offset` is that of a session whose samples are streams already."""
    from ...recording.lsl.clock import clock_offset
    from ...recording.lsl.outlet import LslOutlets

    if offset is not None:
        return LslOutlets(offset, name, with_samples=False)
    return LslOutlets(clock_offset(asyncio.get_running_loop().time), name)


def _publisher_of(outlets: LslOutlets | None, session: Session) -> Callable[[list[Event]], None]:
    """Return the function that publishes samples, poses and events."""
    if outlets is None:
        return lambda events: None
    from ...recording.posed import PosedSession

    posed = PosedSession(session)
    return lambda events: outlets.push(posed.take(), events)


@define
class LiveFiles:
    """The files that are written while a session runs; `failure` says why writing has failed, None while it works.

    The recording is locked from the start. Files of an earlier run are replaced when a sensor sends its first packet,
    not by what the receiver itself reports."""

    record: Path | None
    out: Path | None
    describe: Callable[[], None]
    """Writes run.json: when a sensor sends its first packet, and at the end."""
    places: bool
    """True for a session with a floor plan."""
    replace: bool
    """True if an earlier recording may be replaced."""
    failure: str | None = field(default=None, init=False)
    is_started: bool = field(default=False, init=False)
    """Flag: a sensor has sent something."""
    _packets: PacketWriter | None = field(default=None, init=False)
    _events: TrackFiles | None = field(default=None, init=False)
    _held: deque[tuple[Packet | Sample | None, list[Event]]] = field(factory=lambda: deque(maxlen=MAX_HELD), init=False)
    """What was not written, because no sensor has sent anything."""

    def __attrs_post_init__(self) -> None:
        """Open and lock the recording; raise RecordingError when it cannot be opened."""
        if self.record is not None:
            self._packets = PacketWriter(self.record, start_keys(), replace=self.replace)

    def take(self, item: Packet | Sample | None, events: list[Event]) -> None:
        """Write an item and its events."""
        self._held.append((item, events))
        if isinstance(item, Sample) or isinstance(item, Packet) and not item.channel.startswith("receiver/"):
            self.is_started = True
        if self.is_started and self.failure is None:
            with self._reported():
                self._write()

    def _write(self) -> None:
        if self._events is None and self.out is not None:
            self._events = TrackFiles(self.out, places=self.places)
            self.describe()
        while self._held:
            item, events = self._held.popleft()
            if self._packets is not None and isinstance(item, Packet):
                self._packets.write(item)
            if self._events is not None:
                for event in events:
                    self._events.write(event)

    @contextmanager
    def _reported(self) -> Iterator[None]:
        """Let `failure` have the first error of writing."""
        try:
            yield
        except (RecordingError, OSError) as error:
            text = in_words(error) if isinstance(error, RecordingError) else file_error_text(error)
            self.failure = self.failure or text

    def close(self) -> None:
        """Close all files; those for which nothing came stay as they were."""
        packets, events, self._packets, self._events = self._packets, self._events, None, None
        if packets is not None and not self.is_started:
            packets.discard()
            packets = None
        for file in (packets, events):
            with self._reported():
                if file is not None:
                    file.close()
        if events is not None:
            with self._reported():
                self.describe()


@contextmanager
def show_state(walk: Walk, end_hint: str) -> Iterator[Callable[[], None]]:
    """Yield a function that shows the state of the session, as a picture in a terminal if rich is installed.

    Otherwise it prints lines every REPORT_INTERVAL s. `end_hint`, the picture's title, says when the session ends."""
    if sys.stdout.isatty() and is_installed("rich"):
        from rich.console import Console

        from ...show.tables.terminal import screen

        with screen(Console()) as terminal_screen:
            yield lambda: terminal_screen.show(walk, end_hint)
        return
    started: float | None = None
    due = REPORT_INTERVAL

    def report() -> None:
        nonlocal started, due
        started = walk.now if started is None else started
        if walk.now - started >= due:
            due += REPORT_INTERVAL
            print("\n".join(f"{walk.now - started:6.1f} s  {line}" for line in status(walk)), flush=True)

    yield report
