"""Feet that were recorded with separate clocks: an offset that is known, or that a shared event shows."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve
from commands import run, run_failing
from hypothesis import given
from hypothesis import strategies as st
from walks import LEFT, RIGHT, samples

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.recording import RecordingError, shift_clock
from solepath.recording.samples import load_samples
from solepath.recording.samples.shared_event import shared_offset
from solepath.types import Foot, Sample

LIFT = Route().stand(3.0).lift(3.2).stand(3.0).walk(26.0, 1.3).stop(1.0)
"""A lift ride from 3 s on, and a walk."""


@cache
def ride() -> dict[str, np.ndarray]:
    """Return the columns of both feet of the ride."""
    walker = Walker(LIFT, seed=7)
    feet = {foot: list(walker.samples(foot, 100.0, LSM6DSOX)) for foot in Foot}
    return {
        f"{key}_{foot.value}": np.array([getattr(sample, key) for sample in of_foot])
        for foot, of_foot in feet.items()
        for key in ("t", "acc", "gyro")
    }


def write(path: Path, delay: float, start: float = 0.0, end: float = 1e3) -> Path:
    """Write the ride with a clock of the right foot that is late by `delay`, s.

    Each foot is recorded from `start` to `end`, s, of its own clock."""
    columns = ride()
    columns = columns | {"t_right": columns["t_right"] + delay}
    kept = {foot: (start <= columns[f"t_{foot}"]) & (columns[f"t_{foot}"] <= end) for foot in Foot}
    np.savez(path, **{name: column[kept[Foot(name.partition("_")[2])]] for name, column in columns.items()})
    return path


@given(offset=st.floats(-2.0, 2.0))
def test_a_shifted_recording_has_the_same_samples_in_the_order_of_their_new_times(offset: float) -> None:
    walk = samples()[:800]
    shifted = list(shift_clock(walk, offset))
    times = [item.t for item in shifted]
    assert times == sorted(times)
    assert [s for s in shifted if s.site is LEFT] == [s for s in walk if s.site is LEFT]
    right = [evolve(s, t=s.t + offset, known_at=s.known_at + offset) for s in walk if s.site is RIGHT]
    assert [s for s in shifted if s.site is RIGHT] == right


def test_a_fault_in_the_recording_comes_after_all_samples_before_it() -> None:
    walk = samples()[:100]

    def faulty() -> Iterator[Sample]:
        yield from walk
        raise RecordingError("walk.csv", "time runs backwards")

    received = []
    with pytest.raises(RecordingError):
        for item in shift_clock(faulty(), 0.3):
            received.append(item)
    assert len(received) == len(walk)


@pytest.mark.parametrize("delay", [0.0, 0.12, -0.5])
def test_a_ride_in_a_lift_shows_the_offset_within_10_ms(tmp_path: Path, delay: float) -> None:
    offset, sigma = shared_offset(load_samples(write(tmp_path / "ride.npz", delay)), 2.0, 10.0)
    assert offset == pytest.approx(-delay, abs=0.01)
    assert abs(offset + delay) < 3.0 * sigma < 0.1


@pytest.mark.parametrize("delay", [0.12, -0.5])
def test_the_ends_of_a_recording_are_no_shared_event(tmp_path: Path, delay: float) -> None:
    recording = load_samples(write(tmp_path / "ride.npz", delay, 2.0, 9.0))
    offset, sigma = shared_offset(recording, 2.02, 8.98)
    assert offset == pytest.approx(-delay, abs=0.01) and sigma < 0.01


def test_walking_shows_no_offset_for_half_a_cycle_makes_the_feet_alike(tmp_path: Path) -> None:
    recording = load_samples(write(tmp_path / "walk.npz", 0.1))
    end = float(ride()["t_left"][-1])
    with pytest.raises(RecordingError, match="do not feel the same"):
        shared_offset(recording, end - 8.0, end - 3.0)
    with pytest.raises(RecordingError, match="no samples of the left foot"):
        shared_offset(recording, end, end + 5.0)


@pytest.mark.soak
def test_track_undoes_the_offset_on_request_only(tmp_path: Path) -> None:
    path = write(tmp_path / "ride.npz", 0.12)
    process = run("track", path, "--shared-event", "2,10")
    assert process.returncode == 0 and "step time" in process.stdout and "left out" not in process.stdout
    assert "-120 ms" in process.stderr or "-119 ms" in process.stderr or "-121 ms" in process.stderr
    assert "is not START,END" in run_failing("track", path, "--shared-event", "10")
    assert "-3600 to 3600" in run("track", path, "--clock-offset", "nan").stderr


def test_rides_in_recorded_lifts_show_the_same_small_offset(data_dir: Path) -> None:
    """The sensors of hugadb are read one after the other, so both feet's times differ by some 10 ms."""
    recording = load_samples(data_dir / "hugadb" / "various_08_15.npz")
    offsets = [shared_offset(recording, start, end)[0] for start, end in ((33.7, 48.0), (61.0, 78.0), (89.7, 109.8))]
    assert all(-0.016 < offset < 0.0 for offset in offsets)
