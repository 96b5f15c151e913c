"""Links that are hard to make: devices that are gone or taken when they are connected to, or lost over and over."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from airs import received
from belts import ONE, PELVIS, RATE, STRAP, address, failing, logged_radio, strap, times
from benches import LEFT
from bleak.exc import BleakDBusError, BleakError
from memory_radio import MemoryRadio
from strap import Strap
from virtual import now

from solepath import Session
from solepath.ble import Backend, DeviceConfig
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.wire.fields import parse_text


def test_a_device_that_left_before_it_was_connected_is_soon_searched_for_again():
    bench = Bench(Route().stand(5.0), faults=parse_faults("0.005 left_foot vanish 300"))

    packets = received(MemoryRadio(bench.peripherals).backend, DeviceConfig(None, "solepath L"), seconds=60.0)
    troubles = [(p.t, parse_text(p.data)) for p in packets if p.channel == "receiver/trouble"]
    (connecting, unanswered), (searching, unheard) = troubles
    assert unanswered.startswith("the device does not answer: bring it near") and connecting == pytest.approx(10.0)
    assert unheard.startswith("no device 'solepath L' is in range") and 20.0 < searching < 30.0


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


def test_a_scan_without_advertisements_is_restarted() -> None:
    """Bluetooth was switched off and on, on systems that do not report it."""
    device = strap(faults="5 * disconnect")
    memory_backend = MemoryRadio([device]).backend
    scanner: Any = memory_backend.scanner

    class Scanner(scanner):
        started_at = 0.0

        async def start(self) -> None:
            self.started_at = now()
            await super().start()

        def call_detection_callbacks(self, *given: Any) -> None:
            if now() < 5.0 or self.started_at > 20.0:
                super().call_detection_callbacks(*given)

    packets = received(Backend(memory_backend.client, Scanner), ONE, seconds=90.0)
    connected_at = times(packets, "receiver/connected")
    assert len(connected_at) == 2 and connected_at[1] < 75.0
    assert device.sent["strap/beat"] > 10 * RATE


def test_a_signal_that_no_radio_measures_and_a_name_that_is_no_text_are_no_fault() -> None:
    beneath = MemoryRadio([strap()]).backend
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        def call_detection_callbacks(self, device: Any, advertisement: Any) -> None:
            super().call_detection_callbacks(device, advertisement._replace(rssi=127, local_name="str\ud800p"))

    packets = received(Backend(beneath.client, Scanner), ONE, seconds=3.0)
    assert times(packets, "strap/beat")
    [event] = Session().feed([packet for packet in packets if packet.channel == "receiver/connected"])
    assert (event.name, event.signal) == ("str?p", None)  # type: ignore[attr-defined]
