"""The table of recordings damaged on purpose: what is damaged, what a session reports of it, and what is left out."""

from __future__ import annotations

from math import radians
from pathlib import Path

import numpy as np
import pytest
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.events import Defect
from solepath.types import Foot
from solepath_lab.damage.sensors import DefectOutcome, examine, pieces

ROUTE = Route().stand(2.0).walk(26.0, 1.3).turn(radians(180), radius=1.0).walk(10.0, 1.3).stop(1.0)
MIRRORED = [f"{sensor} {axis} mirrored" for sensor in ("gyroscope", "accelerometer") for axis in "xyz"]

Columns = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def columns() -> Columns:
    return columns_of(Walker(ROUTE, seed=5), Foot.RIGHT)


def saved(folder: Path, name: str, columns: Columns) -> Path:
    """Write a walk of the right foot into a folder of data sets; return that folder."""
    (folder / name).mkdir()
    np.savez(folder / name / "walk.npz", **columns)
    return folder


def examined(folder: Path) -> DefectOutcome:
    (piece,) = pieces(folder)
    outcome = examine(piece)
    assert outcome is not None and outcome.piece.foot is Foot.RIGHT
    return outcome


@pytest.fixture(scope="module")
def outcome(columns: Columns, tmp_path_factory: pytest.TempPathFactory) -> DefectOutcome:
    return examined(saved(tmp_path_factory.mktemp("data"), "emulated", columns))


@pytest.mark.long
def test_each_damage_of_a_walk_is_reported_and_the_whole_walk_is_silent(outcome: DefectOutcome) -> None:
    assert outcome.whole == ()
    reported = {name: (hit, delay, names) for name, hit, delay, names in outcome.damaged}
    expected = dict.fromkeys(MIRRORED, Defect.AXES) | {
        "specific force in g": Defect.ACC_UNIT,
        "angular rate in deg/s": Defect.GYRO_UNIT,
        "times in ms": Defect.TIME_UNIT,
        "gravity removed": Defect.NO_GRAVITY,
        "clipped at 2 g and 250 deg/s": Defect.CLIPPED,
        "half the rate, both repeated": Defect.REPEATED,
    }
    assert len(expected) == 12
    for name, defect in expected.items():
        hit, delay, names = reported[name]
        assert hit and defect.name in names, name
        assert delay is not None and -3.0 < delay < 20.0, name
