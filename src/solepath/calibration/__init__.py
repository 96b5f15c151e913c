"""Records of what is known of wearer, shoes and insoles; limits.py has their limits, file.py their file."""

from .records import Calibration, CalibrationError, InsoleCalibration, Limbs, Newtons, ShoeGeometry, merged

__all__ = ["Calibration", "CalibrationError", "InsoleCalibration", "Limbs", "Newtons", "ShoeGeometry", "merged"]
