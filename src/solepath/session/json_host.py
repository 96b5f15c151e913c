"""A host whose calls and results are JSON texts, for programs in other languages (protocol/host.md).

host = JsonHost()
for message in json.loads(host.receive(text)): ..."""

from __future__ import annotations

import json
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from ..events import Event
from ..link.catalogue import BY_NAME, PROFILES
from ..link.decoder import MAX_ARRIVAL_TIME
from ..link.kinds import is_address
from ..link.profile import Profile
from ..link.setup.config import scan_filters, used_services
from ..link.setup.device_setup import GattCharacteristic
from ..types import Packet, Site
from .host import Host, HostCommand, Observe
from .session import Session

Message = dict[str, Any]
T = TypeVar("T")

SITES = {site.value: site for site in Site}
BASE_UUID = "-0000-1000-8000-00805f9b34fb"
"""End of every UUID that Bluetooth itself assigns (Bluetooth Core, vol 3 part B, 2.5.1)."""
MAX_NAME_LENGTH = 248
"""Longest name of a device, characters (Bluetooth Core, vol 3 part C, 12.1: 248 bytes)."""
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
            HANDLERS[kind](self, _Fields(message))
        except ValueError as error:
            self._messages.append(_error(str(error), kind, message.get("device")))

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
        state, packets = message.get("state"), message.get("packets", False)
        if type(packets) is not bool:
            raise ValueError("packets is true or false")
        if state is not None and not isinstance(state, str):
            raise ValueError("state is the text of a message saved")
        recipe = self.host.session.recipe
        drivers = self.host.session._kinds.drivers
        if state is None:
            session = Session(recipe, profiles=drivers)
        else:
            session = Session.unpack(b64decode(state, validate=True), recipe, profiles=drivers)
        self.host = Host(session, self.host.observe)
        self._packets, self._is_finished = packets, False
        self._connections.clear()

    def _bind(self, message: Message) -> None:
        site, address = _choose(message, "site", SITES), message.get("address", "")
        if site is None:
            raise ValueError("site is absent")
        if not isinstance(address, str):
            raise ValueError("address is no address of a device")
        self.host.session.bind(site, address)

    def _add(self, message: Message) -> None:
        address = message.get("address")
        if address is not None and (not isinstance(address, str) or not is_address(address)):
            raise ValueError("address is no address of a device")
        site, profile = _choose(message, "site", SITES), _choose(message, "profile", BY_NAME | self.host.profiles)
        self.host.add(_device(message), site, profile, address)

    def _remove(self, message: Message) -> None:
        self.host.remove(_device(message))
        self._connections.pop(_device(message), None)

    def _connected(self, message: Message) -> None:
        characteristics, name, signal = message["characteristics"], message.get("name") or "", message.get("signal")
        if not isinstance(characteristics, list) or len(characteristics) > MAX_CHARACTERISTICS:
            raise ValueError("characteristics are a list")
        if not isinstance(name, str) or len(name) > MAX_NAME_LENGTH:
            raise ValueError("name is no name of a device")
        if signal is not None and (type(signal) is not int or not -127 <= signal <= 20):
            raise ValueError("signal is a whole number of dBm")
        found: dict[tuple[str, str], GattCharacteristic] = {}
        for one in characteristics:
            match one:
                case [str(service), str(uuid), bool(can_notify)]:
                    key = _whole(service), _whole(uuid)
                    found.setdefault(key, GattCharacteristic(*key, can_notify))
                case _:
                    raise ValueError("a characteristic is [service, UUID, can notify]")
        device, connection = _device(message), message.get("connection")
        if connection is not None and type(connection) is not int:
            raise ValueError("connection is a whole number")
        commands = self.host.connect(device, name, found.values(), _time(message), signal)
        self._connections[device] = connection
        self._command(commands)

    def _done(self, message: Message) -> None:
        device, now, value = _device(message), _time(message), _bytes(message.get("value", ""))
        if self._is_current(message):
            self._command(self.host.answer(device, now, value))

    def _rejected(self, message: Message) -> None:
        device, now, reason = _device(message), _time(message), _reason(message)
        if self._is_current(message):
            self._command(self.host.reject(device, now, reason))

    def _is_current(self, message: Message) -> bool:
        """Return whether the message is of the newest connection of its device, as far as it names one."""
        connection = message.get("connection")
        return connection is None or connection == self._connections.get(_device(message))

    def _failed(self, message: Message) -> None:
        self.host.report(_device(message), _time(message), _reason(message))

    def _values(self, message: Message) -> None:
        values = []
        for one in message["values"] if isinstance(message["values"], list) else [None]:
            match one:
                case [float() | int() as t, str(device), str(channel), data]:
                    values.append((device, channel, _time({"t": t}), _bytes(data)))
                case _:
                    raise ValueError("each is [t, device, channel, value]")
        unknown = ""
        for device, channel, arrival, value in values:
            try:
                self.host.notify(device, channel, arrival, value)
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
    profiles = (*own, *PROFILES)
    conditions = [{"name": one.name, "prefix": one.prefix, "service": one.service} for one in scan_filters(profiles)]
    return {"type": "filters", "filters": conditions, "services": [*used_services(profiles)]}


def _whole(uuid: str) -> str:
    """Return a UUID with all its digits in lower case; a short one is one of Bluetooth's own."""
    digits = uuid.lower()
    return f"{digits:0>8}{BASE_UUID}" if len(digits) in (4, 8) else digits


def _reject_constant(text: str) -> None:
    raise ValueError(f"{text} is no number")


class _Fields(Message):
    """The fields of a message; ValueError for one that is read and absent."""

    def __missing__(self, key: str) -> Any:
        raise ValueError(f"{key} is absent")


def _error(reason: str, of: str | None = None, device: Any = None) -> Message:
    about = {"device": device} if isinstance(device, str) else {}
    return {"type": "error", "of": of, **about, "reason": reason}


def _device(message: Message) -> str:
    device = message["device"]
    if not isinstance(device, str) or not device or not is_address(device):
        raise ValueError("device is no address of a device")
    return device


def _choose(message: Message, key: str, known: Mapping[str, T]) -> T | None:
    """Return what the text below `key` names; None when it is absent or null."""
    name = message.get(key)
    if name is not None and (not isinstance(name, str) or name not in known):
        raise ValueError(f"there is no {key} {name!r:.40}")
    return None if name is None else known[name]


def _time(message: Message) -> float:
    t = message["t"]
    if type(t) not in (int, float) or not -MAX_ARRIVAL_TIME <= t <= MAX_ARRIVAL_TIME:
        raise ValueError("t is a time in s")
    return float(t)


def _reason(message: Message) -> str:
    reason = message["reason"]
    if not isinstance(reason, str) or not reason:
        raise ValueError("reason is a sentence")
    return reason


def _bytes(text: Any) -> bytes:
    if not isinstance(text, str):
        raise ValueError("a value is a text of hexadecimal digits")
    try:
        return bytes.fromhex(text)
    except ValueError:
        raise ValueError("a value is a text of hexadecimal digits") from None


HANDLERS: dict[str, Callable[[JsonHost, Message], None]] = {
    "start": JsonHost._start,
    "bind": JsonHost._bind,
    "scan": lambda json_host, message: json_host._messages.append(filters(json_host.host.profiles.values())),
    "add": JsonHost._add,
    "remove": JsonHost._remove,
    "connected": JsonHost._connected,
    "done": JsonHost._done,
    "rejected": JsonHost._rejected,
    "failed": JsonHost._failed,
    "values": JsonHost._values,
    "disconnected": lambda json_host, message: json_host.host.disconnect(_device(message), _time(message)),
    "time": lambda json_host, message: json_host._command(json_host.host.advance(_time(message))),
    "restart": lambda json_host, message: json_host.host.restart_clock(_time(message)),
    "save": JsonHost._save,
    "finish": JsonHost._finish,
}
"""Method for each type of message that is received."""
AFTER_THE_END = ("start", "scan", "save", "remove")
"""Messages that make sense after "finish"."""
