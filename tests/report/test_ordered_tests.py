"""The report of a walk test that was ordered: the result comes first, is that of the events, and is not overclaimed."""

from __future__ import annotations

import json
import re
from math import pi
from pathlib import Path

import pytest
from commands import run, run_failing
from pages import read_page
from recordings import recorded
from walks import insoles

from solepath.emulate.routes.route import Route
from solepath.show.outcomes.references import SIX_MINUTE_CHANGE, UP_AND_GO_CHANGE

WOMAN = "72,female,162,68"


def there_and_back(crossings: int, speed: float) -> Route:
    route = Route().stand(2.0)
    for _ in range(crossings):
        route = route.walk(12.0, speed).turn(pi, radius=0.5)
    return route.stop(2.0)


@pytest.fixture(scope="module")
def walks(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Return the recordings of a walk of some 40 s, and of a slower one before it."""
    folder = tmp_path_factory.mktemp("ordered")
    slow, fast = insoles(there_and_back(3, 0.9), seed=5), insoles(there_and_back(3, 1.25), seed=6)
    return recorded(folder / "after.jsonl", fast.packets), recorded(folder / "before.jsonl", slow.packets)


def distance_of(events: Path, start: float | None = None) -> float:
    """Return the mean of what both feet went from the first toe-off, or from `start`, by the lines of events.jsonl."""
    strides = [one for one in map(json.loads, events.read_text().splitlines()) if one["event"] == "StrideTaken"]
    swings = [(one["foot"], one["t_toe_off"], one["t_heel_strike"], one["length"]) for one in strides if one["final"]]
    first = min(lifted for _, lifted, _, _ in swings) if start is None else start
    total = 0.0
    for _, lifted, landed, length in swings:
        total += length * max(0.0, min(1.0, (landed - first) / (landed - lifted)))
    return 0.5 * total


def tracked(tmp_path: Path, walk: Path, *options: object) -> tuple[list[str], str]:
    """Return the first paragraphs of the report of a walk, and its whole text."""
    done = run("track", walk, *options, "--out", tmp_path / "out", "--report", tmp_path / "r.html")
    assert done.returncode == 0, done.stderr
    page = read_page(tmp_path / "r.html")
    return [one.text for one in page.first("main").all("p")[:3]], page.text


def test_the_distance_of_a_test_that_was_not_finished_is_compared_with_nothing(
    walks: tuple[Path, Path], tmp_path: Path
) -> None:
    after, before = walks
    run("track", before, "--out", tmp_path / "earlier")
    (result, *_), text = tracked(tmp_path, after, "--test", "six-minute", "--compare", before, "--reference", WOMAN)
    now, then = distance_of(tmp_path / "out" / "events.jsonl"), distance_of(tmp_path / "earlier" / "events.jsonl")
    assert re.fullmatch(
        rf"Six-minute walk: {now:.2f} m in \d+ s of the six minutes. The recording ends before the six minutes do: "
        rf"it is compared with no prediction and no other walk. Before: {then:.2f} m in \d+ s of the six minutes: "
        "the recording ends before the six minutes do, so that no change is given.",
        result,
    )
    assert "redicted" not in text and SIX_MINUTE_CHANGE.source not in text
    assert rows_before_and_after(tmp_path)["distance, m"] == [f"{then:.2f}", f"{now:.2f}", "-"]


def rows_before_and_after(tmp_path: Path) -> dict[str, list[str]]:
    """Return the rows of the table of both walks by their first cells."""
    rows = read_page(tmp_path / "r.html").named("comparison").all("tr")[1:]
    return {row.first("th").text: [cell.text for cell in row.all("td")] for row in rows}


def test_the_time_of_a_timed_up_and_go_is_that_of_its_marks_and_few_strides_do_not_concern_it(
    walks: tuple[Path, Path], tmp_path: Path
) -> None:
    after, before = walks
    marks = ("--test", "tug=3.5,14", "--test-before", "3,17.25", "--compare", before)
    paragraphs, text = tracked(tmp_path, after, *marks, "--reference", "72,female")
    assert paragraphs[0] == (
        "Timed up and go: 10.50 s, 114 % of 9.20 s, the mean of healthy people aged 70 to 79. "
        f"Before: 14.25 s. The change, -3.75 s, reaches the smallest that matters, {UP_AND_GO_CHANGE.value:g} s."
    )
    assert not [one for one in paragraphs if one.startswith("Check before use")]
    rows = rows_before_and_after(tmp_path)
    assert rows["total time, s"] == ["14.25", "10.50", "-3.75 (-26 %)", "3.50", "yes"]
    assert rows["speed, m/s"][-2:] == ["-", "-"], "the limit is of walks at the usual pace"
    assert "usual pace" not in text and "Smallest change of speed" not in text
    assert UP_AND_GO_CHANGE.source in text and "95 % interval of that mean" in text
    assert "lower limit of normal" not in text


def test_a_walk_is_answered_by_the_speed_of_its_steady_strides(walks: tuple[Path, Path], tmp_path: Path) -> None:
    after, before = walks
    (result, *_), _ = tracked(tmp_path, after, "--test", "walk", "--compare", before)
    found = re.match(r"Walk: ([\d.]+) m/s. Before: ([\d.]+) m/s. The change, ([+-][\d.]+) m/s, reaches", result)
    assert found is not None
    speed, earlier, change = map(float, found.groups())
    assert change == pytest.approx(speed - earlier, abs=0.011)
    assert [float(cell) for cell in rows_before_and_after(tmp_path)["speed, m/s"][:2]] == [earlier, speed]


def test_a_change_is_said_to_matter_only_where_a_publication_says_how_much(
    walks: tuple[Path, Path], tmp_path: Path
) -> None:
    after, before = walks
    run("track", after, "--compare", before, "--report", tmp_path / "r.html")
    judged = {label: cells[-2:] for label, cells in rows_before_and_after(tmp_path).items()}
    assert judged.pop("speed, m/s") == ["0.10", "yes"]
    assert judged and set(map(tuple, judged.values())) == {("-", "-")}


def test_marks_that_a_test_needs_are_asked_for(walks: tuple[Path, Path], tmp_path: Path) -> None:
    after, before = walks
    options = ("--test", "tug=3,9", "--compare", before, "--report", tmp_path / "r.html")
    assert "needs --test-before START,STOP" in run_failing("track", after, *options)
    assert "--test-before has the marks" in run_failing("track", after, *options, "--test-before", "3")
