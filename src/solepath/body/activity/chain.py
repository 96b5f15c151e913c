"""Chain of activities from one half second to the next: sixteen states, five of them for a ride each way.

A ride in a lift sets off, runs, stops, or creeps on to its floor first and stops there. The chances with which
standing, walking, running and stairs follow each other are learnt (motion.py); so is the delay between the detection of
a change and its date by people. The other chances describe durations (a pulse 2 s, a ride between its pulses 7 s) and
rarity. They were not fitted to labels, but they were chosen in view of HuGaDB's recordings and of emulated lifts."""

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
"""Activity of each state."""
LIFTS = frozenset((Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN))
PULSES = {RISE: 1, RISEN: -1, SINK: -1, SUNK: 1}
"""Sign of the acceleration in these states, upwards positive."""
HALTS = {UP_THERE: -1, DOWN_THERE: 1}
"""Sign of the acceleration of a lift that has crept on to its floor and stops: weaker than in `PULSES`."""
RIDES = frozenset(range(RISE, DOWN_THERE + 1))
CRUISES = frozenset((RISING, NEARLY_UP, SINKING, NEARLY_DOWN))

Chances = tuple[tuple[float, ...], ...]
"""Chances of a change from STAND, WALK, RUN, UP or DOWN (rows) to each of them within half a second, without rides.

Rows add up to 1."""
Shifts = tuple[tuple[Activity, Activity, float], ...]
"""Delays of the start of an activity after the half second in which it is first detected, s, by the change."""

DEFAULT_CHANCES: Chances = (
    (0.959, 0.03, 1e-3, 5e-3, 5e-3),
    (0.03, 0.936, 4e-3, 0.015, 0.015),
    (0.01, 0.03, 0.956, 2e-3, 2e-3),
    (0.02, 0.05, 2e-3, 0.926, 2e-3),
    (0.02, 0.05, 2e-3, 2e-3, 0.926),
)
"""Chances before anything is learnt: a stand lasts quarter of a minute, and most flights end on the level."""

_RIDE = {"RISE": 3e-3, "RISING": 1e-5, "SINK": 3e-3, "SINKING": 1e-5}
_LATE_RIDE = {"RISE": 1e-3, "RISING": 3e-4, "SINK": 1e-3, "SINKING": 3e-4}
_LEARNT_STATES = ("STAND", "WALK", "RUN", "UP", "DOWN")
_OTHER_CHANCES: dict[str, dict[str, float]] = {
    "STAND": {"UNKNOWN": 1e-3, **_RIDE},
    "WALK": {"UNKNOWN": 1e-3, **_LATE_RIDE},
    "RUN": {"UNKNOWN": 1e-3},
    "UP": {"UNKNOWN": 1e-3, **_LATE_RIDE},
    "DOWN": {"UNKNOWN": 1e-3, **_LATE_RIDE},
    "UNKNOWN": {"STAND": 0.1, "WALK": 0.1, "RUN": 0.02, "UP": 0.02, "DOWN": 0.02, **_LATE_RIDE},
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
"""Chances of a change within half a second that are not learnt; the rest is the chance to stay."""
_NAMES = (
    *_LEARNT_STATES,
    "UNKNOWN",
    *("RISE", "RISING", "RISEN", "NEARLY_UP", "UP_THERE"),
    *("SINK", "SINKING", "SUNK", "NEARLY_DOWN", "DOWN_THERE"),
)
FIRST_CHANCES = (0.5, 0.25, 0.05, 0.05, 0.05, 0.04, *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5), *(1e-3, 5e-4, 2e-4, 1e-5, 1e-5))
"""Chance of each state before any evidence."""


@frozen
class Chain:
    """The transitions between states.

    `predecessors`: for each state those that may come before it, with the logarithm of the chance. `shift`: for a
    change from one state to another, the delay of its start after the half second in which it is first detected, s."""

    predecessors: tuple[tuple[tuple[int, float], ...], ...]
    shift: tuple[tuple[float, ...], ...]


@lru_cache(maxsize=4)
def chain_of(chances: Chances, shifts: Shifts) -> Chain:
    """Return the chain with the learnt chances and shifts, and the fixed chances."""
    chances_from = {name: dict(_OTHER_CHANCES[name]) for name in _NAMES}
    for name, row in zip(_LEARNT_STATES, chances, strict=True):
        chances_from[name] |= {to: chance for to, chance in zip(_LEARNT_STATES, row, strict=True) if to != name}
    before = tuple(
        [
            tuple(
                [
                    (i, log(1.0 - sum(chances_from[name].values()) if name == to else chances_from[name][to]))
                    for i, name in enumerate(_NAMES)
                    if name == to or to in chances_from[name]
                ]
            )
            for to in _NAMES
        ]
    )
    known = {(a, b): shift for a, b, shift in shifts}
    return Chain(before, tuple([tuple([known.get((a, b), 0.0) for b in ACTIVITIES]) for a in ACTIVITIES]))
