"""Storage files of OpenSim: OpenSim itself reads them, and finds the poses of the session."""

from math import cos, sin
from pathlib import Path

import pytest

from solepath import Phase, Sample, Site
from solepath.recording.posed import PosedSample, PoseState
from solepath.show.opensim import LONGEST_INTERVAL, OpensimWriter, Quantity

opensim = pytest.importorskip("opensim", reason="the extra opensim is not installed")

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
SPIN = 2.0
"""Angular rate of the turning foot about the vertical, rad/s."""


def posed(t: float, site: Site = LEFT) -> PosedSample:
    """Return the pose at `t` of a foot that turns at a constant rate and walks straight on at 1 m/s, 0.1 m up."""
    attitude = (cos(SPIN * t / 2), 0.0, 0.0, sin(SPIN * t / 2))
    return PosedSample(Sample(t, site), PoseState((t, 0.2, 0.1), (1.0, 0.0, 0.0), attitude, Phase.SWING))


def written(path: Path, quantity: Quantity, samples: list[PosedSample]) -> Path:
    writer = OpensimWriter(quantity)
    for sample in samples:
        writer.add(sample)
    writer.write(path)
    return path


def rows(table) -> list[tuple[float, list]]:
    """Return the time and the values of each row, as OpenSim read them."""
    columns = range(table.getNumColumns())
    return [
        (t, [table.getRowAtIndex(i).getElt(0, column) for column in columns])
        for i, t in enumerate(table.getIndependentColumn())
    ]


def test_attitudes_between_samples_lie_on_the_turn_of_the_foot(tmp_path):
    samples = [posed(0.01 * k) for k in range(101)] + [posed(0.013 * k + 0.0047, RIGHT) for k in range(80)]
    table = opensim.TimeSeriesTableQuaternion(str(written(tmp_path / "walk.sto", Quantity.ATTITUDES, samples)))
    assert list(table.getColumnLabels()) == ["calcn_l_imu", "calcn_r_imu"]
    assert float(table.getTableMetaDataString("DataRate")) == pytest.approx(100.0)
    found = rows(table)
    assert len(found) == 100
    for t, attitudes in found:
        for attitude in attitudes:
            # a turn about the vertical, which is y in OpenSim's ground, of a sensor whose z points upwards
            ahead = opensim.Rotation(attitude).multiply(opensim.Vec3(1, 0, 0))
            up = opensim.Rotation(attitude).multiply(opensim.Vec3(0, 0, 1))
            assert ahead.to_numpy() == pytest.approx([cos(SPIN * t), 0.0, -sin(SPIN * t)], abs=1e-9)
            assert up.to_numpy() == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)


def test_nothing_is_interpolated_over_a_gap(tmp_path):
    times = [0.01 * k for k in range(100) if not 30 < k < 60]
    samples = [posed(0.01 * k) for k in range(100)] + [posed(t, RIGHT) for t in times]
    table = opensim.TimeSeriesTableVec3(str(written(tmp_path / "a.sto", Quantity.POSITIONS, samples)))
    found = rows(table)
    assert not [t for t, _ in found if 0.301 < t < 0.599]
    assert len(found) == pytest.approx(71, abs=2)
    assert LONGEST_INTERVAL < 0.3
    for t, positions in found:  # forward is x, up is y, and to the left is -z
        assert [list(one.to_numpy()) for one in positions] == [pytest.approx([t, 0.1, -0.2])] * 2
