"""Outcomes on the command line, in files, in the report and on the page of documents; loaded by nothing else."""

from __future__ import annotations

import csv
import re
from math import pi
from pathlib import Path

import pytest
from commands import run, run_failing
from quoted import PAGES, run_page
from recordings import recorded
from walks import insoles, run_session

from solepath.emulate.routes.route import Route
from solepath.recording import read_packets
from solepath.show.outcomes import Person, Sex, mobility_outcomes, variability, walking_bouts
from solepath.show.outcomes.clinic import LABEL
from solepath.show.outcomes.files import BOUT_COLUMNS, OUTCOME_COLUMNS
from solepath.show.outcomes.references import six_minute_reference, up_and_go_reference, walking_speed_reference

ROUTE = Route().stand(2.0).walk(3.0, speed=1.0).turn(pi, radius=0.5).walk(3.0).stop(5.0).walk(12.0, speed=1.2).stop(2.0)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return recorded(tmp_path_factory.mktemp("clinic") / "walk.jsonl", insoles(ROUTE, seed=3).packets)


@pytest.fixture(scope="module")
def tracked(recording: Path) -> tuple[str, Path]:
    """Return the output of all options together, and the folder of their files."""
    out, report = recording.parent / "out", recording.parent / "walk.html"
    options = ["--outcomes", "--test", "tug=1,14", "--reference", "72,female,162,68"]
    result = run("track", recording, *options, "--out", out, "--report", report)
    assert (result.returncode, result.stderr) == (0, "")
    return result.stdout, out


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_files_hold_the_outcomes_of_the_events(tracked: tuple[str, Path], recording: Path) -> None:
    _, out = tracked
    events = run_session(read_packets(recording))
    bouts = walking_bouts(events)
    assert [
        (int(row["number"]), float(row["t_start_s"]), int(row["strides"])) for row in rows_of(out / "bouts.csv")
    ] == [(number, bout.t_start, bout.strides) for number, bout in enumerate(bouts, 1)]
    outcomes = {(row["part"], row["outcome"]): row for row in rows_of(out / "outcomes.csv")}
    expected = f"{mobility_outcomes(bouts).walkdur_all_sum:.6f}"
    assert (len(bouts), outcomes["mobility", "walkdur_all_sum"]["value"]) == (2, expected)
    assert outcomes["mobility", "ws_30_avg"]["value"] == "" and outcomes["mobility", "ws_30_avg"]["unit"] == "m/s"
    one, row = variability(events, "stride_time"), outcomes["variability", "stride_time"]
    assert one is not None
    assert [float(row[key]) for key in ("value", "low", "high", "strides", "needed")] == pytest.approx(
        [one.value, one.low, one.high, one.strides, one.needed], abs=1e-6
    )
    total = outcomes["timed up and go", "duration"]
    assert (total["value"], total["mean_of_group"], total["mean_high"]) == ("13.000000", "9.200000", "10.200000")
    assert (total["predicted"], total["lower_limit_of_normal"], total["smallest_change"]) == ("", "", "3.500000")


def test_the_text_names_what_was_measured_and_what_it_is_not(tracked: tuple[str, Path]) -> None:
    text, _ = tracked
    assert "sitting to standing cannot be seen from a foot" in text
    assert re.search("^bout +start s +.* steps/min +length m +speed m/s$", text, re.MULTILINE)
    assert LABEL in text and "not outcomes of its validated pipeline" in LABEL
    assert re.search(r"^total time +13\.00 +s +9\.20 \(141 %\) +8\.20 to 10\.20$", text, re.MULTILINE)
    assert "Bohannon 2006" in text and "usual pace" not in text, "that reference is of walks at the usual pace"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--test", "tug=4,3"], "is not six-minute, six-minute=START, tug=START,STOP or walk"),
        (["--test", "tug"], "is not six-minute"),
        (["--test", "walk=3"], "is not six-minute"),
        (["--test-before", "3"], "--test-before goes with --test and --compare"),
        (["--outcomes", "--reference", "72,male,1.7,70"], "is not AGE,SEX"),
        (["--reference", "72,male"], "--reference goes with"),
    ],
)
def test_a_wrong_option_gets_one_line(recording: Path, options: list[str], words: str) -> None:
    assert words in run_failing("track", recording, *options)


def test_references_are_those_of_their_tables_and_formulas() -> None:
    woman, man = Person(72.0, Sex.FEMALE, 1.62, 68.0), Person(60.0, Sex.MALE, 1.75, 80.0)
    # 2.11 * 162 - 2.29 * 68 - 5.78 * 72 + 667 = 341.82 - 155.72 - 416.16 + 667 = 436.94; less 139 = 297.94
    # 7.57 * 175 - 5.02 * 60 - 1.76 * 80 - 309 = 1324.75 - 301.2 - 140.8 - 309 = 573.75; less 153 = 420.75
    for person, value, low in ((woman, 436.94, 297.94), (man, 573.75, 420.75)):
        one = six_minute_reference(person)
        assert one is not None and (one.value, one.lower_limit) == pytest.approx((value, low))
    for unknown in (Person(72.0, Sex.FEMALE), Person(39.0, Sex.MALE, 1.75, 80.0)):
        assert six_minute_reference(unknown) is None
    times = [up_and_go_reference(Person(age, Sex.MALE)) for age in (59.0, 60.0, 69.9, 70.0, 99.0, 100.0)]
    assert [time and time.value for time in times] == [None, 8.1, 8.1, 9.2, 11.3, None]
    people = (man, Person(85.0, Sex.FEMALE), Person(19.0, Sex.MALE))
    speeds = [speed and (speed.value, speed.words) for speed in map(walking_speed_reference, people)]
    assert speeds[0] and speeds[0][0] == 1.34 and "men aged 60 to 69" in speeds[0][1]
    assert speeds[1] and speeds[1][0] == 0.94 and "women aged 80 to 99" in speeds[1][1] and speeds[2] is None


def test_the_page_of_documents_runs_and_names_the_columns() -> None:
    page = PAGES["docs/clinic.md"]
    (out,), _ = run_page("docs/clinic.md")
    lines = out.splitlines()
    assert lines[0].startswith("bout 1: ") and lines[2].startswith("2 bouts, ") and lines[-1].endswith(" False")
    assert f"`{','.join(BOUT_COLUMNS)}`" in page and f"`{','.join(OUTCOME_COLUMNS)}`" in page


@pytest.mark.soak
def test_marks_that_are_not_within_the_recording_give_no_outcome(recording: Path, tmp_path: Path) -> None:
    files = ("--out", tmp_path / "out", "--report", tmp_path / "walk.html")
    result = run("track", recording, "--test", "tug=3,1000", *files)
    assert result.returncode == 0
    sentence = "There is no outcome of the timed up and go. The recording is from 0.0 to "
    assert sentence in result.stdout and "; 1000 s is not within it." in result.stdout
    assert "total time" not in result.stdout and sentence in (tmp_path / "walk.html").read_text()
    assert rows_of(tmp_path / "out" / "outcomes.csv") == []
