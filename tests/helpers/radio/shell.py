"""A program in place of an app in another language: it has the Bluetooth, and exchanges nothing but JSON texts."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any

from attrs import define, field

from solepath.emulate.devices.attributes import AttError
from solepath.emulate.devices.peripheral import Peripheral

TICK = 0.1
"""Time between two messages "time", s."""
RETRY_DELAY = 0.5
"""Time from a disconnection to the next connection, s."""


@define
class Shell:
    """The shell: it connects to emulated devices and does what the messages of `receive` request."""

    receive: Callable[[str], str]
    devices: dict[str, Peripheral]
    now: float = 0.0
    messages: list[dict[str, Any]] = field(factory=list, init=False)
    """All messages that were received."""
    _connected: set[str] = field(factory=set, init=False)
    _retry_at: dict[str, float] = field(factory=dict, init=False)
    _connections: int = field(default=0, init=False)
    """Number of the newest connection."""
    _current: dict[str, int] = field(factory=dict, init=False)

    def send(self, *sent: dict[str, Any]) -> None:
        """Send messages, and do what the answers request."""
        for message in json.loads(self.receive(json.dumps(sent))):
            self.messages.append(message)
            if message["type"] in ("read", "subscribe", "write"):
                assert message["connection"] == self._current[message["device"]]
                self._do(message)
            elif message["type"] == "disconnect":
                self._lose(message["device"])

    def use(self, *sites: str | None) -> None:
        """Add the devices in order, at these sites; None for those that report theirs."""
        for device, site in zip(self.devices, sites, strict=True):
            self.send({"type": "add", "device": device, "site": site})
            self._retry_at[device] = self.now

    def run(self, until: float) -> None:
        """Let the devices send until `until`, s."""
        next_tick = self.now
        while self.now < until:
            due = [t for device in self._connected if (t := self.devices[device].next_due()) is not None]
            self.now = max(self.now, min([next_tick, *due, *self._retry_at.values()]))
            for device in [device for device, t in self._retry_at.items() if t <= self.now]:
                del self._retry_at[device]
                self._connect(device)
            for device in sorted(self._connected):
                self._poll(device)
            if self.now >= next_tick:
                next_tick += TICK
                self.send({"type": "time", "t": self.now})

    def lose(self, device: str) -> None:
        """Lose a connection, as by distance; the device is connected again."""
        self._lose(device)
        self._retry_at[device] = self.now + RETRY_DELAY

    def events(self, *kinds: str) -> list[dict[str, Any]]:
        """Return the events of these kinds, in order."""
        return [one for one in self.messages if one["type"] == "event" and one["event"] in kinds]

    def _connect(self, device: str) -> None:
        emulated = self.devices[device]
        emulated.connected(self.now, emulated.mtu)
        self._connected.add(device)
        characteristics = [
            [service.uuid.upper(), one.uuid, "notify" in one.properties]
            for service in emulated.services
            for one in service.characteristics
        ]
        self._connections += 1
        self._current[device] = self._connections
        about = {"device": device, "name": emulated.name, "signal": -61, "characteristics": characteristics}
        self.send({"type": "connected", "t": self.now, "connection": self._connections, **about})

    def _do(self, message: dict[str, Any]) -> None:
        emulated, about = self.devices[message["device"]], {"device": message["device"], "t": self.now}
        channel = self._channel(emulated, message["service"], message["characteristic"])
        value = b""
        try:
            if message["type"] == "read":
                value = emulated.read(channel, self.now) or b""
            elif message["type"] == "subscribe":
                emulated.subscribe(channel, True, self.now)
            else:
                emulated.write(channel, bytes.fromhex(message["value"]), self.now)
        except AttError as error:
            self.send({"type": "rejected", "reason": str(error), **about})
        else:
            self.send({"type": "done", "value": value.hex(), **about})

    def _poll(self, device: str) -> None:
        emulated = self.devices[device]
        sent = [[self.now, device, one.channel, one.value.hex()] for one in emulated.poll(self.now)]
        if sent:
            self.send({"type": "values", "values": sent})
        if emulated.must_hang_up(self.now):
            self.lose(device)

    def _lose(self, device: str) -> None:
        if device in self._connected:
            self._connected.discard(device)
            self.devices[device].disconnected(self.now)
            self.send({"type": "disconnected", "device": device, "t": self.now})

    @staticmethod
    def _channel(emulated: Peripheral, service: str, characteristic: str) -> str:
        [channel] = [
            one.channel
            for found in emulated.services
            for one in found.characteristics
            if (found.uuid, one.uuid) == (service, characteristic)
        ]
        return channel


def shell(receive: Callable[[str], str], devices: Iterable[Peripheral]) -> Shell:
    """Return a shell with these devices, by their addresses."""
    return Shell(receive, {device.address: device for device in devices})
