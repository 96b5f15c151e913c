"""The five published systems: each folder has its parts, its calibration and its recipes, loaded when asked for."""
