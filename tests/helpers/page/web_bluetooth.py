"""Emulated sensors behind Chromium's own Bluetooth stack, by its protocol for tests (domain BluetoothEmulation).

It does chooser, connection, discovery, reads, writes and subscriptions, but no notifications. Reads stand in for them:
the page reads a subscribed characteristic again and again (`READ_FRAMES`), each answer is the next notification of the
emulated device, at its time, and fires the same event in the page as a notification does."""

from __future__ import annotations

import asyncio
from base64 import b64decode, b64encode
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable
from contextlib import asynccontextmanager
from typing import Any

from attrs import define, field
from browsers import MAX_WAIT, Window, closing

from solepath.emulate.devices.attributes import AttError
from solepath.emulate.devices.peripheral import Peripheral
from solepath.link.devices.insole import PROFILE

STREAM = PROFILE.streams[0]
SUBSCRIPTION = "00002902-0000-1000-8000-00805f9b34fb"
"""Descriptor of a characteristic that notifies (Bluetooth Core, vol 3 part G, 3.3.3.3)."""
UNLIKELY_ERROR = 0x0E
"""ATT error code of a request that failed (Bluetooth Core, vol 3 part F, 3.4.1.1)."""
READ_FRAMES = """async ([name, uuid]) => {
    const { sensors } = await import('./bluetooth.js');
    for (const sensor of sensors.values())
        for (const one of sensor.characteristics.values())
            if (sensor.name === name && one.uuid === uuid)
                {
                const reading = ((globalThis.reading ??= {})[name] = { on: true });
                reading.ended = (async () => { while (reading.on) await one.readValue(); })()
                    .catch((error) => { if (one.service.device.gatt.connected) throw error; });
            }
}"""
"""Reads the frames of an insole until the connection is lost, as fast as they are answered."""


STOP_READING = "name => { const reading = globalThis.reading[name]; reading.on = false; return reading.ended; }"


@define(eq=False)
class EmulatedSensor:
    """An emulated device, with what it has sent and the page has not yet read."""

    device: Peripheral
    channels: dict[str, str] = field(factory=dict)
    """Channel by the id that Chromium gives to a characteristic."""
    unread: deque[bytes] = field(factory=deque)
    sent: int = 0
    """Number of frames that were read."""
    arrived: asyncio.Event = field(factory=asyncio.Event)
    subscribed: set[str] = field(factory=set)
    connected: bool = False
    is_read: bool = False
    """True if the page reads the frames."""


class WebBluetooth:
    """Emulated devices that a page in Chromium can choose and connect."""

    def __init__(self, view: Window, devices: Iterable[Peripheral]) -> None:
        self.view = view
        self.sensors = {device.address: EmulatedSensor(device) for device in devices}
        self.reachable = True
        """False while the devices are too far away for a connection."""
        self.silent = False
        """True while the devices send no frame."""
        self._tasks: set[asyncio.Task[None]] = set()
        self._devtools: Any = None

    async def start(self) -> None:
        """Switch the emulation on; the devices advertise from now on."""
        browser = self.view.tab.context.browser
        assert browser is not None
        self._devtools = await browser.new_browser_cdp_session()
        handlers: dict[str, Callable[[Any], Awaitable[None]]] = {
            "gatt": lambda got: self._gatt(got["address"], got["type"]),
            "characteristic": lambda got: self._characteristic(
                got["characteristicId"], got["type"], got.get("data", "")
            ),
            "descriptor": lambda got: self._descriptor(got["descriptorId"], got["type"]),
        }
        for kind, handle in handlers.items():
            self._devtools.on(f"BluetoothEmulation.{kind}OperationReceived", self._starter(handle))
        await self._send("enable", state="powered-on", leSupported=True)
        await self._advertise()
        self._task(self._run())

    async def _advertise(self) -> None:
        for address, one in self.sensors.items():
            await self._send(
                "simulatePreconnectedPeripheral",
                address=address,
                name=one.device.name,
                manufacturerData=[],
                knownServiceUuids=[service.uuid for service in one.device.services],
            )

    async def stop(self) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._send("disable")

    async def choose(self, address: str | None) -> None:
        """Tap "connect" and choose a device; None leaves the browser's list of devices without a choice."""
        devtools = await self.view.tab.context.new_cdp_session(self.view.tab)
        prompted: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()

        def on_prompt(prompt: dict[str, Any]) -> None:
            if not prompted.done() and address in {None, *(one["id"] for one in prompt["devices"])}:
                prompted.set_result(prompt)

        devtools.on("DeviceAccess.deviceRequestPrompted", on_prompt)
        await devtools.send("DeviceAccess.enable")
        await self.view.tab.locator("#connect").click()
        choice = {"id": (await asyncio.wait_for(prompted, MAX_WAIT))["id"]}
        if address is None:
            await devtools.send("DeviceAccess.cancelPrompt", choice)
        else:
            await devtools.send("DeviceAccess.selectPrompt", {**choice, "deviceId": address})
        await devtools.detach()

    @property
    def frames_read(self) -> int:
        """Number of frames that the page has read."""
        return sum(one.sent for one in self.sensors.values())

    async def kill_tab(self) -> None:
        """Kill the page as a system does that needs its memory; its connections end."""
        await self.stop_reading()
        devtools = await self.view.tab.context.new_cdp_session(self.view.tab)
        async with self.view.tab.expect_event("crash"):
            killing = asyncio.create_task(devtools.send("Page.crash"))
        killing.cancel()  # who is killed does not answer
        for address, one in self.sensors.items():
            one.channels.clear()
            await self._send("simulateGATTDisconnection", address=address)
        await self._advertise()

    async def stop_reading(self) -> None:
        """End all reads; the devices send no more frames."""
        for one in self.sensors.values():
            await self._stop_reading(one)

    async def _stop_reading(self, one: EmulatedSensor) -> None:
        """End the last read: Chromium answers nothing any more if a connection ends while a request waits."""
        await self.view.tab.evaluate(STOP_READING, one.device.name)
        self._disconnect(one)

    async def lose(self, address: str) -> None:
        """Lose a connection, as by distance."""
        one = self.sensors[address]
        await self._stop_reading(one)
        one.channels.clear()
        await self._send("simulateGATTDisconnection", address=address)

    async def _send(self, method: str, **values: Any) -> Any:
        return await self._devtools.send(f"BluetoothEmulation.{method}", values)

    def _starter(self, handle: Callable[[Any], Awaitable[None]]) -> Callable[[Any], None]:
        return lambda got: self._task(handle(got))

    def _task(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            self.view.complaints.append(f"emulation: {task.exception()!r}")

    async def _run(self) -> None:
        """Let the devices send at their times."""
        while True:
            now = asyncio.get_running_loop().time()
            for one in self.sensors.values():
                if one.connected:
                    for outgoing in one.device.poll(now):
                        if outgoing.channel == STREAM and not self.silent:
                            one.unread.append(outgoing.value)
                            one.arrived.set()
            await asyncio.sleep(0.002)

    async def _gatt(self, address: str, kind: str) -> None:
        one = self.sensors[address]
        if kind == "connection":
            while not self.reachable:
                await asyncio.sleep(0.01)
            one.channels.clear()
            one.subscribed.clear()
            self._connect(one)
        elif kind == "discovery":
            await self._add_services(address, one)
        await self._send("simulateGATTOperationResponse", address=address, type=kind, code=0)
        if kind == "disconnection":
            self._disconnect(one)

    def _connect(self, one: EmulatedSensor) -> None:
        one.connected = True
        one.device.connected(asyncio.get_running_loop().time(), one.device.mtu)

    def _disconnect(self, one: EmulatedSensor) -> None:
        if one.connected:
            one.connected = one.is_read = False
            one.device.disconnected(asyncio.get_running_loop().time())
        one.unread.clear()
        one.arrived.set()

    async def _add_services(self, address: str, one: EmulatedSensor) -> None:
        for service in one.device.services:
            added = await self._send("addService", address=address, serviceUuid=service.uuid)
            for characteristic in service.characteristics:
                properties = {
                    "read": "read" in characteristic.properties or characteristic.channel == STREAM,
                    "write": "write" in characteristic.properties,
                    "notify": "notify" in characteristic.properties,
                }
                made = await self._send(
                    "addCharacteristic",
                    serviceId=added["serviceId"],
                    characteristicUuid=characteristic.uuid,
                    properties=properties,
                )
                one.channels[made["characteristicId"]] = characteristic.channel
                if properties["notify"]:
                    await self._send(
                        "addDescriptor", characteristicId=made["characteristicId"], descriptorUuid=SUBSCRIPTION
                    )

    async def _characteristic(self, identifier: str, kind: str, data: str) -> None:
        one = next((one for one in self.sensors.values() if identifier in one.channels), None)
        if one is None:
            return
        if not one.connected:  # Chromium keeps a connection that the page ends, and does not report the next one
            self._connect(one)
            for subscribed in one.subscribed:
                one.device.subscribe(subscribed, True, asyncio.get_running_loop().time())
        channel, now, answer = one.channels[identifier], asyncio.get_running_loop().time(), b""
        code = 0
        try:
            if kind == "read" and channel == STREAM:
                answer = await self._next_frame(one)
            elif kind == "read":
                answer = one.device.read(channel, now) or b""
            elif kind == "write":
                one.device.write(channel, b64decode(data), now)
                if not one.is_read and channel == PROFILE.setup[-1].channel:  # a read before would keep it waiting
                    one.is_read = True
                    uuid = PROFILE.channel(STREAM).characteristic
                    self._task(self.view.tab.evaluate(READ_FRAMES, [one.device.name, uuid]))
            elif kind == "subscribe-to-notifications":
                one.device.subscribe(channel, True, now)
                one.subscribed.add(channel)
            else:
                one.device.subscribe(channel, False, now)
        except AttError as error:
            code = error.code
        response = {"data": b64encode(answer).decode()} if kind == "read" and code == 0 else {}
        await self._send(
            "simulateCharacteristicOperationResponse", characteristicId=identifier, type=kind, code=code, **response
        )

    async def _next_frame(self, one: EmulatedSensor) -> bytes:
        while not one.unread:
            if not one.connected:
                raise AttError(UNLIKELY_ERROR)
            one.arrived.clear()
            await one.arrived.wait()
        one.sent += 1
        return one.unread.popleft()

    async def _descriptor(self, identifier: str, kind: str) -> None:
        response = {"data": ""} if kind == "read" else {}
        await self._send("simulateDescriptorOperationResponse", descriptorId=identifier, type=kind, code=0, **response)


@asynccontextmanager
async def web_bluetooth(view: Window, devices: Iterable[Peripheral]) -> AsyncIterator[WebBluetooth]:
    """Yield emulated devices that advertise to the page."""
    radio = WebBluetooth(view, devices)
    await radio.start()
    async with closing(radio.stop):
        yield radio
