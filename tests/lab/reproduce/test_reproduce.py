"""`solepath reproduce`: the statistics by hand, the papers' own figures, and the commands from end to end."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from commands import run, run_failing

from solepath.cli.reproduce import NAMES
from solepath.emulate.routes import ways
from solepath.lab.processes import run_jobs
from solepath.lab.reproduce import footstep_tracker, kupt_dfpc, pressure_contour, shoe_sensing, walking_modes
from solepath.lab.reproduce.footstep import turning
from solepath.lab.reproduce.kupt import walks as kupt_walks
from solepath.lab.reproduce.published import CORNERS, KUPT_DFPC, LOOPS, PRESSURE_CONTOUR, WALKING_MODES, corner_row
from solepath.lab.reproduce.shoe import walks as shoe_walks
from solepath.lab.reproduce.tables import (
    BoxPlots,
    DrawStyle,
    FigureRow,
    FloorPanel,
    PictureTrack,
    Reproduction,
    Statistics,
    as_json,
    statistics,
)
from solepath.lab.tables.comparison import comparison_with_paper
from solepath.lab.train import emulated
from solepath.types.extras import install_hint

FIVE = ["mean", "std", "q1", "median", "q3"]


def test_the_five_statistics_of_five_walks_are_those_of_a_pencil():
    # deviations -2, -1, 0, 1, 2: squares 10, over n - 1 = 4; quartiles are the second and the fourth
    assert statistics([21.0, 18.0, 20.0, 19.0, 22.0]) == Statistics(20.0, 2.5**0.5, 19.0, 20.0, 21.0)


def test_one_walk_has_no_deviation_and_none_has_nothing():
    assert statistics([20.5]) == Statistics(20.5, None, 20.5, 20.5, 20.5)
    assert statistics([]) == Statistics()


def test_jobs_are_done_in_order_and_their_progress_is_reported(capsys):
    progress = []
    assert list(run_jobs(abs, [-3, 2, -1], progress=lambda done, of: progress.append((done, of)))) == [3, 2, 1]
    assert progress == [(1, 3), (2, 3), (3, 3)]
    assert list(run_jobs(abs, [-3, 2, -1], processes=2)) == [3, 2, 1]


def test_table_one_of_the_known_velocities_is_the_papers():
    assert list(KUPT_DFPC) == ["ZUPT-L", "ZUPT-R", "KUPT-L", "KUPT-R", "KUPT+DFPC"]
    assert KUPT_DFPC["ZUPT-L"] == Statistics(20.97, 1.84, 19.74, 21.17, 22.56)
    assert KUPT_DFPC["KUPT+DFPC"] == Statistics(20.08, 0.51, 19.74, 20.06, 20.46)


def test_the_six_loops_come_to_the_means_and_deviations_that_the_paper_prints():
    assert (len(LOOPS), round(sum(loop.distance for loop in LOOPS) / 6)) == (6, 1215)
    printed = {name: (round(of.mean, 2), round(of.std, 2)) for name, of in PRESSURE_CONTOUR.items()}
    assert printed["Gyroscope m"] == (4.87, 2.75) and printed["Pressure m"] == (4.30, 3.15)


def test_table_four_of_the_walking_modes_has_two_axes_of_four_methods_at_four_corners():
    assert list(CORNERS) == list("ABCD") and all(list(by) == ["I", "II", "III", "IV"] for by in CORNERS.values())
    assert len(WALKING_MODES) == 32
    assert WALKING_MODES[corner_row("B", "IV", "y")] == Statistics(mean=-0.0208, std=0.0198, median=-0.0204)


TWO_ROWS = Reproduction(
    name="kupt-dfpc",
    paper_title="a paper, table I",
    emulation="2 walks",
    unit="m",
    rows=(
        FigureRow("ZUPT-L", (19.0, 21.0), Statistics(20.97, 1.84, 19.74, 21.17, 22.56)),
        FigureRow("other", (1.0,), Statistics(3.0)),
    ),
    panels=(
        BoxPlots("distances", ("ZUPT-L", "other"), "m", 20.0),
        FloorPanel(
            "the way",
            (
                PictureTrack("true", ((0.0, 0.0), (1.0, 0.0)), DrawStyle.TRUTH),
                PictureTrack("ours", ((0.0, 0.1),), DrawStyle.DOTS),
                PictureTrack("line", ((0.0, 0.0), (1.0, 0.1))),
            ),
            marks=(("start", 0.0, 0.0),),
        ),
    ),
    notes=("A note.",),
)  # fmt: skip


def test_the_json_has_the_form_of_the_design():
    assert as_json(TWO_ROWS) == {
        "name": "kupt-dfpc",
        "emulated": True,
        "table": {
            "ZUPT-L": {"mean": 20.0, "std": 2.0**0.5, "q1": 19.5, "median": 20.0, "q3": 20.5},
            "other": {"mean": 1.0, "std": None, "q1": 1.0, "median": 1.0, "q3": 1.0},
        },
        "paper": {
            "ZUPT-L": {"mean": 20.97, "std": 1.84, "q1": 19.74, "median": 21.17, "q3": 22.56},
            "other": {"mean": 3.0, "std": None, "q1": None, "median": None, "q3": None},
        },
    }


def test_our_figures_stand_beside_the_papers_and_are_marked_as_emulated():
    first, _, header, _, row, other, _, note = comparison_with_paper(TWO_ROWS).splitlines()
    assert "ours is emulated" in first and "a paper, table I" in first
    assert header.split() == ["m", "ours:", *FIVE, "paper:", *FIVE]
    assert " ".join(row.split()) == "ZUPT-L 20.00 1.41 19.50 20.00 20.50 20.97 1.84 19.74 21.17 22.56"
    assert " ".join(other.split()) == "other 1.00 - 1.00 1.00 1.00 3.00 - - - -"
    assert note == "A note."


@pytest.mark.parametrize(("ending", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_boxes_and_floors_are_drawn_in_the_format_that_the_ending_names(tmp_path, ending, magic):
    figures = pytest.importorskip("solepath.lab.tables.figures", exc_type=ImportError)
    figures.draw(TWO_ROWS, tmp_path / f"figure.{ending}", ending)
    assert (tmp_path / f"figure.{ending}").read_bytes().startswith(magic)


LONGEST = ("footstep-tracker", "walking-modes", "pressure-contour", "shoe-sensing")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.soak if name in LONGEST else ()) for name in NAMES]
)
def test_the_fewest_walks_give_a_table_json_and_a_figure(tmp_path, name, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(pressure_contour, "WALK_DURATION", 60.0)
    monkeypatch.setattr(pressure_contour, "SHORT_DURATION", 30.0)
    monkeypatch.setattr(pressure_contour, "SETUPS", pressure_contour.SETUPS[:2])
    monkeypatch.setattr(pressure_contour, "CALIBRATION_LAPS", 3)
    monkeypatch.setattr(walking_modes, "MARKED_STEPS", 10)
    monkeypatch.setattr(walking_modes, "MARKED_REPEATS", 1)
    monkeypatch.setattr(turning, "TURNS_PER_CLASS", 1)
    monkeypatch.setattr(turning, "TURN_ANGLES", turning.TURN_ANGLES[:2])
    monkeypatch.setattr(footstep_tracker, "SETTINGS", footstep_tracker.SETTINGS[-1:])
    monkeypatch.setattr(kupt_walks, "CORRIDOR_LENGTH", 30.0)
    monkeypatch.setattr(kupt_dfpc, "CORRIDOR_LENGTH", 30.0)
    monkeypatch.setattr(kupt_dfpc, "SETTINGS", kupt_dfpc.SETTINGS[:1])
    monkeypatch.setattr(shoe_sensing, "SETUPS", shoe_sensing.SETUPS[:1])
    monkeypatch.setattr(shoe_walks, "LAPS", 1)
    monkeypatch.setattr(shoe_walks, "MANY_ROUNDS", 3)
    monkeypatch.setattr(emulated, "REPEATS", 1)
    monkeypatch.setattr(ways, "MIN_CORNERS", 1)
    monkeypatch.setattr(ways, "MAX_CORNERS", 1)
    monkeypatch.chdir(tmp_path)
    json_path, figure = Path("table.json"), Path(f"{name}.png")
    options = ("--walks", 1, "--seed", 3, "--processes", 1, "--json", json_path)
    done = run("reproduce", name, *options, "--figure")  # named after the experiment when nothing is said
    assert done.returncode == 0 and re.fullmatch(r"(\d+) of \1: .+", done.stderr.splitlines()[-1])
    assert f"{name}: ours is emulated" in done.stdout
    assert done.stdout.endswith(f"figure drawn in {figure}\n") and figure.read_bytes().startswith(b"\x89PNG")
    table = json.loads(json_path.read_text(), parse_constant=pytest.fail)
    assert list(table) == ["name", "emulated", "table", "paper"]
    assert table["name"] == name and table["emulated"] is True
    assert list(table["table"]) == list(table["paper"])
    assert all(list(of) == FIVE for part in ("table", "paper") for of in table[part].values())
    assert all(of["mean"] is not None for of in table["table"].values())
    assert any(of["mean"] is not None for of in table["paper"].values())


def test_an_unknown_experiment_is_rejected_in_one_line():
    assert run_failing("reproduce", "xyzzy") == (
        "solepath: there is no experiment 'xyzzy'; there are: " + ", ".join(NAMES) + "\n"
    )
    assert run_failing("reproduce", "kupt") == "solepath: there is no experiment 'kupt': did you mean kupt-dfpc?\n"


@pytest.mark.parametrize("walks", ["0", "-1", "many", "1.5"])
def test_fewer_than_one_walk_is_rejected(walks):
    done = run("reproduce", "kupt-dfpc", f"--walks={walks}")
    assert done.returncode == 2 and f"'{walks}' is not a number of 1 or more" in done.stderr


def test_an_unwritable_file_is_reported_before_the_walks_start(tmp_path):
    pytest.importorskip("matplotlib")
    nowhere = tmp_path / "none" / "table.json"
    assert f"{nowhere}: there is no folder" in run_failing("reproduce", "kupt-dfpc", "--json", nowhere)
    assert "ends in none of" in run_failing("reproduce", "kupt-dfpc", "--figure", tmp_path / "figure.docx")
    assert list(tmp_path.iterdir()) == []


def test_a_figure_without_matplotlib_is_rejected_in_one_line(tmp_path):
    code = (
        "import sys\nsys.modules['matplotlib'] = None\nimport importlib.util\n"
        "from solepath.cli import main\n"
        f"sys.exit(main(['reproduce', 'kupt-dfpc', '--figure', {str(tmp_path / 'figure.png')!r}]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"solepath: figures need matplotlib: {install_hint('figures')}\n"
