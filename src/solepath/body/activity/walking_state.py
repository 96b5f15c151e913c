"""Walking state by the angle per metre of each step: Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors
16, 1809, 2016), section 3.4.1; the angle and its thresholds are in foot/steepness.py.
"""

from __future__ import annotations

from attrs import define, field

from ...events import ActivityChanged, Event, StepTaken
from ...foot.steepness import steepness
from ...foot.tracker import FootTracker
from ...types import Activity, Phase, Sample, Site
from ...vector import TIE
from .flights import Flights

_OF_STEP = {0: Activity.WALKING, 1: Activity.STAIRS_UP, -1: Activity.STAIRS_DOWN}


@define
class AnglePerMetre:
    """Each step of each foot is level, upstairs or downstairs by its own angle per metre; flights are counted.

    The paper tells three states and takes walking and jogging for one: a level step is WALKING, however fast. It has no
    word for who does not walk: feet that stand for `stands` s are STANDING since they came to stand, and feet that move
    without a step for `lost` s are UNKNOWN. What is told is final and knows no probabilities. Latency: the step's end,
    for a state that began with its toe-off; `stands` for standing.
    """

    stands: float = 1.2
    """Longer than a foot of a slow walker stands, s."""
    lost: float = 5.0
    """s."""
    # state
    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    flights: Flights = field(factory=Flights, init=False)
    since: float | None = field(default=None, init=False)
    """`t` of what was told last, s; None when it was told on a clock that is gone."""
    moved_at: float | None = field(default=None, init=False)
    """When a foot was last seen off the ground or on its way there; at first, when a foot was first seen, s."""
    stepped_at: float | None = field(default=None, init=False)
    """The end of the last step, or the last moment of standing; at first as above, s."""

    def interrupt(self, site: Site) -> None:
        """As in `ActivityPart`."""
        self.since = self.moved_at = self.stepped_at = None
        self.flights.interrupt()

    def finish(self, known_at: float) -> list[Event]:
        """As in `ActivityPart`."""
        return [*self.flights.finish(known_at)]

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """As in `ActivityPart`."""
        t = sample.t
        if foot.moved_at != t or not foot.levelled:
            return []
        if self.moved_at is None or self.stepped_at is None:
            self.moved_at = self.stepped_at = t
        known_at = t if sample.known_at is None else max(t, sample.known_at)
        told: list[Event] = []
        for event in events:
            if isinstance(event, StepTaken):
                way = steepness(event.stride_length, event.height_change)
                began = event.t_start if event.t_toe_off is None else max(event.t_start, event.t_toe_off)
                self.stepped_at = max(self.stepped_at, event.t)
                self._tell(_OF_STEP[way], began, known_at, told)
                told += self.flights.stepped(event, way)
        if foot.phase is not Phase.STATIONARY:
            if t > self.moved_at:
                self.moved_at = t
            if t - self.stepped_at > self.lost and self.activity is not Activity.UNKNOWN:
                self._tell(Activity.UNKNOWN, self.stepped_at, known_at, told)
        elif t - self.moved_at >= self.stands - TIE:
            self.stepped_at = max(self.stepped_at, t)
            self._tell(Activity.STANDING, self.moved_at, known_at, told)
        if self.flights.way != 0:
            told += self.flights.waited(t, known_at)
        return told

    def _tell(self, activity: Activity, began: float, known_at: float, told: list[Event]) -> None:
        if activity is self.activity:
            return
        began = began if self.since is None else max(began, self.since)
        self.activity, self.since = activity, began
        told.append(
            ActivityChanged(t=began, known_at=max(known_at, began), activity=activity, probability=None)
        )
