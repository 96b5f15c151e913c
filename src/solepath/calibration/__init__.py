"""What is known of wearer, shoes and insoles: a record; what it may hold is in limits.py, its file in file.py."""

from .records import Calibration, CalibrationError, InsoleCalibration, Limbs, Newtons, ShoeGeometry, merged

__all__ = ["Calibration", "CalibrationError", "InsoleCalibration", "Limbs", "Newtons", "ShoeGeometry", "merged"]
