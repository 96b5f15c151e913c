"""One virtual central: a bumble Device that scanners and clients share, opened when it is first needed.

A controller makes one connection at a time. Whoever waits for a device that does not answer has its turn for a few
seconds, gives way to the others and comes again, until its own time is up.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from typing import Any, TypeVar

from bleak.exc import BleakError
from bumble import core, hci
from bumble.device import Advertisement, Connection, Device, DeviceConfiguration
from bumble.host import Host
from bumble.keys import MemoryKeyStore
from bumble.pairing import PairingConfig, PairingDelegate
from bumble.transport.common import Transport

_T = TypeVar("_T")

ATTEMPT_TIMEOUT = 2.0
"""s that one attempt to connect may hold the controller; devices advertise about every 0.1 s."""
CONTROLLER_TIMEOUT = 5.0
"""s that a controller may take to be started or to end a link."""
RETRY_INTERVAL = 1.0
"""s between attempts to reach a lost controller again while somebody scans."""

ScanListener = Callable[[Advertisement], None]
"""Called for each advertisement that is heard."""


class VirtualRadio:
    """A central behind an HCI transport.

    `reach` opens the transport and raises OSError when there is none; after it was lost it is asked again as soon as
    somebody scans or connects. `where` is for messages. `address`: the central's own, static random; None: any.
    `mtu`: the ATT MTU that it asks for.
    """

    def __init__(
        self, reach: Callable[[], Awaitable[Transport]], where: str, mtu: int, address: str | None = None
    ) -> None:
        self.mtu = mtu
        self.where = where
        self.keys = MemoryKeyStore()
        """Of the devices that were paired with, by address."""
        self._reach = reach
        self._address = hci.Address(address) if address else hci.Address.generate_static_address()
        self._device: Device | None = None
        self._transport: Transport | None = None
        self._listeners: list[ScanListener] = []
        self._opening = asyncio.Lock()
        self._connecting = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._closed = False

    async def device(self) -> Device:
        """The Device, started. BleakError naming `where` when it cannot be reached."""
        async with self._opening:
            if self._device is None:
                await self._open()
            if self._device is None:
                raise BleakError(f"{self.where}: the connection to the controller was lost")
            return self._device

    async def _open(self) -> None:
        if self._closed:
            raise BleakError(f"{self.where} is closed")
        try:
            transport = await self._reach()
        except OSError as error:
            raise BleakError(f"nothing answers at {self.where}: {error.strerror or error}") from error
        config = DeviceConfiguration(name="solepath", address=self._address, gatt_service_enabled=False)
        device = Device(config=config, host=Host(transport.source, transport.sink))
        device.keystore = self.keys
        just_works(device, lambda: False)  # a central begins pairings, and answers none
        try:
            async with asyncio.timeout(CONTROLLER_TIMEOUT):
                await device.power_on()
        except BaseException as error:
            await transport.close()
            if isinstance(error, Exception):  # bumble trusts controllers, and raises whatever comes of their answers
                raise BleakError(f"no Bluetooth controller answers at {self.where}") from error
            raise
        device.on(Device.EVENT_ADVERTISEMENT, self._on_advertisement)
        self._device, self._transport = device, transport
        transport.source.terminated.add_done_callback(lambda _: self._lost(device))
        if self._listeners:
            await self._scan(device, True)

    def _lost(self, device: Device) -> None:
        """The transport broke: bumble has told every link already, but what waits for the controller would wait for
        ever. Whoever scans goes on as soon as it is back."""
        if self._device is device:
            self._device = self._transport = None
            for task in self._tasks:
                task.cancel()
            if self._listeners and not self._closed:
                self.task(self._reopen())

    async def _reopen(self) -> None:
        while self._listeners and not self._closed:
            try:
                await self.device()
            except BleakError:
                await asyncio.sleep(RETRY_INTERVAL)
            else:
                return

    async def listen(self, listener: ScanListener) -> None:
        """From now on `listener` hears what is advertised. BleakError."""
        device = await self.device()
        self._listeners.append(listener)
        if len(self._listeners) == 1:
            try:
                await self._scan(device, True)
            except BaseException:
                self._listeners.remove(listener)
                raise

    async def ignore(self, listener: ScanListener) -> None:
        """Undoes listen."""
        if listener in self._listeners:
            self._listeners.remove(listener)
            if not self._listeners and self._device is not None:
                with suppress(BleakError):
                    await self._scan(self._device, False)

    async def _scan(self, device: Device, on: bool) -> None:
        try:
            async with asyncio.timeout(CONTROLLER_TIMEOUT):
                await self.finish(device.start_scanning(legacy=True) if on else device.stop_scanning(legacy=True))
        except TimeoutError:
            transport = self._transport
            self._lost(device)  # the next attempt reaches for it anew
            if transport is not None:
                await transport.close()
            raise BleakError(f"{self.where} does not answer any more") from None
        except core.BaseBumbleError as error:
            raise BleakError(f"{self.where}: {error}") from error

    def _on_advertisement(self, advertisement: Advertisement) -> None:
        for listener in list(self._listeners):
            listener(advertisement)

    async def connect(self, peer: hci.Address) -> Connection:
        """A link to the device of this address. Tries until it is cancelled; BleakError."""
        while True:
            device = await self.device()
            async with self._connecting:
                attempt = self.task(device.connect(peer, timeout=ATTEMPT_TIMEOUT))
                try:
                    link = await asyncio.shield(attempt)
                    if not is_up(link):
                        raise BleakError(f"the link to {peer.to_string(False)} was lost as soon as it was made")
                    return link
                except core.TimeoutError:
                    pass  # nobody answered: the next one's turn
                except core.BaseBumbleError as error:
                    raise BleakError(f"no connection to {peer.to_string(False)}: {error}") from error
                except asyncio.CancelledError:
                    if attempt.cancelled() and not _cancelled():
                        raise BleakError(f"{self.where}: the connection to the controller was lost") from None
                    await self._cancel_attempt(device, attempt)
                    raise

    async def _cancel_attempt(self, device: Device, attempt: asyncio.Task[Connection]) -> None:
        """The caller gave up: neither a request nor a link without an owner may stay behind."""
        try:
            async with asyncio.timeout(CONTROLLER_TIMEOUT):
                if not attempt.done():
                    await device.cancel_connection()  # type: ignore[no-untyped-call]
                link = await attempt
                await link.disconnect()
        except (TimeoutError, core.BaseBumbleError, asyncio.CancelledError):
            attempt.cancel()

    def task(self, work: Coroutine[Any, Any, _T]) -> asyncio.Task[_T]:
        """Work that must be ended when the radio closes."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._done)
        return task

    def _done(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled():
            task.exception()  # whoever waited for it has it; when nobody does any more it matters to nobody

    async def finish(self, work: Coroutine[Any, Any, _T]) -> _T:
        """Runs an exchange with the controller or a device to its end even when the caller gives up: a request that is
        abandoned halfway would have its answer taken for that of the next. BleakError when the link ended it."""
        task = self.task(work)
        try:
            return await asyncio.shield(task)
        except asyncio.CancelledError:
            if task.cancelled() and not _cancelled():
                raise BleakError("the link was lost") from None
            raise

    async def close(self) -> None:
        """Ends every link and the transport."""
        self._closed = True
        self._listeners.clear()
        device, self._device = self._device, None
        if device is not None:
            for link in list(device.connections.values()):
                await end_link(link)
            with suppress(TimeoutError):
                async with asyncio.timeout(CONTROLLER_TIMEOUT):
                    await device.power_off()
            device.host.ready = False  # deaf to what is still in flight: nobody waits for it any more
        tasks = list(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        if self._transport is not None:
            await self._transport.close()
            self._transport = None


def is_up(link: Connection) -> bool:
    """Whether it is a link still. One that fails to be established may be over before anybody could listen for it."""
    return link.device.connections.get(link.handle) is link


async def end_link(link: Connection) -> None:
    """Disconnects; returns when both ends know, or when the link is gone anyhow."""
    if not is_up(link):
        return
    try:
        async with asyncio.timeout(CONTROLLER_TIMEOUT):
            await link.disconnect()
    except (TimeoutError, core.BaseBumbleError):
        pass
    except asyncio.CancelledError:
        if _cancelled():
            raise


def _cancelled() -> bool:
    """Whether it is the running task that is cancelled, and not what it waits for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


_KEYS = PairingDelegate.KeyDistribution.DISTRIBUTE_ENCRYPTION_KEY
"""No identities are exchanged: the addresses are static."""


class PairingConsent(PairingDelegate):
    """`agrees` is asked whether a pairing that the other end begins is welcome."""

    def __init__(self, agrees: Callable[[], bool]) -> None:
        super().__init__(local_initiator_key_distribution=_KEYS, local_responder_key_distribution=_KEYS)
        self._agrees = agrees

    async def accept(self) -> bool:
        return self._agrees()


def just_works(device: Device, agrees: Callable[[], bool]) -> None:
    """From now on the device pairs by LE Secure Connections, Just Works, and the keys are kept (bonding), if `agrees`
    says so when the other end begins."""
    pairing_consent = PairingConsent(agrees)

    def config(link: Connection) -> PairingConfig:
        return PairingConfig(sc=True, mitm=False, bonding=True, delegate=pairing_consent)

    device.pairing_config_factory = config
