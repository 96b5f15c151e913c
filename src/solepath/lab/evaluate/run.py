"""Runs one recording through one session and collects what the scores need.

Only the values that `samples` reads (t, acc, gyro, pressure) reach the session; the truth in the same file never does.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from time import perf_counter
from typing import Any

import attrs
import numpy as np
from attrs import frozen

from ...body.part import ActivityPart
from ...calibration import Calibration, merged
from ...events import Event
from ...recipes import Recipe
from ...recording.samples import load_samples
from ...session import Session
from ...types import Foot, Sample, Vec3
from ..measures.alignment import Floats
from ..measures.score import Scored
from .gathered import FootRun, Gathering


@frozen
class RunSettings:
    """Settings of a run: the recipe, and the calibration known beforehand.

    `activity` replaces the recipe's own part by the same part trained on other recordings."""

    recipe: Recipe
    calibration: Calibration = Calibration()
    activity: ActivityPart | None = None


@frozen(eq=False)
class ScoredTrack:
    """Positions (n,3) in m at `t` (n,) s."""

    t: Floats
    positions: Floats


@frozen(eq=False)
class RecordingRun:
    """Results of one recording: events by foot, samples and time."""

    feet: dict[Foot, FootRun]
    gathering: Gathering
    samples: int
    seconds: float
    """Wall time that the session took, s."""
    body: ScoredTrack | None = None
    """The wearer's position after every sample; None when it was not requested."""


def run(
    path: Path,
    settings: RunSettings,
    *,
    without_pressure: bool = False,
    calibration: Calibration | None = None,
    poses: bool = True,
    body: bool = False,
) -> RecordingRun:
    """Run the recording at `path` through a session, sample by sample.

    `without_pressure` leaves the pressure out, because the truth was made of it. `calibration` has the positions of the
    cells. `poses` requests the live position at every sample, `body` that of the wearer."""
    known = settings.calibration if calibration is None else merged(settings.calibration, calibration)
    recipe = (
        settings.recipe if settings.activity is None else settings.recipe.exchanged(ActivityPart, settings.activity)
    )
    session = Session(recipe, calibration=known, poses=poses)
    recording = load_samples(path)
    samples = list(recording)
    if without_pressure:
        samples = [attrs.evolve(sample, pressure=None) for sample in samples]
    gathering, wearer, seconds = run_timed(session, samples, 0.0 if body else None)
    feet = {table.foot: gathering.foot(table.foot) for table in recording.tables}
    return RecordingRun(feet, gathering, len(samples), seconds, wearer)


def run_timed(
    session: Session, samples: Iterable[Sample], every: float | None
) -> tuple[Gathering, ScoredTrack | None, float]:
    """Return the session's events for the samples, the wearer's track and the wall time, s.

    The track is sampled every `every` s: 0 stands for every sample, None for never."""
    outputs: list[list[Event]] = []
    places: list[tuple[float, Vec3]] = []
    started_at = perf_counter()
    for sample in samples:
        outputs.append(session.feed(sample))
        due = every is not None and (every == 0.0 or sample.t >= len(places) * every)
        if due and (position := session.position) is not None:
            places.append((position.t, position.position))
    outputs.append(session.finish())
    seconds = perf_counter() - started_at
    track = ScoredTrack(np.array([t for t, _ in places]), np.array([at for _, at in places]).reshape(-1, 3))
    return Gathering.of(event for events in outputs for event in events), track if places else None, seconds


Meta = dict[str, Any]
"""A recording's entry in dataset.json."""
Arrays = dict[str, Any]


def truth_of(path: Path) -> Arrays:
    """Return the arrays of the truth in a recording's file, with its times and pressure."""
    with np.load(path, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files if key == "t" or key.startswith(("t_", "gt_", "pressure"))}


def scored(path: Path, result: RecordingRun, **parts: Any) -> Scored:
    """Return the scores of a run with its name, number of samples and wall time."""
    return Scored(path.stem, samples=result.samples, seconds=result.seconds, **parts)
