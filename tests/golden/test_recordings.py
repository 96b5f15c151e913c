"""Recordings of every kind, whole and damaged: what is read of each, and what is said, is what it was."""

from __future__ import annotations

import pytest
from corpus import Case
from table import PARTS, differences


@pytest.mark.parametrize("case", PARTS["recordings"], ids=lambda case: case.name)
def test_every_event_is_what_it_was(case: Case) -> None:
    assert differences(case) == [], "`.ci/golden check` prints the first event that differs"
