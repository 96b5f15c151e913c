"""How what is done goes on from one half second to the next: sixteen states, five of them for a ride each way.

A ride in a lift sets off, runs, stops, or creeps on to its floor first and stops there. How likely standing, walking,
running and stairs follow each other is learnt (motion.py); so is how much later than a change is seen people date it.
The other chances say how long things last (a pulse 2 s, a ride between its pulses 7 s) and how rare they are. They
were not fitted to labels, but they were chosen in view of HuGaDB's recordings and of emulated lifts.
"""

from __future__ import annotations

from functools import lru_cache
from math import log

from ...types import Activity
from ...types.attrs import frozen

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

Chances = tuple[tuple[float, ...], ...]
"""Of going from STAND, WALK, RUN, UP or DOWN (rows) to another of them within half a second, rides left out; rows add
up to 1."""
Shifts = tuple[tuple[Activity, Activity, float], ...]
"""From one activity to another: how much later than the half second in which the new one is seen first it began, s."""

SUPPOSED: Chances = (
    (0.959, 0.03, 1e-3, 5e-3, 5e-3),
    (0.03, 0.936, 4e-3, 0.015, 0.015),
    (0.01, 0.03, 0.956, 2e-3, 2e-3),
    (0.02, 0.05, 2e-3, 0.926, 2e-3),
    (0.02, 0.05, 2e-3, 2e-3, 0.926),
)
"""Before anything is learnt: a stand lasts quarter of a minute, and most flights end on the level."""

_RIDE = {"RISE": 3e-3, "RISING": 1e-5, "SINK": 3e-3, "SINKING": 1e-5}
_BLIND = {"RISE": 1e-3, "RISING": 3e-4, "SINK": 1e-3, "SINKING": 3e-4}
_AFOOT = ("STAND", "WALK", "RUN", "UP", "DOWN")
_BESIDES: dict[str, dict[str, float]] = {
    "STAND": {"UNKNOWN": 1e-3, **_RIDE},
    "WALK": {"UNKNOWN": 1e-3, **_BLIND},
    "RUN": {"UNKNOWN": 1e-3},
    "UP": {"UNKNOWN": 1e-3, **_BLIND},
    "DOWN": {"UNKNOWN": 1e-3, **_BLIND},
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
"""Of going from one state to another within half a second, where it is not learnt; the rest is staying."""
_NAMES = (
    *_AFOOT,
    "UNKNOWN",
    *("RISE", "RISING", "RISEN", "NEARLY_UP", "UP_THERE"),
    *("SINK", "SINKING", "SUNK", "NEARLY_DOWN", "DOWN_THERE"),
)
BEGIN = (0.5, 0.25, 0.05, 0.05, 0.05, 0.04, *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5), *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5))
"""Chance of each state before anything is seen."""


@frozen
class Chain:
    """`before`: for each state those that it may come from, with the logarithm of the chance. `late`: from one state
    to another, how much later than the half second in which it is seen first the new activity began, s."""

    before: tuple[tuple[tuple[int, float], ...], ...]
    late: tuple[tuple[float, ...], ...]


@lru_cache(maxsize=4)
def chain_of(chances: Chances, shifts: Shifts) -> Chain:
    """What was learnt, and what was not."""
    goes = {name: dict(_BESIDES[name]) for name in _NAMES}
    for name, row in zip(_AFOOT, chances, strict=True):
        goes[name] |= {to: chance for to, chance in zip(_AFOOT, row, strict=True) if to != name}
    before = tuple(
        [
            tuple(
                [
                    (i, log(1.0 - sum(goes[name].values()) if name == to else goes[name][to]))
                    for i, name in enumerate(_NAMES)
                    if name == to or to in goes[name]
                ]
            )
            for to in _NAMES
        ]
    )
    known = {(a, b): shift for a, b, shift in shifts}
    return Chain(before, tuple([tuple([known.get((a, b), 0.0) for b in ACTIVITIES]) for a in ACTIVITIES]))
