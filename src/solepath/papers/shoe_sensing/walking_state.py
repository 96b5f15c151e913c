"""Walking state by the angle per metre of each step: Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors
16, 1809, 2016), section 3.4.1; the angle and its thresholds are in body/activity/steepness.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ...body.activity.flights import Flights
from ...body.activity.steepness import is_stair_rise, steepness
from ...body.part import ActivityPart, PartOutput
from ...events import ActivityChanged, Event, StrideTaken
from ...foot.view import FootView
from ...types import Activity, Foot, Phase, Site
from ...types.attrs import define, field
from ...types.vector import TIE

STANDS = 1.2
"""Longer than a foot of a slow walker stands, s."""
WITHOUT_STEP = 5.0
"""What a wearer does who moves for so long without a step is UNKNOWN, s."""
CLOCKS_APART, SILENT = 5.0, 10.0
"""Feet whose times are further apart than the first, s, are on different clocks; a foot without samples for the second,
s, no longer keeps the other waiting."""
_OF_STEP = {0: Activity.WALKING, 1: Activity.STAIRS_UP, -1: Activity.STAIRS_DOWN}


@define
class AnglePerMetre(ActivityPart):
    """Each step of each foot is level, upstairs or downstairs by its own angle per metre; flights are counted.

    The paper tells three states and takes walking and jogging for one: a level step is WALKING, however fast. It has no
    word for who does not walk: feet that stand for `STANDS` s are STANDING since they came to stand, and feet that move
    without a step for `WITHOUT_STEP` s are UNKNOWN. Every event is final, and has no probabilities. Latency: the step's
    end, for a state that began with its toe-off; `STANDS` for standing.

    A step that gains more than stairs have (steepness.py) is an error of the track, and its angle means nothing: who
    walked or climbed goes on doing so, who stood is UNKNOWN. When the clock of one foot restarts, events have the times
    of the other's. A foot more than `CLOCKS_APART` s away from the other is left out until it is nearer, the other's
    clock restarts too, or the other has no samples for `SILENT` s.
    """

    needs_samples: ClassVar[bool] = True

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    flights: Flights = field(factory=Flights, init=False)
    since: float | None = field(default=None, init=False)
    """`t` of what was told last, s; None when it was told on a clock that is gone."""
    clocks: dict[Foot, float] = field(factory=dict, init=False)
    """The newest time of each foot that dates what is told, s."""
    apart: dict[Foot, float | None] = field(factory=dict, init=False)
    """Of each foot whose clock began anew and that does not: since when it has waited for the other, by its own clock,
    s; None when the other was heard just now."""
    moved_at: float | None = field(default=None, init=False)
    """When a foot was last seen off the ground or on its way there; at first, when a foot was first seen, s."""
    stepped_at: float | None = field(default=None, init=False)
    """The end of the last step, or the last moment of standing; at first as above, s."""

    def reset(self, site: Site) -> None:
        foot = site.foot
        if foot is None:
            return
        self.flights.reset()
        self.clocks.pop(foot, None)
        self.apart[foot] = None

    def finish(self, now: float) -> Sequence[PartOutput]:
        return self.flights.finish(now)

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        t = view.t
        if view.moved_at != t or not view.levelled:
            return ()
        if self.apart and not self._dates(view.foot, t):
            return ()
        self.clocks[view.foot] = t
        if self.moved_at is None or self.stepped_at is None:
            self.moved_at = self.stepped_at = t
        known_at = view.known_at
        told: list[Event] = []
        for event in view.events:
            if isinstance(event, StrideTaken):
                began = event.t_start if event.t_toe_off is None else max(event.t_start, event.t_toe_off)
                self.stepped_at = max(self.stepped_at, event.t)
                way = None
                if is_stair_rise(event.height_change, event.degraded):
                    way = steepness(event.length, event.height_change)
                    self._tell(_OF_STEP[way], began, known_at, told)
                elif self.activity is Activity.STANDING:
                    self._tell(Activity.UNKNOWN, began, known_at, told)
                told += self.flights.add_stride(event, way)
        if view.phase is not Phase.STATIONARY:
            if t > self.moved_at:
                self.moved_at = t
            if t - self.stepped_at > WITHOUT_STEP and self.activity is not Activity.UNKNOWN:
                self._tell(Activity.UNKNOWN, self.stepped_at, known_at, told)
        elif t - self.moved_at >= STANDS - TIE:
            self.stepped_at = max(self.stepped_at, t)
            self._tell(Activity.STANDING, self.moved_at, known_at, told)
        if self.flights.direction != 0:
            told += self.flights.advance(t, known_at)
        return told

    def _dates(self, foot: Foot, t: float) -> bool:
        """Whether the times of `foot`, of which `t` is the newest, date what is told."""
        apart, clocks = self.apart, self.clocks
        if foot not in apart and clocks:
            for other in apart:
                apart[other] = None
            return True
        if clocks and abs(t - max(clocks.values())) > CLOCKS_APART:
            waiting = apart[foot]
            if waiting is None:
                apart[foot] = waiting = t
            if t - waiting <= SILENT:
                return False
            for other in clocks:
                apart[other] = None
            clocks.clear()
            self.flights.reset()
        if not clocks:
            self.moved_at = self.stepped_at = None
            if self.since is not None and t < self.since:
                self.since = None
        apart.pop(foot, None)
        return True

    def _tell(self, activity: Activity, began: float, known_at: float, told: list[Event]) -> None:
        if activity is self.activity and self.since is not None:
            return
        began = began if self.since is None else max(began, self.since)
        self.activity, self.since = activity, began
        told.append(ActivityChanged(t=began, known_at=max(known_at, began), activity=activity, probability=None))
