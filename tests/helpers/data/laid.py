"""An emulated walk as people's tables have it: raw counts, bursts, several devices, no names, a broken sensor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from exported import columns

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot

LENGTH = 20.0
"""Length of the walk, m."""
NAMES = ["t", "ax", "ay", "az", "gx", "gy", "gz"]
COLUMNS = "t=t,acc=ax,ay,az,gyro=gx,gy,gz"
UNTIMED = "acc=ax,ay,az,gyro=gx,gy,gz"


@cache
def walked(foot: Foot = Foot.LEFT, rate: float = 100.0, speed: float = 1.3) -> np.ndarray:
    """Return rows of time (s), specific force (g) and angular rate (deg/s) of one foot."""
    route = Route().stand(2.0).walk(LENGTH, speed=speed).stop(1.5)
    t, acc, gyro = columns(tuple(Walker(route, seed=3).samples(foot, rate, LSM6DSOX)))
    return np.column_stack([t, acc, gyro])


def table(path: Path, names: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    lines = [",".join(str(float(cell)) if isinstance(cell, np.floating) else str(cell) for cell in row) for row in rows]
    path.write_text("\n".join([*([",".join(names)] if names else []), *lines]) + "\n")
    return path


def distance(stdout: str, foot: str = "left") -> float:
    """Return the distance of a foot in the summary of `track`."""
    (line,) = [line for line in stdout.splitlines() if line.startswith(f"{foot} ") and len(line.split()) == 9]
    return float(line.split()[4])
