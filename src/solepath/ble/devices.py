"""Devices: what an app holds to hear real sensors.

async with Devices([DeviceConfig(Site.LEFT_FOOT, "F0:F1:F2:F3:F4:F5")]) as devices:
    async for packet in devices:
        for event in session.feed(packet): ...
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable

from ..types import Packet, Site
from .air import NATIVE, Backend, Scanner, scanner
from .connection import Connection, ConnectionState
from .inbox import Emitter, Inbox
from .trouble import FAILURES, BluetoothError, sentence
from .wanted import DeviceConfig, check

TICK = 0.2
"""s without a packet after which there is one that says so."""
IN_A_ROW = 64
"""Packets taken at a stretch before Bluetooth gets its turn again."""


class Devices:
    """Any number of devices, found, connected, set up, and connected again whenever they are lost; iterate for packets.

    Every packet is stamped with the event loop's clock when it arrives (`loop.time()`, usually `time.monotonic()`), and
    names its device; it can be taken in the loop's next turn. Besides what devices send there is what was read from and
    written to them, and what only the receiver knows (protocol/receiver.md): connections, troubles in words, packets
    that were dropped, and the passing of time while nothing comes. All of it is for `Session.feed`, which makes events
    of it, and for a recording.

    `capacity`: notifications that wait to be taken; beyond it the oldest are dropped, and a packet says how many.
    `pair`: pair with each device when it is connected. `patience`: s until a device that is not heard is complained of.
    `backend`: another Bluetooth than this machine's (loopback). ValueError when nothing is wanted, one site twice, or
    when nothing tells two devices apart.

    To enter raises BluetoothError when there is no Bluetooth to be used; nothing that happens later does. Leaving
    disconnects; what has arrived by then can still be iterated.
    """

    def __init__(
        self,
        wanted: Iterable[DeviceConfig],
        *,
        backend: Backend = NATIVE,
        capacity: int = 4000,
        pair: bool = False,
        patience: float = 10.0,
    ) -> None:
        wanted = tuple(wanted)
        check(wanted)
        if capacity < 1:
            raise ValueError(f"a capacity of {capacity}")
        self._inbox = Inbox(capacity)
        self._air = Scanner(backend, self._complain)
        self._backend = backend
        self._tasks: list[asyncio.Task[None]] = []
        self._connections: list[Connection] = []
        self._waiter: asyncio.Future[None] | None = None
        self._taken = 0
        self._entered = False
        """At least once."""
        self._in_use = False
        self._fault: asyncio.Task[None] | None = None
        free = [site for site in Site if site not in {one.site for one in wanted}]
        for one in wanted:
            emitter = Emitter(self._inbox, free.pop(0) if one.site is None else one.site)
            self._connections.append(Connection(one, backend, self._air, emitter, self._connections, pair, patience))
        self._inbox.on_arrival = self._wake

    @property
    def connections(self) -> tuple[Connection, ...]:
        """One for each that is wanted, in that order: site, state, address, name, signal. Read only."""
        return tuple(self._connections)

    async def __aenter__(self) -> Devices:
        if self._in_use:
            raise RuntimeError("these devices are in use already")
        self._in_use = True
        try:
            async with scanner(self._backend, lambda _: None):
                pass
        except BaseException as error:
            self._in_use = False
            if isinstance(error, FAILURES):
                raise BluetoothError(sentence(error)) from error
            raise
        self._entered = True
        lives = [self._air.run(), *(connection.run() for connection in self._connections)]
        self._tasks = [asyncio.create_task(life) for life in lives]
        for task in self._tasks:
            task.add_done_callback(self._ended)
        return self

    async def __aexit__(self, *error: object) -> None:
        for task in self._tasks:
            task.cancel()
        try:
            await asyncio.gather(*self._tasks, return_exceptions=True)
        finally:
            self._tasks, self._fault, self._in_use = [], None, False
            self._wake()

    def __aiter__(self) -> AsyncIterator[Packet]:
        return self

    async def __anext__(self) -> Packet:
        """The next packet; StopAsyncIteration when the devices were left and all is taken. RuntimeError when they were
        never entered.

        A fault of this program in one of the tasks is raised as it is.
        """
        if not self._entered:
            raise RuntimeError("nothing comes of devices before they are entered: async with Devices(...) as devices")
        self._taken += 1
        if self._taken >= IN_A_ROW:
            self._taken = 0
            await asyncio.sleep(0)
        packet = self._next()
        if packet is not None:
            return packet
        if self._waiter is not None:
            raise RuntimeError("somebody else waits for the next packet already")
        loop = asyncio.get_running_loop()
        self._taken, self._waiter = 0, loop.create_future()
        timer = loop.call_later(TICK, self._wake)
        try:
            await self._waiter
        finally:
            timer.cancel()
            self._waiter = None
        return self._next() or Packet(loop.time(), self._connections[0].site, "receiver/tick", b"")

    def _next(self) -> Packet | None:
        """What has arrived; None while there may be more to come."""
        if self._fault is not None:
            self._fault.result()
        packet = self._inbox.take()
        if packet is None and not self._tasks:
            raise StopAsyncIteration
        return packet

    def _wake(self) -> None:
        if self._waiter is not None and not self._waiter.done():
            self._waiter.set_result(None)

    def _ended(self, task: asyncio.Task[None]) -> None:
        """A task of ours never ends by itself, unless it has a fault."""
        if not task.cancelled():
            self._fault = task
        self._wake()

    def _complain(self, what: str) -> None:
        for connection in self._connections:
            if connection.state is ConnectionState.SEEKING:
                connection.emitter.complain(what)
