"""`solepath validate`: recordings against one's own truth; the numbers are those of statistics packages."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from hashlib import sha256
from itertools import pairwise
from pathlib import Path
from statistics import fmean, stdev
from typing import Any

import numpy as np
import pandas
import pingouin
import pytest
from commands import rows_in, run, run_failing
from truths import RATE, both_feet, contacts, samples_file, strides, table, walker

from solepath import Foot, Session
from solepath.recording import read_samples
from solepath.recording.text_table import TableError
from solepath.validate import NoMatch, WalkComparison, compare_walks, read_truth
from solepath.validate.agreement_files import agreement_cells

WALK = walker()
Evaluated = Callable[[str, str], Any]
"""Function from a data set and a recipe to the laboratory's result."""


def pair(true: float, found: float, degraded: bool = False) -> dict[str, object]:
    return {"recording": "a", "foot": "left", "parameter": "x_m", "true": true, "found": found, "degraded": degraded}


def only(comparison: WalkComparison):
    """Return the agreement of the only parameter."""
    (row,) = comparison.agreement.itertuples()
    return row


def by_parameter(comparison: WalkComparison) -> dict:
    return {row.parameter: row for row in comparison.agreement.itertuples()}


def stride_truth(path: Path, name: str = "S01", who=WALK, shift: float = 0.0) -> Path:
    rows = [(name, foot, a + shift, b + shift, length) for foot in Foot for a, b, length in strides(who, foot)]
    return table(path, "recording,foot,t_start_s,t_end_s,stride_length_m", rows)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return both_feet(tmp_path_factory.mktemp("walk"), "S01", WALK)


@pytest.fixture(scope="module")
def events(recorded: list[Path]) -> list:
    session = Session()
    return session.feed(read_samples(recorded)) + session.finish()


def test_bias_limits_and_icc_are_those_that_one_computes_by_hand_and_that_pingouin_gives() -> None:
    """Ratings of six targets by two judges: the first two columns of the example of Shrout & Fleiss 1979, table 2."""
    true, found = [9.0, 6.0, 8.0, 7.0, 10.0, 6.0], [2.0, 1.0, 4.0, 1.0, 5.0, 2.0]
    row = only(WalkComparison.of([pair(a, b) for a, b in zip(true, found, strict=True)]))
    differences = np.subtract(found, true)
    assert (row.n, row.bias, row.sd) == (6, pytest.approx(-31 / 6), pytest.approx(differences.std(ddof=1)))
    assert (row.lower, row.upper) == pytest.approx((row.bias - 1.96 * row.sd, row.bias + 1.96 * row.sd))
    # mean squares between targets, between judges and of the rest, and ICC(2,1) of the paper
    ratings = np.array([true, found]).T
    grand, (n, k) = ratings.mean(), ratings.shape
    between = k * ((ratings.mean(1) - grand) ** 2).sum() / (n - 1)
    judges = n * ((ratings.mean(0) - grand) ** 2).sum() / (k - 1)
    rest = (((ratings - grand) ** 2).sum() - between * (n - 1) - judges * (k - 1)) / ((n - 1) * (k - 1))
    assert row.icc == pytest.approx((between - rest) / (between + (k - 1) * rest + k * (judges - rest) / n))


def test_what_is_written_is_what_statistics_packages_say_of_the_pairs(tmp_path: Path, recorded: list[Path]) -> None:
    out = tmp_path / "agreement"
    done = run("validate", stride_truth(tmp_path / "truth.csv"), *recorded, "--out", out)
    assert (done.returncode, done.stderr) == (0, "")
    pairs = pandas.read_csv(out / "pairs.csv")
    written = {row["parameter"]: row for row in rows_in(out / "agreement.csv")}
    assert written.keys() == {"stride_time_s", "stride_length_m"}
    for name, row in written.items():
        matched = pairs[(pairs.parameter == name) & (pairs.degraded == 0)].dropna(subset=["true", "found"])
        differences = matched.found - matched.true
        assert int(row["n"]) == len(matched) > 15
        assert float(row["bias"]) == pytest.approx(differences.mean(), abs=1e-6)
        for end, sign in (("lower", -1.96), ("upper", 1.96)):
            assert float(row[end]) == pytest.approx(differences.mean() + sign * differences.std(), abs=2e-6)
        long = matched.reset_index().melt(id_vars="index", value_vars=["true", "found"])
        table = pingouin.intraclass_corr(long, "index", "variable", "value").set_index("Type")
        assert float(row["icc"]) == pytest.approx(table.loc["ICC(A,1)", "ICC"], abs=1e-6)
    assert abs(float(written["stride_length_m"]["bias"])) < 0.02
    by_foot = rows_in(out / "agreement_groups.csv")
    assert [(row["by"], row["group"]) for row in by_foot] == 2 * [("foot", "left"), ("foot", "right")]
    assert sum(int(row["n"]) for row in by_foot[2:]) == int(written["stride_length_m"]["n"])


def test_every_file_says_how_it_came_about_and_the_page_is_one_file(tmp_path: Path, recorded: list[Path]) -> None:
    truth, out = stride_truth(tmp_path / "truth.csv"), tmp_path / "out"
    run("validate", truth, *recorded, "--out", out)
    made = json.loads((out / "run.json").read_text())
    page = (out / "agreement.html").read_text()
    assert {one["name"] for one in made["inputs"]} == {"truth.csv", "S01_left.csv", "S01_right.csv"}
    for one in made["inputs"]:
        assert one["sha256"] in page and one["name"] in page
    assert sha256(truth.read_bytes()).hexdigest() in page and made["recipe_sha256"] in page
    assert page.count("<figure") == 2 and "prefers-color-scheme: dark" in page
    assert "http" not in page.replace("http://www.w3.org/", "") and "<script" not in page
    assert run("validate", truth, *recorded, "--out", out).returncode == 0, "its own files are replaced"
    (out / "pairs.csv").write_text("mine\n")
    assert "--force replaces it" in run_failing("validate", truth, *recorded, "--out", out)


def test_events_are_matched_within_the_tolerance_and_what_one_side_has_alone_is_counted(
    tmp_path: Path, events: list
) -> None:
    true = contacts(WALK, Foot.LEFT)
    early, late, gone = true[3] - 0.24, true[4] - 0.26, true[5]
    times = [t for t in true if t not in true[3:6]] + [early, late]
    truth = read_truth(table(tmp_path / "t.csv", "foot,event,t_s", [("left", "HS", t) for t in times]))
    row = only(compare_walks(truth, {"S01": events}))
    assert (row.parameter, row.not_found, row.extra, row.icc) == ("heel_strike_s", 1, 2, None)
    assert row.n == len(times) - 1 and row.f1 == pytest.approx(2 * row.n / (2 * row.n + 3))
    assert gone not in times
    wide = only(compare_walks(truth, {"S01": events}, tolerance=0.28))
    assert (wide.not_found, wide.extra) == (0, 1)


def test_a_clock_that_is_apart_is_named_and_an_offset_repairs_it(tmp_path: Path, recorded: list[Path]) -> None:
    truth = stride_truth(tmp_path / "truth.csv", shift=100.0)
    done = run("validate", truth, *recorded)
    assert (done.returncode, done.stdout) == (2, "")
    assert "nothing of the truth matches: its times are" in done.stderr and "--offset" in done.stderr
    mended = run("validate", truth, *recorded, "--offset", "-100")
    assert mended.returncode == 0 and " 0.00" not in mended.stdout.splitlines()[2]


def test_a_truth_of_the_other_foot_is_named(tmp_path: Path) -> None:
    path = samples_file(tmp_path / "walk.csv", WALK, Foot.LEFT)
    truth = table(tmp_path / "truth.csv", "foot,event,t_s", [("left", "HS", t) for t in contacts(WALK, Foot.LEFT)])
    done = run("validate", truth, path)
    assert "it is of the left foot, the recording of the right one; --foot says otherwise" in done.stderr
    mended = run("validate", truth, path, "--foot", "left", "--out", tmp_path / "out")
    assert mended.returncode == 0 and rows_in(tmp_path / "out" / "agreement_groups.csv") == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda rows: [(*row[:2], 1e3 * row[2], 1e3 * row[3], row[4]) for row in rows], "are the truth's in ms?"),
        (lambda rows: [(row[0], [*Foot][row[1] is Foot.LEFT], *row[2:]) for row in rows], "are left and right swapped"),
        (lambda rows: [(*row[:2], row[3], row[2], row[4]) for row in rows], "line 2: ends at "),
        (lambda rows: [rows[0], (*rows[0][:4], 9.9), *rows[1:]], "two strides with different values end at "),
        (lambda rows: [(*row[:4], 100.0 * row[4]) for row in rows], "is it in cm?"),
        (
            lambda rows: [("", *row[1:]) if k % 2 else row for k, row in enumerate(rows)],
            " rows of the truth name no rec",
        ),
        (
            lambda rows: [("S02", *row[1:]) if k % 2 else row for k, row in enumerate(rows)],
            "of the truth are of S02, of",
        ),
        (lambda rows: rows, "the column stride_lenght has numbers, and none of the known names"),
    ],
)
def test_what_of_a_truth_cannot_be_or_is_compared_with_nothing_is_said(
    tmp_path: Path, recorded: list[Path], change: Callable[[list], list], said: str
) -> None:
    rows = [("S01", foot, a, b, length) for foot in Foot for a, b, length in strides(WALK, foot)]
    name = "stride_lenght" if "lenght" in said else "stride_length_m"
    path = table(tmp_path / "truth.csv", f"recording,foot,t_start_s,t_end_s,{name}", change(rows))
    other = table(tmp_path / "S03.csv", "t", [])
    done = run("validate", path, *recorded, *([other] if "name no rec" in said else []))
    assert said in done.stderr
    assert run("validate", stride_truth(tmp_path / "truth.csv"), *recorded).stderr == ""


def test_a_recipe_that_needs_cells_says_so(tmp_path: Path, recorded: list[Path]) -> None:
    failed = run("validate", stride_truth(tmp_path / "truth.csv"), *recorded, "--recipe", "zupt")
    assert "recipe zupt needs pressure cells" in failed.stderr and "nothing of the truth" not in failed.stderr


def test_parameters_of_a_walk_are_those_of_the_gait_table_and_of_mobility(tmp_path: Path, events: list) -> None:
    rows = [("speed_m_per_s", 1.3), ("walkdur_all_sum", 9.0), ("distance_m", 12.0), ("stride_length_m", "-")]
    truth = read_truth(table(tmp_path / "t.csv", "parameter,value", rows))
    found = by_parameter(compare_walks(truth, {"S01": events}))
    assert found.keys() == {"speed_m_per_s", "walkdur_all_sum", "distance_m"}, "what was not measured is left out"
    for name in ("speed_m_per_s", "distance_m"):
        assert abs(found[name].bias) < 0.05 * {"speed_m_per_s": 1.3, "distance_m": 12.0}[name]
    with pytest.raises(TableError, match="there is no parameter pace"):
        read_truth(table(tmp_path / "t.csv", "parameter,value", [("pace", 1.0)]))


def test_lists_of_gaitmap_and_mobgap_count_samples(tmp_path: Path, events: list) -> None:
    by_foot = {foot: [round(RATE * t) for t in contacts(WALK, foot)] for foot in Foot}
    of_gaitmap = [
        (k, f"{foot}_sensor", a, b, a, length)
        for foot in Foot
        for k, (a, b, (_, _, length)) in enumerate(
            zip(by_foot[foot], by_foot[foot][1:], strides(WALK, foot), strict=False)
        )
    ]
    path = table(tmp_path / "strides.csv", "s_id,sensor,start,end,ic,stride_length", of_gaitmap)
    with pytest.raises(TableError, match="its times count samples.*--truth-rate"):
        read_truth(path)
    found = by_parameter(compare_walks(read_truth(path, rate=RATE), {"S01": events}))
    assert found.keys() == {"heel_strike_s", "stride_time_s", "stride_length_m"}
    assert abs(found["stride_length_m"].bias) < 0.02 and found["stride_time_s"].f1 == 1.0
    contacts_of_mobgap = [(k, ic, foot) for foot in Foot for k, ic in enumerate(by_foot[foot])]
    ics = read_truth(table(tmp_path / "ics.csv", "step_id,ic,lr_label", contacts_of_mobgap), rate=RATE)
    strikes = only(compare_walks(ics, {"S01": events}))
    assert (strikes.n, strikes.f1) == (sum(map(len, by_foot.values())), 1.0)
    first, last = min(map(min, by_foot.values())), max(map(max, by_foot.values()))
    bouts = table(tmp_path / "b.csv", "wb_id,start,end,n_steps,duration_s,cadence_spm,walking_speed_mps",
                  [(1, first, last, 20, 9.0, 110.0, 1.3)])  # fmt: skip
    rows = by_parameter(compare_walks(read_truth(bouts, rate=RATE), {"S01": events}))
    assert [*rows] == ["cadence_steps_per_min", "speed_m_per_s"]
    assert abs(rows["speed_m_per_s"].bias) < 0.1


def test_a_stride_between_middles_of_stance_is_compared_with_the_cycle_of_its_contacts(
    tmp_path: Path, events: list
) -> None:
    ics = [round(RATE * t) for t in contacts(WALK, Foot.LEFT)]
    rows = [(k, "left", a + 30, b + 30, a, b, a + 30) for k, (a, b) in enumerate(pairwise(ics))]
    path = table(tmp_path / "s.csv", "s_id,foot,start,end,pre_ic,ic,min_vel", rows)
    found = by_parameter(compare_walks(read_truth(path, rate=RATE), {"S01": events}))
    assert found["heel_strike_s"].n == len(ics), "a contact of two strides counts once"
    assert (found["stride_time_s"].n, found["stride_time_s"].not_found) == (len(rows), 0)
    assert abs(found["stride_time_s"].bias) < 0.005


def test_what_lies_between_the_passes_of_a_walkway_is_not_extra_and_a_stride_cut_in_two_is(
    tmp_path: Path, events: list
) -> None:
    known = [one for number, one in enumerate(strides(WALK, Foot.LEFT)) if number not in (0, 3, 4)]
    rows = [("left", a, b) for a, b, _ in known]
    (start, _), (_, end) = rows[0][1:], rows[1][1:]
    truth = read_truth(table(tmp_path / "t.csv", "foot,t_start_s,t_end_s", [("left", start, end), *rows[2:]]))
    row = only(compare_walks(truth, {"S01": events}))
    assert (row.n, row.not_found, row.extra) == (len(rows) - 1, 0, 1)


def test_conditions_and_means_of_recordings_are_groups(tmp_path: Path) -> None:
    rows, files = [], []
    for number, condition in enumerate(("slow", "fast", "fast"), 1):
        who = walker(seed=number)
        files.append(samples_file(tmp_path / f"P{number}_right.csv", who, Foot.RIGHT))
        rows += [(f"P{number}", f"{a:.4f}".replace(".", ","), f"{b:.4f}".replace(".", ","), condition)
                 for a, b, _ in strides(who, Foot.RIGHT)]  # fmt: skip
    truth = table(tmp_path / "truth.csv", "\ufeffrecording,t_start_s,t_end_s,phase", rows, separator=";")
    done = run("validate", truth, *files, "--out", tmp_path / "out")
    groups = {(row["by"], row["group"]): row for row in rows_in(tmp_path / "out" / "agreement_groups.csv")}
    assert groups.keys() == {("phase", "slow"), ("phase", "fast"), ("means of recordings", "")}, done.stderr
    assert groups["means of recordings", ""]["n"] == "3"
    pairs = [row for row in rows_in(tmp_path / "out" / "pairs.csv") if row["found"] and row["true"]]
    means = [
        fmean([float(row["found"]) - float(row["true"]) for row in pairs if row["recording"] == name])
        for name in ("P1", "P2", "P3")
    ]
    assert float(groups["means of recordings", ""]["sd"]) == pytest.approx(stdev(means), abs=1e-6)


@pytest.mark.parametrize("degraded", [False, True])
def test_one_pair_has_no_limits_and_none_no_bias(degraded: bool) -> None:
    comparison = WalkComparison.of([pair(1.0, 1.5, degraded)])
    ((_, _, bias, limits, *_, icc),) = agreement_cells(comparison.agreement)
    assert (bias, limits, icc) == ("-" if degraded else "+0.500", "-", "-")


def test_strides_that_are_degraded_count_as_found_and_are_in_no_figure() -> None:
    row = only(WalkComparison.of([pair(1.0, 1.1), pair(1.0, 9.0, degraded=True)]))
    assert (row.n, row.bias, row.degraded, row.f1) == (1, pytest.approx(0.1), 1, 1.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "line 1: needs one column at least"),
        ("a,b\n1,2\n", "the columns are none of a truth"),
        ("foot,event,t_s\nleft,Jump,1\n", "there is no event Jump"),
        ("foot,event,t_s\nmiddle,HS,1\n", "a foot is left or right, not middle"),
        ("foot,event,t_s\nleft,HS,soon\n", "line 2: t_s is 'soon', not a number that is finite"),
        ("recording,event,t_s\nS99,HS,1\n", "the truth's recordings (S99) are none of S01"),
    ],
)
def test_a_truth_that_cannot_be_used_gets_one_line(tmp_path: Path, recorded: list[Path], text: str, said: str) -> None:
    truth = tmp_path / "truth.csv"
    truth.write_text(text)
    assert said in run_failing("validate", truth, *recorded)


def test_one_recording_that_cannot_be_compared_costs_only_itself(tmp_path: Path, recorded: list[Path]) -> None:
    truth, broken = stride_truth(tmp_path / "truth.csv"), tmp_path / "S02.csv"
    truth.write_text(truth.read_text() + "S02,left,1,2,1.0\n")
    broken.write_text("nothing\n")
    done = run("validate", truth, *recorded, broken)
    assert done.returncode == 1 and "stride_length_m" in done.stdout and "S02.csv" in done.stderr


def test_without_the_extra_one_line_names_it() -> None:
    program = (
        "import sys; sys.modules['pingouin'] = None; from solepath.validate import compare_walks; compare_walks([], {})"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stderr.splitlines()[-1].startswith("ImportError: the ICC needs pingouin: install the extra validate")


def test_nothing_in_common_is_an_error_in_python_too(tmp_path: Path, events: list) -> None:
    truth = read_truth(table(tmp_path / "t.csv", "event,t_s", [("HS", 900.0)]))
    with pytest.raises(NoMatch, match="its times are 900.0 to 900.0 s"):
        compare_walks(truth, {"S01": events})


@pytest.mark.long
def test_recorded_walks_have_the_scores_of_the_laboratory(data_dir: Path, evaluated: Evaluated, tmp_path: Path) -> None:
    """The labels of the 60 walks of ipol_10m_uturn as a table that somebody would write."""
    files = sorted((data_dir / "ipol_10m_uturn").glob("*.npz"))
    if not files:
        pytest.skip(f"no ipol_10m_uturn in {data_dir}")
    rows = []
    for file in files:
        with np.load(file) as read:
            for foot in Foot:
                for toe_off, contact in read[f"gt_{foot}"]:
                    rows += [(file.stem, foot, "TO", toe_off), (file.stem, foot, "HS", contact)]
    truth = table(tmp_path / "truth.csv", "recording,foot,event,t_s", rows)
    assert run("validate", truth, *files, "--out", tmp_path / "out").returncode == 0
    scores = evaluated("ipol_10m_uturn", "default").summaries[0].together
    found = {row["parameter"]: row for row in rows_in(tmp_path / "out" / "agreement.csv")}
    for name in ("heel_strike", "toe_off"):
        row = found[f"{name}_s"]
        assert int(row["n"]) + int(row["not_found"]) == scores[f"{name}_true"]
        assert int(row["n"]) + int(row["extra"]) == scores[f"{name}_found"]
        assert float(row["f1"]) == pytest.approx(scores[f"{name}_f1"], abs=1e-6)
