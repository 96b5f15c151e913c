"""The tables of all built-in devices, for code that searches for devices; importing this module loads all of them."""

from __future__ import annotations

from ..types.registry import TABLE, load
from .devices.cc2541 import PROFILE_20HZ
from .driver import Driver
from .profile import Profile

_LOADED = [load("device", name) for name in TABLE["device"]]
DECLARED: tuple[Driver, ...] = tuple([device for device in _LOADED if isinstance(device, Driver)])
"""Drivers of the devices that are declared by data alone (driver.py)."""
PROFILES: tuple[Profile, ...] = (*[device.profile for device in _LOADED], PROFILE_20HZ)
DEVICES = {profile.name: profile for profile in PROFILES}
"""Profiles of all known devices by name: their channels, and what to read, subscribe to and write."""
