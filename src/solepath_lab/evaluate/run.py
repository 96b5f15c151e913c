"""Runs one recording through one session and collects the events that are scored.

The session receives only t, acc, gyro and pressure from the file, never the truth that is in the same file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from attrs import field, frozen

from solepath.body.part import ActivityPart, Position
from solepath.calibration import Calibration
from solepath.calibration.records import merged
from solepath.events import Event
from solepath.recipes import Recipe
from solepath.recording.samples import load_samples
from solepath.recording.samples.npz import read_arrays
from solepath.session import Session
from solepath.types import Foot, Sample
from solepath.validate.alignment import Floats
from solepath.validate.foot_run import FootRun
from solepath.walk.walk import Walk

from ..train.hugadb import with_true_rates


@frozen
class RunSettings:
    """The recipe of a run, and the calibration that is known beforehand."""

    recipe: Recipe
    calibration: Calibration = Calibration()
    activity: ActivityPart | None = None
    """Activity part that replaces the recipe's own: a part of the same class, trained on other wearers."""


@frozen(eq=False)
class BodyRun(FootRun):
    """The wearer's positions at successive times, which are empty when they were not requested."""

    t: Floats = field(factory=lambda: np.zeros(0))
    positions: Floats = field(factory=lambda: np.zeros((0, 3)))
    covariances: Floats = field(factory=lambda: np.zeros((0, 3)))
    """Covariances of the horizontal positions, (n,3): xx, xy, yy, m^2."""


@frozen(eq=False)
class RecordingRun:
    """The events of the session that processed a recording."""

    feet: dict[Foot, FootRun]
    walk: Walk
    body: BodyRun
    """The wearer's position after every sample, if that was requested."""


def run(
    path: Path,
    settings: RunSettings,
    *,
    without_pressure: bool = False,
    true_rates: bool = False,
    calibration: Calibration | None = None,
    poses: bool = True,
    body: bool = False,
) -> RecordingRun:
    """Run the recording at `path` through a session, sample by sample.

    `without_pressure` hides from the session the pressure from which the truth was made. `true_rates` corrects angular
    rates that are eight times too large (train/hugadb.py). `calibration` has the positions of the cells. `poses`
    requests each foot's live position at every sample, `body` the wearer's position."""
    known = settings.calibration if calibration is None else merged(settings.calibration, calibration)
    recipe = (
        settings.recipe if settings.activity is None else settings.recipe.replace_part(ActivityPart, settings.activity)
    )
    session = Session(recipe, calibration=known, poses=poses, losses=True)
    recording = load_samples(path)
    samples = list(recording)
    if without_pressure:
        samples = [attrs.evolve(sample, pressure=None) for sample in samples]
    if true_rates:
        samples = with_true_rates(samples)
    walk, wearer = run_session(session, samples, 0.0 if body else None)
    feet = {table.foot: FootRun.of(walk, table.foot) for table in recording.tables}
    return RecordingRun(feet, walk, wearer)


def run_session(session: Session, samples: Iterable[Sample], interval: float | None) -> tuple[Walk, BodyRun]:
    """Return the session's events for the samples, and the wearer's track.

    The track has a position every `interval` s, or after every sample when that is 0. With None there is no track."""
    events: list[Event] = []
    positions: list[Position] = []
    for sample in samples:
        events += session.feed(sample)
        due = interval is not None and (interval == 0.0 or sample.t >= len(positions) * interval)
        if due and (position := session.position) is not None:
            positions.append(position)
    track = BodyRun()
    if positions:
        t, places = np.array([one.t for one in positions]), np.array([one.position for one in positions])
        covariances = np.array([one.covariance for one in positions])[:, [0, 1, 3]]
        track = BodyRun(t=t, positions=places, covariances=covariances)
    return Walk.of(events + session.finish()), track


Meta = dict[str, Any]
"""A recording's entry in dataset.json."""
Arrays = dict[str, Any]
"""Arrays of a recording's file by name."""


def truth_of(path: Path) -> Arrays:
    """Return the arrays of the truth (names with gt_), the times and the pressure in a recording's file."""
    return read_arrays(path, lambda key: key == "t" or key.startswith(("t_", "gt_", "pressure")))
