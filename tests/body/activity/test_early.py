"""What the wearer does is reported at once, by a table, and confirmed or revised later."""

from __future__ import annotations

from pathlib import Path

from solepath.body.activity.early import NEXT_ACTIVITY, ActivityCue, printed_table
from solepath.types import Activity

DOCUMENT = Path(__file__).parents[3] / "docs" / "activities.md"


def test_after_every_cue_the_table_has_an_activity_and_the_document_shows_it() -> None:
    assert set(NEXT_ACTIVITY) == set(Activity)
    assert all(set(row) == set(ActivityCue) for row in NEXT_ACTIVITY.values())
    assert printed_table() in DOCUMENT.read_text()
