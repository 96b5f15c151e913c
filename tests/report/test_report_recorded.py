"""Differences of swing times that the report names on recorded walks are those of the walks' labels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from walks import run_session

from solepath.recording.samples import load_samples
from solepath.show.report import Report
from solepath.show.report.sections.facts import facts_of
from solepath.show.report.walk_summary import SWING_TIME
from solepath_lab.evaluate.run import truth_of

DATA_SETS = ("ipol_10m_uturn", "tripod_treadmill")
"""Data sets with labels of the swings of both feet."""
LONGEST_SWING = 1.0
"""Longest time between two contacts that is a swing, s; after a longer one the treadmill stands."""


def true_difference(path: Path) -> float:
    """Return (right - left) / mean of the labelled swing times, medians."""
    truth = truth_of(path)
    if "gt_foot" in truth:
        swings = []
        for number in (0, 1):
            rows = truth["gt_foot"] == number
            ends = truth["gt_hs_t"][rows] + truth["gt_contact_s"][rows]
            swings.append(truth["gt_hs_t"][rows][1:] - ends[:-1])
    else:
        swings = [truth[f"gt_{foot}"][:, 1] - truth[f"gt_{foot}"][:, 0] for foot in ("left", "right")]
    left, right = (float(np.median(times[times < LONGEST_SWING])) for times in swings)
    return 2.0 * (right - left) / (right + left)


@pytest.mark.long
def test_each_difference_of_swing_times_that_is_named_is_of_the_labelled_foot(data_dir: Path) -> None:
    paths = [path for name in DATA_SETS for path in sorted((data_dir / name).glob("*.npz"))]
    named = {}
    for path in paths:
        report = Report()
        report.take(None, run_session(load_samples(path)))
        difference = facts_of(report).differences.get(SWING_TIME)
        if difference is not None and difference.is_certain:
            named[path.name] = (difference.value, true_difference(path))
    print(f"{len(named)} of {len(paths)}: {named}")
    assert len(paths) == 62 and len(named) >= 5
    assert all(found * true > 0.0 for found, true in named.values())
