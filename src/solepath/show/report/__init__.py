"""Writes a walk as one file that can be mailed, with figures and the gait table."""

from __future__ import annotations

from .content import ReportDetails
from .report import Report

__all__ = ["Report", "ReportDetails"]
