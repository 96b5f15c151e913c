"""A private D-Bus message bus, and a service on it that is a tree of objects."""

from __future__ import annotations

import asyncio
import shutil
from abc import ABC, abstractmethod
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from dbus_fast import Message, MessageType, Variant
from dbus_fast.aio import MessageBus

DAEMON = shutil.which("dbus-daemon")

_CONFIGURATION = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig>
  <listen>unix:path={socket}</listen>
  <auth>EXTERNAL</auth>
  <policy context="default">
    <allow user="*"/>
    <allow own="*"/>
    <allow send_destination="*"/>
    <allow receive_sender="*"/>
  </policy>
</busconfig>
"""
_PROPERTIES = "org.freedesktop.DBus.Properties"
_OBJECTS = "org.freedesktop.DBus.ObjectManager"


@asynccontextmanager
async def message_bus(directory: Path) -> AsyncIterator[str]:
    """Start an empty bus and yield its address for DBUS_SYSTEM_BUS_ADDRESS."""
    assert DAEMON is not None
    configuration = directory / "bus.conf"
    configuration.write_text(_CONFIGURATION.format(socket=directory / "bus"), encoding="utf-8")
    daemon = await asyncio.create_subprocess_exec(
        DAEMON,
        "--nofork",
        "--print-address",
        f"--config-file={configuration}",
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.DEVNULL,  # it complains of limits that it may not raise
    )
    try:
        assert daemon.stdout is not None
        address = (await daemon.stdout.readline()).decode().strip()
        assert address
        yield address
    finally:
        if daemon.returncode is None:
            daemon.terminate()
        await daemon.wait()


class DBusError(Exception):
    """The error with which the service answers a call."""

    def __init__(self, name: str, words: str) -> None:
        super().__init__(name, words)
        self.name, self.words = name, words


class Service(ABC):
    """Objects by path, with their properties by interface.

    `errors` lists the errors that answer the next calls of a method ("Device1.Connect"), `calls` all calls so far.
    """

    def __init__(self) -> None:
        self.objects: dict[str, dict[str, dict[str, Variant]]] = {}
        self.errors: dict[str, list[DBusError]] = {}
        self.calls: list[str] = []
        self._answers: set[asyncio.Task[None]] = set()
        self._bus: MessageBus | None = None

    @abstractmethod
    async def call(self, method: str, path: str, sender: str, body: list[Any]) -> tuple[str, list[Any]]:
        """Run a method and return its signature and result; raise DBusError when it fails."""

    @abstractmethod
    def client_left(self, sender: str) -> None:
        """Discard the state of the program with this bus name, which has left the bus."""

    @asynccontextmanager
    async def owning(self, name: str, address: str) -> AsyncIterator[None]:
        """Serve on the bus until the block is left, then stop as if killed, without signals for removed objects."""
        self._bus = bus = MessageBus(bus_address=address)
        await bus.connect()
        bus.add_message_handler(self._handle)
        rule = "type='signal',interface='org.freedesktop.DBus',member='NameOwnerChanged'"
        daemon = "org.freedesktop.DBus"
        await bus.call(Message(daemon, "/", daemon, "AddMatch", signature="s", body=[rule]))
        await bus.request_name(name)
        try:
            yield
        finally:
            self._bus = None
            answers = tuple(self._answers)
            for answer in answers:
                answer.cancel()
            await asyncio.gather(*answers, return_exceptions=True)
            bus.disconnect()

    def add(self, path: str, interface: str, properties: dict[str, Variant]) -> None:
        """Add an object."""
        self.objects[path] = {interface: properties}
        self._emit("/", _OBJECTS, "InterfacesAdded", "oa{sa{sv}}", [path, self.objects[path]])

    def change(self, path: str, interface: str, *removed: str, **properties: Variant) -> None:
        """Set properties to new values, and remove others."""
        known = self.objects[path][interface]
        known.update(properties)
        for name in removed:
            known.pop(name, None)
        self._emit(path, _PROPERTIES, "PropertiesChanged", "sa{sv}as", [interface, properties, list(removed)])

    def _emit(self, path: str, interface: str, member: str, signature: str, body: list[Any]) -> None:
        if self._bus is not None and self._bus.connected:
            self._bus.send(Message.new_signal(path, interface, member, signature, body))

    def _handle(self, message: Message) -> bool:
        if message.member == "NameOwnerChanged" and not message.body[2]:
            self.client_left(message.body[0])
        if message.message_type is not MessageType.METHOD_CALL:
            return False
        answer = asyncio.create_task(self._answer(message))
        self._answers.add(answer)
        answer.add_done_callback(self._answers.discard)
        return True

    async def _answer(self, call: Message) -> None:
        method = f"{(call.interface or '').rpartition('.')[2]}.{call.member}"
        self.calls.append(method)
        try:
            if self.errors.get(method):
                raise self.errors[method].pop(0)
            signature, body = await self._result(method, call)
        except DBusError as error:
            reply = Message.new_error(call, error.name, error.words)
        else:
            reply = Message.new_method_return(call, signature, body)
        if self._bus is not None and self._bus.connected:
            self._bus.send(reply)

    async def _result(self, method: str, call: Message) -> tuple[str, list[Any]]:
        path = call.path or ""
        if method == "ObjectManager.GetManagedObjects":
            return "a{oa{sa{sv}}}", [self.objects]
        if path not in self.objects:
            raise DBusError("org.freedesktop.DBus.Error.UnknownObject", f"there is no {path}")
        return await self.call(method, path, call.sender or "", call.body)
