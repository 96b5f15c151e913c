"""Errors of one kind that are pooled over recordings, not averaged: of legs, of stride times."""

from __future__ import annotations

import numpy as np
from attrs import frozen


@frozen
class Errors:
    """Signed errors, ours less the true: of legs relative to the true length (0.01 is 1 %), of stride times in s."""

    values: tuple[float, ...] = ()

    def __add__(self, other: Errors) -> Errors:
        return Errors(self.values + other.values)

    @property
    def mean(self) -> float | None:
        """Mean magnitude."""
        return float(np.mean(np.abs(self.values))) if self.values else None

    @property
    def median(self) -> float | None:
        """Median magnitude."""
        return float(np.median(np.abs(self.values))) if self.values else None

    @property
    def bias(self) -> float | None:
        """Median with its sign: positive when ours are too long."""
        return float(np.median(self.values)) if self.values else None
