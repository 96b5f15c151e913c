"""What is known of wearer, shoes and insoles: a record, and the file that it is read from."""

from .calibration import (
    FORMAT,
    LARGEST,
    VERSION,
    Calibration,
    CalibrationError,
    InsoleCalibration,
    Limbs,
    Newtons,
    ShoeGeometry,
    bounded_text,
    merged,
    read_calibration,
    unusable,
    write_calibration,
)

__all__ = [
    "Calibration",
    "CalibrationError",
    "FORMAT",
    "InsoleCalibration",
    "LARGEST",
    "Limbs",
    "Newtons",
    "ShoeGeometry",
    "VERSION",
    "bounded_text",
    "merged",
    "read_calibration",
    "unusable",
    "write_calibration",
]
