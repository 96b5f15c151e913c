"""The requests to one connected device, one at a time, from the connection to its loss.

    setup = DeviceSetup(roster, member, profile, characteristics, address, advertised_name)
    values = setup.start(now)
    while (request := setup.request) is not None:
        # perform it, then
        values = setup.answer(value, now)      # or setup.reject(reason, now), if the device rejects it
    if setup.is_listening:
        # until the connection is lost: setup.add_notification(channel, now) for each notification, and at next_check_at
        values = setup.check(now)              # may give requests again

Each call returns values, which are channels and data of packets to be recorded and fed, in this order. The order of
requests is: the record from which the site is read, reads, writes before subscribing, subscriptions, other writes. A
value that is read after subscribing would arrive twice on BlueZ. When `end` is set, disconnect; the member of the
roster may be connected again (see `Roster.is_excluded`). A request that fails otherwise, by loss of the connection or
without an answer within ANSWER_TIMEOUT, ends this setup."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from enum import Enum

from ...types import SITE_OF_FOOT, Packet, Site
from ...types.attrs import field, frozen, state, stateful
from ...wire.error import WireError
from ...wire.fields import build_text
from ...wire.insole_info import parse_info
from ...wire.receiver import MAX_NAME_SIZE, ConnectionFrame, build_connected
from ..catalogue import PROFILES
from ..decoder import Decoder
from ..profile import Access, Channel, Profile, whole_uuid
from .config import INFO_CHANNEL, reports_site
from .roster import Member, Roster, WrongDevice

ANSWER_TIMEOUT = 5.0
"""Time limit for the answer of a device to a request, s, chosen by hand; then the connection is made again."""
MAX_TRIES = 2
"""Largest number of times that the setup of a frozen stream is written again before the device is disconnected."""
TROUBLE = "receiver/trouble"
"""Channel of a sentence on what could not be done."""
MAX_TEXT_SIZE = 500
"""Longest text of a trouble, bytes, chosen by hand."""
REPORT_INTERVAL = 60.0
"""Shortest interval between two reports of the same trouble, s, chosen by hand."""
MAX_RECENT = 100
"""Largest number of troubles of a device that are remembered, chosen by hand."""

Value = tuple[str, bytes]
"""Channel and data of a packet."""


def trouble(sentence: str) -> Value:
    """Return the value of a trouble; a long sentence is shortened."""
    return TROUBLE, build_text(shorten(sentence, MAX_TEXT_SIZE))


def shorten(text: str, size: int) -> str:
    """Return the start of the text that fits into `size` bytes of UTF-8."""
    return text.encode("utf-8", "replace")[:size].decode("utf-8", "ignore")


@stateful(eq=False)
class RecentTroubles:
    """The troubles of one device that were reported less than `REPORT_INTERVAL` ago."""

    _reported: dict[bytes, float] = state(factory=dict)
    """Time of the last report of each trouble, s, by its text."""

    def leave_out(self, values: list[Value], now: float) -> list[Value]:
        """Return the values, at `now`, s, without troubles that were reported shortly before."""
        return [value for value in values if value[0] != TROUBLE or self._add(value[1], now)]

    def _add(self, text: bytes, now: float) -> bool:
        self._reported = {reported: t for reported, t in self._reported.items() if now - t < REPORT_INTERVAL}
        is_new = text not in self._reported
        if is_new and len(self._reported) < MAX_RECENT:
            self._reported[text] = now
        return is_new


@frozen
class GattCharacteristic:
    """One characteristic of a connected device; UUIDs may be short, and in any case."""

    service: str = field(converter=whole_uuid)
    uuid: str = field(converter=whole_uuid)
    can_notify: bool
    """True if it notifies or indicates; some battery levels can only be read."""


class Operation(Enum):
    """Kind of a request to a device; WRITE is with response, where the device supports it."""

    READ = "read"
    SUBSCRIBE = "subscribe"
    WRITE = "write"


@frozen
class Request:
    """One request to a device."""

    operation: Operation
    channel: Channel
    value: bytes = b""
    """Value to be written."""
    then_read: tuple[str, ...] = ()
    """Channels that are read after the write, if the device accepts it."""


REJECTED = {
    Operation.READ: "{channel} cannot be read: {reason}",
    Operation.SUBSCRIBE: "{channel} cannot be subscribed: {reason}",
    Operation.WRITE: "{channel} was not set to {value}: {reason}",
}
"""Sentence for a rejected request. The setup goes on, except without a stream or without the site."""


@stateful(eq=False)
class DeviceSetup:
    """The setup of one connected device (see the module)."""

    roster: Roster = field()
    member: Member = field()
    profile: Profile = field()
    characteristics: frozenset[GattCharacteristic] = field()
    address: str = field()
    advertised_name: str = field()
    """Name that the device advertises; "" when unknown."""
    signal: int | None = field()
    """Signal strength of its advertisement, dBm; None when unknown."""
    request: Request | None = None
    """Request to do now; None when there is nothing to do."""
    end: str | None = None
    """Reason to disconnect; None as long as there is none."""
    is_listening: bool = False
    """True when the device is set up, also while a frozen stream is set up again."""
    has_streamed: bool = False
    """True once a stream has notified."""
    _is_accepted: bool = False
    _info: bytes | None = None
    """Record from which the site was read, until its turn among the values."""
    _queue: deque[Request] = state(factory=deque)
    _written: list[Value] = state(factory=list)
    """Values that were written until the device was set up, which may let it be silent."""
    _values: list[Value] = state(factory=list)
    """Values that the running call will return."""
    _watched: tuple[str, ...] = ()
    """Streams that must notify in time; none when silence is allowed."""
    _last_t: dict[str, float] = state(factory=dict)
    """Time of the newest notification of each channel since the last setup, s."""
    _set_up_at: float = 0.0
    """Time at which the device was last set up, s."""
    _tries: int = 0
    """Number of times in a row that a frozen stream was set up again."""

    @property
    def name(self) -> str:
        """Name of the device in sentences: the one that it advertises, or its address."""
        return self.advertised_name or self.address

    def start(self, now: float) -> list[Value]:
        """Start at `now`, s: find out whether this is the configured device, and its site."""
        channels = [self.profile.channel(stream) for stream in self.profile.streams]
        missing = next((channel.name for channel in channels if not self._can_notify(channel)), None)
        if missing is not None:
            self._end_wrong(now, f"{self.name} is no {self.profile.name}: it has no {missing}")
        elif reports_site(self.profile) and self._has(info := self.profile.channel(INFO_CHANNEL)):
            self.request = Request(Operation.READ, info)
        else:
            self._accept(now, None)
        return self._take_values()

    def answer(self, value: bytes, now: float) -> list[Value]:
        """Note that the device has done the request, at `now`, s; `value` is what was read, b"" of others."""
        request = self._take_request()
        if not self._is_accepted:
            self._info = value
            self._read_site(now, value)
            return self._take_values()
        if request.operation is Operation.READ:
            self._values.append((request.channel.name, value))
        elif request.operation is Operation.WRITE:
            written = (request.channel.name, request.value)
            self._values.append(written)
            if not self.is_listening:
                self._written.append(written)
            self._queue.extendleft(reversed(self._reads(request.then_read)))
        self._advance(now)
        return self._take_values()

    def reject(self, reason: str, now: float) -> list[Value]:
        """Note that the device has rejected the request while the connection stands; `reason` is in words."""
        request = self._take_request()
        channel = request.channel.name
        sentence = REJECTED[request.operation].format(channel=channel, value=request.value.hex(), reason=reason)
        self._report(sentence)
        is_stream = request.operation is Operation.SUBSCRIBE and channel in self.profile.streams
        if is_stream or not self._is_accepted:
            self.end = sentence
        else:
            self._advance(now)
        return self._take_values()

    def add_notification(self, channel: str, t: float) -> None:
        """Note a notification of `channel` at time `t`, s."""
        self.has_streamed = self.has_streamed or channel in self.profile.streams
        self._last_t[channel] = t

    def next_check_at(self) -> float | None:
        """Return the time at which `check` is due, s; None when there is nothing to check."""
        if not self.is_listening or self.request is not None or self.end is not None:
            return None
        return min(map(self._frozen_at, self._watched), default=None)

    def check(self, now: float) -> list[Value]:
        """Check the streams at `now`, s: one that is frozen is set up again, or ends the connection."""
        due = self.next_check_at()
        if due is not None and now >= due:
            channel = next(stream for stream in self._watched if now >= self._frozen_at(stream))
            self._values.append(("receiver/restarted", build_text(channel)))
            if self._tries >= MAX_TRIES:
                self.end = f"{channel} is frozen"
            else:
                self._tries += 1
                self.restart_clock(now)
                self._queue += self._writes(before_subscribing=True) + self._writes(before_subscribing=False)
                self._advance(now)
        elif self._last_t.keys() >= {*self._watched}:
            self._tries = 0
        return self._take_values()

    def restart_clock(self, now: float) -> None:
        """Go on at `now`, s, after a setup, or after the clock restarted or was set: streams have their whole time."""
        self._last_t.clear()
        self._set_up_at = now

    def disconnect(self) -> list[Value]:
        """Note that the connection was lost or given up."""
        self.request, self.is_listening = None, False
        self._queue.clear()
        return [("receiver/disconnected", b"")] if self._is_accepted else []

    def _frozen_at(self, stream: str) -> float:
        """Return the time from which the stream counts as frozen, s.

        The CC2650's movement sensor is known to freeze (firmware before 1.12 on a weak coin cell); writing its
        configuration again restarts it."""
        return self._last_t.get(stream, self._set_up_at) + self.profile.stale_after

    def _read_site(self, now: float, info: bytes) -> None:
        try:
            site = SITE_OF_FOOT[parse_info(info).foot]
        except WireError as error:
            advice = "switch it off and on, or update its firmware; it is looked at again in a minute"
            self._end_wrong(now, f"the INFO record of {self.name} cannot be read ({error.detail}): {advice}")
        else:
            self._accept(now, site)

    def _accept(self, now: float, site: Site | None) -> None:
        try:
            self.roster.assign(self.member, site, self.address, self.advertised_name)
        except WrongDevice as error:
            self._end_wrong(now, str(error))
            return
        self._is_accepted = True
        self._values.append(
            ("receiver/connected", build_connected(ConnectionFrame(shorten(self.name, MAX_NAME_SIZE), self.signal)))
        )
        notifying = [one for one in self.profile.channels if one.access is Access.NOTIFY and self._can_notify(one)]
        self._queue += self._reads(self.profile.reads) + self._writes(before_subscribing=True)
        self._queue += [Request(Operation.SUBSCRIBE, channel) for channel in notifying]
        self._queue += self._writes(before_subscribing=False)
        self._advance(now)

    def _advance(self, now: float) -> None:
        """Make the next request that the device can do and that is not done; without one, the device is set up."""
        while self._queue:
            request = self._queue.popleft()
            if request.operation is Operation.WRITE and not self._has(request.channel):  # as in old SensorTags
                self._report(f"{request.channel.name} is not there to be set: the device keeps to its own")
            elif request.channel.name == INFO_CHANNEL and self._info is not None:
                self._values.append((INFO_CHANNEL, self._info))
                self._info = None
            else:
                self.request = request
                return
        if not self.is_listening:
            self.is_listening = True
            self.restart_clock(now)
            self._watched = () if may_be_silent(self.member.site, self._written) else self.profile.streams

    def _take_request(self) -> Request:
        if self.request is None:
            raise ValueError("there is no request to answer")
        request, self.request = self.request, None
        return request

    def _take_values(self) -> list[Value]:
        values, self._values = self._values, []
        return values

    def _report(self, sentence: str) -> None:
        self._values.append(trouble(sentence))

    def _end_wrong(self, now: float, sentence: str) -> None:
        """End because this is not the configured device; it is excluded for a while."""
        self.member.wrong_since[self.address] = now
        self.end = sentence
        self._report(sentence)

    def _reads(self, names: Iterable[str]) -> list[Request]:
        channels = [self.profile.channel(name) for name in names]
        return [Request(Operation.READ, channel) for channel in channels if self._has(channel)]

    def _writes(self, *, before_subscribing: bool) -> list[Request]:
        return [
            Request(Operation.WRITE, self.profile.channel(one.channel), one.value, one.then_read)
            for one in self.profile.setup
            if one.before_subscribing is before_subscribing
        ]

    def _has(self, channel: Channel) -> bool:
        return (channel.service, channel.characteristic) in {(one.service, one.uuid) for one in self.characteristics}

    def _can_notify(self, channel: Channel) -> bool:
        return GattCharacteristic(channel.service, channel.characteristic, True) in self.characteristics


def may_be_silent(site: Site, written: Sequence[Value]) -> bool:
    """Return whether the written setup allows the device to send nothing, as with wake-on-motion."""
    decoder = Decoder(site)
    for channel, data in written:
        decoder.feed(Packet(0.0, site, channel, data, ""))
    return decoder.link is not None and decoder.link.may_be_silent


def find_profile(
    name: str, characteristics: Iterable[GattCharacteristic], own: Iterable[Profile] = ()
) -> Profile | None:
    """Return the profile of a connected device that advertises `name` ("" when unknown); None for an unknown device.

    It is one whose streams the device can send, and of several the one whose name the device has. Profiles of an app's
    `own` devices go before the built-in ones."""
    notifying = {(one.service, one.uuid) for one in characteristics if one.can_notify}
    fitting = [
        profile
        for profile in (*own, *PROFILES)
        if notifying.issuperset([(one.service, one.characteristic) for one in map(profile.channel, profile.streams)])
    ]
    return next((profile for profile in fitting if profile.matches_name(name)), fitting[0] if fitting else None)
