"""What the wearer does: the part that says so, and what a session asks of it."""

from __future__ import annotations

from math import sqrt
from typing import Protocol

from attrs import define, field

from ..events import ActivityChanged, Event, StepTaken
from ..foot.tracker import FootTracker
from ..types import Activity, Sample, Site
from ..vector import TIE


class ActivityPart(Protocol):
    """Samples and steps of both feet in, what the wearer does out. A plain record, as every machine is.

    A part with a method `calibrated(calibration) -> Self` is replaced by what that returns before it is used.
    """

    @property
    def activity(self) -> Activity:
        """The newest that it told, final or not; UNKNOWN before any."""

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """A foot has used `sample` (a barometer's too), and `events` are what came of it; returns what follows."""

    def interrupt(self, site: Site) -> None:
        """The clock of the samples of a site begins anew."""


@define
class Activities:
    """Standing, walking and stairs, a window at a time."""

    window: float = 2.0
    """s."""
    still: float = 0.6
    """Standard deviation of |acc| over a window of standing, m/s^2."""
    # state
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    start: float | None = field(default=None, init=False)
    count: int = field(default=0, init=False)
    total: float = field(default=0.0, init=False)
    squares: float = field(default=0.0, init=False)
    risen: float = field(default=0.0, init=False)
    gone: float = field(default=0.0, init=False)

    def interrupt(self, site: Site) -> None:
        """The clock of the samples of a site begins anew."""
        self.start = None

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """A foot has used `sample`, and `events` are what came of it."""
        for event in events:
            if isinstance(event, StepTaken):
                self.risen += event.height_change
                self.gone += event.stride_length
        if sample.acc is None:
            return []
        t = sample.t
        if self.start is None or t < self.start:
            self.start, self.count, self.total, self.squares, self.risen, self.gone = t, 0, 0.0, 0.0, 0.0, 0.0
        x, y, z = sample.acc
        energy = x * x + y * y + z * z
        self.count += 1
        self.total += sqrt(energy)
        self.squares += energy
        if t - self.start < self.window - TIE or self.count < 4:
            return []
        mean = self.total / self.count
        quiet = self.squares / self.count - mean * mean < self.still * self.still
        slope = self.risen / max(self.gone, 0.1)
        told = Activity.WALKING
        if quiet:
            told = Activity.STANDING
        elif abs(slope) > 0.25:
            told = Activity.STAIRS_UP if slope > 0.0 else Activity.STAIRS_DOWN
        began, self.start = self.start, None
        self.risen = self.gone = 0.0
        if told is self.activity:
            return []
        self.activity = told
        known_at = t if sample.known_at is None else max(t, sample.known_at)
        return [ActivityChanged(t=began, known_at=known_at, activity=told, probability=None)]
