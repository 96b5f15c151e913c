"""Real Bluetooth, through bleak: find, connect, set up, listen."""

from .config import DeviceConfig
from .connection import Connection, ConnectionState
from .devices import Devices
from .record import record
from .scanning import NATIVE, Backend, Found, scan
from .trouble import BluetoothError

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
