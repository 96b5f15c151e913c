"""What the wearer may have done: the likeliest course of activities up to each state that may hold now.

Viterbi's algorithm with the paths kept in tokens (Young, Russell, Thornton 1989, "Token passing"): each state holds one
token, the best course that ends in it. Where the tokens agree the past is settled; a token that disagrees with what is
settled is dropped, so that it stays settled. The states are those of chain.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import exp, inf, log

from ...types import Activity
from ...types.attrs import define, field
from ...types.vector import TIE
from .chain import ACTIVITIES, BEGIN, CRUISES, HALTS, LIFTS, PULSES, RIDES, STAND, Chain
from .features import BLOCK
from .ride import DWELLS, HALT, HALT_VARIES, HASTE, USUAL, VARIES, Beside, Felt, Levels, LiftRide, RestLevel

FORGOTTEN = 13.0
"""A token that is so much less likely than the best (natural logarithm) is dropped."""
DOUBT = 8.0
"""One that is less likely by more than this has no say in what is settled."""
SETTLED = 12.0
"""After so long, s, a ride has ended: the lift does not creep on to its floor."""
DECIDED = 60.0
"""After so long, s, it is settled what was begun: few rides are longer."""
ENDS = RIDES - CRUISES
"""A ride ends in one of these states."""
LONGEST = 8
"""Changes of activity that may be unsettled."""


@define
class ActivitySegment:
    """From `t` s on the wearer does `activity`; never changed. Of a ride: when its pulses were felt, s, and its height,
    m, as far as it is known."""

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
    path: tuple[ActivitySegment, ...]
    """What is not settled yet, and the last that is."""
    ride: LiftRide


@define
class BlockEvidence:
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

    def update(self, seen: BlockEvidence, chain: Chain) -> None:
        """Half a second more."""
        scores, stops = [-inf] * len(ACTIVITIES), [0.0] * len(ACTIVITIES)
        held: list[Token | None] = [None] * len(ACTIVITIES)
        for token in self.tokens:
            state = token.state
            held[state], scores[state] = token, token.score
            if state in ENDS:
                stops[state] = token.ride.stopped()
        beside = Beside(seen.felt)
        found: list[tuple[float, int, Token, Levels, float]] = []
        newest = -inf
        for state, before in enumerate(chain.before):
            # the best course that goes on to the state
            best, highest = -1, -inf
            if not self.tokens:
                best, highest = state, BEGUN[state].score
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
            arrived = (held[best] if self.tokens else BEGUN[state]) if best >= 0 else None
            if arrived is not None:
                one = _scored(arrived, highest, state, seen, beside)
                found.append(one)
                if one[0] > newest:
                    newest = one[0]
        self.tokens = []
        for likely, state, token, levels, taken in found:
            score = round(likely - newest, 4)
            if score >= -FORGOTTEN:
                path, ride = _gone_on(token, state, seen, chain, levels, taken)
                self.tokens.append(Token(state, score, path, ride))

    def settle(self, now: float) -> list[tuple[ActivitySegment, ActivitySegment | None, float]]:
        """What is settled from now on, `now` s: each activity that was begun, with the one before it that it ends, and
        how likely it is of the courses that were held."""
        best = self.best
        found: list[tuple[ActivitySegment, ActivitySegment | None, float]] = []
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

    def probability(self, segment: ActivitySegment) -> float:
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


def _score(token: Token) -> float:
    return token.score


def _old(path: Sequence[ActivitySegment], now: float) -> float:
    """What began up to then is settled for want of time, s."""
    old = now - DECIDED
    for before, after in pairwise(path):
        if before.activity in LIFTS and now - after.t >= SETTLED:
            old = max(old, after.t)
    return old


def _agrees(token: Token, i: int, begun: ActivitySegment) -> bool:
    if len(token.path) <= i:
        return False
    other = token.path[i]
    return other.t == begun.t and other.activity is begun.activity


def _scored(
    token: Token, score: float, state: int, seen: BlockEvidence, beside: Beside
) -> tuple[float, int, Token, Levels, float]:
    """How likely the course of `token`, that far, is after half a second in the state; with the levels of its feet at
    rest, and the acceleration of the lift, m/s^2."""
    levels, taken, begins = token.ride.levels, 0.0, 0.0
    motion = state
    if state in RIDES:
        motion = STAND
        if token.ride.stood < DWELLS and (not token.path or token.path[-1].activity is not ACTIVITIES[state]):
            begins = -HASTE
        if state in PULSES:
            levels, taken, likely = beside.pulse(levels, PULSES[state] * USUAL, VARIES)
        elif state in HALTS:
            levels, taken, likely = beside.pulse(levels, HALTS[state] * HALT, HALT_VARIES)
        else:
            levels, likely = beside.rest(levels)
    elif state == STAND:
        levels, likely = beside.rest(levels)
    else:
        levels, likely = beside.walk(levels)
    return score + begins + seen.motions[motion] + likely + seen.climbs[state], state, token, levels, taken


def _gone_on(
    token: Token, state: int, seen: BlockEvidence, chain: Chain, levels: Levels, taken: float
) -> tuple[tuple[ActivitySegment, ...], LiftRide]:
    """The course of the token and its ride after half a second in the state."""
    ride, path, activity = token.ride, token.path, ACTIVITIES[state]
    if path and path[-1].activity is activity:
        if state in RIDES:
            return path, ride.goes(levels, taken, BLOCK)
        if state == STAND:
            return path, ride.stands(levels, BLOCK)
        return path, LiftRide(levels, stood=ride.stood).stands(levels, BLOCK)
    t = seen.t
    if path:
        last = path[-1]
        if token.state in RIDES and state not in RIDES:
            ended = ActivitySegment(last.t, last.activity, last.from_, t, ride.risen(seen.after))
            path = (*path[:-1], ended)
            ride = ride.over()
        t = max(t + chain.late[token.state][state], last.t + TIE)
    if state in RIDES:
        whole = state in PULSES and bool(path)
        return (*path, ActivitySegment(t, activity, seen.t)), ride.begins(whole, seen.before, levels, taken, BLOCK)
    path = (*path, ActivitySegment(t, activity))
    if state == STAND:
        return path, ride.stands(levels, BLOCK)
    return path, LiftRide(levels, stood=ride.stood).stands(levels, BLOCK)


BEGUN = tuple(
    [Token(state, log(chance), (), LiftRide((RestLevel(), RestLevel()))) for state, chance in enumerate(BEGIN)]
)
"""A course that has done nothing yet, for each state."""
