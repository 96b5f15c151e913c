"""Failures of Bluetooth, caught at every call into bleak and described in a sentence with a remedy."""

from __future__ import annotations

import asyncio
import logging
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import bleak_retry_connector as retry
from bleak import exc
from bleak.exc import BleakDBusError, BleakError, BleakGATTProtocolError

LOG = logging.getLogger("solepath.ble")
LOG.addHandler(logging.NullHandler())  # the app decides whether to show the log; a library does not write to a terminal


class BluetoothError(Exception):
    """Raised when Bluetooth cannot be used at all; the message gives the reason and a remedy."""


class UnexpectedError(Exception):
    """Raised from an exception that bleak does not document; the message names that exception."""

    def __init__(self, error: Exception) -> None:
        words = _plain(error)
        super().__init__(type(error).__name__ if words == type(error).__name__ else f"{type(error).__name__}: {words}")


if sys.platform == "linux":
    from dbus_fast import AuthError, InvalidAddressError

    FAILURES = (BleakError, OSError, EOFError, TimeoutError, UnexpectedError, AuthError, InvalidAddressError)
else:
    FAILURES = (BleakError, OSError, EOFError, TimeoutError, UnexpectedError)
"""Exceptions that bleak and the systems below it raise when Bluetooth fails."""


@asynccontextmanager
async def bleak_call(seconds: float) -> AsyncIterator[None]:
    """Limit one call into bleak to `seconds`, then raise TimeoutError; raise only exceptions of FAILURES.

    bleak also raises exceptions that it does not document: for example, its BlueZ client asserts that its bus still
    exists while it waits for an answer. Such an exception ends this connection only; the traceback is logged."""
    try:
        async with asyncio.timeout(seconds):
            yield
    except FAILURES:
        raise
    except Exception as error:
        LOG.error("an unexpected exception out of bleak: the connection restarts", exc_info=True)
        raise UnexpectedError(error) from error


_REASON = exc.BleakBluetoothNotAvailableReason
_UNAVAILABLE_SENTENCES = {
    _REASON.NO_BLUETOOTH: "this machine has no Bluetooth adapter: plug one in, or switch it on in the firmware's setup",
    _REASON.NO_BLE_CENTRAL_ROLE: "this Bluetooth adapter cannot connect to sensors: one with Bluetooth Low Energy can",
    _REASON.POWERED_OFF: "Bluetooth is off: turn it on",
    _REASON.DENIED_BY_USER: "this program may not use Bluetooth: allow it in the system's settings",
    _REASON.DENIED_BY_SYSTEM: "a policy of this system forbids the use of Bluetooth: ask who looks after it",
    _REASON.DENIED_BY_UNKNOWN: "this program may not use Bluetooth: allow it in the system's settings",
    _REASON.UNKNOWN: "Bluetooth is not available: is it on?",
}
_DBUS_SENTENCES = {
    "org.freedesktop.DBus.Error.ServiceUnknown": "the Bluetooth service does not run: systemctl start bluetooth",
    "org.freedesktop.DBus.Error.NameHasNoOwner": "the Bluetooth service does not run: systemctl start bluetooth",
    "org.freedesktop.DBus.Error.AccessDenied": "this user may not use Bluetooth: join the group bluetooth",
    "org.freedesktop.DBus.Error.NoReply": "the Bluetooth service does not answer: systemctl restart bluetooth",
    "org.bluez.Error.NotReady": "Bluetooth is off: turn it on",
    "org.bluez.Error.NotPermitted": "another program listens to this device: close it",
    "org.bluez.Error.InProgress": "another program uses the Bluetooth adapter just now",
}
_NOT_PAIRED = "the device must be paired first: pair=True, or --pair"
_NOT_PAIRED_OVER_DBUS = ("org.bluez.Error.NotPermitted", "Not paired")
"""D-Bus error of BlueZ for the codes of `_PAIRING_CODES`, except insufficient authorization."""
_PAIRING_CODES = {
    exc.BleakGATTProtocolErrorCode.INSUFFICIENT_AUTHENTICATION,
    exc.BleakGATTProtocolErrorCode.INSUFFICIENT_AUTHORIZATION,
    exc.BleakGATTProtocolErrorCode.INSUFFICIENT_ENCRYPTION,
    exc.BleakGATTProtocolErrorCode.INSUFFICIENT_ENCRYPTION_KEY_SIZE,
}
_LOST_TEXTS = ("not connected", "disconnected", "link was lost", "service discovery has not been performed")
"""Texts with which bleak, BlueZ and the loopback report that a connection ended during a request."""
NO_ANSWER = "the device does not answer: bring it near, and see that no other program or phone holds it"


def describe_error(error: BaseException) -> str:
    """Return one line that describes an exception of FAILURES."""
    match error:
        case exc.BleakBluetoothNotAvailableError():
            return _UNAVAILABLE_SENTENCES[error.reason]
        case BleakDBusError() if error.args[:2] == _NOT_PAIRED_OVER_DBUS:
            return _NOT_PAIRED
        case BleakDBusError() if error.dbus_error.startswith("org.bluez.Error.Authentication"):
            return "the device was not paired: make it ready for pairing, and remove what is left of an older one"
        case BleakDBusError() if error.dbus_error in _DBUS_SENTENCES:
            return _DBUS_SENTENCES[error.dbus_error]
        case BleakGATTProtocolError() if error.code in _PAIRING_CODES:
            return _NOT_PAIRED
        case BleakGATTProtocolError():
            meaning = str(error.args[-1]).removeprefix("GATT Protocol Error: ")
            return f"the device answered with the ATT error 0x{int(error.code):02X} ({meaning})"
        case exc.BleakCharacteristicNotFoundError():
            return f"the device has no characteristic {error.char_specifier}"
        case retry.BleakOutOfConnectionSlotsError():
            return "the adapter holds as many connections as it can: disconnect another device"
        case retry.BleakNotFoundError() | exc.BleakDeviceNotFoundError():
            return NO_ANSWER
        case retry.BleakAbortedError():
            return "the connection broke off while it was made: bring the device near"
        case retry.BleakConnectionError() if isinstance(error.__cause__, FAILURES):
            return f"cannot connect: {describe_error(error.__cause__)}"
        case BleakError() if any(words in str(error).lower() for words in _LOST_TEXTS):
            return "the connection was lost: the device is sought again, bring it near if this happens often"
        case FileNotFoundError() | ConnectionRefusedError():
            return "there is no Bluetooth service: install BlueZ, and systemctl start bluetooth"
        case PermissionError():
            return f"this user may not use Bluetooth ({_plain(error)}): join the group bluetooth"
        case TimeoutError():
            return "the device did not answer in time: it is sought again; if this goes on, switch it off and on"
        case UnexpectedError():
            return f"Bluetooth failed unexpectedly ({error}): the device is sought again, the log solepath.ble has more"
    return _plain(error)


def _plain(error: BaseException) -> str:
    """Return the error's own text on one line, or its class name when it has none."""
    words = " ".join((error.strerror or "" if isinstance(error, OSError) else str(error)).split())
    return words[:300] or type(error).__name__
