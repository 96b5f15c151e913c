"""The five published systems: each folder has its parts, calibration and recipes, loaded when they are requested."""
