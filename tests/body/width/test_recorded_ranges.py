"""Ranges in files: both formats, blank cells and other columns, and one line for each fault."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from solepath import Foot, Sample, Site
from solepath.recording import RecordingError
from solepath.recording.samples.ranges import read_ranges

EXPECTED = [Sample(0.5, Site.RIGHT_FOOT, range=0.25), Sample(1.0, Site.RIGHT_FOOT, range=0.75)]


def test_both_formats_give_the_same_samples_in_order(tmp_path: Path) -> None:
    table, archive = tmp_path / "ranges.csv", tmp_path / "walk.npz"
    table.write_text("number,t,range\n1,1.0,0.75\n2,0.75,\n\n3,0.5,0.25\n")
    np.savez(archive, t=[0.0], acc=[[0.0, 0.0, 9.81]], t_range=[1.0, 0.7, 0.5], range=[0.75, np.nan, 0.25])
    assert read_ranges(table) == read_ranges(archive) == EXPECTED
    assert {one.site for one in read_ranges(table, Foot.LEFT)} == {Site.LEFT_FOOT}


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("t,distance\n1,0.5\n", "line 1: names no columns t and range"),
        ("", "line 1: names no columns t and range"),
        ("t,range\n1,0.5\n2,far\n", "line 3: has no numbers t and range"),
        ("t,range\n1,-0.5\n", "holds no ranges"),
        ("t,range\n1,35\n2,40\n", "range: the median is 37.5 m, which no feet are apart: this looks like cm"),
        ("t,range\n1,350\n2,400\n", "range: the median is 375 m, which no feet are apart: this looks like mm"),
    ],
)
def test_a_fault_is_one_line_with_its_place(tmp_path: Path, text: str, fault: str) -> None:
    path = tmp_path / "ranges.csv"
    path.write_text(text)
    with pytest.raises(RecordingError, match=fault):
        read_ranges(path)


def test_an_archive_without_ranges_or_of_unequal_lengths_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "walk.npz"
    np.savez(path, t=[0.0])
    with pytest.raises(RecordingError, match="no keys t_range and range"):
        read_ranges(path)
    np.savez(path, t_range=[0.0, 1.0], range=[0.5])
    with pytest.raises(RecordingError, match="range: has the shape"):
        read_ranges(path)
    with pytest.raises(RecordingError, match="neither .npz nor .csv"):
        read_ranges(tmp_path / "walk.txt")
