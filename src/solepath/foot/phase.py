"""Tables of the phases of a foot and of the support of the body.

The tables contain all transitions and no numbers: a foot that is found in the middle of a walk and one that a gap has
hidden change their phase by them, too (`Gait` looks them up). The modules in cues/ turn samples into cues, with
hysteresis and debounce."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from typing import Final

from ..events import FootFlat, HeelOff, HeelStrike, ToeOff
from ..types import Phase, Support

LOADING: Final = Phase.LOADING
STATIONARY: Final = Phase.STATIONARY
PUSH_OFF: Final = Phase.PUSH_OFF
SWING: Final = Phase.SWING
"""Names for code that runs for every sample, because one look-up in the enum costs as much as five multiplications."""


class Cue(Enum):
    """A sign of a gait event in the samples of one foot."""

    CONTACT = "contact"
    """Sign of heel-strike: the foot touched the ground."""
    FLAT = "flat"
    """Sign of foot-flat: the whole sole is down and still."""
    LIFT = "lift"
    """Sign of heel-off: the heel left the ground."""
    CLEAR = "clear"
    """Sign of toe-off: the toe left the ground."""
    GROUND = "ground"
    """A foot that walks already when its navigation starts is on the ground."""
    AIR = "air"
    """A foot that walks already when its navigation starts is in the air."""


_START = {Cue.GROUND: LOADING, Cue.AIR: SWING}
PHASES: dict[Phase, dict[Cue, Phase]] = {
    LOADING: {
        Cue.CONTACT: LOADING,
        Cue.FLAT: STATIONARY,
        Cue.LIFT: PUSH_OFF,  # a runner's foot may never be flat
        Cue.CLEAR: SWING,
        **_START,
    },
    STATIONARY: {
        Cue.CONTACT: STATIONARY,
        Cue.FLAT: STATIONARY,
        Cue.LIFT: PUSH_OFF,
        Cue.CLEAR: SWING,  # the foot was lifted as a whole
        **_START,
    },
    PUSH_OFF: {
        Cue.CONTACT: LOADING,  # the heel came down again before toe-off
        Cue.FLAT: STATIONARY,
        Cue.LIFT: PUSH_OFF,
        Cue.CLEAR: SWING,
        **_START,
    },
    SWING: {
        Cue.CONTACT: LOADING,
        Cue.FLAT: STATIONARY,  # the foot landed flat
        Cue.LIFT: SWING,
        Cue.CLEAR: SWING,
        **_START,
    },
}
"""Next phase for each phase and cue."""

STRIDE = (Cue.LIFT, Cue.CLEAR, Cue.CONTACT, Cue.FLAT)
"""Cues of a whole stride, in order."""

REMAINING_CUES: dict[Phase, tuple[Cue, ...]] = {
    phase: STRIDE[k:] for k, phase in enumerate((STATIONARY, PUSH_OFF, SWING, LOADING))
}
"""Cues that a stride still needs in each phase, in order: the path through PHASES that a gap may hide."""

EVENT_OF_PHASE: dict[Phase, type[HeelStrike] | type[FootFlat] | type[HeelOff] | type[ToeOff]] = {
    LOADING: HeelStrike,
    STATIONARY: FootFlat,
    PUSH_OFF: HeelOff,
    SWING: ToeOff,
}
"""Event that starts each phase."""

_BOTH, _LEFT, _RIGHT, _NONE = Support.DOUBLE, Support.LEFT, Support.RIGHT, Support.FLIGHT
SUPPORT: dict[Phase, dict[Phase, Support]] = {
    left: dict(zip((LOADING, STATIONARY, PUSH_OFF, SWING), row, strict=True))
    for left, row in (
        (LOADING, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (STATIONARY, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (PUSH_OFF, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (SWING, (_RIGHT, _RIGHT, _RIGHT, _NONE)),
    )
}
"""Support of the body for the phases of the left foot, then of the right foot."""


def describe() -> str:
    """Return the tables as text: PHASES, REMAINING_CUES and SUPPORT."""
    return in_columns(
        [
            ["phase", *(cue.value for cue in Cue)],
            *([phase.name, *(row[cue].name for cue in Cue)] for phase, row in PHASES.items()),
            [],
            ["phase", "a gap may hide"],
            *([phase.name, *(cue.value for cue in REMAINING_CUES[phase])] for phase in PHASES),
            [],
            ["left\\right", *(phase.name for phase in Phase)],
            *([left.name, *(joint[right].name for right in Phase)] for left, joint in SUPPORT.items()),
        ]
    )


def in_columns(rows: Iterable[Iterable[str]], width: int = 12) -> str:
    """Return rows of words as lines of columns, each `width` characters wide."""
    return "\n".join("".join(word.ljust(width) for word in row).rstrip() for row in rows)
