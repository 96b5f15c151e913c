"""One device for as long as it is wanted: sought, connected, set up, listened to, and sought again when it is lost."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from enum import Enum

from attrs import define, field
from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak_retry_connector import establish_connection

from ..link.decoder import Decoder
from ..link.profile import How, Profile
from ..types import Packet, Site
from ..wire.receiver import LONGEST_NAME, build_connected, build_words
from ..wire.receiver import Connection as Made
from .air import Air, Found
from .backend import Backend
from .inbox import Inbox
from .search import Search, either
from .setup import Unfit, characteristic, lacking, read, site_of, write_setup
from .trouble import FAILURES, sentence
from .wanted import Wanted
from .watchdog import Remedy, Watchdog

ATTEMPTS = 2
"""Times that a device which just advertised is tried to connect to, before it is looked for again."""
PAUSE = 0.25
"""s before the next search after a connection failed; twice as long after each further failure ..."""
LONGEST_PAUSE = 8.0
"""... up to this."""
PARTING = 5.0
"""s that a disconnection may take."""
REPEAT = 60.0
"""s before the same trouble is told again."""


class State(Enum):
    """What a connection is at."""

    SEEKING = "seeking"
    CONNECTING = "connecting"
    SETTING_UP = "setting up"
    LISTENING = "listening"


@define(eq=False)
class Connection:
    """`run` is a task of its own, so no device waits for another. What it learns goes into `inbox` as packets.

    `site`: where packets are said to come from; provisional while a device that says its site was not asked.
    `siblings`: all connections of the same owner, this one too; no two use one device or stand at one site.
    """

    wanted: Wanted
    site: Site
    backend: Backend
    air: Air
    inbox: Inbox
    siblings: Sequence[Connection]
    pair: bool
    patience: float
    state: State = field(default=State.SEEKING, init=False)
    address: str = field(default="", init=False)
    """Of the device, once it is known which it is; from then on no other will do."""
    name: str = field(default="", init=False)
    signal: int | None = field(default=None, init=False)
    """With which it last advertised, dBm."""
    _trying: str = field(default="", init=False)
    """The address in use just now."""
    _unfit: set[str] = field(factory=set, init=False)
    _client: BleakClient | None = field(default=None, init=False)
    _watchdog: Watchdog = field(factory=lambda: Watchdog((), 0.0, 0.0), init=False)
    _told: dict[str, float] = field(factory=dict, init=False)
    """Troubles, and when they were told last."""

    async def run(self) -> None:
        """For ever."""
        pause = PAUSE
        while True:
            self.state = State.SEEKING
            search = Search(self.air, self.wanted, self.address, self._barred, self.patience, self.complain)
            found = await search.run()
            self._trying, self.signal = found.address, found.signal
            try:
                await self._use(found)
                pause = PAUSE
            except (Unfit, *FAILURES) as error:
                if isinstance(error, Unfit):
                    self._unfit.add(found.address)
                self.complain(sentence(error))
                await asyncio.sleep(pause)
                pause = min(2.0 * pause, LONGEST_PAUSE)
            finally:
                self._trying = ""

    def _barred(self, address: str) -> bool:
        """Is the device with this address another's, or known not to be the one?"""
        others = (one for one in self.siblings if one is not self)
        return address in self._unfit or any(address in (one.address, one._trying) for one in others)

    async def _use(self, found: Found) -> None:
        """Connect, listen, and return when the connection is lost. Unfit, FAILURES."""
        profile = self.wanted.profile or found.profile
        name = found.name or found.address
        if profile is None:
            raise Unfit(f"{name} is of no kind that is known here: say its profile")
        self.state = State.CONNECTING
        gone = asyncio.Event()
        client = await establish_connection(
            BleakClient,
            found.device,
            name,
            lambda _: gone.set(),
            max_attempts=ATTEMPTS,
            pair=self.pair,
            backend=self.backend.client,
        )
        if client.is_connected:
            gone.clear()  # it was set if the first attempt was connected, for a moment
        told = False
        try:
            self.state = State.SETTING_UP
            if lacks := lacking(client, profile):
                raise Unfit(f"{name} is no {profile.name}: it has no {lacks}")
            site = await site_of(client, profile) or self.site
            self._settle(site, found, name)
            self._client = client
            self.say("receiver/connected", build_connected(Made(_short(name), found.signal)))
            told = True
            await self._set_up(client, profile)
            await self._listen(client, profile, gone)
        finally:
            self._client = None
            if told:
                self.say("receiver/disconnected")
            with suppress(*FAILURES):
                async with asyncio.timeout(PARTING):
                    await client.disconnect()

    def _settle(self, site: Site, found: Found, name: str) -> None:
        """This device it is. Unfit when it belongs at another site, or one is there already."""
        if self.wanted.site is not None and site is not self.wanted.site:
            raise Unfit(f"{name} is a {site.value.replace('_', ' ')} one: wanted at the {_place(self.wanted.site)}")
        if any(one is not self and one.site is site and one.address for one in self.siblings):
            raise Unfit(f"{name} is one more for the {_place(site)}")
        if site is not self.site:
            for one in self.siblings:  # provisional places are exchanged
                if one.site is site:
                    one.site = self.site
        self.site, self.address, self.name = site, found.address, found.name

    async def _set_up(self, client: BleakClient, profile: Profile) -> None:
        """Read, then subscribe (a value read after that would come twice on BlueZ), then write."""
        self._watchdog = Watchdog((), profile.stale_after, 0.0)
        for name in profile.reads:
            await read(client, profile.channel(name), self.say, self.complain)
        for channel in profile.channels:
            if channel.how is How.NOTIFY and (one := characteristic(client, channel)) is not None:
                await client.start_notify(one, self._hearer(client, channel.name))
        written = await write_setup(client, profile, self.say, self.complain)
        silent = _may_be_silent(self.site, written)
        self._watchdog = Watchdog(() if silent else profile.streams, profile.stale_after, self._now())

    def _hearer(self, client: BleakClient, channel: str) -> Callable[[BleakGATTCharacteristic, bytearray], None]:
        loop = asyncio.get_running_loop()

        def heard(_: BleakGATTCharacteristic, data: bytearray) -> None:
            if self._client is client:
                t = loop.time()
                self._watchdog.heard(channel, t)
                self.inbox.put(Packet(t, self.site, channel, bytes(data), self.address), True)

        return heard

    async def _listen(self, client: BleakClient, profile: Profile, gone: asyncio.Event) -> None:
        self.state = State.LISTENING
        while not gone.is_set():
            due = self._watchdog.due()
            await either(gone, None if due is None else max(0.0, due - self._now()))
            frozen = None if gone.is_set() else self._watchdog.look(self._now())
            if frozen is None:
                continue
            channel, remedy = frozen
            self.say("receiver/restarted", build_words(channel))
            if remedy is Remedy.RECONNECT:
                return
            await write_setup(client, profile, self.say, self.complain)

    # --- what it says ---

    def say(self, channel: str, data: bytes = b"") -> Packet:
        """A packet of what was read, written or became known; not to be dropped."""
        packet = Packet(self._now(), self.site, channel, data, self.address)
        self.inbox.put(packet, False)
        return packet

    def complain(self, what: str) -> None:
        """Tell a trouble; the same one not over and over."""
        now = self._now()
        if now - self._told.get(what, -REPEAT) >= REPEAT:
            self._told = {one: t for one, t in self._told.items() if now - t < REPEAT}
            self._told[what] = now
            self.say("receiver/trouble", build_words(what.encode("utf-8")[:500].decode("utf-8", "ignore")))

    @staticmethod
    def _now() -> float:
        return asyncio.get_running_loop().time()


def _place(site: Site) -> str:
    return site.value.replace("_", " ")


def _short(name: str) -> str:
    return name.encode("utf-8")[:LONGEST_NAME].decode("utf-8", "ignore")


def _may_be_silent(site: Site, written: Sequence[Packet]) -> bool:
    """Does what was written allow the device to send nothing, as with wake-on-motion?"""
    decoder = Decoder(site)
    for packet in written:
        decoder.feed(packet)
    return decoder.link is not None and decoder.link.silence_is_legal
