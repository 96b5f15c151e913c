"""Calibration of wearer, shoes, insoles and sensors: records, their limits, their file, and how two are merged."""

from .records import (
    Calibration,
    CalibrationError,
    HeadingCalibration,
    InsoleCalibration,
    Limbs,
    Newtons,
    RestNoise,
    SensorCalibration,
    ShoeGeometry,
)

__all__ = [
    "Calibration",
    "CalibrationError",
    "HeadingCalibration",
    "InsoleCalibration",
    "Limbs",
    "Newtons",
    "RestNoise",
    "SensorCalibration",
    "ShoeGeometry",
]
