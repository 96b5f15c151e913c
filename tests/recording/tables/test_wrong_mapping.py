"""A mapping with wrong axes, signs or units, or of a force without gravity, is caught by `solepath check`."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from commands import run
from exported import columns, write
from soak import soaked

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot

LOOP = np.radians(270.0)
ROUTE = Route().stand(2.0).walk(5.0, speed=1.3).turn(LOOP, radius=1.5).turn(-LOOP, radius=1.5).walk(8.0).stop(1.5)
"""A figure of eight: on a straight way some axes that are wrong cannot be told from others."""
NAMES = "Time (s),AX,AY,AZ,GX,GY,GZ"
RIGHT = "t=Time (s),acc=AX,AY,AZ,gyro=GX,GY,GZ"
UNITS = "g,deg/s"


@pytest.fixture(scope="module")
def walker() -> Walker:
    return Walker(ROUTE, seed=11)


def written(path: Path, walker: Walker, change: Callable[[np.ndarray], np.ndarray] = lambda same: same) -> Path:
    """Write the walk of the left foot as a table in g and deg/s, with its forces changed."""
    t, acc, gyro = columns(walker.samples(Foot.LEFT, 100.0, LSM6DSOX))
    rows = np.column_stack([t, change(acc), gyro])
    return write(path, [NAMES, *(",".join(f"{value:.6f}" for value in row) for row in rows)])


WRONG_AXES = {"two axes of the gyroscope exchanged": "gyro=GY,GX,GZ", "a left-handed accelerometer": "acc=AX,AY,-AZ"}


@pytest.mark.parametrize("wrong", [*WRONG_AXES][:1] + soaked(*[*WRONG_AXES][1:]))
def test_wrong_axes_are_caught_and_the_line_that_is_offered_repairs_them(
    wrong: str, walker: Walker, tmp_path: Path
) -> None:
    path = written(tmp_path / "left.csv", walker)
    key = WRONG_AXES[wrong].partition("=")[0]
    text = re.sub(rf"{key}=[^=]*(?=,\w+=|$)", WRONG_AXES[wrong], RIGHT)
    done = run("check", path, "--columns", text, "--units", UNITS)
    assert done.returncode == 1 and "the axes of the gyroscope do not fit those of the accelerometer" in done.stdout
    (offer,) = re.findall(r"repair, if the gyroscope is wrong: (--columns .*)", done.stdout)
    again = run("check", path, *shlex.split(offer), "--units", UNITS)
    assert again.returncode == 0, again.stdout
