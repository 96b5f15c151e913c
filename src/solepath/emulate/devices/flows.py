"""What the channels of an emulated device have to tell, and which of it is due first. Times are of the walk, s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from attrs import define, field


class ValueSource(Protocol):
    """What a channel has to tell: values with numbers, each at its time."""

    def after(self, t: float) -> int:
        """The number of the first value that is measured at `t` or later."""

    def due(self, number: int) -> float:
        """When the radio has it, not before the one before it; inf when there is no such value."""

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        """What is sent then, in order: nothing, one notification, or several where one is not enough."""


@define(eq=False)
class _Flow:
    source: ValueSource
    number: int


@define(eq=False)
class Flows:
    """The sources of a device's channels, and the channels that its host listens to."""

    _flows: dict[str, _Flow] = field(factory=dict, init=False)
    _subscribed: set[str] = field(factory=set, init=False)

    def put(self, channel: str, source: ValueSource | None, t: float) -> None:
        """From `t` on the channel tells what `source` has, or nothing."""
        if source is None:
            self._flows.pop(channel, None)
        else:
            self._flows[channel] = _Flow(source, source.after(t))

    def subscribe(self, channel: str, on: bool, t: float) -> None:
        """Somebody listens to the channel from `t` on, or nobody does."""
        if on and channel not in self._subscribed:
            self._subscribed.add(channel)
            flow = self._flows.get(channel)
            if flow is not None:
                flow.number = max(flow.number, flow.source.after(t))
        elif not on:
            self._subscribed.discard(channel)

    def go_to(self, t: float) -> None:
        """The walk is at `t` now."""
        for flow in self._flows.values():
            flow.number = flow.source.after(t)

    def clear(self) -> None:
        """Nobody tells anything, and nobody listens."""
        self._flows.clear()
        self._subscribed.clear()

    def first(self, t: float) -> tuple[str | None, float]:
        """The channel listened to that has something to tell soonest, by `t` at the latest, and when; None and `t` when
        there is none."""
        first, soonest = None, t
        for channel, flow in self._flows.items():
            if channel in self._subscribed:
                due = flow.source.due(flow.number)
                if due < soonest or (due == soonest and first is None):
                    first, soonest = channel, due
        return first, soonest

    def take(self, channel: str) -> tuple[ValueSource, int]:
        """The channel's source and the number of its next value, which is taken by this."""
        flow = self._flows[channel]
        number, flow.number = flow.number, flow.number + 1
        return flow.source, number
