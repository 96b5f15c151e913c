"""Hypotheses on the wearer's activities: for each state the likeliest course of activities that ends in it.

This is Viterbi's algorithm with the paths kept in tokens (Young, Russell, Thornton 1989, "Token passing"): each state
holds one token, the best course that ends in it. Where the tokens agree the past is settled; a token that disagrees
with what is settled is dropped, so that it stays settled. chain.py has the states."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import exp, inf, log

from ...types import Activity
from ...types.attrs import define, field
from ...types.vector import TIE
from .chain import ACTIVITIES, CRUISES, FIRST_CHANCES, HALTS, LIFTS, PULSES, RIDES, STAND, Chain
from .features import BLOCK
from .ride import (
    DWELL_TIME,
    HALT,
    HALT_DEVIATION,
    PULSE,
    PULSE_DEVIATION,
    SHORT_DWELL_COST,
    BlockForce,
    Levels,
    LiftEvidence,
    LiftRide,
    RestLevel,
)

DROP_LIMIT = 13.0
"""Difference to the best token's log-likelihood above which a token is dropped."""
AGREEMENT_LIMIT = 8.0
"""Difference to the best token's log-likelihood above which a token need not agree with what is settled."""
LIFT_SETTLED = 12.0
"""Time after which the end of a ride is settled, s: the lift does not creep on to its floor."""
LONGEST_OPEN = 60.0
"""Time after which an activity that has started is settled, s: few rides are longer."""
ENDS = RIDES - CRUISES
"""States in which a ride ends."""
MOST_SEGMENTS = 8
"""Largest number of changes of activity that are not settled."""


@define
class ActivitySegment:
    """The activity from `t` s on; never changed.

    A ride also has the times between which its pulses were measured, `from_` and `to`, s, and its height, m, if known.
    """

    t: float
    activity: Activity
    from_: float | None = None
    to: float | None = None
    height: float | None = None


@define
class Token:
    """The likeliest course that ends in `state`; `score` is its log-likelihood relative to the best."""

    state: int
    score: float
    path: tuple[ActivitySegment, ...]
    """The segments that are not settled yet, and the last one that is."""
    ride: LiftRide


@define
class BlockEvidence:
    """The evidence of half a second from `t` s on."""

    t: float
    motions: tuple[float, ...]
    """Log-likelihoods of STAND, WALK, RUN, UP, DOWN and UNKNOWN by the motion of the feet."""
    forces: tuple[BlockForce | None, ...]
    """Force on the left and on the right foot."""
    climbs: tuple[float, ...]
    """Log-likelihood of each state by the air pressure."""
    before: float | None
    """Height just before the block by the air pressure, m above any reference."""
    after: float | None
    """Height just after the block by the air pressure, m above the same reference."""


@define
class Hypotheses:
    """The tokens of all states, updated with the evidence of every half second."""

    tokens: list[Token] = field(factory=list)
    settled: Activity | None = None
    """The last activity that is settled."""

    @property
    def best(self) -> Token | None:
        """The likeliest token; None before any evidence."""
        return max(self.tokens, key=_score, default=None)

    def update(self, seen: BlockEvidence, chain: Chain) -> None:
        """Add the evidence of one half second."""
        scores, stops = [-inf] * len(ACTIVITIES), [0.0] * len(ACTIVITIES)
        held: list[Token | None] = [None] * len(ACTIVITIES)
        for token in self.tokens:
            state = token.state
            held[state], scores[state] = token, token.score
            if state in ENDS:
                stops[state] = token.ride.stop_score()
        evidence = LiftEvidence(seen.forces)
        found: list[tuple[float, int, Token, Levels, float]] = []
        newest = -inf
        for state, before in enumerate(chain.predecessors):
            # the best course that continues in the state
            best, highest = -1, -inf
            if not self.tokens:
                best, highest = state, FIRST_TOKENS[state].score
            elif state in RIDES:
                for i, chance in before:
                    score = scores[i] + chance
                    if score > highest:
                        best, highest = i, score
            else:
                for i, chance in before:
                    score = scores[i] + chance + stops[i]
                    if score > highest:
                        best, highest = i, score
            arrived = (held[best] if self.tokens else FIRST_TOKENS[state]) if best >= 0 else None
            if arrived is not None:
                one = _scored(arrived, highest, state, seen, evidence)
                found.append(one)
                if one[0] > newest:
                    newest = one[0]
        self.tokens = []
        for likely, state, token, levels, acceleration in found:
            score = round(likely - newest, 4)
            if score >= -DROP_LIMIT:
                path, ride = _extended(token, state, seen, chain, levels, acceleration)
                self.tokens.append(Token(state, score, path, ride))

    def settle(self, now: float) -> list[tuple[ActivitySegment, ActivitySegment | None, float]]:
        """Settle what is certain at `now` s; return each segment, the one that it ends, and its probability."""
        best = self.best
        found: list[tuple[ActivitySegment, ActivitySegment | None, float]] = []
        if best is None:
            return found
        old = _settled_by(best.path, now)
        i = 0 if self.settled is None else 1
        while len(best.path) > i:
            segment = best.path[i]
            if not (
                segment.t <= old
                or len(best.path) > MOST_SEGMENTS
                or all([_agrees(token, i, segment) for token in self.tokens if token.score >= -AGREEMENT_LIMIT])
            ):
                break
            found.append((segment, best.path[0] if i else None, self.probability(segment)))
            self.tokens = [token for token in self.tokens if _agrees(token, i, segment)]
            self.settled = segment.activity
            for token in self.tokens:
                token.path = token.path[i:]
            i = 1
        return found

    def probability(self, segment: ActivitySegment) -> float:
        """Return the probability that the wearer did this then, by the tokens that are kept."""
        those = whole = 0.0
        for token in self.tokens:
            likely = exp(token.score)
            whole += likely
            activity = self.settled
            for one in token.path:
                if one.t <= segment.t:
                    activity = one.activity
            if activity is segment.activity:
                those += likely
        return those / whole if whole > 0.0 else 1.0


def _score(token: Token) -> float:
    return token.score


def _settled_by(path: Sequence[ActivitySegment], now: float) -> float:
    """Return the time before which everything is settled because it is old, s."""
    old = now - LONGEST_OPEN
    for before, after in pairwise(path):
        if before.activity in LIFTS and now - after.t >= LIFT_SETTLED:
            old = max(old, after.t)
    return old


def _agrees(token: Token, i: int, segment: ActivitySegment) -> bool:
    if len(token.path) <= i:
        return False
    other = token.path[i]
    return other.t == segment.t and other.activity is segment.activity


def _scored(
    token: Token, score: float, state: int, seen: BlockEvidence, evidence: LiftEvidence
) -> tuple[float, int, Token, Levels, float]:
    """Return the score of the course of `token` after half a second in the state, with its parts.

    The others are the state, the token, the levels of its feet at rest, and the acceleration of the lift, m/s^2."""
    levels, acceleration, start_score = token.ride.levels, 0.0, 0.0
    motion = state
    if state in RIDES:
        motion = STAND
        if token.ride.standing_time < DWELL_TIME and (
            not token.path or token.path[-1].activity is not ACTIVITIES[state]
        ):
            start_score = -SHORT_DWELL_COST
        if state in PULSES:
            levels, acceleration, likely = evidence.pulse(levels, PULSES[state] * PULSE, PULSE_DEVIATION)
        elif state in HALTS:
            levels, acceleration, likely = evidence.pulse(levels, HALTS[state] * HALT, HALT_DEVIATION)
        else:
            levels, likely = evidence.rest(levels)
    elif state == STAND:
        levels, likely = evidence.rest(levels)
    else:
        levels, likely = evidence.walk(levels)
    return score + start_score + seen.motions[motion] + likely + seen.climbs[state], state, token, levels, acceleration


def _extended(
    token: Token, state: int, seen: BlockEvidence, chain: Chain, levels: Levels, acceleration: float
) -> tuple[tuple[ActivitySegment, ...], LiftRide]:
    """Return the course of the token and its ride after half a second in the state."""
    ride, path, activity = token.ride, token.path, ACTIVITIES[state]
    if path and path[-1].activity is activity:
        if state in RIDES:
            return path, ride.move(levels, acceleration, BLOCK)
        if state == STAND:
            return path, ride.wait(levels, BLOCK)
        return path, LiftRide(levels, standing_time=ride.standing_time).wait(levels, BLOCK)
    t = seen.t
    if path:
        last = path[-1]
        if token.state in RIDES and state not in RIDES:
            ended = ActivitySegment(last.t, last.activity, last.from_, t, ride.height_gain(seen.after))
            path = (*path[:-1], ended)
            ride = ride.end()
        t = max(t + chain.shift[token.state][state], last.t + TIE)
    if state in RIDES:
        whole = state in PULSES and bool(path)
        return (*path, ActivitySegment(t, activity, seen.t)), ride.start(
            whole, seen.before, levels, acceleration, BLOCK
        )
    path = (*path, ActivitySegment(t, activity))
    if state == STAND:
        return path, ride.wait(levels, BLOCK)
    return path, LiftRide(levels, standing_time=ride.standing_time).wait(levels, BLOCK)


FIRST_TOKENS = tuple(
    [Token(state, log(chance), (), LiftRide((RestLevel(), RestLevel()))) for state, chance in enumerate(FIRST_CHANCES)]
)
"""An empty course for each state."""
