"""One device for as long as it is wanted: sought, connected, set up, listened to, and sought again when it is lost."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from enum import Enum

from attrs import define, field
from bleak import BleakClient
from bleak.exc import BleakDeviceNotFoundError
from bleak_retry_connector import establish_connection

from ..types import Site
from ..wire.receiver import LONGEST_NAME, build_connected
from ..wire.receiver import ConnectionFrame as Made
from .air import WEAKEST, Backend, Found, Scanner
from .inbox import Emitter, shortened
from .listening import Listening
from .search import FORGET, Search
from .setup import INFO, Unfit, ask_info, lacking, site_in
from .trouble import FAILURES, NO_ANSWER, calling, sentence
from .wanted import DeviceConfig

ATTEMPTS = 2
"""Times that a device which just advertised is tried to connect to, before it is looked for again."""
CONNECTING = 20.0
"""s that all of this may take, so that a device which left meanwhile is soon looked for again."""
PAUSE = 0.25
"""s before the next search after a link that broke soon, and after a connection failed, that is, brought nothing of a
stream; twice as long after each further failure ..."""
LONGEST_PAUSE = 8.0
"""... up to this."""
STEADY = 1.0
"""s of listening after which a link that is lost is sought again at once."""
PARTING = 5.0
"""s that a disconnection may take."""
RECONSIDER = 60.0
"""s after which a device that was not the one is looked at again: it may have been set to rights."""


class ConnectionState(Enum):
    """What a connection is at: it waits for the device's advertisement, connects to it, reads, subscribes and writes
    what the profile says, or passes on what comes."""

    SEEKING = "seeking"
    CONNECTING = "connecting"
    SETTING_UP = "setting up"
    LISTENING = "listening"


@define(eq=False)
class Connection:
    """One wanted device, as `Devices` has it; for an app to look at: `wanted`, `site`, `state`, `signal`, and `address`
    and `name`, "" as long as they are not known. None of it raises; troubles become packets, and LinkTrouble of those.

    `run` is a task of its own, so no device waits for another. What it learns it says with its `emitter`. `pair`: pair
    when connected. `patience`: s until a device that is not heard is complained of.
    `siblings`: all connections of the same owner, this one too; no two use one device or stand at one site.
    """

    wanted: DeviceConfig
    backend: Backend
    air: Scanner
    emitter: Emitter
    siblings: Sequence[Connection]
    pair: bool
    patience: float
    state: ConnectionState = field(default=ConnectionState.SEEKING, init=False)
    name: str = field(default="", init=False)
    signal: int | None = field(default=None, init=False)
    """With which it last advertised, dBm; None when nobody knows."""
    _trying: str = field(default="", init=False)
    """The address in use just now."""
    _since: float = field(default=0.0, init=False)
    """When it began to listen, s."""
    _lacking_since: float = field(default=0.0, init=False)
    """From when on nothing of a stream was heard, however often it was tried, s."""
    _streamed: bool = field(default=False, init=False)
    """Something of a stream came in the connection that is made, or was last."""
    _unfit: dict[str, float] = field(factory=dict, init=False)
    """Addresses that were not the one, and when that was seen."""

    @property
    def site(self) -> Site:
        """Where packets are said to come from; provisional while a device that says its site was not asked."""
        return self.emitter.site

    @property
    def address(self) -> str:
        """Of the device, once it is known which it is; from then on no other will do."""
        return self.emitter.address

    async def run(self) -> None:
        """For ever."""
        pause, self._lacking_since = PAUSE, _now()
        while True:
            since, complain = self._lacking_since, self.emitter.complain
            search = Search(self.air, self.wanted, self.address, self._barred, self.patience, since, complain)
            found = await search.run()
            self._trying, self.signal = found.address, found.signal if found.signal > WEAKEST else None
            self._streamed = False
            try:
                await self._use(found)
            except Unfit as error:
                self._unfit[found.address] = _now()
                self.emitter.complain(str(error))
            except FAILURES as error:
                self.emitter.complain(sentence(error))
            finally:
                steady = self._streamed and self.state is ConnectionState.LISTENING and _now() - self._since >= STEADY
                self._trying, self.state = "", ConnectionState.SEEKING
            if self._streamed:
                pause, self._lacking_since = PAUSE, _now()
            if not steady:
                await asyncio.sleep(pause)
            if not self._streamed:
                pause = min(2.0 * pause, LONGEST_PAUSE)

    def _barred(self, found: Found) -> bool:
        """Is it another's, or known not to be the one?"""
        self._unfit = {address: t for address, t in self._unfit.items() if _now() - t < RECONSIDER}
        others = (one for one in self.siblings if one is not self)
        return found.address in self._unfit or any(one._claims(found) for one in others)

    def _claims(self, found: Found) -> bool:
        if self.address or self._trying:
            return found.address in (self.address, self._trying)
        return self.wanted.names(found.address, found.name)

    async def _use(self, found: Found) -> None:
        """Connect, listen, and return when the connection is lost. Unfit, FAILURES."""
        profile = self.wanted.profile or found.profile
        name = found.name or found.address
        if profile is None:
            raise Unfit(f"{name} is of no kind that is known here: say its profile")
        self.state = ConnectionState.CONNECTING
        gone = asyncio.Event()
        client = await self._connect(found, name, gone)
        try:
            self.state = ConnectionState.SETTING_UP
            if lacks := lacking(client, profile):
                raise Unfit(f"{name} is no {profile.name}: it has no {lacks}")
            info = await ask_info(client, profile)
            self._settle(None if info is None else site_in(info, name), found, name)
            listening = Listening(client, profile, self.emitter, gone, {} if info is None else {INFO: info})
            self.emitter.say("receiver/connected", build_connected(Made(shortened(name, LONGEST_NAME), self.signal)))
            try:
                await listening.set_up()
                self.state, self._since = ConnectionState.LISTENING, _now()
                await listening.run()
            finally:
                listening.closed, self._streamed = True, listening.streamed
                self.emitter.say("receiver/disconnected")
        finally:
            with suppress(*FAILURES):
                async with calling(PARTING):
                    await client.disconnect()

    async def _connect(self, found: Found, name: str, gone: asyncio.Event) -> BleakClient:
        """`gone` is set when the connection is lost. FAILURES."""
        loop = asyncio.get_running_loop()
        late = max(self._lacking_since + self.patience, _now() + min(FORGET, self.patience))
        telling = loop.call_at(late, self.emitter.complain, NO_ANSWER)
        try:
            async with calling(CONNECTING):
                client = await establish_connection(
                    BleakClient,
                    found.device,
                    name,
                    lambda _: gone.set(),
                    max_attempts=ATTEMPTS,
                    pair=self.pair,
                    backend=self.backend.client,
                )
        except TimeoutError as error:
            raise BleakDeviceNotFoundError(found.address) from error
        finally:
            telling.cancel()
        if client.is_connected:
            gone.clear()  # it was set if the first attempt was connected, for a moment
        return client

    def _settle(self, said: Site | None, found: Found, name: str) -> None:
        """This device it is, `said` being where it says that it is worn. Unfit when that is not where it is wanted."""
        site, wanted = said or self.wanted.site, self.wanted.site
        if site is None:
            raise Unfit(f"{name} does not say where it is worn: name a site")
        if wanted is not None and site is not wanted:
            raise Unfit(f"{name} is a {_place(site)} one: wanted at the {_place(wanted)}")
        there = [one for one in self.siblings if one is not self and one.site is site]
        if any(one.address or one.wanted.site is not None for one in there):
            raise Unfit(f"{name} is one more for the {_place(site)}")
        for one in there:  # provisional places are exchanged
            one.emitter.site = self.site
        self.emitter.site, self.emitter.address, self.name = site, found.address, found.name


def _now() -> float:
    return asyncio.get_running_loop().time()


def _place(site: Site) -> str:
    return site.value.replace("_", " ")
