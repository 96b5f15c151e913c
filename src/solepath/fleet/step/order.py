"""Checking of the rows that a phone sent, and ordering by run and number.

A row in its turn passes at once. A row ahead of its turn is held until the missing rows have come, or until more than
`window` rows or MAX_HELD_BYTES are held: then the missing rows are given up. A row that was used before is dropped
without a report. More than `window` rows in rising order of a smaller run, or of a run that is no longer current, mean
that the phone's clock was corrected or that a run's number was wrong: then their run becomes the current one."""

from __future__ import annotations

from bisect import insort
from math import inf

from attrs import define, field, frozen

from ...types import Packet, Site
from ...types.plain import has_plain_values
from ...types.records import MAX_TIME
from ..events import SentRejection
from .sent import MAX_COUNT, MAX_DATA_LENGTH, MAX_DETAIL_LENGTH, MAX_NAME_LENGTH, End, Tick
from .unused import NumberSpan, StrayRows, UnusedNumbers

MAX_HELD_BYTES = 65_536
"""Largest total size of held packets, with the names of their channels and the addresses of their devices, bytes."""


@frozen
class RejectedItem:
    """The substitute for a row that cannot be used."""

    reason: SentRejection
    detail: str = ""
    count: int = 1
    """Number of unusable rows of the run so far, this one included; not all of them are reported."""


@frozen
class MissingNumbers:
    """The count of consecutive numbers that were given up."""

    count: int


Payload = Packet | Tick | End | RejectedItem
PassedRows = list[tuple[int, int, Payload | MissingNumbers]]
"""Rows (run, number, payload) in order; MissingNumbers stands at the first missing number."""


@define
class RowOrder:
    """The state of ordering one wearer's rows; `next_number` is the next expected number of the current run."""

    window: int
    run: int = -1
    """Current run; -1 before a row has passed."""
    next_number: int = 0
    ended: bool = False
    """True if the End of this run has passed."""
    held_rows: dict[tuple[int, int], Payload] = field(factory=dict)
    unused: UnusedNumbers = field(factory=UnusedNumbers)
    strays: StrayRows = field(factory=StrayRows)
    _waiting: list[tuple[int, int]] = field(init=False)
    """Keys of `held_rows` in order."""
    _size: int = field(init=False)
    """Size of `held_rows`, bytes."""

    def __attrs_post_init__(self) -> None:
        self._waiting = sorted(self.held_rows)
        self._size = sum(map(_size, self.held_rows.values()))  # whole numbers

    def take(self, run: int, number: int, payload: Payload) -> PassedRows:
        """Add one row and return the rows that pass now; `run` and `number` are from 0 to MAX_COUNT."""
        if run == self.run:
            if number < self.next_number:
                return self._reject(run, number, SentRejection.LATE) if self.unused.was_given_up(run, number) else []
            if self.ended:
                return self._reject(run, number, SentRejection.AFTER_END)
        elif run < self.run or self.unused.was_current(run):
            return self._take_other_run(run, number, payload)
        if not self._waiting and number == self.next_number and run == self.run:
            self.strays.rising_rows = self.strays.number = 0
            passed: PassedRows = []
            self._pass(number, payload, passed)
            return passed
        if (run, number) not in self.held_rows:
            self.strays.rising_rows = self.strays.number = 0
            self.held_rows[run, number] = payload
            insort(self._waiting, (run, number))
            self._size += _size(payload)
        return self._release()

    def _take_other_run(self, run: int, number: int, payload: Payload) -> PassedRows:
        """Add a row of a run that is no longer current, or of a smaller run that was never used."""
        unused, strays = self.unused, self.strays
        if unused.was_used(run, number):
            return []
        if not unused.may_continue(run, number):
            return self._reject(run, number, SentRejection.LATE)
        if strays.count_rising(run, number) > self.window:
            return self._switch_run(run, number, payload)
        passed = self._reject(run, number, SentRejection.LATE)
        strays.rising_rows, strays.number = strays.count_rising(run, number), max(number, strays.number)
        return passed

    def _switch_run(self, run: int, number: int, payload: Payload) -> PassedRows:
        """Switch to the run of this row; the held rows pass first, without waiting for missing rows."""
        first_number = self.unused.reenter(run)
        passed = self._release(may_wait=False)
        self._enter(run, first_number)
        self.strays = StrayRows()
        self._pass(number, payload, passed)
        return passed

    def _reject(self, run: int, number: int, reason: SentRejection) -> PassedRows:
        """Count a row that cannot be used; return its rejection if this count is reported (StrayRows.add)."""
        return [(run, number, RejectedItem(reason, count=self.strays.count))] if self.strays.add(run) else []

    def _release(self, may_wait: bool = True) -> PassedRows:
        """Return the held rows that are in their turn, and give up missing rows when too many are held."""
        passed: PassedRows = []
        while self._waiting:
            run, number = self._waiting[0]
            if run == self.run and self.ended:
                self._pop()
                passed += self._reject(run, number, SentRejection.AFTER_END)
                continue
            is_in_turn = number == self.next_number if run == self.run else number == 0
            if may_wait and not is_in_turn and len(self._waiting) <= self.window and self._size <= MAX_HELD_BYTES:
                break
            if run != self.run:
                self._enter(run, 0)
            self._pass(number, self._pop(), passed)
        return passed

    def _pop(self) -> Payload:
        payload = self.held_rows.pop(self._waiting.pop(0))
        self._size -= _size(payload)
        return payload

    def _enter(self, run: int, number: int) -> None:
        """Enter another run at this number; the rest of the previous run counts as unused."""
        if self.run >= 0:
            self.unused.add(NumberSpan(self.run, self.next_number, MAX_COUNT + 1))
        self.run, self.next_number, self.ended = run, number, False

    def _pass(self, number: int, payload: Payload, passed: PassedRows) -> None:
        """Pass one row of the current run; give up the missing rows before it."""
        if number > self.next_number:
            self.unused.add(NumberSpan(self.run, self.next_number, number))
            passed.append((self.run, self.next_number, MissingNumbers(number - self.next_number)))
        self.next_number, self.ended = number + 1, isinstance(payload, End)
        passed.append((self.run, number, payload))


def _size(payload: Payload) -> int:
    return len(payload.data) + len(payload.channel) + len(payload.device) if isinstance(payload, Packet) else 0


def check_payload(payload: object) -> Payload:
    """Return a payload that a session accepts and a state can hold, or its rejection."""
    if isinstance(payload, Packet):
        return _convert_packet(payload)
    if isinstance(payload, Tick):
        t = _number(payload.t)
        if t is None:
            return RejectedItem(SentRejection.MALFORMED, "a Tick without a time")
        return Tick(t) if -MAX_TIME <= t <= MAX_TIME else RejectedItem(SentRejection.NOT_FINITE, f"a Tick at {t:g} s")
    if isinstance(payload, End):
        return End()
    return RejectedItem(SentRejection.MALFORMED, f"a {type(payload).__name__}"[:MAX_DETAIL_LENGTH])


def _convert_packet(packet: Packet) -> Payload:
    """Return the packet with numbers and bytes of the standard types, also for an app's own class."""
    is_plain = type(packet) is Packet and has_plain_values(packet)
    t, data = _number(packet.t), packet.data
    if isinstance(data, bytearray | memoryview):
        data = bytes(data)
    if t is None or not isinstance(data, bytes) or not isinstance(packet.site, Site):
        return RejectedItem(SentRejection.MALFORMED, "a packet holds a time, a Site and bytes")
    if not isinstance(packet.channel, str) or not isinstance(packet.device, str):
        return RejectedItem(SentRejection.MALFORMED, "a packet names its channel and its device")
    for name, size, limit in (
        ("data", len(data), MAX_DATA_LENGTH),
        ("channel", len(packet.channel), MAX_NAME_LENGTH),
        ("device", len(packet.device), MAX_NAME_LENGTH),
    ):
        if size > limit:
            return RejectedItem(SentRejection.OVERSIZED, f"{name} of {size}; {limit} are the most")
    return packet if is_plain else Packet(t, packet.site, str(packet.channel), bytes(data), str(packet.device))


def _number(value: object) -> float | None:
    """Return a float or None; an int that is too large for a float counts as infinite."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return None
    try:
        return float(value)
    except OverflowError:
        return inf
