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

from collections.abc import Callable, Iterable
from math import inf

from attrs import frozen

from ...types import Site
from .attributes import SMALLEST_MTU, AttCode, AttError, Outgoing, Service, check_fits
from .faults import PAIRING, Fault, FaultKind, FaultState
from .flows import Flows, ValueSource

_AT_ONCE = 2e-6
"""s: a timer may fire so much before its time by the resolution of a loop's clock."""


@frozen
class Placement:
    """Where a device is worn, its address, and what befalls it.

    `mtu`: the largest that it agrees to. `began`: the loop's time at which its wearer's walk begins; until then he
    stands as at its beginning.
    """

    site: Site
    address: str
    mtu: int = 247
    started_at: float = 0.0
    faults: tuple[Fault, ...] = ()


class Peripheral:
    """A device without attributes of its own; insole.py and tag.py say what theirs are.

    `sent` counts the notifications that were handed over by channel, and `log` has them all once a list is put there.
    """

    def __init__(self, worn: Placement, name: str, services: Iterable[Service], advertised: Iterable[str]) -> None:
        self.site, self.address = worn.site, worn.address
        self.services = tuple(services)
        self.advertised = tuple(advertised)
        self.sent: dict[str, int] = {}
        self.log: list[Outgoing] | None = None
        self.changed: Callable[[], None] | None = None
        for text in (name, *(fault.argument for fault in worn.faults if fault.kind is FaultKind.NAME)):
            check_fits(text, self.advertised)
        self._name, self._mtu, self._started_at, self._faults = name, worn.mtu, worn.started_at, worn.faults
        self._fault_state = FaultState(worn.faults, worn.site)
        self._properties = {c.channel: c.properties for service in self.services for c in service.characteristics}
        self._flows = Flows()
        self._now = -inf
        self.is_connected = False
        self.is_encrypted = False
        """By the keys of a pairing, of now or of earlier."""
        self.agreed_mtu = SMALLEST_MTU
        """Of the link, while there is one."""

    # what its devices say

    def value(self, channel: str, t: float) -> bytes:
        """What a read of the channel gives at `t` of the walk. AttError."""
        raise AttError(AttCode.READ_NOT_PERMITTED)

    def take(self, channel: str, value: bytes, t: float) -> None:
        """Obey a write at `t` of the walk. AttError."""
        raise AttError(AttCode.WRITE_NOT_PERMITTED)

    def stop(self) -> None:
        """Do as the device does when its link is gone. The flows have been stopped already."""

    def start(self, t: float) -> None:
        """Do as the device does when it is connected at `t` of the walk."""

    def prepare(self) -> None:
        """Work out now what would otherwise be worked out when a host first asks for it."""

    def flow(self, channel: str, source: ValueSource | None, t: float) -> None:
        """From `t` of the walk on the channel tells what `source` has, or nothing."""
        self._flows.put(channel, source, t)

    # what its server asks

    @property
    def name(self) -> str:
        return self._name if self._fault_state.name is None else self._fault_state.name

    @property
    def mtu(self) -> int:
        return self._mtu if self._fault_state.mtu is None else min(self._mtu, self._fault_state.mtu)

    @property
    def restarted_at(self) -> float | None:
        """When it began anew the last time, in time of the walk; None when it never did."""
        return self._fault_state.restarted_at

    @property
    def fault_count(self) -> int:
        """Faults of the script that have happened in this walk."""
        return self._fault_state.happened

    @property
    def needs_pairing(self) -> bool:
        """Whether it refuses requests on a link that is not encrypted, but for Device Information and battery."""
        return self._fault_state.needs_pairing

    def walk_from(self, started_at: float) -> None:
        """The walk begins anew, and the script of its faults with it: nothing of an earlier one holds over."""
        self._started_at = started_at
        self._fault_state = FaultState(self._faults, self.site)
        self._flows.go_to(self._now - started_at)
        self._notify_changed()

    def visible(self, now: float) -> bool:
        """Whether it advertises, if it is not connected."""
        return not self._fault_state.hidden(self._advance(now))

    def connected(self, now: float, mtu: int) -> None:
        """A link begins, with the MTU that is agreed so far."""
        t = self._advance(now)
        self._fault_state.connected()
        self.is_connected, self.is_encrypted, self.agreed_mtu = True, False, mtu
        self.start(t)
        self._notify_changed()

    def accepts_pairing(self, now: float) -> bool:
        """Whether it takes part in a pairing that the host begins."""
        self._advance(now)
        return not self._fault_state.rejects(PAIRING)

    def disconnected(self, now: float) -> None:
        """The link is gone, whoever ended it: subscriptions are forgotten, the device does what its protocol says."""
        self._advance(now)
        self.is_connected = self.is_encrypted = False
        self._flows.clear()
        self.agreed_mtu = SMALLEST_MTU
        self.stop()

    def subscribe(self, channel: str, on: bool, now: float) -> None:
        """AttError for a channel that does not notify."""
        if "notify" not in self._properties.get(channel, ()):
            raise AttError(AttCode.REQUEST_NOT_SUPPORTED)
        t = self._advance(now)
        self._check_paired(channel)
        self._flows.subscribe(channel, on, t)
        self._notify_changed()

    def read(self, channel: str, now: float) -> bytes | None:
        """The value; None when the answer never comes. AttError."""
        t = self._advance(now)
        if self._fails(channel, t):
            return None
        if "read" not in self._properties.get(channel, ()):
            raise AttError(AttCode.READ_NOT_PERMITTED)
        return self.value(channel, t)

    def write(self, channel: str, value: bytes, now: float) -> bool:
        """Obey; False when the answer never comes. AttError."""
        t = self._advance(now)
        if self._fails(channel, t):
            return False
        if not self._properties.get(channel, frozenset()) & {"write", "write-without-response"}:
            raise AttError(AttCode.WRITE_NOT_PERMITTED)
        self.take(channel, bytes(value), t)
        self._fault_state.thaw()
        self._notify_changed()
        return True

    def next_due(self) -> float | None:
        """When `poll` or `hang_up` have something next; None when nothing is foreseeable."""
        if not self.is_connected:
            return None
        soonest = min(self._flows.first(inf)[1], self._fault_state.next_at())
        return None if soonest == inf else max(self._now, self._started_at + soonest)

    def poll(self, now: float) -> list[Outgoing]:
        """The notifications that are due by now, after the faults, in order of their time."""
        found: list[Outgoing] = []
        while self.is_connected:
            channel, due = self._flows.first(now - self._started_at + _AT_ONCE)
            t = self._advance(now) if channel is None else self._advance_faults(due)
            if channel is None or self._fault_state.cut:
                break
            source, number = self._flows.take(channel)
            if self._fault_state.frozen(t) or self._is_closed(channel):
                continue
            for value in source.values(number, self.agreed_mtu):
                found += [Outgoing(channel, sent) for sent in self._fault_state.apply(value)]
        for outgoing in found:
            self.sent[outgoing.channel] = self.sent.get(outgoing.channel, 0) + 1
        if self.log is not None:
            self.log += found
        return found

    def hang_up(self, now: float) -> bool:
        """True once when the link is to be lost now as by a supervision timeout (0x08)."""
        self._advance(now)
        cut, self._fault_state.cut = self._fault_state.cut and self.is_connected, False
        return cut

    def _fails(self, channel: str, t: float) -> bool:
        if self._fault_state.hangs(t):
            self._notify_changed()
            return True
        if self._fault_state.rejects(channel):
            raise AttError(AttCode.APPLICATION_ERROR)
        self._check_paired(channel)
        return False

    def _is_closed(self, channel: str) -> bool:
        """Whether the link must be encrypted first. What every device tells of itself is open to all."""
        return self.needs_pairing and not self.is_encrypted and not channel.startswith("device/")

    def _check_paired(self, channel: str) -> None:
        if self._is_closed(channel):
            raise AttError(AttCode.NOT_PAIRED)

    def _advance(self, now: float) -> float:
        """Time passes; returns the time of the walk."""
        self._now = max(self._now, now)
        return self._advance_faults(now - self._started_at + _AT_ONCE) - _AT_ONCE

    def _advance_faults(self, t: float) -> float:
        self._fault_state.advance(t)
        return t

    def _notify_changed(self) -> None:
        if self.changed is not None:
            self.changed()
