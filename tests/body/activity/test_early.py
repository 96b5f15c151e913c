"""What the wearer does is reported at once, by a table, and confirmed or revised later."""

from __future__ import annotations

from solepath.body.activity.early import NEXT_ACTIVITY, ActivityCue
from solepath.types import Activity


def test_after_every_cue_the_table_has_an_activity() -> None:
    assert set(NEXT_ACTIVITY) == set(Activity)
    assert all(set(row) == set(ActivityCue) for row in NEXT_ACTIVITY.values())
