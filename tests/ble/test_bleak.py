"""Failures of bleak other than ATT errors: rejections under other names, and unexpected exceptions."""

from __future__ import annotations

import asyncio
import logging
from typing import Any

import pytest
from airs import received, troubles
from belts import RATE, STRAP, address, logged_radio, strap
from benches import LEFT, RIGHT
from bleak.exc import BleakDBusError, BleakError
from memory_radio import MemoryRadio

from solepath.ble import Backend, DeviceConfig
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.sensors.insole_device import Insole
from solepath.types import Site

PELVIS = Site.PELVIS
REQUESTS = ("connect", "read_gatt_char", "start_notify", "write_gatt_char", "disconnect")
REJECTIONS = [
    BleakError("Could not read characteristic: Access Denied"),
    BleakDBusError("org.bluez.Error.NotPermitted", ["Read not permitted"]),
]


def raising(backend: Backend, request: str, error: Exception, at: str = "", until: float = 1e9, where: str = "") -> Any:
    """Return a backend whose `request` raises `error` until the time `until`, s, for the device and the channel.

    `at` is the start of the device's address, `where` that of the channel's name."""
    base: Any = backend.client

    class Client(base):
        pass

    async def request_once(self: Any, *arguments: Any, **options: Any) -> Any:
        channel = arguments[0].obj.channel if arguments and hasattr(arguments[0], "obj") else ""
        if self.address.startswith(at) and channel.startswith(where) and asyncio.get_running_loop().time() < until:
            raise error
        return await getattr(base, request)(self, *arguments, **options)

    setattr(Client, request, request_once)
    return Backend(Client, backend.scanner)


@pytest.mark.parametrize(
    ("request_", "error"),
    [
        *((request, AssertionError()) for request in REQUESTS),
        *((request, AttributeError("'NoneType' object has no attribute 'call'")) for request in REQUESTS[1:]),
    ],  # an AttributeError in connecting is one more failed attempt for bleak-retry-connector
)
def test_a_fault_of_bleak_in_one_foots_client_is_reported_and_survived_and_does_not_affect_the_other_foot(
    request_: str, error: Exception, caplog: pytest.LogCaptureFixture
) -> None:
    devices = strap(1, faults="1 * disconnect"), strap(2)
    backend = raising(logged_radio(*devices).backend, request_, error, at=address(1), until=3.0)
    with caplog.at_level(logging.ERROR, "solepath.ble"):
        packets = received(
            backend, DeviceConfig(LEFT, address(1), STRAP), DeviceConfig(RIGHT, address(2), STRAP), seconds=14.0
        )
    beats = {site: [p.t for p in packets if p.site is site and p.channel == "strap/beat"] for site in (LEFT, RIGHT)}
    assert len(beats[RIGHT]) > 13 * RATE
    assert len(beats[LEFT]) > 5 * RATE and max(beats[LEFT]) > 13.0
    logged = [record for record in caplog.records if record.name == "solepath.ble"]
    assert logged and all(record.exc_info and record.exc_info[1] is error for record in logged)
    if request_ != "disconnect":  # nobody is bothered with how the end of a connection went
        [words] = troubles(packets)
        assert {packet.site for packet in packets if packet.channel == "receiver/trouble"} == {LEFT}
        assert type(error).__name__ in words and str(error) in words and "sought again" in words


def test_a_stream_that_is_rejected_is_no_connection() -> None:
    backend = raising(logged_radio(strap()).backend, "start_notify", REJECTIONS[1], where="strap/beat", until=3.0)
    packets = received(backend, DeviceConfig(PELVIS, address(1), STRAP), seconds=12.0)
    assert len([packet for packet in packets if packet.channel == "receiver/connected"]) > 2
    assert [packet for packet in packets if packet.channel == "strap/beat"]


@pytest.mark.parametrize("error", REJECTIONS, ids=["winrt", "bluez"])
def test_a_rejection_beside_the_stream_is_reported_with_its_channel_and_the_foot_streams(error: Exception) -> None:
    for request in ("read_gatt_char", "start_notify"):
        bench = Bench(Route().stand(9.0), devices={LEFT: Insole(cells=8, rate=50.0)})
        backend = raising(MemoryRadio(bench.peripherals).backend, request, error, where="device/battery")
        packets = received(backend, DeviceConfig(LEFT, bench[LEFT].address), seconds=8.0)
        if request == "read_gatt_char":
            [words] = troubles(packets)
            assert words.startswith("device/battery cannot be read: ")
        else:
            assert not [words for words in troubles(packets) if not words.startswith("device/battery cannot be sub")]
        assert len([packet for packet in packets if packet.channel == "insole/frame"]) > 300
        assert len([packet for packet in packets if packet.channel == "receiver/connected"]) == 1
