"""Calibrations: a file that is read back as it was written, and one clear sentence for every file that is none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from solepath import (
    Calibration,
    CalibrationError,
    Cell,
    Foot,
    Layout,
    Sample,
    Session,
    Site,
    WalkingMode,
    read_calibration,
)
from solepath.calibration import InsoleCalibration, Limbs, Newtons, ShoeGeometry, merged, write_calibration
from solepath.foot.pressure import in_newtons

WHOLE = Calibration(
    insoles={
        Foot.LEFT: InsoleCalibration(
            Layout(2, Foot.LEFT, (Cell(0.2, 0.0), Cell(0.03, 0.01)), 0.26, scale=1.0),
            Newtons((0.0, 0.1, 0.0, 0.0)),
            (1.5, 2.5),
        )
    },
    shoe=ShoeGeometry(),
    drift={Foot.LEFT: (0.001, -0.002)},
    limbs=Limbs(),
    weight=700.0,
    modes={Foot.RIGHT: {WalkingMode.LEFT_TIGHT: (0.01, -0.02)}},
)


def test_a_calibration_is_read_as_it_was_written(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", WHOLE)
    assert read_calibration(tmp_path / "me.json") == WHOLE


def test_a_newer_part_takes_the_place_of_the_older_and_the_rest_stays() -> None:
    newer = Calibration(insoles={Foot.LEFT: InsoleCalibration(noise=(9.0, 9.0))}, weight=800.0)
    both = merged(WHOLE, newer)
    assert both.insoles[Foot.LEFT].noise == (9.0, 9.0)
    assert both.insoles[Foot.LEFT].newtons == WHOLE.insoles[Foot.LEFT].newtons
    assert (both.weight, both.drift, both.shoe) == (800.0, WHOLE.drift, WHOLE.shoe)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("not json", "is not JSON"),
        ("[]", "is not a calibration"),
        ('{"format": "solepath-calibration", "version": 2, "calibration": {}}', "version 2"),
        ('{"format": "solepath-calibration", "version": 1, "calibration": {"insols": {}}}', "fields"),
        ('{"format": "solepath-calibration", "version": 1}', "expected"),
    ],
)
def test_what_is_no_calibration_is_refused_in_one_sentence(tmp_path: Path, text: str, why: str) -> None:
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises(CalibrationError, match=why) as refused:
        read_calibration(tmp_path / "bad.json")
    assert "bad.json" in str(refused.value) and "\n" not in str(refused.value)


def test_a_number_that_is_none_is_refused(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", WHOLE)
    (tmp_path / "me.json").write_text((tmp_path / "me.json").read_text().replace("700.0", "NaN"))
    with pytest.raises(CalibrationError, match="nan"):
        read_calibration(tmp_path / "me.json")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="nowhere.json"):
        read_calibration(tmp_path / "nowhere.json")


def test_the_file_is_as_the_protocol_says(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", WHOLE)
    told = json.loads((tmp_path / "me.json").read_text())
    assert set(told) == {"format", "version", "calibration"}
    text = (Path(__file__).parents[1] / "protocol" / "calibration.md").read_text()
    for key in (*told["calibration"], *told["calibration"]["shoe"], *told["calibration"]["limbs"]):
        assert f"`{key}`" in text


def test_a_raw_value_becomes_newtons_by_the_cubic_within_5_to_200() -> None:
    # 1 + 2 n + 0.5 n^2 + 0.1 n^3 at n = 1, 2, 10, 20: 3.6 is below 5 N; 7.8; 171; 1041 is beyond 200 N
    assert in_newtons(Newtons((1.0, 2.0, 0.5, 0.1)), (1.0, 2.0, 10.0, 20.0)) == (0.0, pytest.approx(7.8), 171.0, 200.0)


def test_a_layout_of_the_calibration_serves_samples_that_do_not_say_where_their_cells_are() -> None:
    session = Session(calibration=WHOLE)
    session.feed(Sample(0.0, Site.LEFT_FOOT, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0), (20.0, 30.0)))
    layout = session.feet[Foot.LEFT].insole.layout
    assert layout is not None and layout.length == 0.26


def test_only_a_calibration_is_one() -> None:
    with pytest.raises(TypeError, match="Calibration"):
        Session(calibration="me.json")  # type: ignore[arg-type]
