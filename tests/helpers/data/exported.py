"""An emulated walk written as the programs of known devices write it (solepath.recording.exports has the sources)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path

import numpy as np

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Sample

G = 9.80665
LENGTH = 12.0
"""Length of the walk, m."""
ROUTE = Route().stand(2.0).walk(LENGTH, speed=1.3).stop(1.5)


@cache
def walked(foot: Foot, rate: float = 100.0, cells: int = 0) -> tuple[Sample, ...]:
    """Return the samples of one foot of the walk, with the errors of an LSM6DSOX."""
    where = layout(cells, foot) if cells else None
    return tuple(Walker(ROUTE, seed=3).samples(foot, rate, LSM6DSOX, layout=where))


def columns(samples: Sequence[Sample]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times (s), specific force (g) and angular rate (deg/s)."""
    t, acc, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("t", "acc", "gyro"))
    return t, acc / G, np.degrees(gyro)


def write(path: Path, lines: Iterable[str], encoding: str = "utf-8") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(line + "\n" for line in lines), encoding=encoding)
    return path


def strange(folder: Path, foot: Foot, **changed: Callable[[np.ndarray], np.ndarray]) -> Path:
    """Write a table of no known format: semicolons, decimal commas, ms, g and deg/s, with other axes and lines above.

    `acc`, `gyro`: functions that change the columns before they are written."""
    t, acc, gyro = columns(walked(foot))
    acc, gyro = (changed.get(name, lambda same: same)(values) for name, values in (("acc", acc), ("gyro", gyro)))
    head = ["Labor 7;;;;;;", "Proband;S 12;;;;;", "Zeit;Beschl X;Beschl Y;Beschl Z;Gyro X;Gyro Y;Gyro Z"]
    rows = (
        ";".join(f"{v:.5f}" for v in (1e3 * s, *a, *w)).replace(".", ",") for s, a, w in zip(t, acc, gyro, strict=True)
    )
    return write(folder / f"{foot.value}.csv", [*head, *rows], "latin-1")
