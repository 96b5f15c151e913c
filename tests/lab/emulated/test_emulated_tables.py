"""Tables of emulated walks: what each kind of evidence earns, and how reliable the weights of places are."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from attrs import evolve

from solepath import Packet, Sample, Site
from solepath.emulate.routes import ways
from solepath.events import Candidate
from solepath.lab.emulated import evidence, reliability
from solepath.lab.emulated.evidence import EVERYTHING, NO_AIR_PRESSURE, NO_GYROSCOPE, NO_HEADING, ONE_FOOT, TABLES
from solepath.lab.emulated.reliability import BINS, WeightBin, count, join
from solepath.lab.train import emulated

SAMPLE = Sample(1.0, Site.RIGHT_FOOT, (0.0, 0.0, 9.8), (0.1, 0.0, 0.0), air_pressure=101325.0)
TAGS = TABLES[-1]


def packet(channel: str) -> Packet:
    return Packet(1.0, Site.LEFT_FOOT, channel, b"")


def test_evidence_is_taken_from_samples_and_from_packets_and_the_rest_stays() -> None:
    gyro, air, acc = map(packet, ("cc2541/gyroscope", "cc2541/barometer", "cc2541/accelerometer"))
    assert NO_GYROSCOPE.remove is not None and NO_AIR_PRESSURE.remove is not None and ONE_FOOT.remove is not None
    assert NO_GYROSCOPE.remove(SAMPLE) == evolve(SAMPLE, gyro=None)
    assert [NO_GYROSCOPE.remove(one) for one in (gyro, air, acc)] == [None, air, acc]
    assert NO_AIR_PRESSURE.remove(SAMPLE) == evolve(SAMPLE, air_pressure=None)
    assert [NO_AIR_PRESSURE.remove(one) for one in (gyro, air, acc)] == [gyro, None, acc]
    assert [ONE_FOOT.remove(one) for one in (SAMPLE, acc)] == [None, acc]


@pytest.fixture
def short_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten the routes: each flight and ride once, and one corner of the corridors before the exit."""
    monkeypatch.setattr(emulated, "REPEATS", 1)
    monkeypatch.setattr(ways, "MIN_CORNERS", 1)
    monkeypatch.setattr(ways, "MAX_CORNERS", 1)


@pytest.mark.usefixtures("short_ways")
def test_a_row_without_evidence_is_scored_beside_that_with_everything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = evolve(TAGS, rows=(EVERYTHING, NO_GYROSCOPE, NO_HEADING))
    evidence.main(["--walks", "1", "--seed", "5001", "--json", str(tmp_path / "figures.json")], [short])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split("|")[1].strip() for line in lines[2:]] == ["everything", "no gyroscope", "no first heading"]
    assert lines[2] != lines[3] and " of 1 |" in lines[2]
    assert lines[4].split("|")[2:6] == ["  "] * 4, "activities do not use the heading"
    (rows,) = json.loads((tmp_path / "figures.json").read_text())["tables"].values()
    assert rows["everything"]["accuracy"] > 0.95 > rows["no gyroscope"]["accuracy"] > 0.5
    assert rows["everything"]["rides_true"] == 2 and rows["everything"]["place_mean"] > 0.0
    assert rows["no gyroscope"]["place_mean"] is None, "no turn is found, so that no stride is scored"


def test_candidates_near_a_heavier_one_on_its_level_are_one_place() -> None:
    first, near, above, far = [
        Candidate(level, (x, 0.0, 0.0), None, weight, "start")
        for level, x, weight in (("0", 0.0, 0.4), ("0", 2.0, 0.3), ("1", 0.0, 0.2), ("0", 4.0, 0.1))
    ]
    assert join([first, near, above, far]) == [[first, near], [above], [far]]


def test_weights_are_counted_in_bins_and_the_only_place_by_itself() -> None:
    bins = count([(7, [(0.25, False, False), (0.75, False, True)]), (8, [(1.0, True, True), (0.25, False, True)])])
    assert [k for k, one in enumerate(bins) if one.count] == [2, 7, BINS]
    assert bins[2] == WeightBin(2, 1, 0.5, {7, 8}) and bins[2].mean_weight == 0.25 and bins[2].share_true == 0.5
    assert bins[BINS] == WeightBin(1, 1, 1.0, {8})


@pytest.mark.usefixtures("short_ways")
def test_the_weights_of_a_stride_without_a_known_start_add_up_to_one() -> None:
    bins = count([(5001, reliability.scored_places("footstep-tracker", 5001, apart=False))])
    for k, one in enumerate(bins[:BINS]):
        assert one.mean_weight is None or k / BINS <= one.mean_weight <= (k + 1) / BINS
        assert 0 <= one.true <= one.count
    strides = sum(one.weight_sum for one in bins)
    assert strides == pytest.approx(round(strides), abs=1e-6) and strides > 50
    lines = reliability.table({"footstep-tracker": [WeightBin(4, 3, 2.0, {1, 2}) for _ in range(BINS + 1)]})
    assert lines[2] == "| 0.0 to 0.1 | 0.500: 0.750 (4 in 2) |" and lines[-1].startswith("| the only one |")
