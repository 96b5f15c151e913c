"""Real Bluetooth, through bleak: find, connect, set up, listen."""

from .air import NATIVE, Backend, Found, scan
from .connection import Connection, ConnectionState
from .devices import Devices
from .record import record
from .trouble import BluetoothError
from .wanted import DeviceConfig

__all__ = [
    "NATIVE",
    "Backend",
    "BluetoothError",
    "Connection",
    "Devices",
    "Found",
    "ConnectionState",
    "DeviceConfig",
    "record",
    "scan",
]
