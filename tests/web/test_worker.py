"""What runs in the site's worker, run here: messages, saving, files with errors in words, the report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from recordings import recorded
from shown import walked
from walks import insoles
from worker_walks import connect, send_frames

from solepath import Packet
from solepath.emulate import Route
from solepath.show.web.worker import Worker

HEADER = b'{"format": "solepath-packets", "version": 1}\n'
PACKETS = walked(Route().stand(1.0).walk(10.0, 1.3).stop(1.0), cells=16)


def walk(worker: Worker, packets: tuple[Packet, ...]) -> bytes:
    """Let two insoles connect and send the frames; return the lines of the recording."""
    connect(worker, packets)
    send_frames(worker, packets)
    return worker.take_lines()


def call(worker: Worker, name: str, *arguments: Any) -> Any:
    """Return the result of a call, or the words of its error."""
    worker.start(name, arguments)
    while "share" in (answer := json.loads(worker.step(0.01))):
        assert 0.0 <= answer["share"] <= 1.0
    return answer.get("problem", answer.get("value"))


def shown(worker: Worker) -> Any:
    """Return all that a page shows that is opened now."""
    return json.loads(json.dumps(worker.scene.whole_message()))


@pytest.fixture
def worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Worker:
    monkeypatch.chdir(tmp_path)
    return Worker("1.2.3")


def test_a_walk_that_is_saved_and_continued_shows_what_an_uninterrupted_one_shows(worker: Worker) -> None:
    half = len(PACKETS) // 2
    worker.start_walk("a walk")
    walk(worker, PACKETS[:half])
    saved = worker.save()
    assert saved is not None and len(saved) < 1_000_000
    send_frames(worker, PACKETS[half:])
    Path("tail.jsonl").write_bytes(HEADER + worker.take_lines())
    other = Worker()
    assert call(other, "resume_walk", "a walk", saved, "tail.jsonl", PACKETS[-1].t) == PACKETS[-1].t
    assert shown(other) == shown(worker)
    assert shown(worker)["frame"]["feet"]["left"]["strides"] >= 5


def test_the_page_shows_the_time_from_the_arrival_to_the_events_if_it_says_when_it_hands_frames_over(
    worker: Worker,
) -> None:
    for late in (None, 0.05):
        worker.start_walk("a walk")
        connect(worker, PACKETS)
        for k in range(0, len(PACKETS), 6):
            packets = PACKETS[k : k + 6]
            send_frames(worker, packets, None if late is None else packets[-1].t + late)
        (delay, _) = [link["delay"] for link in shown(worker)["frame"]["links"].values()]
        assert delay["sensor"] and ("decision" in delay) == (late is not None)
    assert 50 <= delay["decision"][0] <= delay["decision"][1] < 60_000  # of the walk's clock, not of the day's


@pytest.mark.soak
def test_a_time_without_packets_is_shown_as_a_gap_and_a_clock_that_was_set_back_as_a_reset(worker: Worker) -> None:
    worker.start_walk("a walk")
    walk(worker, PACKETS)
    saved, end = worker.save(), PACKETS[-1].t
    call(worker, "resume_walk", "a walk", saved, "", end + 60.0)
    assert any("nothing has come for" in words for _, _, words in shown(worker)["log"])
    assert call(worker, "resume_walk", "a walk", saved, "", end - 3600.0) == pytest.approx(end, abs=0.1)
    assert any("clock" in words for _, _, words in shown(worker)["log"])


def test_a_position_that_is_reported_during_a_walk_is_shown_and_recorded_and_none_is_after_its_end(
    worker: Worker,
) -> None:
    worker.command('{"do": "here", "sigma": 1}')  # there is no walk yet
    assert json.loads(worker.message() or "")["control"] is False
    worker.start_walk("a walk")
    lines = walk(worker, PACKETS)
    assert json.loads(worker.message() or "")["control"] is True
    worker.command('{"do": "here", "sigma": 5}')
    worker.command('{"do": "pause"}')
    worker.command('{"do": "here", "sigma": 1, "at": [1, 2], "level": "0"}')  # there is no plan
    (line,) = worker.take_lines().splitlines()
    assert json.loads(line)["channel"] == "receiver/position" and line not in lines
    assert [mark[1:4] for mark in shown(worker)["reports"]] == [[None, 0.0, 0.0]]
    worker.finish_walk()
    assert json.loads(worker.message() or "")["control"] is False
    worker.command('{"do": "here", "sigma": 5}')
    assert worker.take_lines() == b""


def test_a_recording_is_played_and_may_be_controlled(worker: Worker) -> None:
    recorded(Path("walk.jsonl"), insoles().packets)
    assert call(worker, "open", "walk.jsonl") == {"kind": "recording", "notes": []}
    scene = json.loads(worker.message() or "")
    assert (scene["title"], scene["source"], scene["control"]) == ("walk.jsonl", "recording", True)
    worker.play(0.2, 1.0)
    worker.command('{"do": "pause"}')
    assert shown(worker)["frame"]["playback"]["state"] == "paused"
    report = call(worker, "report", "", "a walk")
    assert "left foot took" in report and "solepath 1.2.3" in report
    assert report == call(worker, "report", "walk.jsonl", "a walk")


def test_the_report_answers_the_test_that_a_person_ordered_and_a_slip_of_the_pen_is_named(worker: Worker) -> None:
    recorded(Path("walk.jsonl"), insoles().packets)
    given = {"test": "tug", "marks": "1.0, 7.5", "age": "72", "sex": "female", "subject": "P 07", "outcomes": True}
    report = call(worker, "report", "walk.jsonl", "a walk", given)
    assert "6.5" in report and "P 07" in report and "healthy people" in report.lower()
    assert "Walking bouts" in report and "Walking bouts" not in call(worker, "report", "walk.jsonl", "a walk")
    short = call(worker, "report", "walk.jsonl", "a walk", given | {"marks": "1.0"})
    assert short.startswith("tug=1.0 is not six-minute")
    small = call(worker, "report", "walk.jsonl", "a walk", given | {"height": "1.62", "weight": "68"})
    assert small.startswith("72,female,1.62,68 is not AGE,SEX[,CM,KG]")


def test_the_report_compares_with_an_earlier_walk_whose_test_has_marks_of_its_own(worker: Worker) -> None:
    recorded(Path("walk.jsonl"), insoles().packets)
    recorded(Path("earlier.jsonl"), PACKETS)
    assert call(worker, "open", "walk.jsonl")["kind"] == "recording"
    given = {"test": "tug", "marks": "1.0,7.5", "compare": "earlier.jsonl", "marks_before": "1.0,9.0"}
    compared = call(worker, "report", "", "a walk", given)
    assert "Compared with the walk before" in compared and "earlier.jsonl" in compared
    assert "6.5" in compared and "8.0" in compared
    assert "Compared with" not in call(worker, "report", "", "a walk", given | {"compare": ""})
    assert call(worker, "report", "", "a walk", given | {"marks_before": "1.0"}).startswith("tug=1.0 is not six-minute")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bands.csv", "measure,low,high,source\nspeed_m_per_s,1.1,1.5,our ward\n"),
        ("bands.json", '{"source": "our ward", "bands": {"speed_m_per_s": [1.1, 1.5]}}'),
    ],
)
def test_bands_that_a_person_opens_are_in_the_reports_that_follow(worker: Worker, name: str, text: str) -> None:
    recorded(Path("walk.jsonl"), walked(Route().stand(1.0).walk(40.0, 1.3).stop(1.0)))
    Path(name).write_text(text)
    assert call(worker, "open", name) == {"kind": "bands", "notes": []}
    assert "our ward" in call(worker, "report", "walk.jsonl", "a walk")
    Path(name).write_text(text.replace("our ward", ""))
    assert "has no source" in call(worker, "open", name)
