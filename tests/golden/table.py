"""All cases of the golden corpus, by the part that a test file checks."""

from __future__ import annotations

from functools import cache

from body_cases import BODY
from cases import DEVICES, FAULTS, PLACES, RECIPES, recorded
from corpus import Case
from paper_cases import PAPERS
from place_cases import MORE_PLACES
from recording_cases import RECORDINGS

PARTS: dict[str, tuple[Case, ...]] = {
    "devices": DEVICES,
    "faults": FAULTS,
    "recipes": RECIPES,
    "papers": PAPERS,
    "body": BODY,
    "places": PLACES,
    "plans": MORE_PLACES,
    "recordings": RECORDINGS,
}


@cache
def all_cases() -> dict[str, Case]:
    """Return every case by its name, the long ones first, since several are computed at a time."""
    order = ("plans", "places", "recipes", "devices", "recordings", "body", "faults", "papers")
    parts = [case for name in order for case in PARTS[name]]
    cases = [*parts, *recorded()]
    named = {case.name: case for case in cases}
    assert len(named) == len(cases), "two cases have one name"
    return named
