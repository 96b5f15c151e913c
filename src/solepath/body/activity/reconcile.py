"""Strides and the likeliest sequence of activities, brought to agree.

The sequence (hypotheses.py) is found from blocks of half a second, some of which are the slow stance of a patient, and
some the legs of a cyclist. A stride that is reported is of a foot that carries its walker (foot/bearing.py). So the
wearer walks, runs or is on stairs while a stride lasts, whatever its duration; what looks like walking, but has no
stride for longer than the pause of one bout, is not known, and neither are feet that move for longer than that while
they seem to stand."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, fsum, inf

from ...events import FootFlat, GaitEvent, HeelOff, HeelStrike, StrideTaken, ToeOff
from ...foot.bearing import LONGEST_WAIT, MOST_WAITING, USUAL_TILT
from ...foot.stride import RESTING_RATE
from ...types import Activity, Foot, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import TIME_EPSILON, UP, dot, rotate_back
from ..gait.cycles import MAX_PHASE_TIME
from .chain import ELEVATOR_ACTIVITIES
from .foot_blocks import BLOCK_DURATION, MOVING_VARIANCE, ActivityBlock
from .hypotheses import ActivitySegment
from .motion import slope_evidence

Likely = tuple[ActivitySegment, float]
"""An activity and its probability."""
GAITS = (Activity.WALKING, Activity.RUNNING, Activity.STAIRS_UP, Activity.STAIRS_DOWN)
"""Activities in which the feet carry the wearer from place to place."""
BOUT_PAUSE = 3.0
"""Longest pause within one bout of walking, s (Kluge et al., "Consensus based framework for digital mobility
monitoring", PLoS ONE 16, 2021)."""
LEAST_LIFT, LONGEST_LIFT = 0.3, 2.0
"""Shortest and longest time for which a foot is lifted that moves, s: one at rest seems to leave the ground for less,
and the step of a patient who turns on the spot takes 2 s. What is longer hides an absence."""
LONGEST_TURN = 2.0 * BOUT_PAUSE + LONGEST_LIFT
"""Longest time between two strides with a turn on the spot, s: a pause before it, one after it, and a step."""
EDGE = 1.5
"""Time before the first and after the last stride of a bout that may belong to it, s: a half stride, and the reach of a
block's window (`WINDOW_REACH`)."""
LEANING_SHARE = 0.2
"""Share of the time in which the force leans from which on the wearer is in a vehicle, and in no elevator.

In elevators of hugadb it leans in less than 1 % of half seconds, in cars of hugadb_daily in half. Chosen by hand."""
RUNNING_FORCE, RUNNING_RATE = 17.0, 3.0
"""Mean specific force, m/s^2, and root mean square of the angular rate, rad/s, of a foot in half a second of running.

A runner flies between impacts, and throws each foot forwards faster than it falls. Both hold in 98 % of the half
seconds of running of hugadb, whose accelerometers clip at 2 g, and in none of bicycling (hugadb_daily): a crank of
0.17 m at 80 turns a minute adds 12 m/s^2, and the pedal hardly turns against the floor."""
STAIRS_EVIDENCE = 1.0
"""Mean evidence of strides, a logarithm of a likelihood ratio, from which on they are on stairs; chosen by hand."""
NEAR_TIME = 1.5
"""Time before and after a cycle of gait in which others decide with it whether it was walked, s: two steps or more."""
SETTLING_TIME = 6.0
"""Time after which all strides of a moment are known, s: a patient's stride, and the wait of a bout's first ones."""
CERTAINTY = 0.9
"""Probability of what strides show: that of the evidence from which on a foot is known to carry its walker."""


@define
class StrideSpan:
    """The swing of a stride, s, and what the stride shows."""

    start: float
    end: float
    up: float
    """Evidence of stairs up, and down, as logarithms of likelihood ratios."""
    down: float


@define
class Strides:
    """The strides of both feet that are newer than the last final activity."""

    spans: list[StrideSpan] = field(factory=list)
    newest: dict[Foot, dict[str, float]] = field(factory=dict)
    """Time of the newest event of each kind of each foot, s."""
    cycles: list[tuple[float, float, bool]] = field(factory=list)
    """Time of the end of each stance, s, duration of the cycle, s, and whether the stance was longer than the swing
    before it: nobody ran."""
    moved: list[tuple[float, float]] = field(factory=list)
    """Times at which a foot was lifted and came down again, with a stride or without, s."""
    lying: dict[Foot, Vec3] = field(factory=dict)
    """Direction of up in the sensor of each foot at its newest foot-flat."""
    tilted: list[tuple[float, float]] = field(factory=list)
    """Times at which a foot was lifted and came to lie otherwise than before, s."""
    bearing: dict[Foot, bool] = field(factory=dict)
    """Whether each foot may carry its walker."""
    forces: list[tuple[float, bool]] = field(factory=list)
    """Times of half seconds at rest, s, and whether the force on the feet leans in them."""
    runs: list[float] = field(factory=list)
    """Times of half seconds in which a foot moves as in a run, s: a runner's foot-flat is too short to end strides."""
    restless: list[float] = field(factory=list)
    """Times of half seconds in which a foot turns or is shaken, s."""
    tracked: bool = False
    """Flag: the feet have gyroscopes and are navigated, so that a walk has strides."""
    gait_since: float | None = None
    """Time since which the likeliest sequence has nothing but gaits, s; None when it ends with another activity."""

    def add(self, stride: StrideTaken, length: float, rise: float) -> None:
        """Add a stride of this length and rise, m."""
        start, end, slope = stride.t_start, stride.t_end, slope_evidence(length, rise)
        start = start if stride.t_toe_off is None else max(start, stride.t_toe_off)
        end = end if stride.t_heel_strike is None else min(end, stride.t_heel_strike)
        self.spans.append(StrideSpan(start, end, slope.up, slope.down))
        self.spans.sort(key=_start)

    def add_event(self, event: object, attitude: Quat) -> None:
        """Add an event of a foot with this attitude: contacts tell a run from a walk, and a lift ends a pause."""
        if not isinstance(event, GaitEvent):
            return
        times = self.newest.setdefault(event.foot, {})
        if isinstance(event, FootFlat):
            lifted = times.get(HeelOff.__name__, event.t)
            if LEAST_LIFT + TIME_EPSILON < event.t - lifted < LONGEST_LIFT + TIME_EPSILON:
                self.moved.append((lifted, event.t))
                up = rotate_back(attitude, UP)
                if dot(up, self.lying.get(event.foot, up)) < cos(USUAL_TILT):
                    self.tilted.append((lifted, event.t))
                self.lying[event.foot] = up
        elif isinstance(event, ToeOff):
            swung, contact = times.get(ToeOff.__name__), times.get(HeelStrike.__name__)
            if swung is not None and contact is not None and swung < contact:
                swing, stance = contact - swung, event.t - contact
                if max(stance, swing) < MAX_PHASE_TIME - TIME_EPSILON:
                    self.cycles.append((event.t, swing + stance, stance > swing + TIME_EPSILON))
        times[type(event).__name__] = event.t

    def add_block(self, t: float, block: ActivityBlock) -> None:
        """Add half a second of a foot, from `t`, s, if it moves in it as in a run, turns or is shaken.

        Nobody runs on a foot that is known not to carry; that of a runner without strides is not."""
        fast = block.gyro_mean_square > RUNNING_RATE * RUNNING_RATE
        may_run = fast and all(self.bearing.values())
        if may_run and block.force > RUNNING_FORCE and block.variance > MOVING_VARIANCE:
            self.runs.append(t)
        is_restless = block.gyro_mean_square > RESTING_RATE or block.variance > MOVING_VARIANCE
        if is_restless and t not in self.restless[-1:]:
            self.restless.append(t)

    def drop_before(self, until: float) -> None:
        """Drop what ended before `until`, s."""
        self.spans = [span for span in self.spans if span.end >= until]
        self.cycles = [cycle for cycle in self.cycles if cycle[0] >= until]
        self.moved = [times for times in self.moved if times[1] >= until]
        self.tilted = [times for times in self.tilted if times[1] >= until]
        self.forces = [force for force in self.forces if force[0] >= until]
        self.runs = [t for t in self.runs if t >= until]
        self.restless = [t for t in self.restless if t >= until]

    def leans(self, start: float, end: float) -> bool:
        """Return whether the force on the feet leans so often from `start` to `end`, s, that they are in a vehicle."""
        leaning = [leans for t, leans in self.forces if start <= t + TIME_EPSILON < end]
        return leaning.count(True) > LEANING_SHARE * len(leaning)

    def undecided_since(self, now: float) -> float:
        """Return the time from which lifts of a foot may still become strides, s; infinite if none may.

        A patient's first strides are known with later ones only (foot/bearing.py), and standing cannot contain one, nor
        be a pause of their bout."""
        known = max([span.end for span in self.spans], default=-inf)
        oldest, after = inf, now
        for lifted, fallen in sorted(self.moved, reverse=True)[: MOST_WAITING * len(self.newest)]:
            if lifted < known or after - fallen > LONGEST_WAIT + TIME_EPSILON:
                break
            oldest, after = lifted, fallen
        return known if oldest - known <= BOUT_PAUSE + TIME_EPSILON else oldest

    def covered(self, start: float, end: float) -> float:
        """Return the time between `start` and `end`, s, in which strides moved the wearer."""
        parts = [min(end, last) - max(start, first) for first, last in self._bouts()]
        return fsum([max(0.0, part) for part in parts])

    def _long_motions(self, gaits: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        """Return the times, s, in which the feet move outside `gaits` for longer than a pause of one.

        Who stands shifts a foot within 2 s (hugadb, slow_gait), and whoever moves their feet for longer taps or swings
        them. A foot that stands comes back to lie as before; while it does not, a pause is no standing."""
        blocks = [(t, t + BLOCK_DURATION) for t in self.restless if all([not a <= t < b for a, b in gaits])]
        spans = [*_joined(blocks, 0.0), *_joined(self.tilted, BOUT_PAUSE)]
        return _joined([span for span in spans if span[1] - span[0] > BOUT_PAUSE + TIME_EPSILON], 0.0)

    def _bouts(self) -> list[tuple[float, float]]:
        """Return the bouts, s: the times of walking with pauses of at most `BOUT_PAUSE`.

        In a pause all feet are flat. A foot that turns on the spot between two strides pauses before and after it."""
        bouts: list[tuple[float, float]] = []
        for span in self.spans:
            if bouts:
                start, end = bouts[-1]
                if span.start - end <= BOUT_PAUSE + TIME_EPSILON:  # whatever moves between is in the bout
                    bouts[-1] = (start, max(end, span.end))
                    continue
                moved = sorted([times for times in self.moved if end < times[1] < span.start])
                lifts, falls = [*[times[0] for times in moved], span.start], [end, *[times[1] for times in moved]]
                pauses = [lift - fall for fall, lift in zip(falls, lifts, strict=True)]
                if max(pauses) <= BOUT_PAUSE + TIME_EPSILON and span.start - end <= LONGEST_TURN + TIME_EPSILON:
                    bouts[-1] = (start, max(end, span.end))
                    continue
            bouts.append((span.start, span.end))
        return bouts

    def reconcile(self, likely: Sequence[Likely], now: float) -> list[Likely]:
        """Return the activities that agree with the strides up to `now`, s; `likely` is the likeliest sequence."""
        if not self.tracked:
            return [*likely]
        walked = self._bouts()
        bouts = [(start - EDGE, end + EDGE) for start, end in walked]
        runs = sorted([*bouts, *[(t - BLOCK_DURATION, t + 2.0 * BLOCK_DURATION) for t in self.runs]])
        # whoever walks now may be in a stride that has not ended, or whose foot is not known to carry yet
        since = None
        for segment, _ in likely:
            since = None if segment.activity not in GAITS else segment.t if since is None else since
        if since is None or self.gait_since is None:
            self.gait_since = since
        if self.gait_since is not None:
            open_since = max([self.gait_since, *[span.end for span in self.spans]])
            if now - open_since < SETTLING_TIME - TIME_EPSILON:
                bouts.append((open_since, inf))
                runs.append((open_since, inf))
        agreed: list[Likely] = []
        for k, (segment, probability) in enumerate(likely):
            end = likely[k + 1][0].t if k + 1 < len(likely) else inf
            if segment.activity in GAITS:
                for t, until, supported in _cut(
                    segment.t, end, runs if segment.activity is Activity.RUNNING else bouts
                ):
                    if not supported:
                        _append(agreed, segment, t, Activity.UNKNOWN, 1.0 - CERTAINTY)
                    elif segment.activity is Activity.RUNNING:
                        for t_start, walks in self._walks(t, until):
                            activity = Activity.WALKING if walks else Activity.RUNNING
                            _append(agreed, segment, t_start, activity, probability)
                    else:
                        _append(agreed, segment, t, segment.activity, probability)
            else:
                in_vehicle = segment.activity in ELEVATOR_ACTIVITIES and self.leans(segment.t, end)
                otherwise = Activity.UNKNOWN if in_vehicle else segment.activity
                for t, until, supported in _cut(segment.t, end, walked):
                    if supported:
                        _append(agreed, segment, t, self.gait(t, until), CERTAINTY)
                        continue
                    for first, _, moves in _cut(t, until, self._long_motions(runs)):
                        _append(agreed, segment, first, Activity.UNKNOWN if moves else otherwise, probability)
        return agreed

    def _walks(self, start: float, end: float) -> list[tuple[float, bool]]:
        """Return the parts of a run from `start` to `end`, s: when each starts, and whether it was walked.

        Cycles that were walked fill most of the time of both feet around; those that start shortly after the run count,
        because the first contacts of a recording are in no cycle. Single ones show nothing: some detectors find few
        contacts of a runner, and these late."""
        cycles = sorted([cycle for cycle in self.cycles if start <= cycle[0] and cycle[0] - cycle[1] < end + NEAR_TIME])
        parts: list[tuple[float, bool]] = []
        before = start
        for t, _, _ in cycles:
            since, until = max(start, t - NEAR_TIME), min(cycles[-1][0], t + NEAR_TIME)
            walked = fsum([duration for other, duration, walks in cycles if walks and since < other <= until])
            walks = walked > 0.5 * len(self.newest) * (until - since)
            if before < end and (not parts or walks != parts[-1][1]):
                parts.append((before, walks))
            before = t
        return parts or [(start, False)]

    def gait(self, start: float, end: float) -> Activity:
        """Return the gait from `start` to `end`, s, by the slopes of the strides."""
        spans = [span for span in self.spans if span.start < end and span.end > start]
        if not spans:
            return Activity.WALKING
        up, down = [fsum(values) / len(spans) for values in zip(*[(span.up, span.down) for span in spans], strict=True)]
        if max(up, down) < STAIRS_EVIDENCE:
            return Activity.WALKING
        return Activity.STAIRS_UP if up > down else Activity.STAIRS_DOWN


def _start(span: StrideSpan) -> float:
    return span.start


def _joined(spans: Sequence[tuple[float, float]], pause: float) -> list[tuple[float, float]]:
    """Return the spans in order of time, s; those with at most `pause`, s, between them are one."""
    joined: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if joined and start - joined[-1][1] <= pause + TIME_EPSILON:
            start, end = joined[-1][0], max(end, joined.pop()[1])
        joined.append((start, end))
    return joined


def _cut(start: float, end: float, times: Sequence[tuple[float, float]]) -> list[tuple[float, float, bool]]:
    """Return the parts of the time from `start` to `end`, s, each with whether it lies within one of `times`."""
    parts: list[tuple[float, float, bool]] = []
    for first, last in times:
        first, last = max(first, start), min(last, end)
        if first >= last - TIME_EPSILON:
            continue
        if first > start + TIME_EPSILON:
            parts.append((start, first, False))
        parts.append((first, last, True))
        start = last
    if start < end - TIME_EPSILON:
        parts.append((start, end, False))
    return parts


def _append(agreed: list[Likely], segment: ActivitySegment, t: float, activity: Activity, probability: float) -> None:
    """Append the activity from `t`, s, unless it goes on."""
    if agreed and agreed[-1][0].activity is activity:
        return
    if activity is segment.activity and t == segment.t:
        agreed.append((segment, probability))
    else:
        agreed.append((ActivitySegment(t, activity), probability))
