"""The object through which an app receives packets of real sensors.

async with Devices([DeviceConfig(Site.LEFT_FOOT, "F0:F1:F2:F3:F4:F5")]) as devices:
    async for packet in devices:
        for event in session.feed(packet): ..."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import suppress

from ..link.driver import Driver
from ..link.setup.config import DeviceConfig, check_configs
from ..link.setup.roster import Roster
from ..types import Packet
from ..wire.receiver import PositionFrame, build_position
from .connection import Connection, ConnectionState
from .inbox import Emitter, Inbox
from .scanning import NATIVE, Backend, Scanner, make_scanner
from .trouble import FAILURES, BluetoothError, describe_error

TICK_INTERVAL = 0.2
"""Time without a packet after which a packet receiver/tick reports the time, s."""
MAX_PACKETS_IN_A_ROW = 64
"""Largest number of packets that are taken in a row before the event loop can serve Bluetooth again."""


class Devices:
    """The configured devices, connected for the duration of an `async with`; iterate over it for packets.

    Every packet has the address of its device and the time of the event loop's clock at its arrival, s (`loop.time()`,
    usually `time.monotonic()`). A packet is available to the app one turn of the event loop after it arrives.
    Besides notifications there are the values that were read and written, and packets of the receiver itself
    (protocol/receiver.md): connections, troubles as sentences, counts of dropped packets, and ticks while nothing
    arrives. `Session.feed` turns all of them into events.

    `capacity` is the number of notifications that can wait; beyond it the oldest are dropped and a packet reports their
    number. `pair` requests pairing of every device when it is connected. `patience` is the time until a device that
    does not advertise is reported, s. `backend` replaces this machine's Bluetooth, for emulated devices. `profiles` are
    the app's own devices, as for Session: one whose config has no profile is recognised by its advertisement. Raises
    ValueError when no device is configured, two have the same site, or two configs can mean one device.

    Entering raises BluetoothError when Bluetooth cannot be used; later failures are packets. A lost device is connected
    again. Leaving disconnects; the packets that have arrived by then can still be iterated."""

    def __init__(
        self,
        configs: Iterable[DeviceConfig],
        *,
        backend: Backend = NATIVE,
        capacity: int = 4000,
        pair: bool = False,
        patience: float = 10.0,
        profiles: Iterable[Driver] = (),
    ) -> None:
        configs = tuple(configs)
        check_configs(configs)
        if capacity < 1:
            raise ValueError(f"a capacity of {capacity}")
        self._inbox = Inbox(capacity)
        self._scanner = Scanner(backend, self._report_trouble)
        self._backend = backend
        self._tasks: list[asyncio.Task[None]] = []
        self._connections: list[Connection] = []
        self._arrival = asyncio.Event()
        """Set when a packet has arrived, or a task has ended."""
        self._taken_in_a_row = 0
        self._entered = False
        """True once `async with` was entered."""
        self._in_use = False
        """True from the start of `async with` to its end."""
        self._fault: asyncio.Task[None] | None = None
        roster, own = Roster(), tuple([driver.profile for driver in profiles])
        for member in roster.add(configs):
            emitter = Emitter(self._inbox, member)
            self._connections.append(Connection(roster, member, backend, self._scanner, emitter, pair, patience, own))
        self._inbox.on_arrival = self._arrival.set

    @property
    def connections(self) -> tuple[Connection, ...]:
        """Read-only connections in the order of the configs: site, state, address, name, signal."""
        return tuple(self._connections)

    def report_position(self, position: PositionFrame) -> None:
        """Add a packet receiver/position after those that have arrived: a person reports where the wearer is, now.

        Raises ValueError for impossible values, and RuntimeError outside `async with`."""
        if not self._in_use:
            raise RuntimeError("a position is reported among the packets of devices in use: async with Devices(...)")
        now, site = asyncio.get_running_loop().time(), self._connections[0].site
        self._inbox.put(Packet(now, site, "receiver/position", build_position(position)), False)

    async def __aenter__(self) -> Devices:
        if self._in_use:
            raise RuntimeError("these devices are in use already")
        self._in_use = True
        try:
            async with make_scanner(self._backend, lambda _: None):
                pass  # only tests whether Bluetooth can be used
        except BaseException as error:
            self._in_use = False
            if isinstance(error, FAILURES):
                raise BluetoothError(describe_error(error)) from error
            raise
        self._entered = True
        runs = [self._scanner.run(), *(connection.run() for connection in self._connections)]
        self._tasks = [asyncio.create_task(run) for run in runs]
        for task in self._tasks:
            task.add_done_callback(self._note_end)
        return self

    async def __aexit__(self, *error: object) -> None:
        for task in self._tasks:
            task.cancel()
        try:
            await asyncio.gather(*self._tasks, return_exceptions=True)
        finally:
            self._tasks, self._fault, self._in_use = [], None, False
            self._arrival.set()

    def __aiter__(self) -> AsyncIterator[Packet]:
        return self

    async def __anext__(self) -> Packet:
        """Return the next packet.

        Raises StopAsyncIteration after `async with` when all packets are taken, and RuntimeError before `async with`.
        A programming error in one of the tasks is raised unchanged."""
        if not self._entered:
            raise RuntimeError("devices give packets only after they are entered: async with Devices(...) as devices")
        self._taken_in_a_row += 1
        if self._taken_in_a_row >= MAX_PACKETS_IN_A_ROW:
            self._taken_in_a_row = 0
            await asyncio.sleep(0)
        packet = self._next()
        if packet is not None:
            return packet
        self._taken_in_a_row = 0
        self._arrival.clear()
        with suppress(TimeoutError):
            async with asyncio.timeout(TICK_INTERVAL):
                await self._arrival.wait()
        now = asyncio.get_running_loop().time()
        return self._next() or Packet(now, self._connections[0].site, "receiver/tick", b"")

    def _next(self) -> Packet | None:
        """Return the oldest packet that waits, or None; raise StopAsyncIteration when no more can come."""
        if self._fault is not None:
            self._fault.result()
        packet = self._inbox.take()
        if packet is None and not self._tasks:
            raise StopAsyncIteration
        return packet

    def _note_end(self, task: asyncio.Task[None]) -> None:
        """Note the end of a task as a fault, since a task ends only when it is cancelled or raises."""
        if not task.cancelled():
            self._fault = task
        self._arrival.set()

    def _report_trouble(self, text: str) -> None:
        for connection in self._connections:
            if connection.state is ConnectionState.SEEKING:
                connection.emitter.report_trouble(text)
