"""Ranges in files: both formats, blank cells and other columns, and one line for each fault."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from solepath import Foot, Sample, Site
from solepath.recording.samples.ranges import read_ranges

EXPECTED = [Sample(0.5, Site.RIGHT_FOOT, range=0.25), Sample(1.0, Site.RIGHT_FOOT, range=0.75)]


def test_both_formats_give_the_same_samples_in_order(tmp_path: Path) -> None:
    table, archive = tmp_path / "ranges.csv", tmp_path / "walk.npz"
    table.write_text("number,t,range\n1,1.0,0.75\n2,0.75,\n\n3,0.5,0.25\n")
    np.savez(archive, t=[0.0], acc=[[0.0, 0.0, 9.81]], t_range=[1.0, 0.7, 0.5], range=[0.75, np.nan, 0.25])
    assert read_ranges(table) == read_ranges(archive) == EXPECTED
    assert {one.site for one in read_ranges(table, Foot.LEFT)} == {Site.LEFT_FOOT}
