"""Values that the channels of an emulated device notify, each at its time.

All times count from the start of the walk, s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from attrs import define, field


class ValueSource(Protocol):
    """The values of one channel, each with a number and a time; times grow with the number."""

    def first_number_from(self, t: float) -> int:
        """Return the number of the first value at time `t` or later."""

    def due(self, number: int) -> float:
        """Return the time at which the radio has the value of this number, s; inf when there is no such value."""

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        """Return the notifications of the value in order; there are several when the value is too long for one."""


@define(eq=False)
class _Flow:
    source: ValueSource
    next_number: int


@define(eq=False)
class Flows:
    """The value sources of a device's channels, and the channels that its host has subscribed to."""

    _flows: dict[str, _Flow] = field(factory=dict, init=False)
    _subscribed: set[str] = field(factory=set, init=False)

    def put(self, channel: str, source: ValueSource | None, t: float) -> None:
        """Set the source of the channel's values from `t` on; None stops the channel."""
        if source is None:
            self._flows.pop(channel, None)
        else:
            self._flows[channel] = _Flow(source, source.first_number_from(t))

    def subscribe(self, channel: str, on: bool, t: float) -> None:
        """Start or stop the channel's notifications at `t`."""
        if on and channel not in self._subscribed:
            self._subscribed.add(channel)
            flow = self._flows.get(channel)
            if flow is not None:
                flow.next_number = max(flow.next_number, flow.source.first_number_from(t))
        elif not on:
            self._subscribed.discard(channel)

    def go_to(self, t: float) -> None:
        """Continue every channel at time `t` of the walk."""
        for flow in self._flows.values():
            flow.next_number = flow.source.first_number_from(t)

    def clear(self) -> None:
        """Remove all sources and all subscriptions."""
        self._flows.clear()
        self._subscribed.clear()

    def find_due(self, t: float) -> tuple[str | None, float]:
        """Return the subscribed channel whose value is due first until `t`, with its time, s; or None and `t`."""
        first, soonest = None, t
        for channel, flow in self._flows.items():
            if channel in self._subscribed:
                due = flow.source.due(flow.next_number)
                if due < soonest or (due == soonest and first is None):
                    first, soonest = channel, due
        return first, soonest

    def take(self, channel: str) -> tuple[ValueSource, int]:
        """Return the channel's source and the number of its next value, and advance to the value after it."""
        flow = self._flows[channel]
        number, flow.next_number = flow.next_number, flow.next_number + 1
        return flow.source, number
