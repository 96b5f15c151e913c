"""Hypotheses on the wearer's activities: for each state the likeliest sequence of activities that ends in it.

This is Viterbi's algorithm with the paths kept in tokens (Young, Russell, Thornton 1989, "Token passing"). Each state
(chain.py) holds one token: the likeliest path that ends in that state. A segment on which all likely tokens agree is
settled: it is final. A token that disagrees with a settled segment is dropped, so that no later result contradicts it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import exp, inf, log, sqrt
from operator import attrgetter

from ...types import Activity, Floats
from ...types.attrs import define, evolve, field
from ...types.vector import TIME_EPSILON
from .chain import (
    ACTIVITIES,
    ELEVATOR_ACTIVITIES,
    ELEVATOR_STARTS_DOWN,
    ELEVATOR_STARTS_UP,
    FIRST_CHANCES,
    HALT_SIGNS,
    PULSE_SIGNS,
    RIDE_STATES,
    STAIRS_DOWN,
    STAIRS_UP,
    STAND,
    UNACCELERATED_STATES,
    Chain,
)
from .elevator_evidence import (
    HALT_ACCELERATION,
    HALT_DEVIATION,
    PULSE_ACCELERATION,
    PULSE_DEVIATION,
    BlockForce,
    ElevatorEvidence,
    RestLevel,
    RestLevels,
    bell,
)
from .foot_blocks import BLOCK_DURATION

Height = tuple[float, float]
"""A mean height, m above an arbitrary level, and its variance, m^2."""
NO_EVIDENCE = (0.0,) * len(ACTIVITIES)
"""Log-likelihood of each state without air pressure."""

# Heights by the air pressure (pressure_height.py), for and against stairs and elevators.

BLOCKS_BEFORE, BLOCKS_AFTER = 3, 2
"""Numbers of blocks before and after the judged one; the slope is computed over all of them."""
STAIR_SPEED, STAIR_SPEED_DEVIATION = 0.3, 0.1
"""Mean vertical speed on stairs and its standard deviation between wearers, m/s: two treads of 0.16 m per second."""
LEAST_RIDE_HEIGHT = 2.2
"""Least height of an elevator ride, m: a low storey."""
DOOR_SHARE = 0.05
"""Likelihood of any change of pressure, because of a door or a gust, relative to the likeliest one (assumed).

It limits what the height of a whole stretch says to a ratio of 21 to 1."""


def stairs_evidence(gain: float, variance: float, sign: float, duration: float) -> float:
    """Return the logarithm of the likelihood ratio of stairs to level ground, from the height that was gained, m.

    `variance` is that of `gain`, m^2, `sign` is 1 for stairs up and -1 for down, `duration` that of the stairs, s."""
    residual, total = gain - sign * STAIR_SPEED * duration, variance + (STAIR_SPEED_DEVIATION * duration) ** 2
    return _log_ratio(sqrt(variance / total) * bell(residual, total), bell(gain, variance))


def ride_evidence(gain: float, variance: float, sign: float) -> float:
    """Return the logarithm of the likelihood ratio of a ride of any height to none, from the height that was gained, m.

    While a ride is possible, each block asks for it as if the ride ended there. `variance` is that of `gain`, m^2,
    `sign` is 1 for a ride up and -1 for one down."""
    return _log_ratio(bell(max(0.0, LEAST_RIDE_HEIGHT - sign * gain), variance), bell(gain, variance))


def _log_ratio(likelihood: float, level: float) -> float:
    """Return the logarithm of a ratio of likelihoods, in which a share of all changes of pressure are a door's."""
    return log((likelihood + DOOR_SHARE) / (level + DOOR_SHARE))


# Elevator rides: the motion of an elevator, integrated from its acceleration, in one hypothesis.
#
# elevator_evidence.py has the acceleration. Velocities and heights are positive upwards.

DWELL_TIME = 5.0
"""Least usual time between two rides, s: an elevator opens and closes its doors before it sets off again."""
PULSE_HEIGHT_ERROR = 0.1
"""Standard deviation of a ride's height that is integrated from its pulses, as a share of the height."""
SLOWEST_ELEVATOR_SPEED, SLOWEST_ESCALATOR_SPEED, SPEED_DEVIATION = 0.4, 0.2, 0.03
"""Vertical speeds of the slowest elevator and the slowest escalator, m/s, and the standard deviation of the speed that
their pulses show, m/s.

An escalator at 0.5 m/s (EN 115-1) rises by 0.25 m/s, in bends whose pulses look like an elevator's. Emulated escalators
show 0.20 to 0.27 m/s, emulated elevators of 0.4 m/s 0.36 to 0.41; the 53 rides of hugadb have 0.76 or more."""
ESCALATOR_LIMIT = 0.34
"""Vertical speed below which the first pulse is that of an escalator, m/s: between one at 0.6 m/s, whose slope is 30
degrees, and what emulated elevators of 0.4 m/s show. A faster escalator is taken for a lift."""
STOP_ERROR_SHARE, STOP_ERROR = 0.3, 0.1
"""Standard deviation of the integrated velocity at a stop: share of the top speed, and constant part, m/s."""
MAX_STOP_PENALTY, MAX_SPEED_PENALTY = 4.0, 16.0
"""Largest penalties (minus log-likelihood) for the velocity at a stop, and for a speed that no elevator has."""
SHORT_DWELL_COST = 6.0
"""Penalty (minus log-likelihood) for less than `DWELL_TIME` between two rides."""


@define
class ElevatorRide:
    """The motion of an elevator in one hypothesis, positive upwards."""

    levels: RestLevels
    velocity: float = 0.0
    """Velocity of the elevator, m/s."""
    top_speed: float = 0.0
    """Largest speed in this ride so far, m/s."""
    height: float = 0.0
    """Height gained since the elevator set off, integrated from its acceleration, m."""
    duration: float = 0.0
    """Duration of the ride so far, s."""
    has_first_pulse: bool = False
    """Flag: the first pulse was measured."""
    start_height: Height | None = None
    """Height when the elevator set off, or at the start of stairs, by the air pressure."""
    standing_time: float = 1e3
    """Time since the last ride ended, s."""

    def move(self, levels: RestLevels, acceleration: float) -> ElevatorRide:
        """Return the ride after another block with this elevator acceleration, m/s^2, and with new levels."""
        old_velocity = self.velocity
        velocity = round(old_velocity + acceleration * BLOCK_DURATION, 6)
        speed = abs(velocity)
        return ElevatorRide(
            levels,
            velocity,
            speed if speed > self.top_speed else self.top_speed,
            round(self.height + 0.5 * (old_velocity + velocity) * BLOCK_DURATION, 6),
            self.duration + BLOCK_DURATION,
            self.has_first_pulse,
            self.start_height,
            self.standing_time,
        )

    def wait(self, levels: RestLevels) -> ElevatorRide:
        """Return the state after a block outside a ride, with new levels and the values of the last ride."""
        standing_time = self.standing_time
        if standing_time < DWELL_TIME:
            standing_time += BLOCK_DURATION
        elif levels is self.levels:
            return self
        return evolve(self, levels=levels, standing_time=standing_time)

    def end(self) -> ElevatorRide:
        """Return the state just after a ride ends: nothing but the levels is kept."""
        return ElevatorRide(self.levels, standing_time=0.0)

    def score_speed(self) -> float:
        """Return the log-likelihood of the largest speed so far, when the elevator does not become faster."""
        # the last pulse alone, which is any shift of weight, is no escalator
        slowest = SLOWEST_ESCALATOR_SPEED if self.has_first_pulse else SLOWEST_ELEVATOR_SPEED
        lack = max(0.0, slowest - self.top_speed) / SPEED_DEVIATION
        return -min(0.5 * lack * lack, MAX_SPEED_PENALTY)

    @property
    def is_slow(self) -> bool:
        """Whether the first pulse was that of an escalator."""
        return self.has_first_pulse and self.top_speed < ESCALATOR_LIMIT

    def score_stop(self) -> float:
        """Return the log-likelihood that the elevator stands now, after the motion of this ride."""
        if not self.has_first_pulse:
            return self.score_speed()
        velocity_error = STOP_ERROR_SHARE * self.top_speed + STOP_ERROR
        return -min(MAX_STOP_PENALTY, 0.5 * (self.velocity / velocity_error) ** 2)

    def height_gain(self, height: Height | None) -> float | None:
        """Return the height of the ride, m; None when neither the first pulse nor air pressure gives it.

        `height` is the height by air pressure now. With both sources the result is their mean, weighted by the
        inverse variances. The height by the pulses is corrected so that the final velocity is zero."""
        by_pulses = self.height - 0.5 * self.velocity * self.duration if self.has_first_pulse else None
        if height is None or self.start_height is None:
            return by_pulses
        (start, start_variance), (end, end_variance) = self.start_height, height
        by_pressure, air_variance = end - start, end_variance + start_variance
        if by_pulses is None:
            return by_pressure
        share = air_variance / (air_variance + (PULSE_HEIGHT_ERROR * by_pressure) ** 2)
        return by_pressure + share * (by_pulses - by_pressure)


DROP_LIMIT = 13.0
"""A token whose log-likelihood is further than this below that of the best token is dropped."""
MOST_FORCE_EVIDENCE = 4.0
"""Above any log-likelihood of the forces in a block: with both feet's `SWAY_DEVIATION` alone it is 2.9."""
AGREEMENT_LIMIT = 8.0
"""Tokens whose log-likelihood is further than this below that of the best token need not agree with a segment."""
RIDE_SETTLING_TIME = 12.0
"""Time after which the end of a ride is settled, s; later, the elevator will not creep on to its floor."""
MAX_OPEN_TIME = 60.0
"""Time after which the start of an activity is settled in any case, s; few rides last longer."""
PULSES = {
    **{state: (sign * PULSE_ACCELERATION, PULSE_DEVIATION) for state, sign in PULSE_SIGNS.items()},
    **{state: (sign * HALT_ACCELERATION, HALT_DEVIATION) for state, sign in HALT_SIGNS.items()},
}
"""Mean and standard deviation of an elevator's acceleration, m/s^2, in each state that has one."""
ACCELERATED_STATES = RIDE_STATES - UNACCELERATED_STATES
"""States of a ride with acceleration; `ElevatorRide.score_stop` scores a path that ends the ride after one of them."""
START_STATES = frozenset((ELEVATOR_STARTS_UP, ELEVATOR_STARTS_DOWN))
"""States of the first pulse of a ride; after it the elevator has its speed (`ElevatorRide.score_speed`)."""
STAIR_SIGNS = {STAIRS_UP: 1.0, STAIRS_DOWN: -1.0}
"""Sign of the height gained in each state on stairs."""
MAX_SEGMENTS = 8
"""Largest number of segments of a path; when there are more, the oldest is settled."""


@define
class ActivitySegment:
    """The activity from `t`, s, until the next segment; a segment never changes."""

    t: float
    activity: Activity
    detected_at: float | None = None
    """Start of the first block of a ride, s; None for other activities."""
    ended_at: float | None = None
    """Start of the first block after a ride, s."""
    height: float | None = None
    """Height of a ride, m, positive upwards; None when it is not known."""
    by_escalator: bool = False
    """Flag: a ride as slow as an escalator's, on which the wearer stands."""


def activity_at(path: Sequence[ActivitySegment], t: float, before: Activity | None) -> Activity | None:
    """Return the activity at `t`, s, on a path; `before` its first segment."""
    activity = before
    for segment in path:
        if segment.t <= t:
            activity = segment.activity
    return activity


@define
class Token:
    """The likeliest path that ends in `state`."""

    state: int
    score: float
    """Log-likelihood relative to the best token, at most 0."""
    path: tuple[ActivitySegment, ...]
    """The last settled segment, when there is one, and the segments that are not settled, oldest first."""
    ride: ElevatorRide


@define
class BlockEvidence:
    """The evidence of the block that starts at `t`, s."""

    t: float
    motion_scores: Floats
    """Log-likelihoods of the first six states of chain.py by the motion of the feet (`motion_votes`)."""
    forces: tuple[BlockForce | None, ...]
    """Force on the left and on the right foot."""
    pressure_scores: Floats
    """Log-likelihood of each state by the air pressure."""
    before: Height | None
    """Height just before the block by the air pressure."""
    after: Height | None
    """Height just after the block by the air pressure."""


@define
class Hypotheses:
    """The tokens of all states, updated with the evidence of every half second."""

    tokens: list[Token] = field(factory=list)
    settled: Activity | None = None
    """The last activity that is settled; None before any."""

    @property
    def best(self) -> Token | None:
        """The likeliest token; None before any evidence."""
        return max(self.tokens, key=attrgetter("score"), default=None)

    def update(self, block: BlockEvidence, chain: Chain) -> None:
        """Extend the paths by one block."""
        # find the best path that continues in each state
        scores = [-inf] * len(ACTIVITIES)
        predecessors: list[Token | None] = [None] * len(ACTIVITIES)
        for token in self.tokens or FIRST_TOKENS:
            before = token.state
            end_score = _score_end(token, block) if before in RIDE_STATES or before in STAIR_SIGNS else 0.0
            started_score = token.ride.score_speed() if before in START_STATES else 0.0
            for state, chance in chain.successors[before] if self.tokens else ((before, 0.0),):
                score = token.score + chance
                if state != before:
                    score += started_score if state in RIDE_STATES else end_score
                if score > scores[state]:
                    scores[state], predecessors[state] = score, token
        elevator = ElevatorEvidence(block.forces)
        candidates: list[tuple[float, int, Token, RestLevels, float]] = []
        top_score = -inf
        for state, predecessor in enumerate(predecessors):
            if predecessor is None:
                continue
            most = scores[state] + block.motion_scores[STAND if state in RIDE_STATES else state]
            most += block.pressure_scores[state] + MOST_FORCE_EVIDENCE
            if most >= top_score - DROP_LIMIT:
                candidate = _score_path(predecessor, scores[state], state, block, elevator)
                candidates.append(candidate)
                if candidate[0] > top_score:
                    top_score = candidate[0]
        self.tokens = []
        for new_score, state, token, levels, acceleration in candidates:
            score = round(new_score - top_score, 4)
            if score >= -DROP_LIMIT:
                path, ride = _extend_path(token, state, block, chain, levels, acceleration)
                self.tokens.append(Token(state, score, path, ride))

    def settle(self, now: float) -> list[tuple[ActivitySegment, ActivitySegment | None, float]]:
        """Settle the segments that are certain at `now`, s; return each with the one before it and its probability."""
        best = self.best
        settled_segments: list[tuple[ActivitySegment, ActivitySegment | None, float]] = []
        i = 0 if self.settled is None else 1
        if best is None or len(best.path) <= i:
            return settled_segments
        old = now - MAX_OPEN_TIME  # all segments up to there are settled because of their age
        for ended, successor in pairwise(best.path):
            if ended.activity in ELEVATOR_ACTIVITIES and now - successor.t >= RIDE_SETTLING_TIME:
                old = max(old, successor.t)
        while len(best.path) > i:
            segment = best.path[i]
            if not (
                segment.t <= old
                or len(best.path) > MAX_SEGMENTS
                or all([_agrees(token, i, segment) for token in self.tokens if token.score >= -AGREEMENT_LIMIT])
            ):
                break
            settled_segments.append((segment, best.path[0] if i else None, self.probability(segment)))
            self.tokens = [token for token in self.tokens if _agrees(token, i, segment)]
            self.settled = segment.activity
            for token in self.tokens:
                token.path = token.path[i:]
            i = 1
        return settled_segments

    def settled_until(self, now: float) -> float:
        """Return the time up to which no likely path changes its activity any more, at most `now`, s."""
        i = 0 if self.settled is None else 1
        open_paths = [token.path[i:] for token in self.tokens if token.score >= -AGREEMENT_LIMIT]
        return min([now, *[path[0].t for path in open_paths if path]])

    def probability(self, segment: ActivitySegment) -> float:
        """Return the share of the whole likelihood of tokens that have the segment's activity at its start."""
        agreeing = total = 0.0
        for token in self.tokens:
            likelihood = exp(token.score)
            total += likelihood
            if activity_at(token.path, segment.t, self.settled) is segment.activity:
                agreeing += likelihood
        return agreeing / total if total > 0.0 else 1.0


def _agrees(token: Token, i: int, segment: ActivitySegment) -> bool:
    if len(token.path) <= i:
        return False
    counterpart = token.path[i]
    return counterpart.t == segment.t and counterpart.activity is segment.activity


def _score_path(
    token: Token, score: float, state: int, block: BlockEvidence, elevator: ElevatorEvidence
) -> tuple[float, int, Token, RestLevels, float]:
    """Return the score of the path of `token` after a block in `state`, the state, the token, levels and acceleration.

    Levels (rest levels) and acceleration (of the elevator, m/s^2) are those of the block; `score` is that before it."""
    levels, acceleration, start_score = token.ride.levels, 0.0, 0.0
    motion = state
    if state in RIDE_STATES:
        motion = STAND
        is_new = not token.path or token.path[-1].activity is not ACTIVITIES[state]
        if is_new and token.ride.standing_time < DWELL_TIME:
            start_score = -SHORT_DWELL_COST
    if state in PULSES:
        levels, acceleration, log_likelihood = elevator.add_pulse(levels, *PULSES[state])
    elif motion == STAND:
        levels, log_likelihood = elevator.add_rest(levels)
    else:
        levels, log_likelihood = elevator.add_walking(levels)
    return (
        score + start_score + block.motion_scores[motion] + log_likelihood + block.pressure_scores[state],
        state,
        token,
        levels,
        acceleration,
    )


def _score_end(token: Token, block: BlockEvidence) -> float:
    """Return the log-likelihood that the ride or the stairs of `token` have ended when `block` starts."""
    state, start, after = token.state, token.ride.start_height, block.after
    stopped = token.ride.score_stop() if state in ACCELERATED_STATES else 0.0
    if start is None or after is None:
        return stopped
    gain, variance = after[0] - start[0], after[1] + start[1]
    if state in STAIR_SIGNS:
        duration = block.t - token.path[-1].t if token.path else 0.0
        return stairs_evidence(gain, variance, STAIR_SIGNS[state], duration)
    return stopped + ride_evidence(gain, variance, 1.0 if ACTIVITIES[state] is Activity.ELEVATOR_UP else -1.0)


def _extend_path(
    token: Token, state: int, block: BlockEvidence, chain: Chain, levels: RestLevels, acceleration: float
) -> tuple[tuple[ActivitySegment, ...], ElevatorRide]:
    """Return the path and the ride of the token after a block in `state`."""
    ride, path, activity = token.ride, token.path, ACTIVITIES[state]
    start_height = block.before if state in STAIR_SIGNS else None
    if path and path[-1].activity is activity:
        if state in RIDE_STATES:
            if token.state in START_STATES and state not in START_STATES:
                path = (*path[:-1], evolve(path[-1], by_escalator=ride.is_slow))
            return path, ride.move(levels, acceleration)
        start_height = ride.start_height
    else:
        t = block.t
        if path:
            last = path[-1]
            if token.state in RIDE_STATES and state not in RIDE_STATES:
                ended = evolve(last, ended_at=t, height=ride.height_gain(block.after))
                path = (*path[:-1], ended)
                ride = ride.end()
                if state != STAND:
                    # whoever walks in what seemed a ride was in none, and its pulses were steps
                    levels = UNKNOWN_LEVELS
            t = max(t + chain.shift[token.state][state], last.t + TIME_EPSILON)
        if state in RIDE_STATES:
            has_first_pulse = state in PULSE_SIGNS and bool(path)
            started = ElevatorRide(levels, has_first_pulse=has_first_pulse, start_height=block.before)
            return (*path, ActivitySegment(t, activity, block.t)), started.move(levels, acceleration)
        path = (*path, ActivitySegment(t, activity))
    if state != STAND:
        ride = ElevatorRide(levels, start_height=start_height, standing_time=ride.standing_time)
    return path, ride.wait(levels)


UNKNOWN_LEVELS: RestLevels = (RestLevel(), RestLevel())
"""Rest levels of which nothing is known."""
FIRST_TOKENS = tuple(
    [Token(state, log(chance), (), ElevatorRide(UNKNOWN_LEVELS)) for state, chance in enumerate(FIRST_CHANCES)]
)
"""A token with an empty path for each state."""
