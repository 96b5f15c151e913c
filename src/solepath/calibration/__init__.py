"""Calibration of wearer, shoes, insoles and sensors: records; their limits, file and merging are modules."""

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
