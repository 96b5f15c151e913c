"""Connection to one configured device: search, connect, set up, listen, and search again when it is lost."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from enum import Enum

from attrs import define, field
from bleak import BleakClient
from bleak.exc import BleakDeviceNotFoundError
from bleak_retry_connector import establish_connection

from ..link.profile import Profile
from ..link.setup.config import DeviceConfig, identify
from ..link.setup.device_setup import DeviceSetup, find_profile
from ..link.setup.roster import Member, Roster
from ..types import Site
from .candidates import PRESENCE_TIME, Advertisement, Candidates
from .client import Client, list_characteristics
from .inbox import Emitter
from .scanning import WEAKEST_SIGNAL, Backend, Scanner
from .search import find_device
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
    pairing when connected. `patience` is the time until a device that does not advertise is reported, s. `roster` holds
    all devices of the Devices, of which `member` is this one."""

    roster: Roster
    member: Member
    backend: Backend
    scanner: Scanner
    emitter: Emitter
    pair: bool
    patience: float
    own: tuple[Profile, ...] = ()
    """Profiles of an app's own devices, by which one without a configured profile is recognised."""
    state: ConnectionState = field(default=ConnectionState.SEEKING, init=False)
    signal: int | None = field(default=None, init=False)
    """Signal strength of the last advertisement, dBm; None when unknown."""
    _listening_since: float = field(default=0.0, init=False)
    """Start of listening, s."""
    _no_stream_since: float = field(default=0.0, init=False)
    """Start of the time without any stream data, over all attempts, s."""
    _has_streamed: bool = field(default=False, init=False)
    """True if the current or last connection brought stream data."""

    @property
    def config(self) -> DeviceConfig:
        """The device to connect to."""
        return self.member.config

    @property
    def site(self) -> Site:
        """Site of the packets; provisional until a device that reports its own site was read."""
        return self.member.site

    @property
    def address(self) -> str:
        """Address of the device, "" until it is known; from then on no other device is accepted."""
        return self.member.address

    @property
    def name(self) -> str:
        """Advertised name of the device, "" until it is known."""
        return self.member.name

    async def run(self) -> None:
        """Keep the device connected; never returns."""
        pause, self._no_stream_since = SEARCH_DELAY, _now()
        while True:
            found = await find_device(self.scanner, self._make_candidates(), self.emitter.report_trouble)
            self.member.current_address = found.address
            self.signal = found.signal if found.signal > WEAKEST_SIGNAL else None
            self._has_streamed = False
            try:
                await self._use(found)
            except FAILURES as error:
                self.emitter.report_trouble(describe_error(error))
            finally:
                stable = (
                    self._has_streamed
                    and self.state is ConnectionState.LISTENING
                    and _now() - self._listening_since >= STABLE_TIME
                )
                self.member.current_address, self.state = "", ConnectionState.SEEKING
            if self._has_streamed:
                pause, self._no_stream_since = SEARCH_DELAY, _now()
            if not stable:
                await asyncio.sleep(pause)
            if not self._has_streamed:
                pause = min(2.0 * pause, MAX_SEARCH_DELAY)

    def _make_candidates(self) -> Candidates:
        def is_excluded(found: Advertisement) -> bool:
            return self.roster.is_excluded(self.member, found.address, found.name, _now())

        return Candidates(self.config, self.address, is_excluded, self._report_at())

    def _report_at(self) -> float:
        """Return the time at which a device that is not found or does not answer is reported, s."""
        return max(self._no_stream_since + self.patience, _now() + min(PRESENCE_TIME, self.patience))

    async def _use(self, found: Advertisement) -> None:
        """Connect and listen until the connection is lost. Raises FAILURES."""
        name = found.name or found.address
        self.state = ConnectionState.CONNECTING
        disconnected = asyncio.Event()
        bleak_client = await self._connect(found, name, disconnected)
        try:
            self.state = ConnectionState.SETTING_UP
            characteristics = list_characteristics(bleak_client)
            # what it has says more than what it advertises
            profile = (
                self.config.profile
                or find_profile(found.name, characteristics, self.own)
                or identify(found.name, found.services, self.own)
            )
            if profile is None:
                self.member.wrong_since[found.address] = _now()
                self.emitter.report_trouble(f"{name} is of no kind that is known here: say its profile")
                return
            setup = DeviceSetup(
                self.roster, self.member, profile, characteristics, found.address, found.name, self.signal
            )
            client = Client(bleak_client, setup, self.emitter, disconnected)
            try:
                await client.set_up()
                if setup.is_listening:
                    self.state, self._listening_since = ConnectionState.LISTENING, _now()
                    await client.listen()
            finally:
                client.closed, self._has_streamed = True, setup.has_streamed
                self.emitter.emit(setup.disconnect())
        finally:
            with suppress(*FAILURES):
                async with bleak_call(DISCONNECT_TIMEOUT):
                    await bleak_client.disconnect()

    async def _connect(self, found: Advertisement, name: str, disconnected: asyncio.Event) -> BleakClient:
        """Connect to the device; `disconnected` is set when the connection is lost. Raises FAILURES."""
        loop = asyncio.get_running_loop()
        timer = loop.call_at(self._report_at(), self.emitter.report_trouble, NO_ANSWER)
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


def _now() -> float:
    return asyncio.get_running_loop().time()
