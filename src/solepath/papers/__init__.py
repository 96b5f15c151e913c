"""Five published systems: a folder contains the parts, calibration and recipes of one, and is loaded on request."""
