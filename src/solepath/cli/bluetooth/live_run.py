"""Does the work of `solepath live` and `solepath record` after their options are read."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Callable, Iterator
from contextlib import AsyncExitStack, contextmanager

from attrs import define

from ...ble import Devices, scan
from ...calibration import Calibration
from ...events import Event
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ...recipes import Recipe
from ...recording import printable
from ...session import Session
from ...show.page.body import LiveBody
from ...show.page.live_commands import position_of
from ...show.page.scene.scales import newtons_of
from ...show.page.scene.scene import Scene
from ...show.tables.summary import place_lines, status, summary
from ...types import Packet
from ...walk.walk import Walk
from ..common.failure import Failure, is_installed, note
from ..common.loop import unless_stopped
from ..common.own_devices import drivers_of
from ..common.view import PageAddress, serve_page
from .backend import backend_of, packets_until
from .devices import SCAN_TIME, choose_devices, listening_time, named_devices
from .live_files import LiveFiles


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
    drivers = drivers_of(options)
    devices = named_devices(options, drivers)
    session = Session(
        recipe,
        calibration=calibration,
        poses=True,
        pressures=address is not None,
        profiles=drivers,
        floorplan=plan,
        start=start,
    )
    walk = Walk()
    scene: Scene | None = None
    async with AsyncExitStack() as stack:
        files = LiveFiles(options.record, options.out, places=plan is not None, force=options.force)
        stack.callback(files.discard)
        seconds = listening_time(options)
        async with unless_stopped(stop):
            backend = await stack.enter_async_context(backend_of(options.via))
            if not devices:
                print(f"looking for sensors for {SCAN_TIME:g} s ...", flush=True)
                devices = choose_devices(await scan(SCAN_TIME, backend=backend), options.profile, drivers)
            connections = Devices(devices, backend=backend, pair=options.pair, profiles=drivers)
            packets = await stack.enter_async_context(connections)
        publish = _publisher_of(options, session)
        if address is not None:
            floor_plan, newtons = None if plan is None else plan.plan, newtons_of(calibration)
            scene = Scene("Live", recipe.name, "live", plan=floor_plan, newtons=newtons, walk=walk)
            scene.body = LiveBody(session)
            await stack.enter_async_context(
                serve_page(scene, address, lambda command: packets.report_position(position_of(command, floor_plan)))
            )
        live = LiveSession(session, walk if scene is None else scene, files, publish)
        end_hint = "Ctrl-C ends" if seconds is None else f"{seconds:g} s"
        try:
            with show_state(walk, end_hint) as report:
                async for packet in packets_until(packets, stop, seconds):
                    live.take(packet)
                    report()
                    if files.failure is not None:
                        break
        except asyncio.CancelledError:
            note("interrupted")
        finally:
            live.finish()
    print(summary(walk, title=f"recipe {recipe.name}", seconds=0.0))  # 0: no line on the speed
    if plan is not None:
        print("\n".join(place_lines(walk.places)))
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
    collector: Walk | Scene
    files: LiveFiles
    publish: Callable[[list[Event]], None] | None = None
    """Function that gets the events after each packet."""

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
        if self.publish is not None:
            self.publish(events)


def _publisher_of(options: argparse.Namespace, session: Session) -> Callable[[list[Event]], None] | None:
    """Return the function that publishes samples, poses and events as --lsl says; None without --lsl."""
    if options.lsl is None:
        return None
    from ...recording.lsl.clock import clock_offset
    from ...recording.lsl.outlet import LslOutlets
    from ...recording.posed import PosedSession

    outlets = LslOutlets(clock_offset(asyncio.get_running_loop().time), options.lsl)
    posed = PosedSession(session)
    return lambda events: outlets.push(posed.take(), events)


REPORT_INTERVAL = 5.0
"""Time between two reports when the state is printed as lines, s; chosen by hand."""


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
