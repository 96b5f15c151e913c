"""One emulated device as its server sees it: attributes to read and write, and notifications that fall due.

No clock and no asyncio: whoever serves it passes its own loop's time as `now` (s, never going back) and does with each
device of a connection

    device.connected(now, mtu)
    ... subscribe, read, write as the host asks ...
    at device.next_due(), and whenever `changed` was called sooner:
        for outgoing in device.poll(now): send it
        if device.hang_up(now): lose the link
    device.disconnected(now)

A fault script (faults.py) acts inside; the server sees only its effects.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

from attrs import define, frozen

from ..types import Site
from .advertisement import check_fits
from .faults import Fault, Misfortune, What

READ_NOT_PERMITTED = 0x02
WRITE_NOT_PERMITTED = 0x03
REQUEST_NOT_SUPPORTED = 0x06
WRONG_LENGTH = 0x0D
REFUSED = 0x80
"""The first of the codes that an application may give a meaning (Bluetooth Core, vol 3 part F, 3.4.1.1)."""

SMALLEST_MTU = 23
_AT_ONCE = 2e-6
"""s: a timer may fire so much before its time by the resolution of a loop's clock."""


class AttError(Exception):
    """A request is refused with this ATT error code."""

    def __init__(self, code: int) -> None:
        super().__init__(f"ATT error {code:#04x}")
        self.code = code


@frozen
class Characteristic:
    """`uuid`: in full, lower case. `channel`: the name by which it is read and written here.
    `properties`: of "read", "write", "write-without-response" and "notify"."""

    uuid: str
    channel: str
    properties: frozenset[str]


@frozen
class Service:
    """A primary service, its uuid in full, lower case."""

    uuid: str
    characteristics: tuple[Characteristic, ...]


@frozen
class Outgoing:
    """A notification to be sent now."""

    channel: str
    value: bytes


class Source(Protocol):
    """What a channel has to tell: values with numbers, each at its time. Times are of the walk, s."""

    def after(self, t: float) -> int:
        """The number of the first value that is measured at `t` or later."""

    def due(self, number: int) -> float:
        """When the radio has it, not before the one before it; inf when there is no such value."""

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        """What is sent then, in order: nothing, one notification, or several where one is not enough."""


@define(eq=False)
class _Flow:
    source: Source
    number: int


class Peripheral:
    """A device without attributes of its own; insole.py and sensortags.py say what theirs are.

    `mtu`: the largest that it agrees to. `began`: the loop's time at which its wearer's walk begins; until then he
    stands as at its beginning. `sent` counts the notifications that were handed over by channel, and `log` has them
    all once a list is put there.
    """

    def __init__(
        self,
        *,
        site: Site,
        address: str,
        name: str,
        services: Iterable[Service],
        advertised: Iterable[str],
        mtu: int = 247,
        began: float = 0.0,
        faults: Iterable[Fault] = (),
    ) -> None:
        self.site = site
        self.address = address
        self.services = tuple(services)
        self.advertised = tuple(advertised)
        self.sent: dict[str, int] = {}
        self.log: list[Outgoing] | None = None
        self.changed: Callable[[], None] | None = None
        faults = tuple(faults)
        for said in (name, *(fault.argument for fault in faults if fault.what is What.NAME)):
            check_fits(said, self.advertised)
        self._name, self._mtu, self._began = name, mtu, began
        self._misfortune = Misfortune(faults, site)
        self._properties = {c.channel: c.properties for service in self.services for c in service.characteristics}
        self._flows: dict[str, _Flow] = {}
        self._subscribed: set[str] = set()
        self._linked = False
        self._now = float("-inf")
        self._agreed = SMALLEST_MTU

    # what its devices say

    def value(self, channel: str, t: float) -> bytes:
        """What a read of the channel gives at `t` of the walk. AttError."""
        raise AttError(READ_NOT_PERMITTED)

    def take(self, channel: str, value: bytes, t: float) -> None:
        """Obey a write at `t` of the walk. AttError."""
        raise AttError(WRITE_NOT_PERMITTED)

    def stop(self) -> None:
        """Do as the device does when its link is gone. The flows have been stopped already."""

    def begin(self) -> None:
        """Do as the device does when it is connected."""

    def prepare(self) -> None:
        """Work out now what would otherwise be worked out when a host first asks for it."""

    def flow(self, channel: str, source: Source | None, t: float) -> None:
        """From `t` of the walk on the channel tells what `source` has, or nothing."""
        if source is None:
            self._flows.pop(channel, None)
        else:
            self._flows[channel] = _Flow(source, source.after(t))

    # what its server asks

    @property
    def name(self) -> str:
        return self._name if self._misfortune.name is None else self._misfortune.name

    @property
    def mtu(self) -> int:
        return self._mtu if self._misfortune.mtu is None else min(self._mtu, self._misfortune.mtu)

    @property
    def agreed_mtu(self) -> int:
        """Of the link, while there is one."""
        return self._agreed

    @property
    def walk_time(self) -> float:
        """The time of the walk when it was last asked anything, s."""
        return self._now - self._began

    @property
    def restarted(self) -> float | None:
        """When it began anew the last time, in time of the walk; None when it never did."""
        return self._misfortune.restarted

    @property
    def is_connected(self) -> bool:
        return self._linked

    @property
    def began(self) -> float:
        return self._began

    @began.setter
    def began(self, began: float) -> None:
        self._began = began
        for flow in self._flows.values():
            flow.number = flow.source.after(self._now - began)
        self._tell()

    def visible(self, now: float) -> bool:
        """Whether it advertises, if it is not connected."""
        t = self._pass(now)
        return not self._misfortune.hidden(t)

    def connected(self, now: float, mtu: int) -> None:
        """A link begins, with the MTU that is agreed so far."""
        self._pass(now)
        self._misfortune.connected()
        self._linked, self._agreed = True, mtu
        self.begin()
        self._tell()

    def mtu_changed(self, mtu: int) -> None:
        self._agreed = mtu

    def disconnected(self, now: float) -> None:
        """The link is gone, whoever ended it: subscriptions are forgotten, the device does what its protocol says."""
        self._pass(now)
        self._linked = False
        self._subscribed.clear()
        self._flows.clear()
        self._agreed = SMALLEST_MTU
        self.stop()

    def subscribe(self, channel: str, on: bool, now: float) -> None:
        """AttError for a channel that does not notify."""
        if "notify" not in self._properties.get(channel, ()):
            raise AttError(REQUEST_NOT_SUPPORTED)
        t = self._pass(now)
        if on and channel not in self._subscribed:
            self._subscribed.add(channel)
            flow = self._flows.get(channel)
            if flow is not None:
                flow.number = max(flow.number, flow.source.after(t))
        elif not on:
            self._subscribed.discard(channel)
        self._tell()

    def read(self, channel: str, now: float) -> bytes | None:
        """The value; None when the answer never comes. AttError."""
        t = self._pass(now)
        if self._fails(channel, t):
            return None
        if "read" not in self._properties.get(channel, ()):
            raise AttError(READ_NOT_PERMITTED)
        return self.value(channel, t)

    def write(self, channel: str, value: bytes, now: float) -> bool:
        """Obey; False when the answer never comes. AttError."""
        t = self._pass(now)
        if self._fails(channel, t):
            return False
        if not self._properties.get(channel, frozenset()) & {"write", "write-without-response"}:
            raise AttError(WRITE_NOT_PERMITTED)
        self.take(channel, bytes(value), t)
        self._misfortune.thaw()
        self._tell()
        return True

    def next_due(self) -> float | None:
        """When `poll` or `hang_up` have something next; None when nothing is foreseeable."""
        if not self._linked:
            return None
        times = [flow.source.due(flow.number) for channel, flow in self._flows.items() if channel in self._subscribed]
        fault = self._misfortune.next_at()
        if fault is not None:
            times.append(fault)
        soonest = min(times, default=float("inf"))
        return None if soonest == float("inf") else max(self._now, self._began + soonest)

    def poll(self, now: float) -> list[Outgoing]:
        """The notifications that are due by now, after the faults, in order of their time."""
        found: list[Outgoing] = []
        while self._linked:
            channel, due = self._first(now - self._began + _AT_ONCE)
            t = self._pass(now) if channel is None else self._happen(due)
            if channel is None or self._misfortune.cut:
                break
            flow = self._flows[channel]
            number, flow.number = flow.number, flow.number + 1
            if self._misfortune.frozen(t):
                continue
            for value in flow.source.values(number, self._agreed):
                found += [Outgoing(channel, sent) for sent in self._misfortune.carry(value)]
        for outgoing in found:
            self.sent[outgoing.channel] = self.sent.get(outgoing.channel, 0) + 1
        if self.log is not None:
            self.log += found
        return found

    def hang_up(self, now: float) -> bool:
        """True once when the link is to be lost now as by a supervision timeout (0x08)."""
        self._pass(now)
        cut, self._misfortune.cut = self._misfortune.cut and self._linked, False
        return cut

    def _first(self, t: float) -> tuple[str | None, float]:
        """The channel that has something to tell soonest, by `t` at the latest, and when."""
        first, soonest = None, t
        for channel, flow in self._flows.items():
            if channel in self._subscribed:
                due = flow.source.due(flow.number)
                if due < soonest or (due == soonest and first is None):
                    first, soonest = channel, due
        return first, soonest

    def _fails(self, channel: str, t: float) -> bool:
        if self._misfortune.hangs(t):
            self._tell()
            return True
        if self._misfortune.refuses(channel):
            raise AttError(REFUSED)
        return False

    def _pass(self, now: float) -> float:
        """Time passes; returns the time of the walk."""
        self._now = max(self._now, now)
        return self._happen(now - self._began + _AT_ONCE) - _AT_ONCE

    def _happen(self, t: float) -> float:
        self._misfortune.advance(t)
        return t

    def _tell(self) -> None:
        if self.changed is not None:
            self.changed()
