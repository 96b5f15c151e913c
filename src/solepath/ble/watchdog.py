"""Tells a stream that froze from one that has nothing to say.

The CC2650's movement sensor is known to freeze while its connection stands (firmware before 1.12 on a weak coin
cell); writing its configuration again wakes it. A device that may be silent by its configuration (wake-on-motion) is
left alone.
"""

from __future__ import annotations

from enum import Enum

from attrs import define, field


class Remedy(Enum):
    """What to do about a frozen stream."""

    SET_UP = "write the setup again"
    RECONNECT = "disconnect and begin anew"


TRIES = 2
"""Times that the setup is written again before the connection is given up."""


@define
class Watchdog:
    """One connection. `streams`: the channels that must speak, `patience` s apart at most; none when silence is legal.

    `began`: when the device was set up, s.
    """

    streams: tuple[str, ...]
    patience: float
    began: float
    _heard: dict[str, float] = field(factory=dict, init=False)
    _tries: int = field(default=0, init=False)

    def heard(self, channel: str, t: float) -> None:
        """A notification of `channel` came at `t`, s."""
        self._heard[channel] = t

    def due(self) -> float | None:
        """When to look next, s; None: there is nothing to watch."""
        return min((self._last(stream) for stream in self.streams), default=None)

    def look(self, now: float) -> tuple[str, Remedy] | None:
        """The channel that froze, if any, and what to do. The time for the remedy to work begins with the call."""
        for stream in self.streams:
            if now < self._last(stream):
                continue
            if self._tries >= TRIES:
                return stream, Remedy.RECONNECT
            self._tries += 1
            self.began = now
            return stream, Remedy.SET_UP
        if all(stream in self._heard and self._heard[stream] > self.began for stream in self.streams):
            self._tries = 0
        return None

    def _last(self, stream: str) -> float:
        """The moment from which on the stream is frozen."""
        return max(self._heard.get(stream, self.began), self.began) + self.patience
