"""Connection to one configured device: search, connect, set up, listen, and search again when it is lost."""

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
from ..wire.receiver import MAX_NAME_SIZE, ConnectionFrame, build_connected
from .config import DeviceConfig
from .inbox import Emitter, shorten
from .listening import Listening
from .scanning import WEAKEST_SIGNAL, Advertisement, Backend, Scanner
from .search import PRESENCE_TIME, Search
from .setup import INFO_CHANNEL, WrongDevice, find_missing_stream, parse_site, read_info
from .trouble import FAILURES, NO_ANSWER, bleak_call, describe_error

MAX_ATTEMPTS = 2
"""Largest number of attempts to connect to a device that has just advertised, before the search starts again."""
CONNECT_TIMEOUT = 20.0
"""Time limit for all attempts to connect, s, so that the search for a device that left starts again soon."""
SEARCH_DELAY = 0.25
"""Delay before the next search after a connection that ended soon or brought no stream data, s.

The delay doubles after each further connection that brought no stream data."""
MAX_SEARCH_DELAY = 8.0
"""Upper limit of the delay before the next search, s."""
STABLE_TIME = 1.0
"""Time of listening after which a lost device is searched for again without delay, s."""
DISCONNECT_TIMEOUT = 5.0
"""Time limit of a disconnection, s."""
RECHECK_TIME = 60.0
"""Time after which a wrong device is tried again, s: its owner may have corrected it."""


class ConnectionState(Enum):
    """State of a connection.

    SEEKING waits for the device's advertisement, CONNECTING connects, SETTING_UP reads, subscribes and writes as the
    profile says, and LISTENING passes packets on."""

    SEEKING = "seeking"
    CONNECTING = "connecting"
    SETTING_UP = "setting up"
    LISTENING = "listening"


@define(eq=False)
class Connection:
    """The connection of one configured device, as `Devices` holds it.

    An app may read `config`, `site`, `state`, `signal`, `address` and `name`; the last two are "" until they are known.
    `run` raises no Bluetooth failure: each becomes a packet, which the session turns into LinkTrouble.

    Every connection runs in its own task, so no device waits for another. It reports through `emitter`. `pair` requests
    pairing when connected. `patience` is the time until a device that does not advertise is reported, s. `siblings` are
    all connections of the Devices, this one included; no two of them use the same device or the same site."""

    config: DeviceConfig
    backend: Backend
    scanner: Scanner
    emitter: Emitter
    siblings: Sequence[Connection]
    pair: bool
    patience: float
    state: ConnectionState = field(default=ConnectionState.SEEKING, init=False)
    name: str = field(default="", init=False)
    signal: int | None = field(default=None, init=False)
    """Signal strength of the last advertisement, dBm; None when unknown."""
    _current_address: str = field(default="", init=False)
    """Address of the device that is in use now; "" for none."""
    _listening_since: float = field(default=0.0, init=False)
    """Start of listening, s."""
    _no_stream_since: float = field(default=0.0, init=False)
    """Start of the time without any stream data, over all attempts, s."""
    _streamed: bool = field(default=False, init=False)
    """True if the current or last connection brought stream data."""
    _wrong_since: dict[str, float] = field(factory=dict, init=False)
    """Time at which each wrong device was detected, s, by its address."""

    @property
    def site(self) -> Site:
        """Site of the packets; provisional until a device that reports its own site was read."""
        return self.emitter.site

    @property
    def address(self) -> str:
        """Address of the device, "" until it is known; from then on no other device is accepted."""
        return self.emitter.address

    async def run(self) -> None:
        """Keep the device connected; never returns."""
        pause, self._no_stream_since = SEARCH_DELAY, _now()
        while True:
            silent_since, report_trouble = self._no_stream_since, self.emitter.report_trouble
            search = Search(
                self.scanner, self.config, self.address, self._is_excluded, self.patience, silent_since, report_trouble
            )
            found = await search.run()
            self._current_address, self.signal = found.address, found.signal if found.signal > WEAKEST_SIGNAL else None
            self._streamed = False
            try:
                await self._use(found)
            except WrongDevice as error:
                self._wrong_since[found.address] = _now()
                self.emitter.report_trouble(str(error))
            except FAILURES as error:
                self.emitter.report_trouble(describe_error(error))
            finally:
                stable = (
                    self._streamed
                    and self.state is ConnectionState.LISTENING
                    and _now() - self._listening_since >= STABLE_TIME
                )
                self._current_address, self.state = "", ConnectionState.SEEKING
            if self._streamed:
                pause, self._no_stream_since = SEARCH_DELAY, _now()
            if not stable:
                await asyncio.sleep(pause)
            if not self._streamed:
                pause = min(2.0 * pause, MAX_SEARCH_DELAY)

    def _is_excluded(self, found: Advertisement) -> bool:
        """Return whether the device belongs to another connection or is known to be wrong."""
        self._wrong_since = {address: t for address, t in self._wrong_since.items() if _now() - t < RECHECK_TIME}
        other_connections = (connection for connection in self.siblings if connection is not self)
        return found.address in self._wrong_since or any(connection._claims(found) for connection in other_connections)

    def _claims(self, found: Advertisement) -> bool:
        if self.address or self._current_address:
            return found.address in (self.address, self._current_address)
        return self.config.is_named(found.address, found.name)

    async def _use(self, found: Advertisement) -> None:
        """Connect and listen until the connection is lost. Raises WrongDevice and FAILURES."""
        profile = self.config.profile or found.profile
        name = found.name or found.address
        if profile is None:
            raise WrongDevice(f"{name} is of no kind that is known here: say its profile")
        self.state = ConnectionState.CONNECTING
        disconnected = asyncio.Event()
        client = await self._connect(found, name, disconnected)
        try:
            self.state = ConnectionState.SETTING_UP
            if missing := find_missing_stream(client, profile):
                raise WrongDevice(f"{name} is no {profile.name}: it has no {missing}")
            info = await read_info(client, profile)
            self._assign(None if info is None else parse_site(info, name), found, name)
            listening = Listening(
                client, profile, self.emitter, disconnected, {} if info is None else {INFO_CHANNEL: info}
            )
            self.emitter.emit(
                "receiver/connected", build_connected(ConnectionFrame(shorten(name, MAX_NAME_SIZE), self.signal))
            )
            try:
                await listening.set_up()
                self.state, self._listening_since = ConnectionState.LISTENING, _now()
                await listening.run()
            finally:
                listening.closed, self._streamed = True, listening.streamed
                self.emitter.emit("receiver/disconnected")
        finally:
            with suppress(*FAILURES):
                async with bleak_call(DISCONNECT_TIMEOUT):
                    await client.disconnect()

    async def _connect(self, found: Advertisement, name: str, disconnected: asyncio.Event) -> BleakClient:
        """Connect to the device; `disconnected` is set when the connection is lost. Raises FAILURES."""
        loop = asyncio.get_running_loop()
        report_at = max(self._no_stream_since + self.patience, _now() + min(PRESENCE_TIME, self.patience))
        timer = loop.call_at(report_at, self.emitter.report_trouble, NO_ANSWER)
        try:
            async with bleak_call(CONNECT_TIMEOUT):
                client = await establish_connection(
                    BleakClient,
                    found.device,
                    name,
                    lambda _: disconnected.set(),
                    max_attempts=MAX_ATTEMPTS,
                    pair=self.pair,
                    backend=self.backend.client,
                )
        except TimeoutError as error:
            raise BleakDeviceNotFoundError(found.address) from error
        finally:
            timer.cancel()
        if client.is_connected:
            disconnected.clear()  # an earlier attempt may have set it: it was connected for a moment
        return client

    def _assign(self, reported: Site | None, found: Advertisement, name: str) -> None:
        """Assign this device to the site that it reports; raise WrongDevice when another site is configured."""
        site, requested = reported or self.config.site, self.config.site
        if site is None:
            raise WrongDevice(f"{name} does not say where it is worn: name a site")
        if requested is not None and site is not requested:
            raise WrongDevice(f"{name} is a {_describe(site)} one: expected at the {_describe(requested)}")
        same_site = [other for other in self.siblings if other is not self and other.site is site]
        if any(other.address or other.config.site is not None for other in same_site):
            raise WrongDevice(f"{name} is one more for the {_describe(site)}")
        for other in same_site:  # both sites are provisional, so they can be exchanged
            other.emitter.site = self.site
        self.emitter.site, self.emitter.address, self.name = site, found.address, found.name


def _now() -> float:
    return asyncio.get_running_loop().time()


def _describe(site: Site) -> str:
    return site.value.replace("_", " ")
