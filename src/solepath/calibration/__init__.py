"""Calibration of wearer, shoes and insoles: records.py has the records, limits.py their limits, file.py their file."""

from .records import (
    Calibration,
    CalibrationError,
    HeadingCalibration,
    InsoleCalibration,
    Limbs,
    Newtons,
    RestNoise,
    ShoeGeometry,
    merged,
)

__all__ = [
    "Calibration",
    "CalibrationError",
    "HeadingCalibration",
    "InsoleCalibration",
    "Limbs",
    "Newtons",
    "RestNoise",
    "ShoeGeometry",
    "merged",
]
