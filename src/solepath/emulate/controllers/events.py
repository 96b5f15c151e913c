"""The connection events of a link: both ends listen at them only, so what is ready waits for the next."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from math import ceil

from attrs import define, field

_SLACK = 1e-6
"""Of an interval: what the sums of floats may be out by."""


@define(eq=False)
class Events:
    """One link's. The first is `interval` s after it was made, and the others at the same distance.

    At an event everything goes that is ready by then, in its order, however much it is: a radio that can send no more
    than some packets at each is not modelled. What is said in answer goes at the next.
    """

    interval: float
    _loop: asyncio.AbstractEventLoop = field(factory=asyncio.get_running_loop, init=False)
    _began: float = field(init=False)
    _done: int = field(default=0, init=False)
    """The number of the last event at which anything went."""
    _ready: list[Callable[[], None]] = field(factory=list, init=False)
    _timer: asyncio.TimerHandle | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self._began = self._loop.time()

    def send(self, packet: Callable[[], None]) -> None:
        """Call it at the next event."""
        self._ready.append(packet)
        if self._timer is None:
            number = max(self._done + 1, ceil((self._loop.time() - self._began) / self.interval - _SLACK))
            self._timer = self._loop.call_at(self._began + number * self.interval, self._event, number)

    def flush(self) -> None:
        """Send what is ready without waiting any longer: the link ends in an orderly way."""
        ready = self._ready
        self.end()
        for packet in ready:
            packet()

    def end(self) -> None:
        """Forget what is ready: the link is gone."""
        self._ready = []
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _event(self, number: int) -> None:
        self._done = number
        self.flush()
