"""Devices that are declared (../driver.py), a file each: its profile, the constructs of its values, its readers."""

from ..driver import Driver
from . import dot, dot_orientation, orphe, thingy

DECLARED: tuple[Driver, ...] = (orphe.DRIVER, dot.DRIVER, dot_orientation.DRIVER, thingy.DRIVER)
