"""The truth in a recording's file, and the scores of a session that never saw it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..measures.score import Scored
from .run import RecordingRun

Meta = dict[str, Any]
"""A recording's entry in dataset.json."""
Arrays = dict[str, Any]


def truth_of(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files if key == "t" or key.startswith(("t_", "gt_", "pressure"))}


def scored(path: Path, went: RecordingRun, **parts: Any) -> Scored:
    return Scored(path.stem, samples=went.samples, seconds=went.seconds, **parts)
