"""The built-in devices, one per module.

Declared devices (../driver.py) have a profile, the constructs of their values, and readers; insole.py and cc2541.py
have a profile and their own link class."""
