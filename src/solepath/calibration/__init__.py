"""Calibration of wearer, shoes, insoles and sensors: its records, and its files (file.py)."""

from .records import (
    Calibration,
    CalibrationError,
    HeadingCalibration,
    InsoleCalibration,
    Limbs,
    Newtons,
    SensorCalibration,
    ShoeGeometry,
    usual_strides,
)

__all__ = [
    "Calibration",
    "CalibrationError",
    "HeadingCalibration",
    "InsoleCalibration",
    "Limbs",
    "Newtons",
    "SensorCalibration",
    "ShoeGeometry",
    "usual_strides",
]
