"""A runner whose feet are never flat for long has no strides and runs all the same; whoever pedals does not run."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from solepath.recording.samples import load_samples
from solepath.session import Session
from solepath.types import Activity
from solepath.walk.walk import Walk


def activities_of(path: Path, t_start: float, t_end: float) -> Counter[Activity]:
    """Return for how many tenths of a second each activity is reported in the end."""
    session = Session()
    samples = [sample for sample in load_samples(path, report=lambda sentence: None) if sample.t < t_end + 10.0]
    walk = Walk.of([event for sample in samples for event in session.feed(sample)] + list(session.finish()))
    tenths = range(round((t_end - t_start) * 10.0))
    return Counter([walk.timeline.at(t_start + 0.1 * tenth) for tenth in tenths])


def test_a_runner_whose_strides_do_not_close_runs(data_dir: Path) -> None:
    found = activities_of(data_dir / "hugadb" / "various_08_21.npz", 6.0, 13.0)
    assert found[Activity.RUNNING] > 0.9 * found.total()


def test_a_stuck_accelerometer_on_a_bicycle_is_no_run(data_dir: Path) -> None:
    found = activities_of(data_dir / "hugadb_daily" / "bicycling_01_18.npz", 0.0, 140.0)
    assert found[Activity.RUNNING] + found[Activity.WALKING] < 0.03 * found.total()
