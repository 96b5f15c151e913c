"""Watchdog for streams that freeze while the connection stands.

The CC2650's movement sensor is known to freeze (firmware before 1.12 on a weak coin cell); writing its configuration
again restarts it. A device whose configuration allows silence (wake-on-motion) is not watched."""

from __future__ import annotations

from enum import Enum

from ...types.attrs import define, field


class Remedy(Enum):
    """The measure against a frozen stream."""

    SET_UP = "write the setup again"
    RECONNECT = "disconnect and connect again"


MAX_TRIES = 2
"""Largest number of times that the setup is written again before the device is disconnected."""


@define
class Watchdog:
    """The watchdog of one connection.

    `streams` are the channels that must notify at least every `patience` s; none when silence is allowed. `t_start` is
    the time at which the device was last set up, s."""

    streams: tuple[str, ...]
    patience: float
    t_start: float
    _last_t: dict[str, float] = field(factory=dict, init=False)
    _tries: int = field(default=0, init=False)

    def add_notification(self, channel: str, t: float) -> None:
        """Note a notification of `channel` at time `t`, s."""
        self._last_t[channel] = t

    def restart_clock(self, now: float) -> None:
        """Go on at `now`, s, after the clock restarted or was set."""
        self._last_t.clear()
        self.t_start = now

    def next_check_at(self) -> float | None:
        """Return the time of the next check, s; None when there is nothing to watch."""
        return min((self._frozen_at(stream) for stream in self.streams), default=None)

    def check(self, now: float) -> tuple[str, Remedy] | None:
        """Return the frozen channel and its remedy, or None; the remedy has `patience` s from `now` to take effect."""
        for stream in self.streams:
            if now < self._frozen_at(stream):
                continue
            if self._tries >= MAX_TRIES:
                return stream, Remedy.RECONNECT
            self._tries += 1
            self.t_start = now
            return stream, Remedy.SET_UP
        if all(stream in self._last_t and self._last_t[stream] > self.t_start for stream in self.streams):
            self._tries = 0
        return None

    def _frozen_at(self, stream: str) -> float:
        """Return the time from which the stream counts as frozen, s."""
        return max(self._last_t.get(stream, self.t_start), self.t_start) + self.patience
