"""What the wearer does is reported at once, by a table, and confirmed or revised later."""

from __future__ import annotations

import re
from pathlib import Path

from solepath.body.activity.early import NEXT_ACTIVITY, ActivityCue
from solepath.types import Activity

DOCUMENT = Path(__file__).parents[3] / "docs" / "gait.md"


def test_after_every_cue_the_table_has_an_activity_and_the_document_shows_it() -> None:
    assert set(NEXT_ACTIVITY) == set(Activity)
    assert all(set(row) == set(ActivityCue) for row in NEXT_ACTIVITY.values())
    rows = [re.split(" {2,}", line.strip()) for line in DOCUMENT.read_text().splitlines()]
    assert [cue.value for cue in ActivityCue] in rows
    for before, row in NEXT_ACTIVITY.items():
        assert [before.value, *[row[cue].value for cue in ActivityCue]] in rows
