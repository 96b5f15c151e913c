"""Markov chain of activities from one block (half a second) to the next, with sixteen states.

Five states describe an elevator ride in each direction: the elevator STARTS with a pulse of acceleration, MOVES without
acceleration and STOPS with a pulse in the other direction. It may then CREEP on to its floor and HALT there with a weak
pulse. "Chance" is the probability of a transition within one block. The chances between standing, walking, running and
stairs are learnt (motion.py), as are the delays between the detection of a change and its time in the labels. The other
chances describe durations (2 s for a pulse, 7 s between the pulses of a ride) and rare transitions. They were not
fitted to labels, but chosen by hand while looking at HuGaDB's recordings and emulated elevators."""

from __future__ import annotations

from functools import lru_cache
from math import fsum, log

from ...types import Activity, Floats
from ...types.attrs import frozen

STAND, WALK, RUN, STAIRS_UP, STAIRS_DOWN, UNKNOWN = range(6)
ELEVATOR_STARTS_UP, ELEVATOR_MOVES_UP, ELEVATOR_STOPS_UP, ELEVATOR_CREEPS_UP, ELEVATOR_HALTS_UP = range(6, 11)
ELEVATOR_STARTS_DOWN, ELEVATOR_MOVES_DOWN, ELEVATOR_STOPS_DOWN, ELEVATOR_CREEPS_DOWN, ELEVATOR_HALTS_DOWN = range(
    11, 16
)

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
"""Activity of each state."""
ELEVATOR_ACTIVITIES = frozenset((Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN))
PULSE_SIGNS = {ELEVATOR_STARTS_UP: 1, ELEVATOR_STOPS_UP: -1, ELEVATOR_STARTS_DOWN: -1, ELEVATOR_STOPS_DOWN: 1}
"""Sign of the elevator's acceleration in each state with a pulse, positive upwards."""
HALT_SIGNS = {ELEVATOR_HALTS_UP: -1, ELEVATOR_HALTS_DOWN: 1}
"""Sign of the weaker acceleration of an elevator that has crept on to its floor and stops, positive upwards."""
RIDE_STATES = frozenset(range(ELEVATOR_STARTS_UP, ELEVATOR_HALTS_DOWN + 1))
"""States of an elevator ride."""
UNACCELERATED_STATES = frozenset((ELEVATOR_MOVES_UP, ELEVATOR_CREEPS_UP, ELEVATOR_MOVES_DOWN, ELEVATOR_CREEPS_DOWN))
"""States of a ride without acceleration, before its last pulse."""

Chances = tuple[Floats, ...]
"""Chances of a transition from each of the first five states (rows) to each of them (columns); a row adds up to 1."""
Shifts = tuple[tuple[Activity, Activity, float], ...]
"""For each change: old activity, new activity, and time from the block of its detection to the change, s."""


def _to_ride(starts: float, moves: float) -> dict[int, float]:
    """Return the chances of the first two states of a ride, which are those of both directions."""
    return {
        ELEVATOR_STARTS_UP: starts, ELEVATOR_MOVES_UP: moves, ELEVATOR_STARTS_DOWN: starts, ELEVATOR_MOVES_DOWN: moves
    }  # fmt: skip


def _in_ride(starts: int, moves: int, stops: int, creeps: int, halts: int) -> dict[int, dict[int, float]]:
    """Return the chances from the states of a ride in one direction."""
    return {
        starts: {moves: 0.25, stops: 0.05},
        moves: {stops: 0.07, WALK: 3e-4, STAND: 1e-5, UNKNOWN: 3e-4},
        stops: {STAND: 0.2, WALK: 0.02, creeps: 0.08},
        creeps: {halts: 0.1, WALK: 1e-3, UNKNOWN: 1e-3},
        halts: {STAND: 0.4, WALK: 0.02},
    }


_FROM_MOVING = _to_ride(1e-3, 3e-4)
_OTHER_CHANCES: dict[int, dict[int, float]] = {
    STAND: {UNKNOWN: 1e-3, **_to_ride(3e-3, 1e-5)},
    WALK: {UNKNOWN: 1e-3, **_FROM_MOVING},
    RUN: {UNKNOWN: 1e-3},
    STAIRS_UP: {UNKNOWN: 1e-3, **_FROM_MOVING},
    STAIRS_DOWN: {UNKNOWN: 1e-3, **_FROM_MOVING},
    UNKNOWN: {STAND: 0.1, WALK: 0.1, RUN: 0.02, STAIRS_UP: 0.02, STAIRS_DOWN: 0.02, **_FROM_MOVING},
    **_in_ride(*range(ELEVATOR_STARTS_UP, ELEVATOR_STARTS_DOWN)),
    **_in_ride(*range(ELEVATOR_STARTS_DOWN, ELEVATOR_HALTS_DOWN + 1)),
}
"""Chances within one block of the transitions that are not learnt; the rest is the chance to stay."""
FIRST_CHANCES = (0.5, 0.25, 0.05, 0.05, 0.05, 0.04, *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5), *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5))
"""Probability of each state before any evidence, in the order of the states."""


@frozen
class Chain:
    """The transitions between states."""

    successors: tuple[tuple[tuple[int, float], ...], ...]
    """States that may follow each state, in order, with the natural logarithm of the chance."""
    shift: tuple[Floats, ...]
    """Time from the block in which a change from a state (row) to a state (column) was detected to the change, s."""


@lru_cache(maxsize=4)
def chain_of(chances: Chances, shifts: Shifts) -> Chain:
    """Return the chain with the learnt chances and delays, and the fixed chances."""
    chances_from = {state: dict(others) for state, others in _OTHER_CHANCES.items()}
    for state, row in enumerate(chances):
        chances_from[state] |= {to: chance for to, chance in enumerate(row) if to != state}
    successors = tuple(
        [
            tuple([(to, log(chance)) for to, chance in sorted({**others, state: 1.0 - fsum(others.values())}.items())])
            for state, others in chances_from.items()
        ]
    )
    delays = {(a, b): shift for a, b, shift in shifts}
    return Chain(successors, tuple([tuple([delays.get((a, b), 0.0) for b in ACTIVITIES]) for a in ACTIVITIES]))
