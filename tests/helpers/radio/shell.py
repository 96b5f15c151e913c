"""A program in place of an app in another language: it has the Bluetooth, and exchanges nothing but JSON texts."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from random import Random
from typing import Any

from attrs import define, field

from solepath.emulate.devices.attributes import AttError
from solepath.emulate.devices.peripheral import Peripheral

TICK = 0.2
"""Time between two messages "time", s."""
BATCH_TIME = 0.03
"""Time for which notifications are collected, s."""
MAX_DELAY = 0.06
"""Longest time that a device takes for a request, s."""
RETRY_DELAY = 0.5
"""Time from a disconnection to the next connection, s."""
REQUESTS = ("read", "subscribe", "write")


@define
class Shell:
    """The shell: it connects to emulated devices and does what the messages of `receive` request, each after a while.

    A request that is still to be done when its connection is lost is answered late, as a system may do."""

    receive: Callable[[str], str]
    devices: dict[str, Peripheral]
    now: float = 0.0
    messages: list[dict[str, Any]] = field(factory=list, init=False)
    """All messages that were received."""
    _connections: int = field(default=0, init=False)
    """Number of the newest connection."""
    _connected: dict[str, int] = field(factory=dict, init=False)
    """Number of the connection of each connected device."""
    _requests: list[tuple[float, dict[str, Any]]] = field(factory=list, init=False)
    """Requests, each with the time at which the device has done it."""
    _batch: list[list[Any]] = field(factory=list, init=False)
    _retry_at: dict[str, float] = field(factory=dict, init=False)
    _delays: Random = field(factory=lambda: Random(5), init=False)

    def send(self, *sent: dict[str, Any]) -> None:
        """Send messages after the notifications that wait, and take the answers."""
        values, self._batch = self._batch, []
        first = ({"type": "values", "values": values},) if values else ()
        for message in json.loads(self.receive(json.dumps([*first, *sent]))):
            self.messages.append(message)
            device = message.get("device", "")
            if message["type"] in (*REQUESTS, "disconnect") and message["connection"] != self._connected.get(device):
                continue
            if message["type"] in REQUESTS:
                self._requests.append((self.now + self._delays.uniform(0.0, MAX_DELAY), message))
            elif message["type"] == "disconnect":
                self._lose(device)
                if not message["wrong"]:
                    self._retry_at[device] = self.now + RETRY_DELAY

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
            due += [t for t, _ in self._requests] + [self._batch[0][0] + BATCH_TIME for _ in self._batch[:1]]
            self.now = max(self.now, min([next_tick, *due, *self._retry_at.values()]))
            for device in [device for device, t in self._retry_at.items() if t <= self.now]:
                del self._retry_at[device]
                self._connect(device)
            for device in sorted(self._connected):
                self._poll(device)
            done = [message for t, message in self._requests if t <= self.now]
            self._requests = [(t, message) for t, message in self._requests if t > self.now]
            for message in done:
                self._do(message)
            if self._batch and self.now >= self._batch[0][0] + BATCH_TIME:
                self.send()
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
        self._connections += 1
        self._connected[device] = self._connections
        characteristics = [
            [short(service.uuid), short(one.uuid), "notify" in one.properties]
            for service in emulated.services
            for one in service.characteristics
        ]
        about = {"device": device, "name": emulated.name, "signal": -61, "characteristics": characteristics}
        self.send({"type": "connected", "t": self.now, "connection": self._connections, **about})

    def _do(self, message: dict[str, Any]) -> None:
        device, connection = message["device"], message["connection"]
        about, value = {"device": device, "connection": connection, "t": self.now}, b""
        if connection != self._connected.get(device):  # the system answers for a connection that it has lost
            self.send({"type": "done", "value": "", **about})
            return
        emulated = self.devices[device]
        channel = self._channel(emulated, message["service"], message["characteristic"])
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
        self._batch += [[self.now, device, one.channel, one.value.hex()] for one in emulated.poll(self.now)]
        if emulated.must_hang_up(self.now):
            self.lose(device)

    def _lose(self, device: str) -> None:
        if self._connected.pop(device, None) is not None:
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


def short(uuid: str) -> str:
    """Return a UUID in upper case, of one that Bluetooth assigns only the four digits, as CoreBluetooth does."""
    return uuid[4:8].upper() if uuid.endswith("-0000-1000-8000-00805f9b34fb") else uuid.upper()


def shell(receive: Callable[[str], str], devices: Iterable[Peripheral]) -> Shell:
    """Return a shell with these devices, by their addresses."""
    return Shell(receive, {device.address: device for device in devices})
