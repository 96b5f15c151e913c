"""Experiments of the papers, walked again by emulated wearers with emulated sensors.

Every figure is of a session that heard what the sensors sent; the truth is only compared with. What sensors do wrong
comes from the data sheets in emulate/sensors/parts.py.
"""
