"""Activities that were reported and are not final yet, and the events by which they change."""

from __future__ import annotations

from collections.abc import Sequence

from ...events import ActivityChanged, Event, LiftRidden
from ...types import Activity
from ...types.attrs import define, field
from .hypotheses import ActivitySegment, Hypotheses

START_TOLERANCE = 1.0
"""Largest change in the start of a provisional activity that is not reported as a revision, s."""
ELEVATOR_GOES_UP = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}
"""Flag for each elevator activity: the ride goes up."""
Early = tuple[ActivitySegment, float]
"""An activity after the likeliest sequence (early.py), and its probability."""


@define
class ActivityReport:
    """The activities that were reported."""

    activity: Activity = field(default=Activity.UNKNOWN, init=False)
    """The newest activity that was reported, final or not."""
    provisional: list[Early] = field(factory=list, init=False)
    """Segments that were reported and are not final, oldest first, each with its newest probability."""
    withdrawn_at: float | None = field(default=None, init=False)
    """Time `t` of the newest report, s, if it is not final and withdrew an activity without a successor; else None."""

    def add(
        self, hypotheses: Hypotheses, early: Sequence[Early], settled_by: float, known_at: float, ending: bool = False
    ) -> list[Event]:
        """Return the events by which the likeliest sequence and the activities after it replace what was reported.

        Segments that are certain at `settled_by`, s, are final; with `ending`, all are."""
        events: list[Event] = []
        for settled, ended, probability in hypotheses.settle(settled_by):
            if ended is not None and ended.activity in ELEVATOR_GOES_UP:
                events.append(_ride_event(ended, settled.t, known_at))
            revises = self.provisional[0][0].t if self.provisional else self.withdrawn_at
            events.append(self._event(settled, known_at, True, revises, probability))
            self.provisional, self.withdrawn_at = [], None
        best = hypotheses.best
        path = () if best is None else best.path if hypotheses.settled is None else best.path[1:]
        newest = [*[(segment, hypotheses.probability(segment)) for segment in path], *early]
        unchanged = 0
        for (old, _), (new, _) in zip(self.provisional, newest, strict=False):
            if old.activity is not new.activity or abs(old.t - new.t) > START_TOLERANCE:
                break
            unchanged += 1
        withdrawn, changed = self.provisional[unchanged:], newest[unchanged:]
        revised = withdrawn[0][0].t if withdrawn else self.withdrawn_at
        kept = [
            (old, probability) for (old, _), (_, probability) in zip(self.provisional[:unchanged], newest, strict=False)
        ]
        self.provisional = kept
        if withdrawn and not changed:
            # no new activity takes the place of the withdrawn one: the activity before it continues
            events.append(self._withdraw(hypotheses, withdrawn[0][0].t, known_at, False))
        for segment, probability in changed:
            events.append(self._event(segment, known_at, False, revised, probability))
            revised = self.withdrawn_at = None
        if ending and self.withdrawn_at is not None:
            events.append(self._withdraw(hypotheses, self.withdrawn_at, known_at, True))
        self.provisional = [*kept, *changed]
        return events

    def _withdraw(self, hypotheses: Hypotheses, t: float, known_at: float, final: bool) -> ActivityChanged:
        """Return the event by which the activity of time `t`, s, is withdrawn and the one before it continues."""
        if self.provisional:
            segment, probability = self.provisional[-1]
            continued = ActivitySegment(t, segment.activity)
        else:
            continued = ActivitySegment(t, Activity.UNKNOWN if hypotheses.settled is None else hypotheses.settled)
            probability = hypotheses.probability(continued)
        self.withdrawn_at = None if final else t
        return self._event(continued, known_at, final, t, probability)

    def _event(
        self, segment: ActivitySegment, known_at: float, final: bool, revises: float | None, probability: float
    ) -> ActivityChanged:
        self.activity = segment.activity
        return ActivityChanged(
            t=segment.t,
            known_at=max(known_at, segment.t),
            final=final,
            activity=segment.activity,
            probability=probability,
            revises=revises,
        )


def _ride_event(ride: ActivitySegment, t_end: float, known_at: float) -> LiftRidden:
    start = ride.t if ride.detected_at is None else ride.detected_at
    end = max(start, t_end if ride.ended_at is None else ride.ended_at)
    up = ELEVATOR_GOES_UP[ride.activity]
    # the pulses are surer of the direction than a height of the other sign, which therefore is not known
    height = None if ride.height is None or (ride.height > 0.0) is not up else ride.height
    return LiftRidden(t=end, known_at=max(known_at, end), t_start=start, up=up, height=height)
