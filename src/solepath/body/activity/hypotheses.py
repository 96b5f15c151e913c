"""What the wearer may have done: the likeliest course of activities up to each state that may hold now.

Viterbi's algorithm with the paths kept in tokens (Young, Russell, Thornton 1989, "Token passing"): each state holds one
token, the best course that ends in it. Where the tokens agree the past is settled; a token that disagrees with what is
settled is dropped, so that it stays settled. The states are those of chain.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import exp, log

from attrs import define, evolve, field, frozen

from ...types import Activity
from ...vector import TIE
from .chain import ACTIVITIES, BEGIN, CRUISES, HALTS, LIFTS, PULSES, RIDES, STAND, Chain
from .features import BLOCK
from .ride import HALT, HALT_VARIES, USUAL, VARIES, Felt, Level, Ride

FORGOTTEN = 13.0
"""A token that is so much less likely than the best (natural logarithm) is dropped."""
DOUBT = 8.0
"""One that is less likely by more than this has no say in what is settled."""
SETTLED = 12.0
"""After so long, s, a ride has ended: the lift does not creep on to its floor."""
DECIDED = 60.0
"""After so long, s, it is settled what was begun: few rides are longer."""
LONGEST = 8
"""Changes of activity that may be unsettled."""


@frozen
class Segment:
    """From `t` s on the wearer does `activity`. Of a ride: when its pulses were felt, s, and its height, m,
    as far as it is known."""

    t: float
    activity: Activity
    from_: float | None = None
    to: float | None = None
    height: float | None = None


@define
class Token:
    """The likeliest course that ends in `state`; `score`: logarithm of how likely, beside the best."""

    state: int
    score: float
    path: tuple[Segment, ...]
    """What is not settled yet, and the last that is."""
    ride: Ride


@frozen
class Evidence:
    """What half a second from `t` s on looks like."""

    t: float
    motions: tuple[float, ...]
    """Logarithms of how likely it is, for STAND, WALK, RUN, UP, DOWN and UNKNOWN."""
    felt: tuple[Felt | None, ...]
    """In the left foot and the right one."""
    climbs: tuple[float, ...]
    """The same of what the air pressure shows, for each state."""
    before: float | None
    """How high the wearer was just before it, m above anything, by the air pressure,"""
    after: float | None
    """and is just after it."""


@define
class Hypotheses:
    """Feed it the evidence of every half second."""

    tokens: list[Token] = field(factory=list)
    settled: Activity | None = None
    """The last activity that is settled."""

    @property
    def best(self) -> Token | None:
        """The likeliest; None before any evidence."""
        return max(self.tokens, key=_score, default=None)

    def update(self, seen: Evidence, chain: Chain) -> None:
        """Half a second more."""
        held: list[Token | None] = [None] * len(ACTIVITIES)
        for token in self.tokens:
            held[token.state] = token
        found: list[Token] = []
        for state, before in enumerate(chain.before):
            arrived = _likeliest(held, state, before) if self.tokens else _begun(state)
            if arrived is not None:
                found.append(_gone_on(arrived, state, seen, chain))
        highest = max([token.score for token in found])
        for token in found:
            token.score = round(token.score - highest, 4)
        self.tokens = [token for token in found if token.score >= -FORGOTTEN]

    def settle(self, now: float) -> list[tuple[Segment, Segment | None, float]]:
        """What is settled from now on, `now` s: each activity that was begun, with the one before it that it ends, and
        how likely it is of the courses that were held."""
        best = self.best
        found: list[tuple[Segment, Segment | None, float]] = []
        if best is None:
            return found
        old = _old(best.path, now)
        i = 0 if self.settled is None else 1
        while len(best.path) > i:
            begun = best.path[i]
            if not (
                begun.t <= old
                or len(best.path) > LONGEST
                or all([_agrees(token, i, begun) for token in self.tokens if token.score >= -DOUBT])
            ):
                break
            found.append((begun, best.path[0] if i else None, self.probability(begun)))
            self.tokens = [token for token in self.tokens if _agrees(token, i, begun)]
            self.settled = begun.activity
            for token in self.tokens:
                token.path = token.path[i:]
            i = 1
        return found

    def probability(self, segment: Segment) -> float:
        """That the wearer did this then, of the courses that are held."""
        those = whole = 0.0
        for token in self.tokens:
            likely = exp(token.score)
            whole += likely
            doing = self.settled
            for one in token.path:
                if one.t <= segment.t:
                    doing = one.activity
            if doing is segment.activity:
                those += likely
        return those / whole if whole > 0.0 else 1.0


def _begun(state: int) -> Token:
    return Token(state, log(BEGIN[state]), (), Ride((Level(), Level())))


def _score(token: Token) -> float:
    return token.score


def _old(path: Sequence[Segment], now: float) -> float:
    """What began up to then is settled for want of time, s."""
    old = now - DECIDED
    for before, after in pairwise(path):
        if before.activity in LIFTS and now - after.t >= SETTLED:
            old = max(old, after.t)
    return old


def _agrees(token: Token, i: int, begun: Segment) -> bool:
    if len(token.path) <= i:
        return False
    other = token.path[i]
    return other.t == begun.t and other.activity is begun.activity


def _likeliest(held: Sequence[Token | None], state: int, before: tuple[tuple[int, float], ...]) -> Token | None:
    """The best course that goes on to the state: its token, with the score that it has there."""
    best: Token | None = None
    highest = 0.0
    for i, chance in before:
        token = held[i]
        if token is None:
            continue
        score = token.score + chance
        if i in RIDES and i not in CRUISES and state not in RIDES:
            score += token.ride.stopped()
        if best is None or score > highest:
            best, highest = token, score
    return None if best is None else Token(best.state, highest, best.path, best.ride)


def _gone_on(token: Token, state: int, seen: Evidence, chain: Chain) -> Token:
    """The token after half a second in the state."""
    ride, path, activity = token.ride, token.path, ACTIVITIES[state]
    begins = 0.0
    if not path:
        path = (Segment(seen.t, activity, seen.t if state in RIDES else None),)
        if state in RIDES:
            ride, begins = ride.begun(False, seen.before)
    elif path[-1].activity is not activity:
        last = path[-1]
        t = max(seen.t + chain.shifts.get((last.activity, activity), 0.0), last.t + TIE)
        if state in RIDES:
            ride, begins = ride.begun(state in PULSES, seen.before)
            path = (*path, Segment(t, activity, seen.t))
        else:
            if token.state in RIDES:
                path = (*path[:-1], evolve(last, to=seen.t, height=ride.risen(seen.after)))
                ride = ride.over()
            path = (*path, Segment(t, activity))
    if state in PULSES:
        ride, likely = ride.pulse(seen.felt, PULSES[state] * USUAL, VARIES, BLOCK)
    elif state in HALTS:
        ride, likely = ride.pulse(seen.felt, HALTS[state] * HALT, HALT_VARIES, BLOCK)
    elif state in CRUISES:
        ride, likely = ride.rest(seen.felt)
        ride = ride.cruise(BLOCK)
    elif state == STAND:
        ride, likely = ride.rest(seen.felt)
    else:
        ride, likely = ride.walk(seen.felt)
    if state not in RIDES:
        ride = ride.waited(BLOCK)
    score = token.score + begins + seen.motions[STAND if state in RIDES else state] + likely + seen.climbs[state]
    return Token(state, score, path, ride)
