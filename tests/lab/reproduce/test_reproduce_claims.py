"""The claims of the papers as docs/recipes.md reports them, with the full number of walks.

    python -m pytest -m long tests/lab/reproduce/test_reproduce_claims.py

Takes half an hour or more on two cores. A claim that is not reproduced is not asserted here; the page reports it.
"""

from __future__ import annotations

import time
from types import ModuleType

import pytest

from solepath_lab.reproduce import footstep_tracker, kupt_dfpc, pressure_contour, shoe_sensing, walking_modes
from solepath_lab.reproduce.runner import Runner
from solepath_lab.reproduce.seeds import Experiment
from solepath_lab.reproduce.tables import CLAIMS, Reproduction

pytestmark = pytest.mark.long


def seed_of_today() -> int:
    """Return a seed that nobody has chosen."""
    return time.time_ns() // 10**6 % 100_000


def verdicts(found: Reproduction) -> dict[str, str]:
    """Return the verdicts by sentence; each claim of the file has walks."""
    assert len(found.claims) == sum([len(one.get("of", [""])) for one in CLAIMS[found.name]])
    return {one.sentence: one.verdict for one in found.claims}


def test_known_velocity_with_our_additions_errs_less_than_zero_velocity_without_them() -> None:
    found = verdicts(kupt_dfpc.reproduce(None, seed_of_today(), Runner(processes=2)))
    for setting in ("", "rigid sole: ", "pivot +2 cm: ", "slip 2 cm: ", "no low pass: ", "MPU-9250: "):
        assert found[f"{setting}KUPT errs less than ZUPT"] == "holds"
    assert found["KUPT errs less than KUPT, no bias"] == "holds"


HELD = {
    pressure_contour.reproduce: (
        "loops end nearer than the paper's 4.30 m", "short: ours finds more strides than the printed one",
    ),
    shoe_sensing.reproduce: (
        "walking: lengths err less with ours than as printed", "jogging: ours finds more strides than printed",
        "ramps and kerbs: heights err less with ours than with level by angle",
    ),
}  # fmt: skip
"""Claims that hold, by experiment."""


@pytest.mark.parametrize("experiment", HELD, ids=["contours", "shoe"])
def test_what_the_pages_claim_holds_with_the_seed_of_today(experiment: Experiment) -> None:
    found = verdicts(experiment(None, seed_of_today(), Runner(processes=2)))
    assert {found[sentence] for sentence in HELD[experiment]} == {"holds"}


HOLDS = {
    walking_modes: (
        "at B IV is nearer than III", "at C IV is nearer than III", "at D IV is nearer than III",
        "over all corners IV is nearer than III", "over all corners III is nearer than II",
        "heel out, forefoot in, 4 mm: modes by turn are right more often than by table 2",
    ),
    footstep_tracker: (
        "corridor, one foot: closing at rest errs less than as printed",
        "a stride: the mean with the other foot's last one errs less",
        "activities: more windows are right than as printed",
        "turns: the turn about the vertical errs less than (7)",
        "a circle: ours errs less than (7) and the printed filter",
    ),
}  # fmt: skip
"""Claims that the pages of two papers say hold."""


@pytest.mark.parametrize("experiment", list(HOLDS), ids=lambda one: one.NAME)
def test_what_a_page_says_holds_is_not_refuted_with_a_seed_of_the_clock(experiment: ModuleType) -> None:
    seed = time.time_ns() // 10**6 % 100_000
    found = experiment.reproduce(None, seed, Runner(processes=2))
    said = verdicts(found)
    assert {name: said[name] for name in HOLDS[experiment] if said[name] == "fails"} == {}, f"--seed {seed}"
