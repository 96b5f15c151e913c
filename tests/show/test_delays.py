"""The delay of contacts, in its parts, wherever it is told: events, state, frames of the page, run.json."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import run
from recordings import recorded
from shown import frame
from walks import of, samples

from solepath import Foot, HeelStrike, Session, ToeOff
from solepath.emulate import Radio, Route, emulate
from solepath.show.page.scene.scene import Scene
from solepath.show.tables.summary import status
from solepath.walk import Walk

ROUTE = Route().stand(2.0).walk(20.0, 1.3).stop(2.0)
DECISION = 0.003
"""Time that a program takes after the arrival of each packet, s."""


def test_an_event_says_when_it_happened_when_its_last_sample_was_taken_and_when_that_arrived() -> None:
    session = Session(impacts=True)
    for sample in samples(ROUTE, cells=0, rate=100.0):
        for event in of(HeelStrike | ToeOff, session.feed(sample)):
            assert event.t <= event.sampled_at == sample.t <= event.known_at
    packets = emulate(ROUTE, radio=Radio(interval=0.03)).packets
    session = Session()
    for packet in packets:
        for event in of(HeelStrike | ToeOff, session.feed(packet)):
            assert event.t <= event.sampled_at and event.known_at == max(packet.t, event.sampled_at)
            assert event.to_dict()["sampled_at"] == event.sampled_at


def test_medians_and_percentiles_of_each_part_are_told_alike(tmp_path: Path) -> None:
    packets = emulate(ROUTE, radio=Radio(interval=0.03)).packets
    session, scene, walk, events = Session(poses=True), Scene("a walk", "default"), Walk(), []
    for packet in packets:
        new = session.feed(packet)
        events += new
        for collector in (scene, walk):
            collector.take(packet, new, packet.t + DECISION)
    contacts = [event for event in of(HeelStrike | ToeOff, events) if event.foot.value == "left"]
    late = [event.known_at - event.t for event in contacts]
    delay = frame(scene)["links"]["left foot"]["delay"]
    assert delay.keys() == {"sensor", "radio", "decision"} and delay["decision"] == [3, 3]
    assert delay["sensor"][0] + delay["radio"][0] == pytest.approx(1e3 * sorted(late)[len(late) // 2], abs=8.0)
    assert 2 <= delay["sensor"][0] < 20 and 5 < delay["radio"][0] < delay["radio"][1] <= 45
    (line,) = [one for one in status(walk) if one.startswith("left foot")]
    told = [f"{part} {middle} ms (95 %: {most})" for part, (middle, most) in delay.items()]
    assert f"late by {' + '.join(told)}" in line
    out = tmp_path / "out"
    assert run("track", recorded(tmp_path / "walk.jsonl", packets), "--out", out).returncode == 0
    written = json.loads((out / "run.json").read_text())["sites"]["left_foot"]["delay_ms"]
    assert written == {part: pytest.approx(delay[part], abs=0.6) for part in ("sensor", "radio")}


@pytest.mark.parametrize("sampled_at", [float("nan"), float("inf"), 1e300])
def test_a_contact_with_a_number_that_is_none_has_no_delay(sampled_at: float) -> None:
    scene = Scene("a walk", "default")
    scene.take(None, [HeelStrike(t=1.0, known_at=1.1, foot=Foot.LEFT, sampled_at=sampled_at)])
    scene.take(None, [HeelStrike(t=2.0, known_at=2.1, foot=Foot.LEFT, sampled_at=2.04)])
    assert frame(scene)["links"]["left foot"]["delay"] == {"sensor": [40, 40], "radio": [60, 60]}


def test_only_the_newest_contacts_count_each_once_and_none_that_a_gap_has_hidden() -> None:
    walk, session = Walk(), Session(impacts=True)
    walk.take(None, session.feed(samples(ROUTE, cells=0, rate=100.0)))
    seen = [len(link.delays.parts) for link in walk.links.values()]
    assert seen == [sum(foot.events[name] for name in ("heel-strike", "toe-off")) for foot in walk.feet.values()]
    one = HeelStrike(t=1.0, known_at=1.05, sampled_at=1.02, foot=next(iter(walk.feet)))
    delays = next(iter(walk.links.values())).delays
    for _ in range(1000):
        delays.add(one, 1.0)
    assert len(delays.parts) == 200 and delays.figures["decision"] == (0.0, 0.0), "no clock runs backwards"
