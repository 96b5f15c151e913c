"""A walk as one file that can be mailed: figures and the gait table."""

from __future__ import annotations

from .report import Report

__all__ = ["Report"]
