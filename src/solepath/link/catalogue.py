"""The tables of all built-in devices, for code that searches for devices; importing this module loads all of them."""

from __future__ import annotations

from .devices import cc2541, cc2650, dot, dot_orientation, insole, orphe, thingy
from .driver import Driver

DECLARED: tuple[Driver, ...] = (cc2650.DRIVER, orphe.DRIVER, dot.DRIVER, dot_orientation.DRIVER, thingy.DRIVER)
"""Drivers of the devices that are declared by data alone (driver.py)."""
PROFILES = (
    insole.PROFILE,
    cc2650.PROFILE,
    cc2541.PROFILE,
    cc2541.PROFILE_20HZ,
    orphe.PROFILE,
    dot.PROFILE,
    dot_orientation.PROFILE,
    thingy.PROFILE,
)
BY_NAME = {profile.name: profile for profile in PROFILES}
