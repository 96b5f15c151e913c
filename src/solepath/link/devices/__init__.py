"""Devices, one per file.

Declared devices (../driver.py) have a profile, the constructs of their values and their readers; insole.py and
cc2541.py have a link of their own beside their profile."""
