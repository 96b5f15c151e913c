"""What the wearer may have done: the likeliest course of activities up to each state that may hold now.

Viterbi's algorithm with the paths kept in tokens (Young, Russell, Thornton 1989, "Token passing"): each state holds one
token, the best course that ends in it. Where the tokens agree the past is settled; a token that disagrees with what is
settled is dropped, so that it stays settled. A ride in a lift is five states each way: it sets off, runs,
stops, or creeps on to its floor first and stops there.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import exp, log

from attrs import define, evolve, field, frozen

from ...types import Activity
from ...vector import TIE
from .features import BLOCK
from .ride import HALT, HALT_VARIES, USUAL, VARIES, Felt, Level, Ride

STAND, WALK, RUN, UP, DOWN, UNKNOWN = range(6)
RISE, RISING, RISEN, NEARLY_UP, UP_THERE = range(6, 11)
SINK, SINKING, SUNK, NEARLY_DOWN, DOWN_THERE = range(11, 16)

ACTIVITIES = (
    Activity.STANDING,
    Activity.WALKING,
    Activity.RUNNING,
    Activity.STAIRS_UP,
    Activity.STAIRS_DOWN,
    Activity.UNKNOWN,
    *[Activity.ELEVATOR_UP] * 5,
    *[Activity.ELEVATOR_DOWN] * 5,
)
"""Of each state."""
LIFTS = frozenset((Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN))
PULSES = {RISE: 1, RISEN: -1, SINK: -1, SUNK: 1}
"""Which way the acceleration of these states points."""
HALTS = {UP_THERE: -1, DOWN_THERE: 1}
"""The same of a lift that has crept on to its floor and stops: less than the others."""
RIDES = frozenset(range(RISE, DOWN_THERE + 1))
CRUISES = frozenset((RISING, NEARLY_UP, SINKING, NEARLY_DOWN))

_RIDE = {"RISE": 3e-3, "RISING": 1e-5, "SINK": 3e-3, "SINKING": 1e-5}
_BLIND = {"RISE": 1e-3, "RISING": 3e-4, "SINK": 1e-3, "SINKING": 3e-4}
_CHANCES: dict[str, dict[str, float]] = {
    "STAND": {"WALK": 0.03, "RUN": 1e-3, "UP": 5e-3, "DOWN": 5e-3, "UNKNOWN": 1e-3, **_RIDE},
    "WALK": {"STAND": 0.03, "RUN": 4e-3, "UP": 0.015, "DOWN": 0.015, "UNKNOWN": 1e-3, **_BLIND},
    "RUN": {"STAND": 0.01, "WALK": 0.03, "UP": 2e-3, "DOWN": 2e-3, "UNKNOWN": 1e-3},
    "UP": {"STAND": 0.02, "WALK": 0.05, "RUN": 2e-3, "DOWN": 2e-3, "UNKNOWN": 1e-3, **_BLIND},
    "DOWN": {"STAND": 0.02, "WALK": 0.05, "RUN": 2e-3, "UP": 2e-3, "UNKNOWN": 1e-3, **_BLIND},
    "UNKNOWN": {"STAND": 0.1, "WALK": 0.1, "RUN": 0.02, "UP": 0.02, "DOWN": 0.02, **_BLIND},
    "RISE": {"RISING": 0.25, "RISEN": 0.05},
    "RISING": {"RISEN": 0.07, "WALK": 3e-4, "STAND": 1e-5, "UNKNOWN": 3e-4},
    "RISEN": {"STAND": 0.2, "WALK": 0.02, "NEARLY_UP": 0.08},
    "NEARLY_UP": {"UP_THERE": 0.1, "WALK": 1e-3, "UNKNOWN": 1e-3},
    "UP_THERE": {"STAND": 0.4, "WALK": 0.02},
    "SINK": {"SINKING": 0.25, "SUNK": 0.05},
    "SINKING": {"SUNK": 0.07, "WALK": 3e-4, "STAND": 1e-5, "UNKNOWN": 3e-4},
    "SUNK": {"STAND": 0.2, "WALK": 0.02, "NEARLY_DOWN": 0.08},
    "NEARLY_DOWN": {"DOWN_THERE": 0.1, "WALK": 1e-3, "UNKNOWN": 1e-3},
    "DOWN_THERE": {"STAND": 0.4, "WALK": 0.02},
}
"""Of going from one state to another within half a second; the rest is staying. They say how long things last (a pulse
2 s, a ride between its pulses 7 s, a stand quarter of a minute) and are not fitted to any recording."""
_NAMES = (
    *("STAND", "WALK", "RUN", "UP", "DOWN", "UNKNOWN"),
    *("RISE", "RISING", "RISEN", "NEARLY_UP", "UP_THERE"),
    *("SINK", "SINKING", "SUNK", "NEARLY_DOWN", "DOWN_THERE"),
)
_BEGIN = (0.5, 0.25, 0.05, 0.05, 0.05, 0.04, *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5), *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5))

FROM: tuple[tuple[tuple[int, float], ...], ...] = tuple(
    tuple(
        [
            (i, log(1.0 - sum(_CHANCES[name].values()) if name == to else _CHANCES[name][to]))
            for i, name in enumerate(_NAMES)
            if name == to or to in _CHANCES[name]
        ]
    )
    for to in _NAMES
)
"""For each state those that it may come from, with the logarithm of the chance."""

FORGOTTEN = 13.0
"""A token that is so much less likely than the best (natural logarithm) is dropped."""
DOUBT = 8.0
"""One that is less likely by more than this has no say in what is settled."""
SETTLED = 12.0
"""After so long, s, a ride has ended: the lift does not creep on to its floor."""
EARLIER, LATER = 0.5, 1.0
"""A ride begins so much earlier, s, than its first block that was felt, and ends so much later than its last: its first
and last jerk are too weak to feel, and its doors are not open yet."""
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

    def update(self, seen: Evidence) -> None:
        """Half a second more."""
        held: list[Token | None] = [None] * len(_NAMES)
        for token in self.tokens:
            held[token.state] = token
        found: list[Token] = []
        for state, before in enumerate(FROM):
            arrived = _likeliest(held, state, before) if self.tokens else _begun(state)
            if arrived is not None:
                found.append(_gone_on(arrived, state, seen))
        highest = max([token.score for token in found])
        for token in found:
            token.score -= highest
        self.tokens = [token for token in found if token.score >= -FORGOTTEN]

    def settle(self, now: float) -> list[tuple[Segment, Segment | None]]:
        """What is settled from now on, `now` s: each activity that was begun, with the one before it that it ends."""
        best = self.best
        found: list[tuple[Segment, Segment | None]] = []
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
            self.tokens = [token for token in self.tokens if _agrees(token, i, begun)]
            found.append((begun, best.path[0] if i else None))
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
    return Token(state, log(_BEGIN[state]), (), Ride((Level(), Level())))


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


def _gone_on(token: Token, state: int, seen: Evidence) -> Token:
    """The token after half a second in the state."""
    ride, path, activity = token.ride, token.path, ACTIVITIES[state]
    begins = 0.0
    if not path or path[-1].activity is not activity:
        begun = Segment(seen.t, activity)
        if state in RIDES:
            ride, begins = ride.begun(state in PULSES and bool(path), seen.before)
            early = max(seen.t - EARLIER, path[-1].t + BLOCK) if path else seen.t
            begun = Segment(min(early, seen.t), activity, seen.t)
        elif token.state in RIDES and path:
            last = path[-1]
            path = (*path[:-1], evolve(last, to=seen.t, height=ride.risen(seen.after)))
            ride = ride.over()
            begun = Segment(seen.t + (LATER if state == STAND else 0.0), activity)
        elif path and path[-1].t >= seen.t:
            begun = Segment(path[-1].t + TIE, activity)
        path = (*path, begun)
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
