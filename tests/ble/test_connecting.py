"""Links that are hard to make: devices that are gone or taken when they are connected to, or lost over and over."""

from __future__ import annotations

import asyncio

import pytest
from airs import received
from belts import ONE, PELVIS, STRAP, address, failing, logged_radio, strap, times
from benches import LEFT
from bleak.exc import BleakDBusError, BleakError
from memory_radio import MemoryRadio
from strap import Strap

from solepath.ble import Backend, DeviceConfig


def test_an_advertising_device_that_does_not_answer_is_reported_when_patience_ends_not_later():
    """Another program may hold the device, on systems that still report its advertisements."""
    memory_backend = logged_radio(Strap("strap 1", address(1))).backend

    class Client(memory_backend.client):
        async def connect(self, pair, **more):
            await asyncio.Event().wait()

    packets = received(Backend(Client, memory_backend.scanner), ONE, seconds=55.0, patience=7.0)
    [trouble] = [packet for packet in packets if packet.channel == "receiver/trouble"]
    assert trouble.t == pytest.approx(7.0, abs=0.1)
    assert trouble.data.decode().endswith("see that no other program or phone holds it")


def test_a_scan_that_fails_later_is_reported_to_searches_and_is_restarted() -> None:
    errors: list[Exception | None] = [None, None, BleakDBusError("org.bluez.Error.NotReady", []), BleakError("odd")]
    backend = failing(MemoryRadio([strap(1, faults="3 * disconnect"), strap(2)]).backend, errors)

    packets = received(backend, ONE, DeviceConfig(LEFT, address(2), STRAP), seconds=12.0)
    assert [(packet.site, packet.data.decode()) for packet in packets if packet.channel == "receiver/trouble"] == [
        (PELVIS, "cannot look for devices: Bluetooth is off: turn it on"),
        (PELVIS, "cannot look for devices: odd"),
    ]
    assert len([p for p in packets if p.channel == "receiver/connected" and p.site is PELVIS]) == 2
    assert times(packets, "strap/beat")[-1] > 11.0
