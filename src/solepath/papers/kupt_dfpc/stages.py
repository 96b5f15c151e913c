"""What the cells have seen of a step, as a table; what turns loads into its cues is cop_cues.py.

A stage is not a phase. A toe-off is known as soon as the foot is in the air, but a heel-strike only once the foot lies
flat, and a foot that was in the air for no more than a moment had not left the ground yet.
"""

from __future__ import annotations

from ...foot.phase import Cue, in_columns
from ...types import Word


class StepStage(Word):
    """How far a step is, as far as the cells tell."""

    STANDING = "standing"  # stationary
    LEAVING = "leaving"  # motion has started, the foot is on the ground or was so a moment ago
    FLYING = "flying"  # in the air
    LANDING = "landing"  # on the ground again after a normal swing


class CellCue(Word):
    """What the cells show."""

    STANDS = "stands"  # it lies still on the ground
    MOVES = "moves"  # it does so no longer
    LEAVES = "leaves"  # it is in the air
    BRUSHES = "brushes"  # it is on the ground again, too soon for a swing
    LANDS = "lands"  # it is on the ground again after a normal swing
    LINGERS = "lingers"  # it landed long ago and does not lie still


_STANDING, _LEAVING, _FLYING, _LANDING = StepStage
_CHANGES: dict[tuple[StepStage, CellCue], tuple[StepStage, tuple[Cue, ...]]] = {
    (_STANDING, CellCue.MOVES): (_LEAVING, (Cue.LIFT,)),
    (_STANDING, CellCue.LEAVES): (_FLYING, (Cue.LIFT, Cue.CLEAR)),
    (_LEAVING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_LEAVING, CellCue.LEAVES): (_FLYING, (Cue.CLEAR,)),
    (_FLYING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_FLYING, CellCue.BRUSHES): (_LEAVING, ()),  # it was not in the air yet: the best candidate may still come
    (_FLYING, CellCue.LANDS): (_LANDING, ()),
    (_LANDING, CellCue.STANDS): (_STANDING, (Cue.CONTACT, Cue.FLAT)),
    (_LANDING, CellCue.LEAVES): (_FLYING, (Cue.CONTACT, Cue.CLEAR)),  # it was never flat: toe walking, running
    (_LANDING, CellCue.LINGERS): (_LANDING, (Cue.CONTACT,)),
}
"""What changes the stage, or is reported; any other cue of the cells does neither."""

STAGES = {stage: {cue: _CHANGES.get((stage, cue), (stage, ())) for cue in CellCue} for stage in StepStage}
"""Stage and cue -> the next stage, and what is reported: one contact a landing."""


def describe() -> str:
    """The table as text, for people: the next stage, and what is reported."""
    rows = [
        [stage.name, *(" ".join((after.name, *(cue.value for cue in reported))) for after, reported in row.values())]
        for stage, row in STAGES.items()
    ]
    return in_columns([["stage", *(cue.value for cue in CellCue)], *rows], 24)
