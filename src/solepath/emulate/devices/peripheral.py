"""One emulated device for a GATT server: attributes to read and write, and notifications at their times.

The device has no clock and no asyncio. The server passes the time of its event loop as `now`, s, which never decreases.
For each connection the server does this:

    device.connected(now, mtu)
    ... subscribe, read, write as the host requests ...
    at device.next_due(), and whenever `on_change` was called sooner:
        for outgoing in device.poll(now): send it
        if device.must_hang_up(now): lose the link
    device.disconnected(now)

A fault script (faults.py) acts inside the device; the server sees only its effects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import inf
from operator import itemgetter
from typing import Protocol

from attrs import frozen

from ...types import Site
from .attributes import SMALLEST_MTU, AttCode, AttError, Outgoing, Service, check_fits
from .faults import PAIRING_ARGUMENT, Fault, FaultKind, FaultState

_TIMER_TOLERANCE = 2e-6
"""Time by which a timer may fire too early, s; it is the resolution of an event loop's clock."""


@frozen
class Placement:
    """Site, address, MTU, start time and faults of a virtual device."""

    site: Site
    """Site that wears the device."""
    address: str
    """Bluetooth address of the device."""
    mtu: int = 247
    """Largest ATT MTU that the device accepts, bytes."""
    started_at: float = 0.0
    """Time of the event loop at which the walk starts, s; until then the wearer stands at the start."""
    faults: tuple[Fault, ...] = ()
    """Faults of a script; those of other sites have no effect on this device."""


class ValueSource(Protocol):
    """The values of one channel, each with a number and a time of the walk, s; times grow with the number."""

    def first_number_from(self, t: float) -> int:
        """Return the number of the first value at time `t` or later."""

    def due(self, number: int) -> float:
        """Return the time at which the radio has the value of this number, s; inf when there is no such value."""

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        """Return the notifications of the value in order; there are several when the value is too long for one."""


class Peripheral:
    """A virtual device as a GATT server; insole.py and tag.py define its attributes.

    `sent` counts the sent notifications by channel. When `log` is a list, it collects these notifications."""

    def __init__(self, placement: Placement, name: str, services: Iterable[Service], advertised: Iterable[str]) -> None:
        self.site, self.address = placement.site, placement.address
        self.services = tuple(services)
        self.advertised = tuple(advertised)
        self.sent: dict[str, int] = {}
        self.log: list[Outgoing] | None = None
        self.on_change: Callable[[], None] | None = None
        for text in (name, *(fault.argument for fault in placement.faults if fault.kind is FaultKind.NAME)):
            check_fits(text, self.advertised)
        self._name, self._mtu = name, placement.mtu
        self._started_at, self._script = placement.started_at, placement.faults
        self.faults = FaultState(placement.faults, placement.site)
        """Faults of the script that have happened in this walk, and their effects."""
        self._properties = {c.channel: c.properties for service in self.services for c in service.characteristics}
        self._sources: dict[str, ValueSource] = {}
        self._next_numbers: dict[str, int] = {}
        self._subscribed: set[str] = set()
        self._now = -inf
        self.is_connected = False
        self.is_encrypted = False
        """True while the link is encrypted with the keys of a pairing on this or an earlier link."""
        self.agreed_mtu = SMALLEST_MTU
        """ATT MTU of the link, bytes."""

    # methods that a device overrides or calls

    def value(self, channel: str, t: float) -> bytes:
        """Return the value of the channel at `t` s of the walk; raise AttError when it cannot be read."""
        raise AttError(AttCode.READ_NOT_PERMITTED)

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        """Apply a value that the host writes at `t` s of the walk; raise AttError when the device rejects it."""
        raise AttError(AttCode.WRITE_NOT_PERMITTED)

    def stop(self) -> None:
        """Reset the device after the end of its link; its channels have stopped already."""

    def prepare(self) -> None:
        """Compute the signals now and not when a host first needs them."""

    def flow(self, channel: str, source: ValueSource | None, t: float) -> None:
        """Set the source of the channel's values from `t` s of the walk on; None stops the channel."""
        if source is None:
            self._sources.pop(channel, None)
        else:
            self._sources[channel], self._next_numbers[channel] = source, source.first_number_from(t)

    # methods that the server calls

    @property
    def name(self) -> str:
        """Name that the device advertises."""
        return self.faults.name or self._name

    @property
    def mtu(self) -> int:
        """Largest ATT MTU that the device accepts, bytes."""
        return int(min(self._mtu, self.faults.mtu))

    def walk_from(self, started_at: float) -> None:
        """Restart the walk and its fault script at this time of the event loop, s; earlier faults have no effect."""
        self._started_at = started_at
        self.faults = FaultState(self._script, self.site)
        for channel, source in self._sources.items():
            self._next_numbers[channel] = source.first_number_from(self._now - started_at)
        self._notify_changed()

    def visible(self, now: float) -> bool:
        """Return whether a device without a link advertises now."""
        return not self.faults.hidden(self._advance(now))

    def connected(self, now: float, mtu: int) -> None:
        """Start a link with this ATT MTU, bytes."""
        self._advance(now)
        self.faults.connected()
        self.is_connected, self.is_encrypted, self.agreed_mtu = True, False, mtu
        self._notify_changed()

    def accepts_pairing(self, now: float) -> bool:
        """Return whether the device accepts a pairing that the host starts."""
        self._advance(now)
        return not self.faults.uses_up(FaultKind.REJECT, PAIRING_ARGUMENT)

    def disconnected(self, now: float) -> None:
        """End the link: remove all subscriptions and reset the device as its protocol says."""
        self._advance(now)
        self.is_connected = self.is_encrypted = False
        self._sources.clear()
        self._subscribed.clear()
        self.agreed_mtu = SMALLEST_MTU
        self.stop()

    def subscribe(self, channel: str, on: bool, now: float) -> None:
        """Start or stop the notifications of a channel; raise AttError when it has none."""
        if "notify" not in self._properties[channel]:
            raise AttError(AttCode.REQUEST_NOT_SUPPORTED)
        t = self._advance(now)
        self._check_paired(channel)
        if not on:
            self._subscribed.discard(channel)
        elif channel not in self._subscribed:
            self._subscribed.add(channel)
            if channel in self._sources:
                number = self._sources[channel].first_number_from(t)
                self._next_numbers[channel] = max(self._next_numbers[channel], number)
        self._notify_changed()

    def read(self, channel: str, now: float) -> bytes | None:
        """Return the value of a channel; None when the device never answers. A rejected read raises AttError."""
        t = self._advance(now)
        if self._hangs(channel, t):
            return None
        if "read" not in self._properties[channel]:
            raise AttError(AttCode.READ_NOT_PERMITTED)
        return self.value(channel, t)

    def write(self, channel: str, value: bytes, now: float) -> bool:
        """Write a value; return False when the device never answers. A rejected write raises AttError."""
        t = self._advance(now)
        if self._hangs(channel, t):
            return False
        if not self._properties[channel] & {"write", "write-without-response"}:
            raise AttError(AttCode.WRITE_NOT_PERMITTED)
        self.accept_write(channel, bytes(value), t)
        self.faults.thaw()
        self._notify_changed()
        return True

    def next_due(self) -> float | None:
        """Return when to call `poll` and `must_hang_up` next, s of the event loop; None when nothing is due."""
        if not self.is_connected:
            return None
        soonest = min(self._first_due()[0], self.faults.next_at())
        return None if soonest == inf else max(self._now, self._started_at + soonest)

    def poll(self, now: float) -> list[Outgoing]:
        """Return the notifications that are due by now, with the faults applied, in the order of time."""
        found: list[Outgoing] = []
        while self.is_connected:
            due, channel = self._first_due()
            is_over = due > now - self._started_at + _TIMER_TOLERANCE
            t = self._advance(now) if is_over else self._advance_faults(due)
            if is_over or self.faults.must_disconnect:
                break
            source, number = self._sources[channel], self._next_numbers[channel]
            self._next_numbers[channel] += 1
            if self.faults.frozen(t) or self._is_closed(channel):
                continue
            for value in source.values(number, self.agreed_mtu):
                found += [Outgoing(channel, sent) for sent in self.faults.apply(value)]
        for outgoing in found:
            self.sent[outgoing.channel] = self.sent.get(outgoing.channel, 0) + 1
        if self.log is not None:
            self.log += found
        return found

    def must_hang_up(self, now: float) -> bool:
        """Return True, once, when the link must be lost now, as by a supervision timeout (0x08)."""
        self._advance(now)
        must_disconnect, self.faults.must_disconnect = self.faults.must_disconnect, False
        return must_disconnect and self.is_connected

    def _first_due(self) -> tuple[float, str]:
        """Return the time at which the next value is due, s, and its channel, which is subscribed; inf when none is."""
        found = [
            (source.due(self._next_numbers[channel]), channel)
            for channel, source in self._sources.items()
            if channel in self._subscribed
        ]
        return min(found, key=itemgetter(0), default=(inf, ""))

    def _hangs(self, channel: str, t: float) -> bool:
        """Return whether a request to the channel is never answered; raise AttError when it is rejected."""
        if self.faults.hangs(t):
            self._notify_changed()
            return True
        if self.faults.uses_up(FaultKind.REJECT, channel):
            raise AttError(AttCode.APPLICATION_ERROR)
        self._check_paired(channel)
        return False

    def _is_closed(self, channel: str) -> bool:
        """Return whether the channel needs an encryption that the link does not have."""
        return self.faults.needs_pairing and not self.is_encrypted and not channel.startswith("device/")

    def _check_paired(self, channel: str) -> None:
        if self._is_closed(channel):
            raise AttError(AttCode.NOT_PAIRED)

    def _advance(self, now: float) -> float:
        """Advance to `now` and return the time of the walk, s."""
        self._now = max(self._now, now)
        return self._advance_faults(now - self._started_at + _TIMER_TOLERANCE) - _TIMER_TOLERANCE

    def _advance_faults(self, t: float) -> float:
        self.faults.advance(t)
        return t

    def _notify_changed(self) -> None:
        if self.on_change is not None:
            self.on_change()
