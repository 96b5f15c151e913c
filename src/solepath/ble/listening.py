"""One connection while it stands: set up, listened to, and watched."""

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

SHORTEST = 0.01
"""s from one look to the next, so that no rounding of a loop's clock makes them follow each other at once."""


@define(eq=False)
class Listening:
    """`gone`: set when the connection is lost. `known`: values by channel that were read from it already.

    `streamed`: something came on one of the streams. `closed`: whatever comes after that is not passed on.
    """

    client: BleakClient
    profile: Profile
    emitter: Emitter
    gone: asyncio.Event
    known: dict[str, bytes] = field(factory=dict)
    streamed: bool = field(default=False, init=False)
    closed: bool = field(default=False, init=False)
    _watchdog: Watchdog = field(factory=lambda: Watchdog((), 0.0, 0.0), init=False)

    async def set_up(self) -> None:
        """Read, then subscribe (a value read after that would come twice on BlueZ), then write. FAILURES."""
        for name in self.profile.reads:
            if name in self.known:
                self.emitter.say(name, self.known[name])
                continue
            await read(self.client, self.profile.channel(name), self.emitter)
        await subscribe(self.client, self.profile, self._hearer, self.emitter)
        written = await write_setup(self.client, self.profile, self.emitter)
        streams = () if may_be_silent(self.emitter.site, written) else self.profile.streams
        self._watchdog = Watchdog(streams, self.profile.stale_after, asyncio.get_running_loop().time())

    async def run(self) -> None:
        """Until the connection is lost, or worth nothing any more. FAILURES."""
        now = asyncio.get_running_loop().time
        while not self.gone.is_set():
            due = self._watchdog.due()
            with suppress(TimeoutError):
                async with asyncio.timeout(None if due is None else max(SHORTEST, due - now())):
                    await self.gone.wait()
            frozen = None if self.gone.is_set() else self._watchdog.look(now())
            if frozen is None:
                continue
            channel, remedy = frozen
            self.emitter.say("receiver/restarted", build_text(channel))
            if remedy is Remedy.RECONNECT:
                return
            await write_setup(self.client, self.profile, self.emitter)

    def _hearer(self, channel: str) -> Callable[[BleakGATTCharacteristic, bytearray], None]:
        streams = channel in self.profile.streams

        def heard(_: BleakGATTCharacteristic, data: bytearray) -> None:
            if not self.closed:
                self.streamed = self.streamed or streams
                self._watchdog.heard(channel, self.emitter.pass_on(channel, bytes(data)))

        return heard


def may_be_silent(site: Site, written: Sequence[Packet]) -> bool:
    """Does what was written allow the device to send nothing, as with wake-on-motion?"""
    decoder = Decoder(site)
    for packet in written:
        decoder.feed(packet)
    return decoder.link is not None and decoder.link.may_be_silent
