"""Times in the report: the recording's own, or, where its clock counts from long ago, from its start."""

from __future__ import annotations

from attrs import frozen

MINUTES_FROM = 300.0
"""Duration above which a recording is drawn in minutes, s."""
FAR_START = 1e5
"""Start time from which on the clock did not start with the recording, s."""


@frozen
class ReportClock:
    """Clock of one recording, from `start` to `end`, s."""

    start: float
    end: float

    @property
    def origin(self) -> float:
        """Time from which the report's times count, s."""
        return self.start if abs(self.start) >= FAR_START else 0.0

    @property
    def per_unit(self) -> float:
        """Seconds of the unit on axes."""
        return 60.0 if self.end - self.start > MINUTES_FROM else 1.0

    @property
    def label(self) -> str:
        """Label of a time axis."""
        unit = "min" if self.per_unit > 1.0 else "s"
        return f"time from the beginning, {unit}" if self.origin else f"time, {unit}"

    @property
    def span(self) -> tuple[float, float]:
        """Ends of a time axis, in its unit."""
        low, high = self.of(self.start), self.of(self.end)
        return (low, high) if high > low else (low - 0.5, low + 0.5)

    def of(self, t: float) -> float:
        """Return the value of `t`, in s, on a time axis."""
        return (t - self.origin) / self.per_unit

    def text(self, t: float) -> str:
        """Return `t`, in s, as text for a sentence."""
        return f"{t - self.origin:.1f} s"


def duration_text(seconds: float) -> str:
    """Return a duration in words."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
