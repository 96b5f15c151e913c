"""Recorded patients who walk slowly, with pauses, walk from the first to the last stride; riders and sitters do not.

What tells strides from other motions, and the curves of activities, were learnt from some of these recordings, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from solepath import Session, recipes
from solepath.events import ActivityChanged, StrideTaken
from solepath.recording import read_samples
from solepath.types import Activity
from solepath.walk.timeline import Timeline

MIN_WALKING = 0.9


@pytest.mark.parametrize("name", ["coleta1", "coleta2", "coleta3", "leituras2", "slow_walk_10hz"])
def test_from_the_first_stride_to_the_last_one_a_patient_walks(name: str, data_dir: Path) -> None:
    session, timeline = Session(recipes.DEFAULT), Timeline()
    samples = read_samples(data_dir / "slow_gait" / f"{name}.npz")
    events = [event for sample in samples for event in session.feed(sample)] + session.finish()
    for event in events:
        if isinstance(event, ActivityChanged):
            timeline.add(event)
    strides = [event for event in events if isinstance(event, StrideTaken)]
    start, end = min(one.t_toe_off or one.t_start for one in strides), max(one.t_end for one in strides)
    times = [start + 0.1 * k for k in range(int(10.0 * (end - start)))]
    found = [timeline.at(t) for t in times]
    assert found.count(Activity.WALKING) >= MIN_WALKING * len(found)


@pytest.mark.parametrize("name", ["bicycling_01_00", "bicycling_01_12", "sitting_10_00"])
def test_who_rides_or_sits_takes_no_stride_and_walks_nowhere(name: str, data_dir: Path) -> None:
    session = Session(recipes.DEFAULT)
    samples = read_samples(data_dir / "hugadb_daily" / f"{name}.npz")
    events = [event for sample in samples for event in session.feed(sample)] + session.finish()
    assert [event for event in events if isinstance(event, StrideTaken)] == []
    final = {event.activity for event in events if isinstance(event, ActivityChanged) and event.final}
    assert final <= {Activity.UNKNOWN, Activity.STANDING}
