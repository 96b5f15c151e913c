"""`solepath-lab reproduce`: the statistics by hand, the papers' own figures, and a short run from end to end."""

import json
import re
from pathlib import Path

import attrs
import pytest
from commands import run, run_failing

from solepath.papers.walking_modes.compensation import TABLE_1
from solepath_lab.command import main as lab
from solepath_lab.emulated.laps import straight
from solepath_lab.reproduce import kupt_dfpc, shoe_sensing
from solepath_lab.reproduce.command import NAMES
from solepath_lab.reproduce.contour.walks import LOOPS
from solepath_lab.reproduce.kupt import walks as kupt_walks
from solepath_lab.reproduce.shoe import walks as shoe_walks
from solepath_lab.reproduce.tables import CLAIMS, PUBLISHED, Reproduction, Statistics, statistics

FIVE = ["mean", "std", "q1", "median", "q3"]


def test_the_five_statistics_of_five_walks_are_those_of_a_pencil():
    # deviations -2, -1, 0, 1, 2: squares 10, over n - 1 = 4; quartiles are the second and the fourth
    assert statistics([21.0, 18.0, 20.0, 19.0, 22.0]) == Statistics(20.0, 2.5**0.5, 19.0, 20.0, 21.0)
    assert statistics([20.5]) == Statistics(20.5, None, 20.5, 20.5, 20.5)
    assert statistics([]) == Statistics()


def test_the_papers_own_figures_are_those_that_they_print():
    paper = Reproduction("kupt-dfpc", "", "m", ()).paper
    assert paper["ZUPT-L"] == Statistics(20.97, 1.84, 19.74, 21.17, 22.56)
    assert paper["KUPT+DFPC"] == Statistics(20.08, 0.51, 19.74, 20.06, 20.46)
    assert (len(LOOPS), round(sum(LOOPS) / 6)) == (6, 1215)
    contours = PUBLISHED["pressure-contour"]
    for row, column in (("Gyroscope", 1), ("Pressure", 2)):
        for unit, of_loops in (
            ("m", [loop[column] for loop in contours["loops"]]),
            ("%", [100.0 * loop[column] / loop[0] for loop in contours["loops"]]),
        ):
            assert contours["rows"][f"{row} {unit}"] == pytest.approx(attrs.astuple(statistics(of_loops)), abs=1e-4)
    assert [round(value, 2) for value in contours["rows"]["Gyroscope m"][:2]] == [4.87, 2.75]
    assert [round(value, 2) for value in contours["rows"]["Pressure m"][:2]] == [4.30, 3.15]
    for foot, modes in TABLE_1.items():
        for mode, (ahead, left) in modes.items():
            for axis, value in (("x", -left), ("y", ahead)):
                row = PUBLISHED["walking-modes"]["rows"][f"table 1 {foot.value} {mode.value} {axis}"]
                assert row == [pytest.approx(value)]


PAGES = Path(__file__).parents[3] / "docs" / "papers"


@pytest.mark.parametrize("name", ["kupt-dfpc", "pressure-contour", "shoe-sensing"])
def test_a_page_compares_what_the_command_compares(name):
    table = (PAGES / f"{name}.md").read_text(encoding="utf-8").partition("| claim | margin")[2].partition("\n\n")[0]
    shown = [line.split("|")[1].strip() for line in table.splitlines()[2:]]
    claims = [f"{title}{claim['claim']}" for claim in CLAIMS[name] for title in claim.get("of", [""])]
    assert sorted(shown) == sorted(claims)


@pytest.mark.long
@pytest.mark.parametrize("name", ["kupt-dfpc", "shoe-sensing"])
def test_the_fewest_walks_give_a_table_json_and_a_figure_and_are_not_walked_again(tmp_path, name, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(kupt_walks, "CORRIDOR_LENGTH", 20.0)
    monkeypatch.setattr(kupt_walks, "NOISE_WALK", straight(6.0, kupt_walks.SPEED).stand(4.0))
    monkeypatch.setattr(kupt_dfpc, "SETTINGS", ())
    monkeypatch.setattr(shoe_sensing, "SETUPS", shoe_sensing.SETUPS[:1])
    monkeypatch.setattr(shoe_walks, "LAPS", 1)
    monkeypatch.chdir(tmp_path)
    options = ("reproduce", name, "--walks", 1, "--seed", 3, "--processes", 1, "--resume", "walks.jsonl")
    # the figure is named after the experiment when nothing is said
    done = run(*options, "--json", "table.json", "--figure", program=lab)
    assert done.returncode == 0 and re.fullmatch(r"(\d+) of \1: .+", done.stderr.splitlines()[-1])
    assert f"{name}: ours is emulated" in done.stdout
    assert done.stdout.endswith(f"figure drawn in {name}.png\n")
    assert Path(f"{name}.png").read_bytes().startswith(b"\x89PNG")
    table = json.loads(Path("table.json").read_text(), parse_constant=pytest.fail)
    assert list(table) == ["name", "emulated", "table", "paper", "claims"]
    assert table["name"] == name and table["emulated"] is True
    assert list(table["table"]) == list(table["paper"])
    assert all(list(of) == FIVE for part in ("table", "paper") for of in table[part].values())
    assert all(of["mean"] is not None for of in table["table"].values())
    again = run(*options, program=lab)
    assert re.fullmatch(r"(\d+) of \1 were already done\n", again.stderr)
    assert done.stdout.startswith(again.stdout) and len(again.stdout) > 500


def test_what_is_wrong_is_rejected_in_one_line_before_the_walks_start(tmp_path):
    names = ", ".join(NAMES)
    far, near = (run_failing("reproduce", name, program=lab) for name in ("xyzzy", "kupt"))
    assert far == f"solepath: there is no experiment 'xyzzy'; there are: {names}\n"
    assert near == "solepath: there is no experiment 'kupt': did you mean kupt-dfpc?\n"
    nowhere = tmp_path / "none" / "table.json"
    assert f"{nowhere}: there is no folder" in run_failing("reproduce", "kupt-dfpc", "--json", nowhere, program=lab)
    assert list(tmp_path.iterdir()) == []
