"""Handling of one established connection: set up, pass notifications on, and detect frozen streams."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress

from attrs import define, field
from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic

from ..link.decoder import Decoder
from ..link.profile import Profile
from ..types import Packet, Site
from ..wire.fields import build_text
from .inbox import Emitter
from .setup import read, subscribe, write_setup
from .watchdog import Remedy, Watchdog

MIN_CHECK_INTERVAL = 0.01
"""Shortest interval between two checks, s: rounding of the loop's clock must not make it zero."""


@define(eq=False)
class Listening:
    """The handler of one established connection; it passes notifications on.

    `disconnected` is set when the connection is lost. `known` holds values that were read already, by channel.
    `streamed` is True once stream data arrived. `closed` is True when further notifications are not passed on."""

    client: BleakClient
    profile: Profile
    emitter: Emitter
    disconnected: asyncio.Event
    known: dict[str, bytes] = field(factory=dict)
    streamed: bool = field(default=False, init=False)
    closed: bool = field(default=False, init=False)
    _watchdog: Watchdog = field(factory=lambda: Watchdog((), 0.0, 0.0), init=False)

    async def set_up(self) -> None:
        """Read, then subscribe, then write. Raises FAILURES.

        A value that is read after subscribing would arrive twice on BlueZ."""
        for name in self.profile.reads:
            if name in self.known:
                self.emitter.emit(name, self.known[name])
                continue
            await read(self.client, self.profile.channel(name), self.emitter)
        await subscribe(self.client, self.profile, self._make_callback, self.emitter)
        written = await write_setup(self.client, self.profile, self.emitter)
        streams = () if may_be_silent(self.emitter.site, written) else self.profile.streams
        self._watchdog = Watchdog(streams, self.profile.stale_after, asyncio.get_running_loop().time())

    async def run(self) -> None:
        """Check the streams until the connection is lost, or a frozen stream requires a new one. Raises FAILURES."""
        now = asyncio.get_running_loop().time
        while not self.disconnected.is_set():
            next_check_at = self._watchdog.next_check_at()
            with suppress(TimeoutError):
                async with asyncio.timeout(
                    None if next_check_at is None else max(MIN_CHECK_INTERVAL, next_check_at - now())
                ):
                    await self.disconnected.wait()
            frozen_stream = None if self.disconnected.is_set() else self._watchdog.check(now())
            if frozen_stream is None:
                continue
            channel, remedy = frozen_stream
            self.emitter.emit("receiver/restarted", build_text(channel))
            if remedy is Remedy.RECONNECT:
                return
            await write_setup(self.client, self.profile, self.emitter)

    def _make_callback(self, channel: str) -> Callable[[BleakGATTCharacteristic, bytearray], None]:
        is_stream = channel in self.profile.streams

        def callback(_: BleakGATTCharacteristic, data: bytearray) -> None:
            if not self.closed:
                self.streamed = self.streamed or is_stream
                self._watchdog.add_notification(channel, self.emitter.emit_notification(channel, bytes(data)))

        return callback


def may_be_silent(site: Site, written: Sequence[Packet]) -> bool:
    """Return whether the written setup allows the device to send nothing, as with wake-on-motion."""
    decoder = Decoder(site)
    for packet in written:
        decoder.feed(packet)
    return decoder.link is not None and decoder.link.may_be_silent
