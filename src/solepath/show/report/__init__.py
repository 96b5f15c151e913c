"""Writes a walk as one file that can be mailed, with figures and the gait table."""

from __future__ import annotations

from .report import Report
from .sections.heading import ReportDetails

__all__ = ["Report", "ReportDetails"]
