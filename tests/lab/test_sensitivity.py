"""The table of docs/settings.md: each number of detector, filter and cues at half and at twice its value."""

from __future__ import annotations

import json
import re
from math import radians
from pathlib import Path

import attrs
import numpy as np
import pytest
from quoted import NUMBER, below
from walks import columns_of

from solepath.calibration import Calibration
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.foot.cues import inertial
from solepath.foot.settings import CycleSettings, ErrorStateSettings
from solepath.lab.evaluate.jobs import EvaluationJob, find_data_sets, recordings
from solepath.lab.evaluate.run import Meta, RunSettings
from solepath.lab.evaluate.sensitivity import FACTORS, TABLE_COLUMNS, SensitivityJob, columns, evaluate, numbers, table
from solepath.lab.measures.score import Scored
from solepath.recipes import DEFAULT
from solepath.types import Foot

NUMBERS = {number.name: number for number in numbers()}


def test_every_number_of_detector_and_filter_is_in_the_table_with_its_meaning() -> None:
    for cls in (CycleSettings, ErrorStateSettings):
        for name, value in attrs.asdict(cls()).items():
            if isinstance(value, float):
                assert NUMBERS[name].value == value and NUMBERS[name].meaning, name


def test_the_page_has_each_number_with_its_value_and_its_meaning() -> None:
    rows = [[cell.strip() for cell in line.split("|")[1:]] for line in below("settings")[3:]]
    assert [row[:3] for row in rows] == [[f"{n.part} `{n.name}`", f"{n.value:g}", n.meaning] for n in numbers()]
    assert {len(row) for row in rows} == {4 + len(TABLE_COLUMNS)}


def test_a_setting_at_twice_its_value_is_a_recipe_of_its_own() -> None:
    recipe, constants = NUMBERS["innovation_gate"].scale(2.0)
    assert recipe.corrector.settings == ErrorStateSettings(innovation_gate=2.0 * ErrorStateSettings().innovation_gate)
    assert (recipe.detector, constants) == (DEFAULT.detector, {})


def score(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """The value of the constant while a recording is scored."""
    return Scored(path.name, {"past_peak": inertial.TOE_OFF_RATE_RATIO})


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_constant_is_changed_while_a_recording_is_scored_and_then_as_before(factor: float) -> None:
    before = inertial.TOE_OFF_RATE_RATIO
    recipe, constants = NUMBERS["TOE_OFF_RATE_RATIO"].scale(factor)
    job = SensitivityJob(EvaluationJob(score, RunSettings(recipe, Calibration(), None), Path("walk"), {}), constants)
    scored = job.run()
    assert isinstance(scored, Scored) and scored.figures == {"past_peak": factor * before}
    restored = inertial.TOE_OFF_RATE_RATIO
    assert restored == before


def test_a_line_has_the_change_at_half_and_at_twice_the_value() -> None:
    number = NUMBERS["TOE_OFF_RATE_RATIO"]
    columns = [column for column in TABLE_COLUMNS if column.title in ("strides", "HS F1", "ipol HS")]
    default, half, double = [0.02, 0.98, 0.010], [0.021, 0.95, 0.0104], [0.02, 0.98, -0.020]
    lines = list(table(iter([(None, 1.0, default), (number, 0.5, half), (number, 2.0, double)]), columns))
    assert [cell.strip() for cell in lines[2].split("|")][4:-1] == ["2 %", "0.98", "10 ms"]
    assert [cell.strip() for cell in lines[3].split("|")][4:-1] == ["+5 % / 0", "-0.03 / 0", "0 / -30 ms"]


def test_the_factors_are_a_half_and_two() -> None:
    assert FACTORS == (0.5, 2.0)


def test_a_count_stays_a_whole_number_of_at_least_one() -> None:
    count = NUMBERS["OTHER_AXIS_PUSH_OFFS"]
    assert [count.scale(factor)[1] for factor in FACTORS] == [{count.name: 2}, {count.name: 6}]
    assert attrs.evolve(count, value=1).scale(0.5)[1] == {count.name: 1}


def test_the_columns_of_ipol_are_the_offsets_that_they_are_called() -> None:
    figures = {column.title: (column.data_set, column.figure) for column in TABLE_COLUMNS}
    assert figures["ipol HS"] == ("ipol_10m_uturn", "heel_strike_bias")
    assert figures["ipol TO"] == ("ipol_10m_uturn", "toe_off_bias")


@pytest.fixture(scope="module")
def loops(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a data set of one walk around a triangle."""
    route = Route().stand(1.5)
    for _ in range(3):
        route = route.walk(2.5, speed=1.2).turn(radians(120), radius=0.7)
    folder = tmp_path_factory.mktemp("data")
    (folder / "xio_closed_walks").mkdir()
    np.savez(folder / "xio_closed_walks" / "loop.npz", **columns_of(Walker(route.stop(1.0)), Foot.RIGHT))
    about = {"recordings": {"loop": {"closed_loop": True, "path_m_about": route.length}}}
    (folder / "xio_closed_walks" / "dataset.json").write_text(json.dumps(about))
    return folder


def test_half_and_twice_a_number_have_figures_of_their_own(loops: Path) -> None:
    names = ["xio_closed_walks"]
    chosen = [NUMBERS[name] for name in ("sigma", "gyro_noise", "STILLNESS_DEBOUNCE")]
    default, *rows = evaluate(loops, chosen, names, processes=1)
    (data_set,) = find_data_sets(loops, names)
    ((path, meta),) = recordings(loops, data_set)
    assert default == (None, 1.0, [data_set.score(path, meta, RunSettings(DEFAULT)).figures["end_error"]])
    assert [row[:2] for row in rows] == [(number, factor) for number in chosen for factor in FACTORS]
    figures = [figure for _, _, shown in (default, *rows) for figure in shown]
    assert len(set(figures[:5])) == 5 and figures[6] not in figures[:6]  # half of the debounce is below one sample
    assert len(columns(names)) == 1


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.split("|")[1:-1]]


def test_the_page_has_the_header_of_the_table() -> None:
    fresh = list(table(iter([(None, 1.0, [None] * len(TABLE_COLUMNS))]), TABLE_COLUMNS))
    assert below("settings")[:2] == fresh[:2]


def test_the_default_of_the_page_is_the_default_of_the_ablation() -> None:
    page = dict(zip(cells(below("settings")[0]), cells(below("settings")[2]), strict=True))
    head, _, first, *_ = below("ablation")
    compared = 0
    for title, shown in zip(cells(head), cells(first), strict=True):
        for column in TABLE_COLUMNS:
            if f"{column.title} {column.unit}".strip() == title:
                (figure,) = NUMBER.findall(page[column.title])
                last_digit = 10.0 ** -len(shown.partition(".")[2])
                assert float(figure) == pytest.approx(float(shown), abs=0.6 * last_digit), title
                compared += 1
    assert compared == len(TABLE_COLUMNS) - 2


def test_each_cell_of_the_page_is_a_pair_of_changes_in_the_unit_of_its_column() -> None:
    form = {"m": r"0|[+-]\d+ %", "%": r"0|[+-]\d+ %", "": r"0|[+-]\d\.\d\d", "ms": r"0|[+-]\d+ ms"}
    for line in below("settings")[3:]:
        for column, cell in zip(TABLE_COLUMNS, cells(line)[3:], strict=True):
            assert all(re.fullmatch(form[column.unit], part) for part in cell.split(" / ")), f"{column.title}: {cell}"
            assert cell.count(" / ") == 1
