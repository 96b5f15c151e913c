"""Messages to an app when Bluetooth cannot be used, and the number of attempts."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any

import pytest
from airs import others, received, troubles
from belts import ONE, PELVIS, address, logged_radio, times
from bleak.exc import BleakBluetoothNotAvailableError, BleakBluetoothNotAvailableReason, BleakDBusError, BleakError
from memory_radio import MemoryRadio
from strap import Strap
from virtual import virtually

from solepath.ble import Backend, BluetoothError, DeviceConfig, Devices, scan
from solepath.link.devices.cc2650 import PROFILE as CC2650

REASONS = BleakBluetoothNotAvailableReason
UNAVAILABLE = [
    *(BleakBluetoothNotAvailableError("no", reason) for reason in REASONS),
    BleakDBusError("org.freedesktop.DBus.Error.ServiceUnknown", []),
    BleakDBusError("org.freedesktop.DBus.Error.AccessDenied", ["no"]),
    BleakDBusError("org.bluez.Error.NotReady", []),
    FileNotFoundError(2, "No such file or directory"),
    ConnectionRefusedError(111, "Connection refused"),
    PermissionError(13, "Permission denied"),
    BleakError("something that nobody foresaw"),
]
REMEDY_WORDS = ("plug", "turn it on", "is it on?", "allow", "ask", "can", "start", "join", "install", "nobody foresaw")


NOT_IN_TIME = "the device did not answer in time: it is sought again; if this goes on, switch it off and on"


def without_bluetooth(error: Exception) -> Backend:
    beneath: Any = MemoryRadio([]).backend.scanner

    class Scanner(beneath):
        async def start(self) -> None:
            raise error

    return Backend(None, Scanner)


@pytest.mark.parametrize("error", UNAVAILABLE, ids=lambda error: " ".join(map(str, error.args))[:50])
@virtually
async def test_to_enter_or_to_scan_without_bluetooth_is_an_error_with_a_remedy(error: Exception) -> None:
    with pytest.raises(BluetoothError) as entered:
        async with Devices([DeviceConfig(PELVIS, "any")], backend=without_bluetooth(error)):
            pass
    one = str(entered.value)
    assert entered.value.__cause__ is error
    with pytest.raises(BluetoothError, match=f"^{re.escape(one)}$"):
        await scan(1.0, backend=without_bluetooth(error))
    assert not others()
    assert "\n" not in one
    assert any(words in one for words in REMEDY_WORDS)


class Fleeting(Strap):
    """A device that notes when it was connected."""

    def __init__(self) -> None:
        super().__init__("strap 1", address(1))
        self.start_times: list[float] = []

    def connected(self, now: float, mtu: int) -> None:
        self.start_times.append(now)
        super().connected(now, mtu)


def test_a_device_that_fails_again_and_again_is_tried_less_and_less_often_and_never_given_up() -> None:
    device = Fleeting()
    packets = received(logged_radio(device).backend, DeviceConfig(PELVIS, address(1), CC2650), seconds=120.0)
    pauses = [b - a for a, b in pairwise(device.start_times)]
    assert pauses[0] < 0.6
    assert pauses[:5] == sorted(pauses[:5])
    assert all(8.0 <= pause < 8.6 for pause in pauses[6:]) and len(pauses) > 12
    report_times = times(packets, "receiver/trouble")
    assert [round(b - a) for a, b in zip(report_times, report_times[1:], strict=False)] == pytest.approx(
        [60] * (len(report_times) - 1), abs=9
    )


def test_a_request_that_is_never_answered_ends_the_attempt() -> None:
    class Mute(Strap):
        def read(self, channel: str, now: float) -> bytes | None:
            return None if now < 8.0 else super().read(channel, now)

    packets = received(logged_radio(Mute("strap 1", address(1))).backend, ONE, seconds=20.0)
    assert troubles(packets) == [NOT_IN_TIME]
    assert times(packets, "strap/beat")
