"""Connections to Bluetooth devices through bleak: search, connect, set up, and receive packets."""

from ..link.setup.config import DeviceConfig
from .candidates import Advertisement
from .connection import Connection, ConnectionState
from .devices import Devices
from .record import record
from .scanning import NATIVE, Backend, scan
from .trouble import BluetoothError

__all__ = [
    "NATIVE",
    "Backend",
    "BluetoothError",
    "Connection",
    "Devices",
    "Advertisement",
    "ConnectionState",
    "DeviceConfig",
    "record",
    "scan",
]
