"""The order of what a phone sent: by run and number, whatever order it comes in.

What comes in its turn passes at once. What is ahead of its turn is held until what is missing has come, or until more
is held than `window` or HELD bytes of it: then what is missing is given up. What was used before is dropped without a
word.
"""

from __future__ import annotations

from bisect import insort

from attrs import define, field, frozen

from ..events.fleet import Refusal
from ..types import Packet
from .sent import MOST, End, Tick

HELD = 65_536
"""Bytes of packets, of their channels' names and devices' addresses."""
REMEMBERED = 16
"""Spans of numbers that were given up."""


@frozen
class Refused:
    """What stands in the place of what cannot be used."""

    reason: Refusal
    detail: str = ""


@frozen
class Missing:
    """So many numbers were given up, from this place on."""

    count: int


What = Packet | Tick | End | Refused
Passed = list[tuple[int, int, What | Missing]]
"""(run, number, what), in order."""


@frozen
class Span:
    """Numbers from `first` to before `end` that were never used. `end` beyond MOST: what was still to come of a run
    when the next began."""

    run: int
    first: int
    end: int


@define
class Order:
    """What is next of one wearer."""

    window: int
    run: int = -1
    """-1: nothing has passed yet."""
    next: int = 0
    ended: bool = False
    """The End of this run has passed."""
    held: dict[tuple[int, int], What] = field(factory=dict)
    spans: list[Span] = field(factory=list)
    """The last that were given up, oldest first."""
    _waiting: list[tuple[int, int]] = field(init=False)
    """Keys of `held` in order."""
    _size: int = field(init=False)
    """Bytes in `held`."""

    def __attrs_post_init__(self) -> None:
        self._waiting = sorted(self.held)
        self._size = sum(map(_size, self.held.values()))

    def take(self, run: int, number: int, what: What) -> Passed:
        """What passes now that this came. `run` and `number`: 0 to MOST."""
        if run < self.run or (run == self.run and number < self.next):
            return [(run, number, Refused(Refusal.LATE))] if self._was_never_used(run, number) else []
        if run == self.run and self.ended:
            return [(run, number, Refused(Refusal.AFTER_END))]
        if (run, number) not in self.held:
            self.held[run, number] = what
            insort(self._waiting, (run, number))
            self._size += _size(what)
        return self._release()

    def _release(self) -> Passed:
        """What is held and in its turn, or waited for too long."""
        passed: Passed = []
        while self._waiting:
            run, number = self._waiting[0]
            in_turn = number == self.next if run == self.run else number == 0
            if run == self.run and self.ended:
                self._pop()
                passed.append((run, number, Refused(Refusal.AFTER_END)))
                continue
            if not in_turn and len(self._waiting) <= self.window and self._size <= HELD:
                break
            if run != self.run:
                self._begin(run)
            if not in_turn:
                self._give_up(self.next, number)
                passed.append((run, self.next, Missing(number - self.next)))
            what = self._pop()
            self.next = number + 1
            self.ended = isinstance(what, End)
            passed.append((run, number, what))
        return passed

    def _pop(self) -> What:
        what = self.held.pop(self._waiting.pop(0))
        self._size -= _size(what)
        return what

    def _begin(self, run: int) -> None:
        """A new run. How many were sent in the one before, nobody said."""
        if self.run >= 0:
            self._give_up(self.next, MOST + 1)
        self.run, self.next, self.ended = run, 0, False

    def _give_up(self, first: int, end: int) -> None:
        self.spans = [*self.spans[1 - REMEMBERED :], Span(self.run, first, end)]

    def _was_never_used(self, run: int, number: int) -> bool:
        """As far as is remembered. Of a run that is not remembered nothing was used."""
        spans = [span for span in self.spans if span.run == run]
        if run != self.run and not spans:
            return True
        return any([span.first <= number < span.end for span in spans])


def _size(what: What) -> int:
    return len(what.data) + len(what.channel) + len(what.device) if isinstance(what, Packet) else 0
