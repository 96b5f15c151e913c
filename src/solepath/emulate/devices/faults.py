"""Scripted faults of emulated devices: the syntax of a script, and its effect on one device.

A line of a script is one fault, `SECONDS SITE WHAT [AMOUNT]`, or several with semicolons between them. `#` starts a
comment and `*` means every site:

    12.5 left_foot disconnect         # the link is lost, the device advertises again at once
    20 right_foot vanish 60           # the link is lost and the device does not advertise for 60 s
    5 left_foot drop 3                # the next 3 notifications are lost
    5 * duplicate 2                   # the next 2 notifications arrive twice
    8 left_foot truncate 4            # the next 4 notifications arrive cut short
    8 left_foot flip 2                # the next 2 notifications arrive with one to three inverted bits
    15 left_foot freeze 5             # nothing is sent for 5 s although the link is up; a setup write ends this
    0 left_foot mtu 23                # the device accepts no larger MTU from its next connection on
    0 left_foot refuse cc2650/movement-config 2   # the next 2 requests to the channel get the ATT error 0x80
    30 left_foot hang                 # the next request is never answered, and 1 s later the link is lost
    40 left_foot restart              # the link is lost and the device restarts with its counters at 0
    0 * name "SensorTag"              # the device has another name
    0 left_foot pairing               # from now on the device sends and answers only on a link that is paired
    0 left_foot refuse pairing        # the next attempt to pair is rejected

Seconds count from the start of the walk. The same script has the same effect every time."""

from __future__ import annotations

import random
import shlex
from collections import defaultdict
from collections.abc import Iterable
from enum import Enum
from itertools import groupby
from math import inf, isfinite
from operator import attrgetter
from typing import TypeVar

from attrs import frozen

from ...types import Site

HANG_TIME = 1.0
"""Time from a request that is never answered until the link is lost, s."""
PAIRING_ARGUMENT = "pairing"
"""Argument of the fault "refuse" that rejects an attempt to pair instead of a request to a channel."""


_E = TypeVar("_E", bound=Enum)


class FaultKind(Enum):
    """Kinds of faults; the values are the words of the script."""

    DISCONNECT = "disconnect"
    VANISH = "vanish"
    DROP = "drop"
    DUPLICATE = "duplicate"
    TRUNCATE = "truncate"
    FLIP = "flip"
    FREEZE = "freeze"
    MTU = "mtu"
    REJECT = "refuse"
    HANG = "hang"
    RESTART = "restart"
    NAME = "name"
    PAIRING = "pairing"


@frozen
class Fault:
    """One scripted fault."""

    at: float
    """Time of the walk at which the fault happens, s."""
    site: Site | None
    """Site of the device; None: every site."""
    kind: FaultKind
    """Kind of the fault."""
    amount: float = 1.0
    """Duration of VANISH and FREEZE, s; bytes for MTU; for other kinds the number of notifications or requests."""
    argument: str = ""
    """Channel or PAIRING_ARGUMENT for REJECT, name for NAME; else empty."""


_NAMING = {FaultKind.REJECT: "a channel", FaultKind.NAME: "a name"}
_WHOLE = (1.0, inf, 1.0, "a whole number, at least 1")
_SECONDS = (0.0, inf, inf, "a time")
_AMOUNTS = {
    **dict.fromkeys(
        (FaultKind.DROP, FaultKind.DUPLICATE, FaultKind.TRUNCATE, FaultKind.FLIP, FaultKind.REJECT), _WHOLE
    ),
    **dict.fromkeys((FaultKind.VANISH, FaultKind.FREEZE), _SECONDS),
    FaultKind.MTU: (23.0, 517.0, 0.0, "a whole number from 23 to 517"),
}
"""Least, largest and usual amount of the kinds that have one, and what it is in words."""


def parse_faults(text: str) -> tuple[Fault, ...]:
    """Return the faults of a script, in its order.

    A line with an error raises ValueError, which names the line and the reason."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        lexer = shlex.shlex(line, posix=True, punctuation_chars=";")
        lexer.whitespace_split = True
        try:
            found += [
                _fault(list(words)) for is_end, words in groupby(lexer, lambda one: set(one) == {";"}) if not is_end
            ]
        except ValueError as error:
            raise ValueError(f"line {number}: {error}") from None
    return tuple(found)


def _fault(words: list[str]) -> Fault:
    if len(words) < 3:
        raise ValueError("a fault is SECONDS SITE WHAT [AMOUNT]")
    at, kind = _number(words[0]), _one_of(FaultKind, words[2], "fault")
    site = None if words[1] == "*" else _one_of(Site, words[1], "site", "* and ")
    arguments, argument = words[3:], ""
    if kind in _NAMING:
        if not arguments:
            raise ValueError(f"{kind.value} needs {_NAMING[kind]}")
        argument = arguments.pop(0)
    if len(arguments) > (kind in _AMOUNTS):
        raise ValueError(f"too many words after {kind.value}")
    amount = 1.0
    if kind in _AMOUNTS:
        least, most, amount, meaning = _AMOUNTS[kind]
        amount = _number(arguments[0]) if arguments else amount
        if not least <= amount <= most or ("whole" in meaning and not amount.is_integer()):
            raise ValueError(f"{kind.value} needs {meaning}")
    return Fault(at, site, kind, amount, argument)


def _number(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        raise ValueError(f"{word!r} is not a number") from None
    if not isfinite(value) or value < 0.0:
        raise ValueError(f"{word} is out of range")
    return value


def _one_of(kind: type[_E], word: str, noun: str, more_choices: str = "") -> _E:
    try:
        return kind(word)
    except ValueError:
        choices = ", ".join(one.value for one in kind)
        raise ValueError(f"no {noun} {word!r}; there are {more_choices}{choices}") from None


class FaultState:
    """The faults of one device over time; `t` is always the time of the walk, s, and must not decrease."""

    def __init__(self, faults: Iterable[Fault], site: Site) -> None:
        site_faults = [fault for fault in faults if fault.site in (None, site)]
        self._pending = sorted(site_faults, key=attrgetter("at"))
        self._random = random.Random(f"faults {site.value}")
        self._left: dict[tuple[FaultKind, str], int] = defaultdict(int)
        self._hidden_until = -inf
        self._frozen_until = -inf
        self._hang_pending = False
        self._lost_at = inf
        self.must_disconnect = False
        """True when the link must end now."""
        self.mtu = inf
        """Largest MTU that the device accepts; inf when no fault sets it."""
        self.restarted_at: float | None = None
        """Time of the last restart of the device, s; None when it never restarted."""
        self.name: str | None = None
        """Name of the device; None when no fault sets it."""
        self.needs_pairing = False
        """True when the device accepts requests only on a paired link."""

    def next_at(self) -> float:
        """Return the time of the next fault, s; inf when there is none."""
        return min(self._pending[0].at if self._pending else inf, self._lost_at)

    def advance(self, t: float) -> None:
        """Apply all faults up to `t`."""
        while self._pending and self._pending[0].at <= t:
            self._start_fault(self._pending.pop(0))
        if self._lost_at <= t:
            self.must_disconnect, self._lost_at = True, inf

    def connected(self) -> None:
        """Start a new link: a pending loss of the old link is discarded, a pending HANG stays."""
        self.must_disconnect, self._lost_at = False, inf

    def hidden(self, t: float) -> bool:
        """Return whether the device does not advertise at `t`."""
        return t < self._hidden_until

    def frozen(self, t: float) -> bool:
        """Return whether the device sends nothing at `t`."""
        return t < self._frozen_until

    def thaw(self) -> None:
        """End a FREEZE before its time."""
        self._frozen_until = -inf

    def hangs(self, t: float) -> bool:
        """Return whether a request at `t` gets no answer: the first after a HANG, and all later ones on its link."""
        if self._hang_pending:
            self._hang_pending, self._lost_at = False, t + HANG_TIME
        return self._lost_at < inf

    def apply(self, value: bytes) -> list[bytes]:
        """Return the notifications that are sent in place of one notification."""
        if self.uses_up(FaultKind.DROP):
            return []
        if self.uses_up(FaultKind.TRUNCATE):
            value = value[: self._random.randrange(len(value))] if value else value
        if self.uses_up(FaultKind.FLIP):
            value = self._flip(value)
        return [value, value] if self.uses_up(FaultKind.DUPLICATE) else [value]

    def uses_up(self, kind: FaultKind, argument: str = "") -> bool:
        """Return whether a fault of this kind, and of this channel for REJECT, happens to the next one."""
        left = self._left[kind, argument]
        self._left[kind, argument] = max(0, left - 1)
        return left > 0

    def _start_fault(self, fault: Fault) -> None:
        if fault.kind in (FaultKind.DISCONNECT, FaultKind.RESTART, FaultKind.VANISH):
            self.must_disconnect = True
        match fault.kind:
            case FaultKind.RESTART:
                self.restarted_at = fault.at
            case FaultKind.VANISH:
                self._hidden_until = fault.at + fault.amount
            case FaultKind.FREEZE:
                self._frozen_until = fault.at + fault.amount
            case FaultKind.MTU:
                self.mtu = fault.amount
            case FaultKind.HANG:
                self._hang_pending = True
            case FaultKind.NAME:
                self.name = fault.argument
            case FaultKind.PAIRING:
                self.needs_pairing = True
            case _:
                self._left[fault.kind, fault.argument] += int(fault.amount)

    def _flip(self, value: bytes) -> bytes:
        damaged = bytearray(value)
        for bit in self._random.sample(range(8 * len(value)), min(8 * len(value), self._random.randint(1, 3))):
            damaged[bit // 8] ^= 1 << (bit % 8)
        return bytes(damaged)
