"""Stages of a stride by the pressure cells, as a table; cop_cues.py turns loads into cues of the table.

A stage is not a phase. A toe-off is known as soon as the foot is in the air, but a heel-strike is known only when the
foot lies flat. A foot that was in the air for less than a swing has not left the ground yet."""

from __future__ import annotations

from ...foot.phase import Cue, in_columns
from ...types import ValueEnum


class StrideStage(ValueEnum):
    """The stage of a stride by the pressure cells."""

    STANDING = "standing"  # stationary
    LEAVING = "leaving"  # moving, but not yet in swing
    FLYING = "flying"  # in the air
    LANDING = "landing"  # on the ground again after a normal swing


class CellCue(ValueEnum):
    """A cue from the pressure cells of one sample."""

    STANDS = "stands"  # the foot lies still on the ground
    MOVES = "moves"  # the foot does not lie still
    LEAVES = "leaves"  # the foot is in the air
    BRUSHES = "brushes"  # the foot is on the ground again, too soon for a swing
    LANDS = "lands"  # the foot is on the ground again after a normal swing
    LINGERS = "lingers"  # the foot landed long ago and does not lie still


_STANDING, _LEAVING, _FLYING, _LANDING = StrideStage
_CHANGES: dict[tuple[StrideStage, CellCue], tuple[StrideStage, tuple[Cue, ...]]] = {
    (_STANDING, CellCue.MOVES): (_LEAVING, (Cue.LIFT,)),
    (_STANDING, CellCue.LEAVES): (_FLYING, (Cue.LIFT, Cue.CLEAR)),
    (_LEAVING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_LEAVING, CellCue.LEAVES): (_FLYING, (Cue.CLEAR,)),
    (_FLYING, CellCue.STANDS): (_STANDING, (Cue.FLAT,)),
    (_FLYING, CellCue.BRUSHES): (_LEAVING, ()),  # no swing yet: a better candidate for toe-off may come
    (_FLYING, CellCue.LANDS): (_LANDING, ()),
    (_LANDING, CellCue.STANDS): (_STANDING, (Cue.CONTACT, Cue.FLAT)),
    (_LANDING, CellCue.LEAVES): (_FLYING, (Cue.CONTACT, Cue.CLEAR)),  # never flat: toe walking, running
    (_LANDING, CellCue.LINGERS): (_LANDING, (Cue.CONTACT,)),
}
"""Next stage and reported cues for those cues of a stage that change it or report a cue."""

STAGES = {stage: {cue: _CHANGES.get((stage, cue), (stage, ())) for cue in CellCue} for stage in StrideStage}
"""Next stage and reported cues by stage and cue."""


def describe() -> str:
    """Return the table as text for people, with the next stage and the reported cues."""
    rows = [
        [
            stage.name,
            *(" ".join((next_stage.name, *(cue.value for cue in reported))) for next_stage, reported in row.values()),
        ]
        for stage, row in STAGES.items()
    ]
    return in_columns([["stage", *(cue.value for cue in CellCue)], *rows], 24)
