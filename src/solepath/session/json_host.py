"""A host whose calls and results are JSON texts, for programs in other languages (protocol/host.md).

host = JsonHost()
for message in json.loads(host.receive(text)): ..."""

from __future__ import annotations

import json
import re
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterable
from typing import Any

from ..events import Event
from ..link.catalogue import DEVICES, PROFILES
from ..link.kinds import is_address
from ..link.profile import Profile
from ..link.setup.device_setup import GattCharacteristic
from ..types import Packet, Site
from ..types.records import MAX_TIME
from ..wire.receiver import MAX_NAME_SIZE
from .host import Host, HostCommand, Observe
from .session import Session

Message = dict[str, Any]

SITES = {site.value: site for site in Site}
HEX = re.compile("([0-9a-fA-F]{2})*")
"""Bytes as hexadecimal digits."""
MAX_CHARACTERISTICS = 1000
"""Largest number of characteristics of a device, chosen by hand."""


class JsonHost:
    """A host that receives and returns messages as JSON texts.

    `session` is a new one with the defaults unless one is given, for instance one with a calibration, or with the app's
    own devices (`Session(profiles=[DRIVER])`), which `add` and `scan` then know. With `packets`, every packet is
    returned as a message too, with the keys of a line of a recording. `observe` replaces the messages of packets and
    events by calls of a function."""

    def __init__(
        self, session: Session | None = None, *, packets: bool = False, observe: Observe | None = None
    ) -> None:
        self._messages: list[Message] = []
        self._packets = packets
        self._connections: dict[str, int | None] = {}
        """Number that the app gave to the newest connection of each device."""
        self._is_finished = False
        self.host = Host(session or Session(), observe or self._observe)

    def receive(self, text: str) -> str:
        """Return the messages that follow from a message, or from a list of messages, as a JSON list.

        A message that cannot be understood changes nothing and is answered by a message "error"."""
        try:
            received = json.loads(text, parse_constant=_reject_constant)
        except (ValueError, RecursionError) as error:
            received, self._messages = [], [_error(f"not JSON: {error}")]
        for message in received if isinstance(received, list) else [received]:
            self._use(message)
        messages, self._messages = self._messages, []
        return json.dumps(messages, allow_nan=False, separators=(",", ":"))

    def _use(self, message: Any) -> None:
        kind = message.get("type") if isinstance(message, dict) else None
        if not isinstance(kind, str) or kind not in HANDLERS:
            self._messages.append(_error("a message is an object with a known type"))
            return
        try:
            if self._is_finished and kind not in AFTER_THE_END:
                raise ValueError("the walk is finished")
            HANDLERS[kind](self, self._read(message))
        except ValueError as error:
            self._messages.append(_error(str(error), kind, message.get("device")))

    def _read(self, message: Message) -> Message:
        """Return the keys of a message that are known and not null; ValueError when one has an impossible value."""
        names: dict[str, dict[str, Any]] = {"site": SITES, "profile": DEVICES | self.host.profiles}
        fields = _Fields()
        for key, value in message.items():
            if value is None:
                continue
            if key in KEYS:
                value = _checked(key, value)
            elif key in names:
                if not isinstance(value, str) or value not in names[key]:
                    raise ValueError(f"there is no {key} {value!r:.40}")
                value = names[key][value]
            fields[key] = value
        return fields

    def _observe(self, packet: Packet | None, events: list[Event]) -> None:
        if packet is not None and self._packets:
            line = {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data.hex()}
            self._messages.append({"type": "packet", **line, **({"device": packet.device} if packet.device else {})})
        self._messages += [{"type": "event", **event.to_dict()} for event in events]

    def _command(self, commands: list[HostCommand]) -> None:
        for one in commands:
            about = {"device": one.device, "connection": self._connections.get(one.device)}
            request = one.request
            if request is None:
                self._messages.append({"type": "disconnect", **about, "reason": one.reason, "wrong": one.is_wrong})
                continue
            self._messages.append(
                {
                    "type": request.operation.value,
                    **about,
                    "channel": request.channel.name,
                    "service": request.channel.service,
                    "characteristic": request.channel.characteristic,
                    "value": request.value.hex(),
                }
            )

    def _start(self, message: Message) -> None:
        """Replace the session by a new or a saved one, with recipe and devices of the earlier, and no other option."""
        recipe = self.host.session.recipe
        drivers = self.host.session._kinds.drivers
        if "state" in message:
            state = b64decode(message["state"], validate=True)
            session = Session.unpack(state, recipe, profiles=drivers)
        else:
            session = Session(recipe, profiles=drivers)
        self.host = Host(session, self.host.observe)
        self._packets, self._is_finished = message.get("packets", False), False
        self._connections.clear()

    def _remove(self, message: Message) -> None:
        self.host.remove(message["device"])
        self._connections.pop(message["device"], None)

    def _connected(self, message: Message) -> None:
        found: dict[tuple[str, str], GattCharacteristic] = {}
        for one in message["characteristics"]:
            match one:
                case [str(service), str(uuid), bool(can_notify)]:
                    one = GattCharacteristic(service, uuid, can_notify)
                    found.setdefault((one.service, one.uuid), one)
                case _:
                    raise ValueError("a characteristic is [service, UUID, can notify]")
        device, name = message["device"], message.get("name", "")
        commands = self.host.connect(device, name, found.values(), message["t"], signal=message.get("signal"))
        self._connections[device] = message.get("connection")
        self._command(commands)

    def _answer(self, message: Message) -> None:
        """Use the outcome of a request, unless it is of an earlier connection of the device."""
        device, now = message["device"], message["t"]
        is_done = message["type"] == "done"
        outcome: Any = bytes.fromhex(message.get("value", "")) if is_done else message["reason"]
        if message.get("connection") in (None, self._connections.get(device)):
            self._command((self.host.answer if is_done else self.host.reject)(device, outcome, now))

    def _values(self, message: Message) -> None:
        values = []
        for one in message["values"]:
            match one:
                case [t, str(device), str(channel), value]:
                    values.append((device, channel, bytes.fromhex(_checked("value", value)), _checked("t", t)))
                case _:
                    raise ValueError("each is [t, device, channel, value]")
        unknown = ""
        for notification in values:
            try:
                self.host.notify(*notification)
            except ValueError as error:  # its last ones, after it was removed, end none of the others
                unknown = str(error)
        if unknown:
            raise ValueError(unknown)

    def _save(self, message: Message) -> None:
        self._messages.append({"type": "saved", "state": b64encode(self.host.session.pack()).decode()})

    def _finish(self, message: Message) -> None:
        self._is_finished = True
        self.host.finish()


def filters(own: Iterable[Profile] = ()) -> Message:
    """Return the message "filters": the conditions of a scan for `own` and built-in devices, and their services."""
    conditions: dict[tuple[str, str, str], None] = {}  # each once, in their order
    services: dict[str, None] = {}
    for profile in (*own, *PROFILES):
        conditions |= dict.fromkeys([("", "", service) for service in profile.services])
        conditions |= dict.fromkeys([(name, "", "") for name in profile.names])
        conditions |= dict.fromkeys([("", prefix, "") for prefix in profile.prefixes])
        services |= dict.fromkeys([channel.service for channel in profile.channels])
    rows = [dict(zip(("name", "prefix", "service"), one, strict=True)) for one in conditions]
    return {"type": "filters", "filters": rows, "services": [*services]}


def _reject_constant(text: str) -> None:
    raise ValueError(f"{text} is no number")


class _Fields(Message):
    """The fields of a message; ValueError for one that is read and absent."""

    def __missing__(self, key: str) -> Any:
        raise ValueError(f"{key} is absent")


def _checked(key: str, value: Any) -> Any:
    """Return the value of a key; ValueError for one that it cannot have."""
    kinds, condition, words = KEYS[key]
    if type(value) not in kinds or not condition(value):
        raise ValueError(words)
    return float(value) if key == "t" else value


def _any(_: object) -> bool:
    return True


def _error(reason: str, of: str | None = None, device: Any = None) -> Message:
    about = {"device": device} if isinstance(device, str) else {}
    return {"type": "error", "of": of, **about, "reason": reason}


KEYS: dict[str, tuple[tuple[type, ...], Callable[[Any], object], str]] = {
    "address": ((str,), is_address, "address is no address of a device"),
    "characteristics": ((list,), lambda rows: len(rows) <= MAX_CHARACTERISTICS, "characteristics are a list"),
    "connection": ((int,), _any, "connection is a whole number"),
    "device": ((str,), lambda device: device and is_address(device), "device is no address of a device"),
    "name": ((str,), lambda name: len(name) <= MAX_NAME_SIZE, "name is no name of a device"),
    "packets": ((bool,), _any, "packets is true or false"),
    "reason": ((str,), len, "reason is a sentence"),
    "signal": ((int,), lambda signal: -127 <= signal <= 20, "signal is a whole number of dBm"),
    "state": ((str,), _any, "state is the text of a message saved"),
    "t": ((int, float), lambda t: abs(t) <= MAX_TIME, "t is a time in s"),
    "value": ((str,), HEX.fullmatch, "a value is a text of hexadecimal digits"),
    "values": ((list,), _any, "values are a list"),
}
"""What the values of keys are: types, a condition, and words for an error."""


HANDLERS: dict[str, Callable[[JsonHost, Message], None]] = {
    "start": JsonHost._start,
    "bind": lambda one, message: one.host.session.bind(message["site"], message.get("address", "")),
    "scan": lambda one, message: one._messages.append(filters(one.host.profiles.values())),
    "add": lambda one, message: one.host.add(
        message["device"], message.get("site"), message.get("profile"), message.get("address")
    ),
    "remove": JsonHost._remove,
    "connected": JsonHost._connected,
    "done": JsonHost._answer,
    "rejected": JsonHost._answer,
    "failed": lambda one, message: one.host.report(message["device"], message["reason"], message["t"]),
    "values": JsonHost._values,
    "disconnected": lambda one, message: one.host.disconnect(message["device"], message["t"]),
    "time": lambda one, message: one._command(one.host.advance(message["t"])),
    "restart": lambda one, message: one.host.restart_clock(message["t"]),
    "save": JsonHost._save,
    "finish": JsonHost._finish,
}
"""Method for each type of message that is received."""
AFTER_THE_END = ("start", "scan", "save", "remove")
"""Messages that make sense after "finish"."""
