"""What is known of wearer, shoes and insoles: a record, and the file that it is read from."""

from .file import FORMAT, LARGEST, VERSION, bounded_text, read_calibration, write_calibration
from .limits import unusable
from .records import Calibration, CalibrationError, InsoleCalibration, Limbs, Newtons, ShoeGeometry, merged

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
