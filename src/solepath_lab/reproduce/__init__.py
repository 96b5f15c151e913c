"""Experiments of the papers, repeated by emulated wearers with emulated sensors.

Every figure comes from a session that receives the sensors' samples; the truth is used only for comparison. Sensor
errors come from data sheets (emulate/sensors/parts.py). Each module repeats the experiments of one paper."""
