"""The activity now: a state machine that follows what feet show before the likeliest sequence of activities is known.

The sequence (hypotheses.py) knows a block 1 to 1.5 s after it. For the newest blocks and strides, each cue changes the
activity by `NEXT_ACTIVITY`; the sequence confirms or revises that. Numbers become cues here, outside the table."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from math import exp, fsum

from ...events import ActivityChanged, EscalatorRidden, Event, LiftRidden
from ...events.activity import Ride
from ...types import Activity, Floats
from ...types.attrs import state, stateful
from ...types.vector import TIME_EPSILON
from .chain import ACTIVITIES, STAND, UNKNOWN, Chain
from .elevator_evidence import PULSE_ACCELERATION, PULSE_DEVIATION, ElevatorEvidence, RestLevels
from .hypotheses import ActivitySegment, Hypotheses
from .motion import SlopeEvidence
from .reconcile import LONGEST_TURN, SETTLING_TIME, Strides

# Activities that were reported and are not final yet, and the events by which they change.

BOARDING_TIME = LONGEST_TURN
"""Longest time from the last stride to the first bend of an escalator, s: 2 m of level steps, and a pause (assumed)."""
LONGEST_RIDE = 120.0
"""Time for which the strides and forces of a ride are kept, s: an escalator of 30 m takes as long, a lift less."""
START_TOLERANCE = 1.0
"""Largest change in the start of a provisional activity that is not reported as a revision, s."""
ELEVATOR_GOES_UP = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}
"""Flag for each elevator activity: the ride goes up."""
NO_ACTIVITY = ActivitySegment(-1e9, Activity.UNKNOWN)
"""Placeholder for the newest activity before any."""
Early = tuple[ActivitySegment, float]
"""An activity after the likeliest sequence (early.py), and its probability."""


@stateful
class ActivityReport:
    """The activities that were reported."""

    activity: Activity = Activity.UNKNOWN
    """The newest activity that was reported, final or not."""
    strides: Strides = state(factory=Strides)
    settled: list[Early] = state(factory=list)
    """Settled segments of the sequence, oldest first, from that of the newest final activity on."""
    rides: list[tuple[ActivitySegment, float]] = state(factory=list)
    """Settled elevator rides that wait until all strides in them are known, each with its end, s."""
    final: ActivitySegment = NO_ACTIVITY
    """Newest activity that was reported as final."""
    known_until: float = NO_ACTIVITY.t
    """Time up to which that activity goes on whatever comes, s."""
    provisional: list[Early] = state(factory=list)
    """Segments that were reported and are not final, oldest first, each with its newest probability."""
    withdrawn_at: float | None = None
    """Time `t` of the newest report, s, if it is not final and withdrew an activity without a successor; else None."""

    def add(
        self, hypotheses: Hypotheses, early: Sequence[Early], settled_by: float, known_at: float, ending: bool = False
    ) -> list[Event]:
        """Return the events by which the likeliest sequence and the activities after it replace what was reported.

        Segments that are certain at `settled_by`, s, and whose strides are known, are final; with `ending`, all are."""
        for segment, ended, probability in hypotheses.settle(settled_by):
            if ended is not None:
                self.settled[-1:] = [(ended, self.settled[-1][1])]
                if ended.activity in ELEVATOR_GOES_UP:
                    self.rides.append((ended, segment.t))
            self.settled.append((segment, probability))
        best = hypotheses.best
        path = () if best is None else best.path if hypotheses.settled is None else best.path[1:]
        likely = [*self.settled, *[(segment, hypotheses.probability(segment)) for segment in path], *early]
        likely = [(_shown(segment), probability) for segment, probability in likely]
        agreed = self.strides.reconcile(likely, settled_by)
        # a change that may still come a little later is not known yet
        undecided = min(hypotheses.settled_until(settled_by), self.strides.undecided_since(settled_by))
        known_until = min(undecided - TIME_EPSILON, settled_by - SETTLING_TIME + TIME_EPSILON)
        events = self._report_rides(settled_by, known_at, ending)
        newest = self._newest(agreed)
        while newest and (ending or newest[0][0].t <= known_until):
            segment, probability = newest.pop(0)
            revises = self.provisional[0][0].t if self.provisional else self.withdrawn_at
            events.append(self._event(segment, known_at, True, revises, probability))
            self.provisional, self.withdrawn_at, self.final = [], None, segment
        self._trim(max(known_until, self.final.t))
        # the edge of a bout or a delay of the chain may lie ahead: an activity is reported once it has begun
        now = max([known_at, *[segment.t for segment, _ in self.provisional]])
        newest = [one for one in newest if one[0].t <= now]
        return events + self._report_newest(newest, known_at, ending)

    def end(self, t: float) -> ActivityChanged:
        """Return the event that nothing is known from `t`, s, on."""
        return self._event(ActivitySegment(t, Activity.UNKNOWN), t, True, None, 1.0)

    def _newest(self, agreed: Sequence[Early]) -> list[Early]:
        """Return the activities after the newest final one, which stays what it is."""
        newest: list[Early] = []
        for segment, probability in agreed:
            after = segment
            if segment.t <= self.known_until:
                newest = []  # what was there before is settled
                after = ActivitySegment(self.known_until + TIME_EPSILON, segment.activity)
            if segment.activity is not (newest[-1][0] if newest else self.final).activity:
                newest.append((after, probability))
        return newest

    def _trim(self, known_until: float) -> None:
        """Drop what no later report needs, when it is known that the newest activity goes on up to `known_until`, s."""
        self.known_until = max(self.known_until, known_until)
        while len(self.settled) > 1 and self.settled[1][0].t <= self.known_until:
            self.settled.pop(0)
        rides = [ride.t for ride, _ in [*self.rides, *self.settled] if ride.activity in ELEVATOR_GOES_UP]
        self.strides.drop_before(max(min([self.known_until, *rides]), self.known_until - LONGEST_RIDE) - LONGEST_TURN)

    def _report_rides(self, now: float, known_at: float, ending: bool) -> list[Event]:
        """Return the rides whose strides are all known.

        Whoever walked for most of one was in no elevator, and whoever has not walked just before on no escalator."""
        events: list[Event] = []
        while self.rides and (ending or now - self.rides[0][1] >= SETTLING_TIME - TIME_EPSILON):
            ride, t_end = self.rides.pop(0)
            is_ridden = 2.0 * self.strides.covered(ride.t, t_end) < t_end - ride.t
            is_boarded = not ride.by_escalator or self.strides.covered(ride.t - BOARDING_TIME, ride.t) > 0.0
            if is_ridden and is_boarded and not self.strides.leans(ride.t, t_end):
                events.append(_ride_event(ride, t_end, known_at))
        return events

    def _report_newest(self, newest: Sequence[Early], known_at: float, ending: bool) -> list[Event]:
        """Return the events by which activities that are not final replace those that were reported."""
        events: list[Event] = []
        unchanged: list[Early] = []
        for (old, _), (new, probability) in zip(self.provisional, newest, strict=False):
            if old.activity is not new.activity or abs(old.t - new.t) > START_TOLERANCE:
                break
            unchanged.append((old, probability))
        withdrawn, changed = self.provisional[len(unchanged) :], newest[len(unchanged) :]
        revised = withdrawn[0][0].t if withdrawn else self.withdrawn_at
        self.provisional = unchanged
        if withdrawn and not changed:
            # no new activity takes the place of the withdrawn one: the activity before it continues
            events.append(self._withdraw(withdrawn[0][0].t, known_at, False))
        for segment, probability in changed:
            events.append(self._event(segment, known_at, False, revised, probability))
            revised = self.withdrawn_at = None
        if ending and self.withdrawn_at is not None:
            events.append(self._withdraw(self.withdrawn_at, known_at, True))
        self.provisional += changed
        return events

    def _withdraw(self, t: float, known_at: float, final: bool) -> ActivityChanged:
        """Return the event by which the activity of time `t`, s, is withdrawn and the one before it continues."""
        continued, probability = self.provisional[-1] if self.provisional else (self.final, 1.0)
        self.withdrawn_at = None if final else t
        return self._event(ActivitySegment(t, continued.activity), known_at, final, t, probability)

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


def _shown(segment: ActivitySegment) -> ActivitySegment:
    """Return the segment as it is reported: who rides on an escalator stands."""
    return ActivitySegment(segment.t, Activity.STANDING) if segment.by_escalator else segment


def _ride_event(ride: ActivitySegment, t_end: float, known_at: float) -> Ride:
    start = ride.t if ride.detected_at is None else ride.detected_at
    end = max(start, t_end if ride.ended_at is None else ride.ended_at)
    up = ELEVATOR_GOES_UP[ride.activity]
    # the pulses are surer of the direction than a height of the other sign, which therefore is not known
    height = None if ride.height is None or (ride.height > 0.0) is not up else ride.height
    kind = EscalatorRidden if ride.by_escalator else LiftRidden
    return kind(t=end, known_at=max(known_at, end), t_start=start, up=up, height=height)


LEAST_MARGIN = 0.5
"""Least difference of the log-likelihoods of a new motion and of the present one: 1.6 to 1; 1.0 is 0.3 points worse 1 s
after a moment, and nothing changes at the end (hugadb).

Without a margin, a twentieth more activities are reported and withdrawn (hugadb)."""
LEAST_PUSH, PUSH_VARIANCE = 0.25, 0.02
"""Least acceleration of both feet together that an elevator may cause, m/s^2, and the largest variance of its
measurement, (m/s^2)^2: half of that deviation. Elevators start with 0.3 to 1.2 m/s^2."""
RIDE_ODDS = 0.05
"""Odds that a push on both standing feet is an elevator's and not the wearer's, before its strength is known (assumed).
They change only the probability that is reported."""
LEAST_SLOPE = 0.5
"""Least evidence of one stride for stairs or against them that is a cue, as a logarithm of likelihoods."""


class ActivityCue(StrEnum):
    """A sign of an activity in one block or stride."""

    STILL = "still"
    WALKING = "walking"
    RUNNING = "running"
    CLIMBING = "climbing"
    DESCENDING = "descending"
    PUSHED_UP = "pushed up"
    PUSHED_DOWN = "pushed down"
    LEVEL = "level stride"
    STRANGE = "strange"


CUE_OF_VOTE = (
    ActivityCue.STILL,
    ActivityCue.WALKING,
    ActivityCue.RUNNING,
    ActivityCue.CLIMBING,
    ActivityCue.DESCENDING,
    ActivityCue.STRANGE,
)
"""Cue of each of `MOTIONS`."""

_MOVING = {
    ActivityCue.WALKING: Activity.WALKING,
    ActivityCue.RUNNING: Activity.RUNNING,
    ActivityCue.CLIMBING: Activity.STAIRS_UP,
    ActivityCue.DESCENDING: Activity.STAIRS_DOWN,
}
_STANDING = {
    ActivityCue.STILL: Activity.STANDING,
    ActivityCue.PUSHED_UP: Activity.ELEVATOR_UP,
    ActivityCue.PUSHED_DOWN: Activity.ELEVATOR_DOWN,
}


def _row(activity: Activity) -> dict[ActivityCue, Activity]:
    """Return the activity after each cue.

    Feet that move are pushed by their own steps; the end of a ride is found by the sequence, from both pulses."""
    row = {**dict.fromkeys(ActivityCue, activity), **_MOVING, ActivityCue.STRANGE: Activity.UNKNOWN}
    if activity in (Activity.UNKNOWN, Activity.STANDING):
        return row | _STANDING
    if activity in (Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN):
        return row
    level = Activity.RUNNING if activity is Activity.RUNNING else Activity.WALKING
    return row | {ActivityCue.STILL: Activity.STANDING, ActivityCue.LEVEL: level}


NEXT_ACTIVITY: dict[Activity, dict[ActivityCue, Activity]] = {activity: _row(activity) for activity in Activity}
"""The activity after each cue, by the activity before it."""

STATE_OF_ACTIVITY = {activity: ACTIVITIES.index(activity) for activity in Activity}
"""First state of each activity in the chain (chain.py): that in which it begins."""


BlockSigns = tuple[Floats, ElevatorEvidence]
"""Signs of activity in a block: the log-likelihoods of `MOTIONS` and the forces on both feet."""


def follow(found: list[Early], t: float, cue: tuple[ActivityCue, float] | None, chain: Chain) -> None:
    """Add the activity after the newest one of `found` that the cue of a block or stride at `t`, s, begins, if any.

    The cue has its probability; `found` has one activity at least."""
    newest = found[-1][0]
    following = newest.activity if cue is None else NEXT_ACTIVITY[newest.activity][cue[0]]
    if cue is not None and following is not newest.activity:
        t += chain.shift[STATE_OF_ACTIVITY[newest.activity]][STATE_OF_ACTIVITY[following]]
        found.append((ActivitySegment(max(t, newest.t + TIME_EPSILON), following), cue[1]))


def follow_block(
    found: list[Early], t: float, shown: BlockSigns | None, levels: RestLevels | None, chain: Chain
) -> None:
    """Follow what a block that starts at `t`, s, shows; `levels` are the forces on the feet at rest."""
    if shown is not None:
        votes, elevator = shown
        follow(found, t, cue_of_block(votes, found[-1][0].activity, elevator, levels), chain)


def cue_of_block(
    votes: Sequence[float], before: Activity, elevator: ElevatorEvidence, levels: RestLevels | None
) -> tuple[ActivityCue, float] | None:
    """Return the cue of a block and the probability of what it shows; None if the activity `before` goes on.

    `votes` are the log-likelihoods of `MOTIONS`, `levels` the forces on the feet at rest."""
    best = max(range(len(votes)), key=votes.__getitem__)
    probability = 1.0 / fsum([exp(vote - votes[best]) for vote in votes])
    push = None if best != STAND or levels is None else elevator.estimate_acceleration(levels)
    if push is not None and abs(push[0]) > LEAST_PUSH and push[1] < PUSH_VARIANCE and levels is not None:
        sign = 1.0 if push[0] > 0.0 else -1.0
        pulse = elevator.add_pulse(levels, sign * PULSE_ACCELERATION, PULSE_DEVIATION)[2]
        odds = RIDE_ODDS * exp(max(-50.0, min(50.0, pulse - elevator.add_rest(levels)[1])))
        return (ActivityCue.PUSHED_UP if sign > 0.0 else ActivityCue.PUSHED_DOWN), odds / (1.0 + odds)
    state = STATE_OF_ACTIVITY[before]
    if votes[best] - votes[state if state < len(votes) else STAND] <= LEAST_MARGIN and state != UNKNOWN:
        return None
    return CUE_OF_VOTE[best], probability


def cue_of_stride(slope: SlopeEvidence) -> tuple[ActivityCue, float] | None:
    """Return the cue of a stride by its slope, and the probability of what it shows; None if it shows nothing."""
    steepest, cue = (slope.up, ActivityCue.CLIMBING) if slope.up > slope.down else (slope.down, ActivityCue.DESCENDING)
    if steepest < -LEAST_SLOPE:
        steepest, cue = -steepest, ActivityCue.LEVEL
    return (cue, 1.0 / (1.0 + exp(-steepest))) if steepest > LEAST_SLOPE else None
