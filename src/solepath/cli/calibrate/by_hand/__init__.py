"""Calibration of one inertial sensor by hand, from rests and turns, closed by gravity (`solepath calibrate sensor`)."""
