"""The phases of a foot and the support of a body, as tables.

Rule 1: every transition there is stands here. Rule 2: this file knows no number; what turns numbers into cues, with
hysteresis and debounce, is in cues/.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from ..events import FootFlat, HeelOff, HeelStrike, ToeOff
from ..types import Phase, Support


class Cue(Enum):
    """What a foot was seen to do."""

    CONTACT = "contact"  # it touched the ground
    FLAT = "flat"  # the whole sole is down and still
    LIFT = "lift"  # the heel came up
    CLEAR = "clear"  # the toe left the ground


PHASES: dict[Phase, dict[Cue, Phase]] = {
    Phase.LOADING: {
        Cue.CONTACT: Phase.LOADING,
        Cue.FLAT: Phase.STATIONARY,
        Cue.LIFT: Phase.PUSH_OFF,  # a runner rolls on without ever being flat
        Cue.CLEAR: Phase.SWING,
    },
    Phase.STATIONARY: {
        Cue.CONTACT: Phase.STATIONARY,
        Cue.FLAT: Phase.STATIONARY,
        Cue.LIFT: Phase.PUSH_OFF,
        Cue.CLEAR: Phase.SWING,  # the foot was lifted as a whole
    },
    Phase.PUSH_OFF: {
        Cue.CONTACT: Phase.LOADING,  # the heel came down again without the toe ever leaving
        Cue.FLAT: Phase.STATIONARY,
        Cue.LIFT: Phase.PUSH_OFF,
        Cue.CLEAR: Phase.SWING,
    },
    Phase.SWING: {
        Cue.CONTACT: Phase.LOADING,
        Cue.FLAT: Phase.STATIONARY,  # it landed flat
        Cue.LIFT: Phase.SWING,
        Cue.CLEAR: Phase.SWING,
    },
}

TO_COME: dict[Phase, tuple[Cue, ...]] = {
    Phase.STATIONARY: (Cue.LIFT, Cue.CLEAR, Cue.CONTACT, Cue.FLAT),
    Phase.PUSH_OFF: (Cue.CLEAR, Cue.CONTACT, Cue.FLAT),
    Phase.SWING: (Cue.CONTACT, Cue.FLAT),
    Phase.LOADING: (Cue.FLAT,),
}
"""The cues of a whole step that are still to come."""

EVENT_OF_PHASE: dict[Phase, type[HeelStrike] | type[FootFlat] | type[HeelOff] | type[ToeOff]] = {
    Phase.LOADING: HeelStrike,
    Phase.STATIONARY: FootFlat,
    Phase.PUSH_OFF: HeelOff,
    Phase.SWING: ToeOff,
}

_BOTH, _LEFT, _RIGHT, _NONE = Support.DOUBLE, Support.LEFT, Support.RIGHT, Support.FLIGHT
SUPPORT: dict[Phase, dict[Phase, Support]] = {  # left foot, then right foot
    left: dict(zip((Phase.LOADING, Phase.STATIONARY, Phase.PUSH_OFF, Phase.SWING), row, strict=True))
    for left, row in (
        (Phase.LOADING, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (Phase.STATIONARY, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (Phase.PUSH_OFF, (_BOTH, _BOTH, _BOTH, _LEFT)),
        (Phase.SWING, (_RIGHT, _RIGHT, _RIGHT, _NONE)),
    )
}


def describe() -> str:
    """Both tables as text, for people."""
    return in_columns(
        [
            ["phase", *(cue.value for cue in Cue)],
            *([phase.name, *(row[cue].name for cue in Cue)] for phase, row in PHASES.items()),
            [],
            ["left\\right", *(phase.name for phase in Phase)],
            *([left.name, *(joint[right].name for right in Phase)] for left, joint in SUPPORT.items()),
        ]
    )


def in_columns(rows: Iterable[Iterable[str]], width: int = 12) -> str:
    """Rows of words as lines of columns, each `width` characters wide."""
    return "\n".join("".join(word.ljust(width) for word in row).rstrip() for row in rows)
