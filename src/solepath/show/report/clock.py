"""Formats the times of a report: on the recording's clock, or from its start if the clock started long before.

The two limits were chosen by hand and not swept."""

from __future__ import annotations

from attrs import frozen

MINUTES_FROM = 300.0
"""Duration above which axes are in minutes, s."""
FAR_START = 1e5
"""Start of a recording, s, above which its clock started long before; its times then count from its start."""


@frozen
class ReportClock:
    """The times of one recording in its report; `start` and `end` are on the recording's clock, s."""

    start: float
    end: float

    @property
    def origin(self) -> float:
        """Time on the recording's clock that is 0 in the report, s."""
        return self.start if abs(self.start) >= FAR_START else 0.0

    @property
    def unit(self) -> str:
        """Unit of time axes."""
        return "min" if self.end - self.start > MINUTES_FROM else "s"

    @property
    def label(self) -> str:
        """Label of a time axis."""
        return f"time{' from the beginning' if self.origin else ''}, {self.unit}"

    @property
    def span(self) -> tuple[float, float]:
        """Lower and upper end of a time axis, in its unit."""
        low, high = self.axis_value(self.start), self.axis_value(self.end)
        return (low, high) if high > low else (low - 0.5, low + 0.5)

    def axis_value(self, t: float) -> float:
        """Return `t`, s on the recording's clock, as a value on a time axis, in its unit."""
        return (t - self.origin) / (60.0 if self.unit == "min" else 1.0)
