"""One recording through one session, and what the scores need of what came out.

Only what samples reads (t, acc, gyro, pressure) reaches the session; the truth in the same file never does.
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
    """How a recording is computed: the recipe, and what is known beforehand.

    `activity`: in the place of the recipe's own part, the same part taught on other recordings.
    """

    recipe: Recipe
    calibration: Calibration = Calibration()
    activity: ActivityPart | None = None


@frozen(eq=False)
class ScoredTrack:
    """`positions` (n,3) in m at `t` (n,) s."""

    t: Floats
    positions: Floats


@frozen(eq=False)
class RecordingRun:
    feet: dict[Foot, FootRun]
    said: Gathering
    samples: int
    seconds: float
    """Wall time that the session took."""
    body: ScoredTrack | None = None
    """Where the session had the wearer after every sample, where that was asked for."""


def run(
    path: Path,
    how: RunSettings,
    *,
    without_pressure: bool = False,
    calibration: Calibration | None = None,
    poses: bool = True,
    body: bool = False,
) -> RecordingRun:
    """The recording at `path` through a session, sample by sample.

    `without_pressure`: leave the pressure out, because the truth was made of it. `calibration`: where the cells are.
    `poses`: the live position at every sample is asked for. `body`: and that of the wearer.
    """
    known = how.calibration if calibration is None else merged(how.calibration, calibration)
    recipe = how.recipe if how.activity is None else how.recipe.exchanged(ActivityPart, how.activity)
    session = Session(recipe, calibration=known, poses=poses)
    recording = load_samples(path)
    samples = list(recording)
    if without_pressure:
        samples = [attrs.evolve(sample, pressure=None) for sample in samples]
    gathering, wearer, seconds = followed(session, samples, 0.0 if body else None)
    feet = {table.foot: gathering.foot(table.foot) for table in recording.tables}
    return RecordingRun(feet, gathering, len(samples), seconds, wearer)


def followed(
    session: Session, samples: Iterable[Sample], every: float | None
) -> tuple[Gathering, ScoredTrack | None, float]:
    """What the session said of the samples; where it had the wearer, asked `every` s (0: after every sample, None:
    never); and the wall time that it took, s."""
    said: list[list[Event]] = []
    places: list[tuple[float, Vec3]] = []
    began = perf_counter()
    for sample in samples:
        said.append(session.feed(sample))
        due = every is not None and (every == 0.0 or sample.t >= len(places) * every)
        if due and (position := session.position) is not None:
            places.append((position.t, position.position))
    said.append(session.finish())
    seconds = perf_counter() - began
    track = ScoredTrack(np.array([t for t, _ in places]), np.array([at for _, at in places]).reshape(-1, 3))
    return Gathering.of(event for events in said for event in events), track if places else None, seconds


Meta = dict[str, Any]
"""A recording's entry in dataset.json."""
Arrays = dict[str, Any]


def truth_of(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files if key == "t" or key.startswith(("t_", "gt_", "pressure"))}


def scored(path: Path, went: RecordingRun, **parts: Any) -> Scored:
    return Scored(path.stem, samples=went.samples, seconds=went.seconds, **parts)
