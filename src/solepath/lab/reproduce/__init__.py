"""Experiments of the papers, repeated by emulated wearers with emulated sensors.

Every figure comes from a session that receives the sensors' samples; the truth is used only for comparison. Sensor
errors come from the data sheets in emulate/sensors/parts.py."""
