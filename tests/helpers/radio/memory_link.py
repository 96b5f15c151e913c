"""A connection to an emulated device in the same process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

from bleak.backends.client import NotifyCallback
from bleak.exc import BleakError, BleakGATTProtocolError

from solepath.emulate.devices.attributes import AttError, Outgoing
from solepath.emulate.devices.peripheral import Peripheral

T = TypeVar("T")


class LoopbackLink:
    """A connection that delivers requests one after the other, and notifications when they are due."""

    def __init__(self, device: Peripheral, mtu: int, round_trip: float, on_lost: Callable[[], None]) -> None:
        self.mtu = mtu
        self.callbacks: dict[str, NotifyCallback] = {}
        self._device, self._round_trip, self._on_lost = device, round_trip, on_lost
        self._loop = asyncio.get_running_loop()
        self._closed = self._loop.create_future()
        self._request_lock = asyncio.Lock()
        self._timer: asyncio.TimerHandle | None = None
        device.on_change = self._schedule
        device.connected(self._loop.time(), mtu)

    @property
    def is_up(self) -> bool:
        return not self._closed.done()

    async def request(self, do: Callable[[float], T | None]) -> T:
        """Return the device's answer; raise BleakGATTProtocolError when it rejects, BleakError when the link ends."""
        async with self._request_lock:
            await asyncio.wait([self._closed], timeout=self._round_trip)
            if self.is_up:
                try:
                    answer = do(self._loop.time())
                except AttError as error:
                    raise BleakGATTProtocolError(error.code) from None
                if answer is not None:
                    return answer
                await asyncio.wait([self._closed])
            raise BleakError("disconnected")

    def command(self, do: Callable[[float], object]) -> None:
        """Write without response; errors are not reported."""
        if self.is_up:
            try:
                do(self._loop.time())
            except AttError:
                return

    def lose(self) -> None:
        """End the link."""
        if not self.is_up:
            return
        self._closed.set_result(None)
        if self._timer is not None:
            self._timer.cancel()
        self._device.on_change = None
        self._device.disconnected(self._loop.time())
        self._on_lost()

    def _schedule(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        due = self._device.next_due()
        self._timer = None if due is None else self._loop.call_at(due, self._wake)

    def _wake(self) -> None:
        now = self._loop.time()
        for outgoing in self._device.poll(now):
            if self.is_up:
                self._notify(outgoing)
        if not self.is_up:
            return
        if self._device.must_hang_up(now):
            self.lose()
        else:
            self._schedule()

    def _notify(self, outgoing: Outgoing) -> None:
        callback = self.callbacks.get(outgoing.channel)
        if callback is None:
            return
        try:
            callback(bytearray(outgoing.value[: self.mtu - 3]))
        except Exception as error:  # raised by the host; the next notification is delivered all the same
            self._loop.call_exception_handler({"message": "a notification's callback failed", "exception": error})
