"""Calibrations: a file that is read back as it was written, and one clear sentence for every file that is none."""

from __future__ import annotations

import json
from operator import attrgetter
from pathlib import Path
from typing import Any

import pytest
from here import PROTOCOL
from walks import of, samples

from solepath import (
    Calibration,
    CalibrationError,
    Cell,
    Foot,
    Layout,
    Sample,
    Session,
    Site,
    StrideTaken,
    read_calibration,
    recipes,
)
from solepath.calibration import InsoleCalibration, Limbs, Newtons, SensorCalibration, ShoeGeometry
from solepath.calibration.file import write_calibration
from solepath.calibration.records import TriadCalibration
from solepath.emulate.sensors.insoles import layout
from solepath.events import CellsFailed, Limitation
from solepath.foot.pressure.insole import in_newtons
from solepath.papers import WalkingMode
from solepath.recipes import Recipe
from solepath.types.checking import find_fault

FULL_CALIBRATION = Calibration(
    insoles={
        Foot.LEFT: InsoleCalibration(
            Layout(2, Foot.LEFT, (Cell(0.2, 0.0), Cell(0.03, 0.01)), 0.26, scale=1.0),
            Newtons((0.0, 0.1, 0.0, 0.0)),
            (1.5, 2.5),
        )
    },
    shoe=ShoeGeometry(),
    drift={Foot.LEFT: (0.001, -0.002)},
    sensors={
        Foot.LEFT: SensorCalibration(
            TriadCalibration(
                (1.01, 0.01, 0.0, 0.01, 0.99, 0.0, 0.0, 0.0, 1.0), (0.1, 0.0, 0.2), (1e-3,) * 9, (0.01,) * 3
            ),
            TriadCalibration(
                (0.98, 0.02, 0.0, 0.0, 1.0, 0.0, 0.0, 0.01, 1.0), (0.0, 0.02, 0.0), (1e-3,) * 9, (1e-4,) * 3
            ),
        )
    },
    limbs=Limbs(),
    weight=700.0,
    modes={Foot.RIGHT: {WalkingMode.LEFT_TIGHT: (0.01, -0.02)}},
)


def test_a_calibration_is_read_as_it_was_written(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", FULL_CALIBRATION)
    assert read_calibration(tmp_path / "me.json") == FULL_CALIBRATION


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("not json", "is not JSON"),
        ("[]", "is not a calibration"),
        ('{"format": "solepath-calibration", "version": 3, "calibration": {}}', "version 3"),
        ('{"format": "solepath-calibration", "version": 1, "calibration": {}}', "version 1.*calibrate again"),
        ('{"format": "solepath-calibration", "version": 2, "calibration": {"insols": {}}}', "no field 'insols'"),
        ('{"format": "solepath-calibration", "version": 2}', "expected"),
        *((f'{{"format": "solepath-calibration", "version": 2, "calibration": {text}}}', "bad.json")
          for text in ("null", '{"insoles": {"middle": {}}}', '{"insoles": []}')),
        ("[" * 100_000, "bad.json"),
        ('{"format": ' * 100_000, "bad.json"),
    ],
    ids=lambda text: text[:40],
)  # fmt: skip
def test_what_is_no_calibration_is_rejected_in_one_sentence(tmp_path: Path, text: str, why: str) -> None:
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises(CalibrationError, match=why) as error:
        read_calibration(tmp_path / "bad.json")
    assert "bad.json" in str(error.value) and "\n" not in str(error.value)
    assert "snapshot" not in str(error.value), "no words of the inside"


def test_a_number_that_is_none_is_rejected(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", FULL_CALIBRATION)
    (tmp_path / "me.json").write_text((tmp_path / "me.json").read_text().replace("700.0", "NaN"))
    with pytest.raises(CalibrationError, match="nan"):
        read_calibration(tmp_path / "me.json")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="nowhere.json"):
        read_calibration(tmp_path / "nowhere.json")


def test_the_file_is_as_in_the_protocol(tmp_path: Path) -> None:
    write_calibration(tmp_path / "me.json", FULL_CALIBRATION)
    saved = json.loads((tmp_path / "me.json").read_text())
    assert set(saved) == {"format", "version", "calibration"}
    text = (PROTOCOL / "calibration.md").read_text()
    for key in (*saved["calibration"], *saved["calibration"]["shoe"], *saved["calibration"]["limbs"]):
        assert f"`{key}`" in text


def test_a_raw_value_becomes_newtons_by_the_cubic_within_5_to_200() -> None:
    # 1 + 2 n + 0.5 n^2 + 0.1 n^3 at n = 1, 2, 10, 20: 3.6 is below 5 N; 7.8; 171; 1041 is beyond 200 N
    assert in_newtons(Newtons((1.0, 2.0, 0.5, 0.1)), (1.0, 2.0, 10.0, 20.0)) == (0.0, pytest.approx(7.8), 171.0, 200.0)


def test_a_layout_of_the_calibration_serves_samples_without_a_layout() -> None:
    session = Session(calibration=FULL_CALIBRATION)
    session.feed(Sample(0.0, Site.LEFT_FOOT, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0), (20.0, 30.0)))
    worn = session.feet[Foot.LEFT].sole.insole.layout
    assert worn is not None and worn.length == 0.26


def test_only_a_calibration_is_one() -> None:
    with pytest.raises(TypeError, match="Calibration"):
        Session(calibration="me.json")  # type: ignore[arg-type]


def cells(*at: Cell, length: float = 0.26) -> Calibration:
    return insole(layout=Layout(2, Foot.LEFT, at, length))


def insole(**known: Any) -> Calibration:
    return Calibration(insoles={Foot.LEFT: InsoleCalibration(**known)})


ABSURD_CALIBRATIONS = {
    "shoe.steepest": Calibration(shoe=ShoeGeometry(steepest=1e200)),
    "shoe.pivot_to_toe has 0 values": Calibration(shoe=ShoeGeometry(pivot_to_toe=())),
    "modes.right.LEFT_TIGHT": Calibration(modes={Foot.RIGHT: {WalkingMode.LEFT_TIGHT: (1e200, 0.0)}}),
    "insoles.left.layout has 0 cells": cells(),
}


@pytest.mark.parametrize("key", ABSURD_CALIBRATIONS)
def test_a_calibration_of_what_cannot_be_is_rejected_with_its_file_and_its_key(tmp_path: Path, key: str) -> None:
    write_calibration(tmp_path / "me.json", ABSURD_CALIBRATIONS[key])
    with pytest.raises(CalibrationError, match=key) as error:
        read_calibration(tmp_path / "me.json")
    assert "me.json" in str(error.value) and "\n" not in str(error.value)
    with pytest.raises(ValueError, match=key):
        Session(calibration=ABSURD_CALIBRATIONS[key])


MISSHAPEN: list[tuple[dict[str, Any], str]] = [
    ({"toe_out": {"left": 1.0}}, "toe_out has the key 'left', not of type Foot"),
    ({"toe_out": {Foot.LEFT: 10**5000}}, "toe_out.left is a huge number; it can be -1 to 1 rad"),
    ({"shoe": "brown"}, "shoe is 'brown', not of type ShoeGeometry"),
    ({"drift": {Foot.LEFT: (0.1,)}}, "drift.left has 1 values, not 2"),
    ({"modes": {Foot.LEFT: None}}, "modes.left is None, not of type dict"),
]


@pytest.mark.parametrize(("what", "message"), MISSHAPEN, ids=[message[:40] for _, message in MISSHAPEN])
def test_a_calibration_of_something_else_than_records_is_rejected_by_the_session_in_one_line(
    what: dict[str, Any], message: str
) -> None:
    with pytest.raises(CalibrationError) as error:
        Session(calibration=Calibration(**what))
    assert str(error.value) == f"calibration: {message}"


def test_what_can_be_is_not_rejected() -> None:
    assert find_fault(FULL_CALIBRATION, Calibration) is None
    assert find_fault(Calibration(), Calibration) is None
    for size in (24, 35, 96, 99):
        assert find_fault(insole(layout=layout(size, Foot.LEFT)), Calibration) is None


OF_OTHER_INSOLES = Calibration({foot: InsoleCalibration(layout=layout(35, foot), noise=(0.5,) * 35) for foot in Foot})


TESTED_RECIPES = [recipes.by_name(name) for name in ("zupt", "kupt-dfpc", "default")]


@pytest.mark.parametrize("recipe", TESTED_RECIPES, ids=attrgetter("name"))
def test_a_calibration_of_another_insole_is_named_and_the_walk_goes_on_without_it(recipe: Recipe) -> None:
    items = samples(cells=96, rate=50.0)
    session, bare = Session(recipe, calibration=OF_OTHER_INSOLES), Session(recipe)
    saved, plain = session.feed(items), bare.feed(items)
    assert of(CellsFailed, saved) == []
    left = [event.what for event in of(Limitation, saved) if event.site is Site.LEFT_FOOT]
    assert [what for what in left if "calibration" in what] == [
        "the calibration's layout has 35 cells, the left insole has 96: it is not used",
        "the calibration's noise is of 35 cells, the left insole has 96: it is not used",
    ]
    assert of(StrideTaken, saved) == of(StrideTaken, plain) != []


def test_a_file_without_an_end_or_too_large_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="/dev/zero: is larger than 8 MB"):
        read_calibration("/dev/zero")
    (tmp_path / "large.json").write_bytes(b" " * 20_000_000)
    with pytest.raises(CalibrationError, match="large"):
        read_calibration(tmp_path / "large.json")
