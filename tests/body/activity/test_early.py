"""What the wearer does is reported at once, by a table, and confirmed or revised later."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solepath.body.activity.blocks.stride_slope import slope_evidence
from solepath.body.activity.early import NEXT_ACTIVITY, ActivityCue, cue_of_stride, printed_table
from solepath.types import Activity

DOCUMENT = Path(__file__).parents[3] / "docs" / "activities.md"
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)


def test_after_every_cue_the_table_has_an_activity_and_the_document_shows_it() -> None:
    assert set(NEXT_ACTIVITY) == set(Activity)
    assert all(set(row) == set(ActivityCue) for row in NEXT_ACTIVITY.values())
    assert printed_table() in DOCUMENT.read_text()


def test_feet_that_move_are_pushed_by_their_own_steps_and_not_by_a_lift() -> None:
    for activity in (Activity.WALKING, Activity.RUNNING, *STAIRS):
        assert NEXT_ACTIVITY[activity][ActivityCue.PUSHED_UP] is activity


def test_a_level_stride_ends_stairs_and_nothing_else() -> None:
    after = {before: row[ActivityCue.LEVEL] for before, row in NEXT_ACTIVITY.items()}
    assert after == {one: Activity.WALKING if one in STAIRS else one for one in Activity}


@pytest.mark.parametrize("length", [0.0, 0.3, 0.9, 1.6])
def test_a_stride_without_rise_speaks_against_stairs(length: float) -> None:
    evidence = slope_evidence(length, 0.0)
    assert evidence.up == evidence.down < 0.0


def test_a_ramp_of_one_in_twelve_is_level_and_a_flight_of_stairs_is_not() -> None:
    ramp, stairs, steep = slope_evidence(1.3, 1.3 / 12.0), slope_evidence(0.58, 0.34), slope_evidence(1.0, 0.62)
    assert ramp.up < 0.0 and ramp.down < 0.0
    assert stairs.up > 1.5 and steep.up > 1.5 and stairs.down < 0.0
    assert slope_evidence(0.58, -0.34).down == stairs.up


@given(st.floats(0.0, 3.0), st.floats(-2.0, 2.0))
def test_evidence_is_the_same_up_and_down_and_one_stride_decides_little(length: float, rise: float) -> None:
    evidence, mirrored = slope_evidence(length, rise), slope_evidence(length, -rise)
    assert (evidence.up, evidence.down) == (mirrored.down, mirrored.up)
    assert -inf < evidence.up and max(abs(evidence.up), abs(evidence.down)) <= 3.0
    cue = cue_of_stride(evidence)
    assert cue is None or 0.5 < cue[1] < 1.0
