"""A virtual central: a bumble Device that scanners and clients share, opened when it is first needed.

A controller makes one connection at a time. An attempt to connect to a device that does not answer occupies the
controller for ATTEMPT_TIMEOUT s. Then it lets other attempts go first, and is repeated until its caller gives up."""

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
"""Time for which one attempt to connect may occupy the controller, s; devices advertise about every 0.1 s."""
CONTROLLER_TIMEOUT = 5.0
"""Time that a controller may take to do what is requested, except to connect, s."""
RETRY_INTERVAL = 1.0
"""Time between attempts to reach a lost controller again during a scan, s."""

ScanListener = Callable[[Advertisement], None]
"""Callback for each received advertisement."""


class VirtualRadio:
    """A central behind an HCI transport.

    `reach` opens the transport and raises OSError when there is none; the next scan or connection after a loss calls it
    again. `where` is the name of the transport in messages. `mtu` is the ATT MTU that the central requests, bytes."""

    def __init__(self, reach: Callable[[], Awaitable[Transport]], where: str, mtu: int) -> None:
        self.mtu = mtu
        self.where = where
        self.keys = MemoryKeyStore()
        """Keys of the paired devices, by address."""
        self._reach = reach
        self._address = hci.Address.generate_static_address()
        self._device: Device | None = None
        self._transport: Transport | None = None
        self._listeners: list[ScanListener] = []
        self._opening_lock = asyncio.Lock()
        self._connecting_lock = asyncio.Lock()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._closed = False

    async def device(self) -> Device:
        """Return the started Device; raise a BleakError that names `where` when it cannot be reached."""
        async with self._opening_lock:
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
        except ConnectionRefusedError as error:
            raise BleakError(f"nothing answers at {self.where}") from error
        except OSError as error:
            raise BleakError(f"{self.where} cannot be reached: {error.strerror or error}") from error
        config = DeviceConfiguration(name="solepath", address=self._address, gatt_service_enabled=False)
        device = Device(config=config, host=Host(transport.source, transport.sink))
        device.keystore = self.keys
        enable_just_works(device, lambda: False)  # a central starts pairings and accepts none
        try:
            async with asyncio.timeout(CONTROLLER_TIMEOUT):
                await device.power_on()
        except BaseException as error:
            await transport.close()
            if isinstance(error, Exception):  # bumble does not check a controller's answers: any exception may come
                raise BleakError(f"no Bluetooth controller answers at {self.where}") from error
            raise
        device.on(Device.EVENT_ADVERTISEMENT, self._on_advertisement)
        self._device, self._transport = device, transport
        transport.source.terminated.add_done_callback(lambda _: self._lost(device))
        if self._listeners:
            await self._scan(device, True)

    def _lost(self, device: Device) -> None:
        """Handle the loss of the transport.

        bumble has already reported the loss to every link. Tasks that wait for the controller would wait for ever, so
        they are cancelled. Scans continue as soon as the controller can be reached again."""
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

    async def add_listener(self, listener: ScanListener) -> None:
        """Call `listener` for every advertisement from now on; raise BleakError when the scan cannot start."""
        device = await self.device()
        self._listeners.append(listener)
        if len(self._listeners) == 1:
            try:
                await self._scan(device, True)
            except BaseException:
                self._listeners.remove(listener)
                raise

    async def remove_listener(self, listener: ScanListener) -> None:
        """Stop calling `listener`."""
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
            self._lost(device)  # the next attempt opens the transport again
            if transport is not None:
                await transport.close()
            raise BleakError(f"{self.where} does not answer any more") from None
        except core.BaseBumbleError as error:
            raise BleakError(f"{self.where}: {error}") from error

    def _on_advertisement(self, advertisement: Advertisement) -> None:
        for listener in list(self._listeners):
            listener(advertisement)

    async def connect(self, peer: hci.Address) -> Connection:
        """Return a link to the device of this address; try until cancelled.

        A controller that fails, or a link that is lost as soon as it is made, raises BleakError."""
        while True:
            device = await self.device()
            async with self._connecting_lock:
                attempt = self.task(device.connect(peer, timeout=ATTEMPT_TIMEOUT))
                try:
                    link = await asyncio.shield(attempt)
                    if not is_up(link):
                        raise BleakError(f"the link to {peer.to_string(False)} was lost as soon as it was made")
                    return link
                except core.TimeoutError:
                    pass  # no answer: let another attempt use the controller
                except core.BaseBumbleError as error:
                    raise BleakError(f"no connection to {peer.to_string(False)}: {error}") from error
                except asyncio.CancelledError:
                    if attempt.cancelled() and not _cancelled():
                        raise BleakError(f"{self.where}: the connection to the controller was lost") from None
                    await self._cancel_attempt(device, attempt)
                    raise

    async def _cancel_attempt(self, device: Device, attempt: asyncio.Task[Connection]) -> None:
        """End an attempt whose caller has given up, so that no request and no link without an owner stays."""
        try:
            async with asyncio.timeout(CONTROLLER_TIMEOUT):
                if not attempt.done():
                    await device.cancel_connection()  # type: ignore[no-untyped-call]
                link = await attempt
                await link.disconnect()
        except (TimeoutError, core.BaseBumbleError, asyncio.CancelledError):
            attempt.cancel()

    def task(self, work: Coroutine[Any, Any, _T]) -> asyncio.Task[_T]:
        """Start a task that ends when the radio closes."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._forget_task)
        return task

    def _forget_task(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled():
            task.exception()  # marks the exception as retrieved, for the case that no caller waits any more

    async def finish(self, work: Coroutine[Any, Any, _T]) -> _T:
        """Run an exchange with the controller or a device to its end, even when the caller gives up.

        Otherwise a late answer would be taken for the answer to the next request. An exchange that ends because the
        link ends raises BleakError."""
        task = self.task(work)
        try:
            return await asyncio.shield(task)
        except asyncio.CancelledError:
            if task.cancelled() and not _cancelled():
                raise BleakError("the link was lost") from None
            raise

    async def close(self) -> None:
        """End every link and the transport."""
        self._closed = True
        self._listeners.clear()
        device, self._device = self._device, None
        if device is not None:
            for link in list(device.connections.values()):
                await end_link(link)
            with suppress(TimeoutError):
                async with asyncio.timeout(CONTROLLER_TIMEOUT):
                    await device.power_off()
            device.host.ready = False  # ignore packets still in flight: no task waits for them
        tasks = list(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        if self._transport is not None:
            await self._transport.close()
            self._transport = None


def is_up(link: Connection) -> bool:
    """Return whether the link is up.

    A link that fails to be established may end before a listener can be attached."""
    return link.device.connections.get(link.handle) is link


async def end_link(link: Connection) -> None:
    """Disconnect; return when both sides have confirmed it, or when the link has ended in any other way."""
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
    """Return whether the running task itself is cancelled, not only the task that it waits for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


_KEYS = PairingDelegate.KeyDistribution.DISTRIBUTE_ENCRYPTION_KEY
"""Keys that a pairing exchanges; identities are not needed, because the addresses are static."""


class PairingConsent(PairingDelegate):
    """A pairing delegate; `accepts()` decides whether to accept a pairing that the other side starts."""

    def __init__(self, accepts: Callable[[], bool]) -> None:
        super().__init__(local_initiator_key_distribution=_KEYS, local_responder_key_distribution=_KEYS)
        self._accepts = accepts

    async def accept(self) -> bool:
        return self._accepts()


def enable_just_works(device: Device, accepts: Callable[[], bool]) -> None:
    """Let the device pair by LE Secure Connections, Just Works, and keep the keys (bonding); see PairingConsent."""
    pairing_consent = PairingConsent(accepts)

    def config(link: Connection) -> PairingConfig:
        return PairingConfig(sc=True, mitm=False, bonding=True, delegate=pairing_consent)

    device.pairing_config_factory = config
