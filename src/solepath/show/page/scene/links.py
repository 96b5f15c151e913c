"""How the link of one site does, from its events: rate, loss, battery, silence."""

from __future__ import annotations

from collections import deque
from math import floor, inf
from typing import Any

from attrs import define, field

from ....events import (
    Connected,
    Disconnected,
    Event,
    PacketRejected,
    SampleGap,
    SampleRejected,
    StreamResumed,
    StreamStale,
)
from ....types import Site
from ...monitor import LinkHealth
from .rounding import shown

WINDOW = 2.0
"""s over which a rate is counted."""
MOST = 1000
"""Samples that are counted in it: 500 a second."""
SILENT = 1.5
"""s without a sample after which a link is silent, whether or not it was told."""
LOSS_OF = 10
"""s over which the loss is counted, in whole ones: an outage is over when it is over."""
STRAY = 1.0
"""s after a connection broke in which what still comes is no sign of a new one."""


@define
class Beat:
    """Samples a second of late."""

    times: deque[float] = field(factory=lambda: deque(maxlen=MOST))
    since: float = 0.0
    """When this stream began, s: one that has just begun is not slow."""

    def add(self, t: float) -> None:
        """One of them came at `t` s."""
        if not self.times:
            self.since = t
        self.times.append(t)

    def rate(self, now: float) -> float:
        """At `now` s, 1/s."""
        times = self.times
        while times and times[0] <= now - WINDOW:
            times.popleft()
        return len(times) / min(WINDOW, max(now - self.since, 0.5 * WINDOW))


@define
class Losses:
    """Packets of samples of the last seconds: how many came, and how many are known to be lost."""

    seconds: deque[list[int]] = field(factory=lambda: deque(maxlen=LOSS_OF + 1))
    """[second, came, lost], of those in which there were any."""

    def add(self, t: float, came: int, lost: int) -> None:
        """At `t` s there were so many more."""
        second = floor(t) if -inf < t < inf else 0
        if not self.seconds or self.seconds[-1][0] < second:
            self.seconds.append([second, 0, 0])
        newest = self.seconds[-1]
        newest[1] += came
        newest[2] += lost

    def share(self, now: float) -> float | None:
        """Of those that were sent, lost; None where none came."""
        kept = [one for one in self.seconds if one[0] > now - LOSS_OF - 1.0]
        came, lost = max(0, sum([one[1] for one in kept])), sum([one[2] for one in kept])
        return lost / (came + lost) if came else None


@define
class SceneLink:
    """One site's. Times are arrivals, s. `counts`: a session tells of its samples, as it does of those of feet."""

    counts: bool = True
    health: LinkHealth = field(factory=LinkHealth)
    moves: Beat = field(factory=Beat)
    """Samples of the inertial sensor."""
    presses: Beat = field(factory=Beat)
    """Samples of the cells."""
    losses: Losses = field(factory=Losses)
    heard: float | None = None
    """The newest sample."""
    fresh: bool = False
    """Samples have come over this connection."""
    lost_at: float | None = None
    """When the connection broke; None while there is one."""
    stale: bool = False
    gaps: int = 0
    rejected: int = 0
    counted: bool = False
    """Samples come in packets, which can get lost."""

    def sampled(self, t: float, known_at: float, beat: Beat) -> None:
        """A sample of `t` s came at `known_at`; `beat`: `moves` or `presses`."""
        beat.add(known_at)
        if known_at != self.heard:
            # the samples of one packet become known together
            self.health.came += 1
            self.losses.add(known_at, 1, 0)
            self.heard = known_at
            if known_at > t:
                self.counted = True
            if self.lost_at is None or known_at > self.lost_at + STRAY:
                self.lost_at, self.fresh, self.stale = None, True, False

    def take(self, event: Event) -> None:
        """What the link itself says."""
        match event:
            case PacketRejected() | SampleRejected():
                self.rejected += 1
                return
            case SampleGap():
                self.gaps += 1
            case StreamStale():
                self.stale = True
            case StreamResumed():
                self.stale = False
            case Connected():
                self.lost_at, self.fresh, self.stale = None, False, False
            case Disconnected():
                self.lost_at, self.fresh = event.known_at, False
            case _:
                pass
        came, lost = self.health.came, self.health.lost
        self.health.heard(event)
        if self.health.lost != lost or self.health.came != came:
            self.losses.add(event.known_at, self.health.came - came, self.health.lost - lost)

    def state(self, now: float) -> str:
        """In a word: whether data come, have not yet, come no more, or cannot come."""
        if self.lost_at is not None:
            return "lost"
        if self.stale:
            return "silent"
        if not self.counts:
            return "ok"
        if not self.fresh:
            return "waiting"
        return "ok" if self.heard is None or now - self.heard <= SILENT else "silent"

    @property
    def silent_from(self) -> float:
        """When it is silent if nothing comes any more, told or not, s."""
        return inf if self.heard is None else self.heard + SILENT

    def rate(self, now: float) -> float | None:
        """Samples a second of late, in the digits that are shown; None where nobody counts."""
        if not self.counts:
            return None
        moves, presses = self.moves.rate(now), self.presses.rate(now)
        rate = moves if moves > 0.0 else presses
        return round(rate) if rate >= 20.0 else round(rate, 1)

    def frame(self, now: float) -> dict[str, Any]:
        """As one of "links" of a frame."""
        health, state = self.health, self.state(now)
        of_late = self.losses.share(now) if self.counted and state == "ok" else None
        silent = state in ("silent", "lost") and self.heard is not None
        return {
            "state": state,
            "rate": self.rate(now),
            "lost": health.lost,
            "loss": shown(of_late, 4),
            "rejected": self.rejected,
            "gaps": self.gaps,
            "battery": shown(health.battery),
            "name": health.name,
            "signal": health.signal,
            "silent_for": shown(max(now - (self.heard or 0.0), 0.0), 1) if silent else None,
            "trouble": health.trouble,
        }


def unheard_since(links: dict[Site, SceneLink], now: float) -> float | None:
    """When any foot was heard last, s, while at `now` none is; None while one is, and before."""
    feet = [link for site, link in links.items() if site.foot is not None]
    last = max([link.heard for link in feet if link.heard is not None], default=None)
    return None if any([link.state(now) == "ok" for link in feet]) else last
