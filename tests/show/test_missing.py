"""One definition of what is missing: page, report, summary, check and run.json agree to 0.1 percentage points."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import pytest
from attrs import evolve
from commands import run
from recordings import recorded
from shown import frame, walked
from soak import longer, soaked

from solepath import Foot, Packet, Sample, SampleGap, Session, Site, recipes
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import emulate
from solepath.link.catalogue import PROFILES
from solepath.show.findings import Concern, findings
from solepath.show.page.scene.scene import Scene
from solepath.walk import Walk
from solepath.wire.receiver import ConnectionFrame, build_connected

LEFT = Site.LEFT_FOOT
CUT, ABSENCE = 20.0, 25.0
"""Start, s, and duration, s, of a time without a connection."""


@cache
def frames() -> list[Packet]:
    """Return more than a minute of walking in a left insole, whose radio loses nothing."""
    route = Route().stand(2.0).walk(80.0, speed=1.2).stop(2.0)
    return [packet for packet in walked(route, cells=8) if packet.site is LEFT]


def without_one_of(every: int, absence: float) -> tuple[list[Packet], int, int]:
    """Return the walk without one frame of `every`, and without those of an absence; the numbers lost and taken."""
    connected = [one for one in frames() if not CUT < one.t <= CUT + absence]
    samples = [one for one in connected if one.channel == "insole/frame"]
    lost = {id(one) for one in samples[every // 2 : -1 : every]}
    return [one for one in connected if id(one) not in lost], len(lost), len(samples)


def shares(text: str) -> list[float]:
    """Return the shares of missing samples that a text states, in percent."""
    return [float(share) for share in re.findall(r"samples missing \(([\d.]+) %", text)]


@pytest.mark.parametrize("absence", [ABSENCE, *longer(0.0)])
@pytest.mark.parametrize("every", [10, *soaked(50, 200)])
def test_one_frame_of_so_many_is_missing_wherever_it_is_told(every: int, absence: float, tmp_path: Path) -> None:
    packets, lost, taken = without_one_of(every, absence)
    share = pytest.approx(100.0 * lost / taken, abs=0.1)
    path, out, report = recorded(tmp_path / "walk.jsonl", packets), tmp_path / "out", tmp_path / "walk.html"
    tracked, checked = run("track", path, "--out", out, "--report", report), run("check", path)
    figures = json.loads((out / "run.json").read_text())["sites"]["left_foot"]
    assert (figures["missing"], figures["samples"]) == (lost, taken - lost)
    assert 100.0 * figures["missing_share"] == share
    assert figures["missing_s"] == pytest.approx(0.01 * lost, rel=0.01)
    assert figures["absent_s"] == pytest.approx(absence, abs=0.1)
    page = re.sub("<[^>]*>", "", report.read_text()).replace("\N{NO-BREAK SPACE}", " ")
    for text in (tracked.stdout, checked.stdout, page):
        assert shares(text) and all(one == share for one in shares(text)), text
        assert ("absent for 25.0 s" in text) is (absence > 0.0)
    session, scene = Session(poses=True, losses=True), Scene("a walk", "default")
    gaps = []
    for packet in packets:
        events = session.feed(packet)
        gaps += [event for event in events if isinstance(event, SampleGap)]
        scene.take(packet, events)
    link = frame(scene)["links"]["left foot"]
    assert link["missing"] == link["gaps"] == lost and 100.0 * link["missing_share"] == share
    assert link["absent"] == pytest.approx(absence, abs=0.1)
    assert len(gaps) == lost + (absence > 0.0), "a loss is one event"
    assert sum(gap.count for gap in gaps) == lost


@pytest.mark.parametrize("every", [10, 50, 200])
def test_rows_that_a_table_lacks_are_counted_by_the_usual_interval(every: int, tmp_path: Path) -> None:
    connected = [k for k in range(4000) if not 2000 < k < 3510]
    rows = [f"{0.01 * k:.2f},0.1,0.2,9.8,0.01,0.02,0.03" for k in connected if k % every != every // 2]
    path = tmp_path / "foot.csv"
    path.write_text("\n".join(["t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z", *rows]) + "\n")
    assert run("track", path, "--foot", "left", "--out", tmp_path / "out").returncode == 0
    figures = json.loads((tmp_path / "out" / "run.json").read_text())["sites"]["left_foot"]
    assert (figures["missing"], figures["samples"]) == (len(connected) - len(rows), len(rows))
    assert figures["absent_s"] == pytest.approx(15.1, abs=0.1)


def test_what_made_the_files_is_written_beside_them(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", frames()[:800])
    for name in ("one", "two"):
        assert run("track", path, "--out", tmp_path / name, "--recipe", "kupt-dfpc").returncode == 0
    one, two = [json.loads((tmp_path / name / "run.json").read_text()) for name in ("one", "two")]
    assert one["recipe"] == "kupt-dfpc" and len(one["recipe_sha256"]) == 64
    assert one["inputs"][0]["name"] == "walk.jsonl" and one["options"]["recipe"]
    assert {**one, "options": None} == {**two, "options": None}
    run("track", path, "--out", tmp_path / "other", "--recipe", "default")
    assert json.loads((tmp_path / "other" / "run.json").read_text())["recipe_sha256"] != one["recipe_sha256"]


@cache
def two_streams() -> list[Packet]:
    """Return a walk with a sensor that sends acceleration and angular rate in packets of their own."""
    route = Route().stand(3.0).walk(45.0, speed=1.3).stop(2.0)
    return emulate(route, devices={LEFT: CC2541()}, radio=CLEAN, seed=3).packets


def moment(item: Packet | Sample) -> float:
    return item.t


def followed(packets: Sequence[Packet | Sample], recipe: str = "default") -> Walk:
    """Return the walk of a session of a recipe that was fed with the packets or samples."""
    session, walk = Session(recipes.by_name(recipe), poses=True, losses=True), Walk()
    for packet in packets:
        walk.take(packet, session.feed(packet))
    walk.take(None, session.finish())
    return walk


@pytest.mark.parametrize("absence", [0.0, ABSENCE])
def test_a_sensor_with_two_streams_misses_samples_and_not_packets(absence: float) -> None:
    route = Route().stand(2.0).walk(80.0, speed=1.2).stop(2.0)
    packets = emulate(route, devices={LEFT: CC2541()}, radio=CLEAN, seed=2).packets
    streams = {"cc2541/accelerometer": 0, "cc2541/gyroscope": 0}
    kept, lost = [], 0
    for packet in packets:
        count = streams.get(packet.channel)
        if count is not None:
            streams[packet.channel] = count + 1
        if CUT < packet.t <= CUT + absence or (count is not None and count % 50 == 25):
            lost += count is not None and not CUT < packet.t <= CUT + absence
        else:
            kept.append(packet)
    link = followed(kept).links[LEFT]
    assert link.missing == pytest.approx(lost / 2, abs=1)
    assert 100.0 * link.missing_share == pytest.approx(2.0, abs=0.25)
    assert link.missing_time == pytest.approx(0.1 * link.missing, rel=0.05)


def test_a_foot_that_falls_silent_until_the_end_is_absent_until_then() -> None:
    route = Route().stand(2.0).walk(40.0, speed=1.2).stop(2.0)
    packets = [one for one in walked(route, cells=8) if one.site is not LEFT or one.t < 15.0]
    walk = followed(packets)
    assert walk.links[LEFT].absent_time(walk.now) == pytest.approx(packets[-1].t - 15.0, abs=0.1)
    assert walk.links[LEFT].missing == 0


@cache
def tagged() -> list[Packet]:
    """Return a walk in an inertial sensor without pressure cells, which loses one packet of fifty."""
    route = Route().stand(2.0).walk(40.0, speed=1.2).stop(2.0)
    packets = emulate(route, devices={LEFT: CC2650()}, radio=CLEAN, seed=2).packets
    moved = [packet for packet in packets if packet.channel == "cc2650/movement"]
    lost = {id(packet) for packet in moved[25::50]}
    return [packet for packet in packets if id(packet) not in lost]


@pytest.mark.parametrize("recipe", recipes.NAMES)
def test_what_is_missing_is_the_same_for_every_recipe_whatever_sensors_it_needs(recipe: str) -> None:
    sent = sum(packet.channel == "cc2650/movement" for packet in tagged())
    link = followed(tagged(), recipe).links[LEFT]
    assert (link.samples, link.missing) == (sent, len(range(25, sent + link.missing, 50))) and link.missing > 5


@pytest.mark.parametrize("recipe", recipes.NAMES)
def test_rows_that_are_missing_are_the_same_for_every_recipe(recipe: str) -> None:
    link = followed(rows(100, lambda k: k % 50 != 25), recipe).links[LEFT]
    assert (link.samples, link.missing) == (3920, 80)


def rows(rate: int, keeps: Callable[[int], bool]) -> list[Sample]:
    """Return 40 s of samples of a foot that stands, without packets."""
    kept = [k for k in range(40 * rate) if keeps(k)]
    return [Sample(k / rate, LEFT, (0.1, 0.2, 9.8), (0.01, 0.02, 0.03)) for k in kept]


@pytest.mark.parametrize("rate", [10, 50, 100, 250, 400])
def test_rows_are_counted_at_every_rate(rate: int) -> None:
    assert followed(rows(rate, lambda k: k % 50 != 25)).links[LEFT].missing == 40 * rate // 50


@pytest.mark.parametrize("rate", [10, 100, *longer(50, 250, 400)])
@pytest.mark.parametrize("burst", [0.5, 0.9, 1.8])
def test_rows_of_a_burst_are_all_counted_up_to_the_silence_that_devices_of_their_rate_are_allowed(
    rate: int, burst: float
) -> None:
    kept = rows(rate, lambda k: k < 20 or k % (4 * rate) >= round(burst * rate))
    link = followed(kept).links[LEFT]
    if burst < 1.0 or rate == 10:
        assert (link.missing, link.ended_absences) == (40 * rate - len(kept), 0.0)
    else:
        assert (link.missing, link.ended_absences) == (0, pytest.approx(10 * burst - 10 / rate))
    assert link.missing_time == pytest.approx(link.missing / rate, rel=1e-3)


@pytest.mark.parametrize("name", ["insole", "dot", "thingy", "orphe", "cc2541", "cc2650"])
def test_a_silence_is_an_absence_of_a_device_exactly_where_it_is_one_of_its_rows(name: str) -> None:
    (profile,) = [one for one in PROFILES if one.name == name]
    rate = round(profile.nominal_rate)
    for silence, is_absence in ((0.95 * profile.stale_after, False), (1.1 * profile.stale_after, True)):
        first = 100 + round(silence * rate)
        kept = [one for k, one in enumerate(rows(rate, lambda k: True)) if not 100 < k < first]
        link = followed(kept).links[LEFT]
        assert (link.missing == 0, link.ended_absences > 0.0) == (is_absence, is_absence)


@pytest.mark.parametrize("where", [0, 2, *soaked(1, 5, 9, 300)])
@pytest.mark.parametrize("rate", [25, *longer(100)])
def test_one_time_that_is_wrong_hides_no_sample(rate: int, where: int) -> None:
    farthest = 0.9 if where < 3 else 0.7  # the interval is known from the fourth sample on: more is a lost sample
    for share in (-farthest, -0.5, -0.2, 0.2, 0.5, farthest):
        moved = [evolve(one, t=one.t + share / rate * (k == where)) for k, one in enumerate(rows(rate, lambda k: True))]
        link = followed(moved).links[LEFT]
        assert (link.missing, link.ended_absences) == (0, 0.0)


@pytest.mark.parametrize("channels", [["accelerometer", "gyroscope"], ["gyroscope"], ["accelerometer"]])
@pytest.mark.parametrize("says", [True, False])
@pytest.mark.parametrize("start", [12.0, 12.03, 12.07, 12.09])
def test_an_absence_of_a_sensor_with_two_streams_counts_once_and_lacks_nothing(
    start: float, says: bool, channels: list[str]
) -> None:
    """Whichever stream comes back first, whether the receiver reports the connection, and if a value is lost then."""
    packets = [one for one in two_streams() if not start <= one.t < start + ABSENCE]
    if says:
        connected = Packet(
            start + ABSENCE - 0.1, LEFT, "receiver/connected", build_connected(ConnectionFrame("", None))
        )
        packets = sorted([*packets, Packet(start + 4.0, LEFT, "receiver/disconnected", b""), connected], key=moment)
    first = next(one for one in packets if one.t >= start + ABSENCE and one.channel.partition("/")[2] in channels)
    walk = followed([one for one in packets if len(channels) > 1 or one is not first])
    link = walk.links[LEFT]
    assert link.missing == 0 and link.ended_absences == pytest.approx(ABSENCE, abs=0.35)
    assert link.rate == pytest.approx(10.0, rel=0.01)
    assert [one.text for one in findings(walk) if one.concern is Concern.LIMITATION] == []


@pytest.mark.parametrize("held", [0.12, 0.25, 0.45, 0.7])
def test_packets_that_are_held_back_at_the_start_cost_no_sample_its_angular_rate(held: float) -> None:
    start = min(map(moment, two_streams()))
    for first in (start + 0.01, start + 0.06):
        late = [evolve(one, t=first + held if first <= one.t < first + held else one.t) for one in two_streams()]
        walk = followed(late)
        assert len(walk.strides[Foot.LEFT]) >= 30
        assert walk.links[LEFT].absent_time(walk.now) == 0.0
        assert [one.text for one in findings(walk) if one.concern is Concern.LIMITATION] == []


@pytest.mark.parametrize("recipe", ["default", "kupt-dfpc"])
def test_an_absence_of_two_streams_is_the_same_where_some_packets_are_lost(recipe: str) -> None:
    for lost in (10, 11, 25):
        streams = [one for one in two_streams() if not 12.0 <= one.t < 12.0 + ABSENCE]
        link = followed([one for k, one in enumerate(streams) if k % lost != lost - 1], recipe).links[LEFT]
        assert link.ended_absences == pytest.approx(ABSENCE, abs=0.35)
        assert link.missing_time == pytest.approx(0.1 * link.missing, rel=0.12)


def test_a_foot_whose_rows_end_is_absent_from_then_on() -> None:
    other = [evolve(one, site=Site.RIGHT_FOOT) for one in rows(100, lambda k: True)]
    walk = followed(sorted([*rows(100, lambda k: k < 2000), *other], key=moment))
    assert walk.links[LEFT].absent_time(walk.now) == pytest.approx(20.0, abs=0.1)
    assert walk.links[Site.RIGHT_FOOT].absent_time(walk.now) == walk.links[LEFT].missing == 0
    codes = {one.code for one in findings(walk)}
    assert "sensor_absent" in codes and "samples_missing" not in codes


@pytest.mark.parametrize("every", [3, 4, 5])
def test_rows_are_counted_where_many_are_lost(every: int) -> None:
    kept = rows(100, lambda k: k % every != 1)
    link = followed(kept).links[LEFT]
    assert link.missing == pytest.approx(4000 - len(kept), abs=2), "the first may be missed"
    assert link.missing_time == pytest.approx(0.01 * link.missing, rel=1e-2)


def test_rows_without_every_second_one_are_rows_at_half_the_rate() -> None:
    link = followed(rows(100, lambda k: k % 2 == 0)).links[LEFT]
    assert (link.missing, link.missing_time, link.rate) == (0, 0.0, pytest.approx(50.0))


def test_frames_are_counted_where_every_second_one_is_lost() -> None:
    sent = [one for one in frames() if one.channel == "insole/frame"]
    lost = {id(one) for one in sent[1::2]}
    link = followed([one for one in frames() if id(one) not in lost]).links[LEFT]
    assert (link.samples, link.missing) == (len(sent[::2]), len(sent[1:-1:2]))
    assert link.missing_time == pytest.approx(0.01 * link.missing, rel=0.01)
    assert link.rate == pytest.approx(100.0, rel=0.01)
