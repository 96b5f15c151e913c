"""The lab streaming layer between processes of this machine: nothing is lost, and times are right to 1 ms."""

import json
import os
import re
import subprocess
import sys
import time
import uuid
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from programs import emulator, run, started
from strides import stride

from solepath import ActivityChanged, Foot, HeelStrike, Sample, Site, TurnMade
from solepath.recording.posed import PosedSample, PoseState
from solepath.types import Activity, Phase, Turn

pylsl = pytest.importorskip("pylsl", reason="the extra lsl is not installed")
from solepath.recording.lsl.inlet import LslError, LslInlet, stream_names  # noqa: E402
from solepath.recording.lsl.outlet import POSE_CHANNELS, LslOutlets  # noqa: E402

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
RATE = 100.0
"""Rate of the samples of each foot, 1/s."""
SEND = """
import sys, time
from solepath import Sample, Site
from solepath.recording.lsl.outlet import LslOutlets
from solepath.recording.posed import PosedSample

seconds, rate, name = float(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
outlets = LslOutlets(0.0, name)
feet = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
outlets.push([PosedSample(Sample(0.0, site, (0.0,) * 3, (0.0,) * 3), None) for site in feet], [])
print("ready", flush=True)
sys.stdin.readline()
from pylsl import local_clock
start = local_clock() + 0.1
for number in range(1, int(seconds * rate) + 1):
    t = start + number / rate
    time.sleep(max(0.0, t - local_clock()))
    for site in feet:
        outlets.push([PosedSample(Sample(t, site, (float(number), 0.0, 0.0), (t, 0.0, 0.0)), None)], [])
print("done", flush=True)
sys.stdin.readline()
"""
"""A program that sends numbered samples of both feet, whose angular rate is their own time on LSL's clock."""


PROBE = """
import sys, pylsl
outlet = pylsl.StreamOutlet(pylsl.StreamInfo("probe", "Test", 1, 0.0, pylsl.cf_double64, "probe"))
print("ready", flush=True)
sys.stdin.readline()
"""
FOLDER = TemporaryDirectory()
Path(FOLDER.name, "lsl_api.cfg").write_text(
    f"[multicast]\nResolveScope = machine\n[lab]\nKnownPeers = {{127.0.0.1}}\nSessionID = {uuid.uuid4().hex}\n"
)
# liblsl reads it once, at the first call of any test: so it is there before the first test runs
os.environ["LSLAPICFG"] = str(Path(FOLDER.name, "lsl_api.cfg"))


@pytest.fixture(scope="module", autouse=True)
def layer() -> None:
    """Skip where no stream is found; the streams of these tests stay on this machine and apart from others."""
    with subprocess.Popen(
        [sys.executable, "-c", PROBE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None and other.stdout.readline() == "ready\n"
        found = pylsl.resolve_byprop("name", "probe", timeout=30.0)
        other.communicate("\n")
    if not found:
        pytest.skip("streams of another process are not found: neither multicast nor loopback works here")


def exchange(seconds: float) -> tuple[dict[Site, list[Sample]], int]:
    """Send samples from another process for so long; return those that came, and how many were sent for each foot."""
    name = f"test {uuid.uuid4().hex[:8]}"
    words = [sys.executable, "-c", SEND, str(seconds), str(RATE), name]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as sender:
        assert sender.stdin is not None and sender.stdout is not None
        assert sender.stdout.readline() == "ready\n"
        inlets = {site: LslInlet(site, f"{name} {site.value} samples", timeout=30.0) for site in (LEFT, RIGHT)}
        found: dict[Site, list[Sample]] = {LEFT: [], RIGHT: []}
        sender.stdin.write("\n")
        sender.stdin.flush()
        end = time.monotonic() + seconds + 0.6
        while time.monotonic() < end:
            for site, inlet in inlets.items():
                found[site] += [sample for sample in inlet.pull() if sample.acc != (0.0, 0.0, 0.0)]
            time.sleep(0.005)
        assert sender.stdout.readline() == "done\n"
        for site, inlet in inlets.items():
            found[site] += inlet.pull()
            inlet.close()
        sender.stdin.write("\n")
    return found, int(seconds * RATE)


def check(seconds: float) -> str:
    """Check a transmission for so long; return the figure."""
    found, sent = exchange(seconds)
    errors = []
    for samples in found.values():
        assert [int(sample.acc[0]) for sample in samples] == list(range(1, sent + 1)), "lost, repeated or out of order"
        errors += [abs(sample.t - sample.gyro[0]) for sample in samples]
        assert all(earlier.t < later.t for earlier, later in zip(samples, samples[1:], strict=False))
    errors.sort()
    assert errors[-1] < 1e-3
    return (
        f"{len(errors)} samples in {seconds:g} s, none lost; clock error: "
        f"median {1e6 * errors[len(errors) // 2]:.1f} us, largest {1e6 * errors[-1]:.1f} us"
    )


@pytest.mark.soak
def test_no_sample_is_lost_and_times_are_right() -> None:
    print(check(2.0))


@pytest.mark.long
def test_no_sample_is_lost_in_ten_minutes() -> None:
    """The figure of docs/formats.md: `pytest -m long -s tests/exchange/test_lsl.py`."""
    print(check(600.0))


def received(name: str, kind: str) -> "pylsl.StreamInlet":
    (info,) = pylsl.resolve_byprop("name", name, timeout=30.0)
    assert info.type() == kind
    inlet = pylsl.StreamInlet(info)
    inlet.open_stream(30.0)
    return inlet


def pulled(inlet: "pylsl.StreamInlet", count: int) -> tuple[list, list[float]]:
    """Return `count` values of a stream with their time stamps, and check that no more come."""
    values, times = [], []
    end = time.monotonic() + 30.0
    while len(times) < count and time.monotonic() < end:
        more, stamps = inlet.pull_chunk(timeout=0.1)
        values, times = values + list(more), times + list(stamps)
    more, _ = inlet.pull_chunk(timeout=0.1)
    assert not list(more)
    return values, times


STATE = PoseState((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (0.5, 0.5, -0.5, -0.5), Phase.SWING)
SENT = [
    PosedSample(Sample(1.0, LEFT, (0.5, -0.25, 9.75), (0.125, 0.0, -1.5)), None),
    PosedSample(Sample(1.25, LEFT, (1.0, 2.0, 3.0), None), STATE),
    PosedSample(Sample(1.5, LEFT, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0)), STATE),
]
EVENTS = [
    HeelStrike(t=2.0, known_at=2.5, foot=Foot.LEFT),
    HeelStrike(t=2.125, known_at=2.5, foot=Foot.RIGHT, final=False),
    stride(Foot.RIGHT, 2.25),
    TurnMade(t=3.0, known_at=3.0, t_start=2.0, angle=1.5, turn=Turn.LEFT),
    TurnMade(t=3.5, known_at=3.5, t_start=3.0, angle=0.1, turn=None),
    ActivityChanged(t=2.5, known_at=4.0, activity=Activity.WALKING, probability=1.0),
]


def test_events_markers_samples_and_poses_go_out_with_their_own_times() -> None:
    """They are received by plain pylsl, as a recorder of the lab would."""
    name, offset = f"walk {uuid.uuid4().hex[:8]}", pylsl.local_clock()
    outlets = LslOutlets(offset, name)
    outlets.push(SENT[2:], [])  # the streams of the foot begin
    contents = {"markers": "Markers", "events": "Events", "left_foot samples": "IMU", "left_foot pose": "MoCap"}
    inlets = {content: received(f"{name} {content}", kind) for content, kind in contents.items()}
    assert inlets["left_foot pose"].info().get_channel_labels() == [label for label, _ in POSE_CHANNELS]
    outlets.push(SENT, EVENTS)
    steady = [*STATE.position, *STATE.velocity, *STATE.attitude, 3.0]
    expected = {
        "markers": [("HeelStrike left", 2.0), ("StrideTaken right", 2.25), ("TurnMade LEFT", 3.0), ("WALKING", 2.5)],
        "events": [(json.dumps(event.to_dict()), event.t) for event in EVENTS],
        "left_foot samples": [([0.5, -0.25, 9.75, 0.125, 0.0, -1.5], 1.0), ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 1.5)],
        "left_foot pose": [(steady, 1.25), (steady, 1.5)],
    }
    for content, rows in expected.items():
        values, times = pulled(inlets[content], len(rows))
        assert [value if len(value) > 1 else value[0] for value in values] == [value for value, _ in rows]
        assert times == pytest.approx([t + offset for _, t in rows], abs=1e-9)
        assert outlets.sent[content] == len(rows) + content.startswith("left")
    outlets.close()


def stream(name: str, labels: list[str] | None, units: list[str] | None) -> "pylsl.StreamOutlet":
    info = pylsl.StreamInfo(name, "IMU", 7, 100.0, pylsl.cf_float32, name)
    if labels:
        info.set_channel_labels(labels)
    if units:
        info.set_channel_units(units)
    return pylsl.StreamOutlet(info)


LABELS = ["battery", "AccX", "AccY", "AccZ", "Gyroscope 1", "Gyroscope 2", "Gyroscope 3"]


def test_a_stream_of_another_program_is_read_in_its_units() -> None:
    outlet = stream("other", LABELS, ["V", "g", "g", "g", "deg/s", "deg/s", "deg/s"])
    inlet = LslInlet(RIGHT, "other", offset=pylsl.local_clock())
    outlet.push_sample([3.7, 0.0, 0.5, 1.0, 180.0, 0.0, -90.0], inlet.offset + 2.0)
    samples: list[Sample] = []
    end = time.monotonic() + 30.0
    while not samples and time.monotonic() < end:
        samples += inlet.pull()
    (sample,) = samples
    assert sample.acc == pytest.approx((0.0, 4.903325, 9.80665)) and sample.site is RIGHT
    assert sample.gyro == pytest.approx((3.14159265, 0.0, -1.5707963))
    assert sample.t == pytest.approx(2.0, abs=1e-3)


@pytest.mark.soak
def test_what_is_wrong_with_a_stream_is_one_sentence() -> None:
    outlets = [stream("bare", None, None), stream("unitless", LABELS, None)]
    with pytest.raises(LslError, match="has no acc_x, _y and _z; its channels are: 7 without labels"):
        LslInlet(LEFT, "bare")
    with pytest.raises(LslError, match="the unit of acc of the stream 'unitless' is none, not one of m/s\\^2"):
        LslInlet(LEFT, "unitless")
    units = {"acc": "g", "gyro": "dps"}
    assert LslInlet(LEFT, "unitless", units=units).received == 0
    assert LslInlet(LEFT, "bare", channels=["-", *[f"{q}_{a}" for q in ("acc", "gyro") for a in "xyz"]], units=units)
    assert {"bare", "unitless"} <= set(stream_names())
    assert len(outlets) == 2


def line_of(process: subprocess.Popen[str], start: str) -> str:
    """Return the first line of a program that starts so."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith(start):
            return line
    raise AssertionError(f"no line starts with {start!r}")


@pytest.mark.long
def test_what_live_publishes_is_run_by_lsl_and_published_again(tmp_path: Path) -> None:
    names = ["--left", "solepath L", "--right", "solepath R"]
    with (
        emulator("--distance", 120) as (_, address),
        started("live", "--via", address, *names, "--lsl", "lab", "--duration", 300) as live,
    ):
        line_of(live, "   ")  # the streams are there since the first sample
        streams = run("scan", "--lsl").stdout.splitlines()
        assert {f"lab {foot}_foot {content}" for foot in ("left", "right") for content in ("samples", "pose")} <= set(
            streams
        )
        given = ["--left", "lsl:lab left_foot samples", "--right", "lsl:lab right_foot samples"]
        done = run("live", *given, "--lsl", "--duration", 8, "--out", tmp_path / "out")
    assert re.search(r"^left +\d{3,} +\d+\.\d +[3-9] ", done.stdout, re.MULTILINE)
    assert re.search(r"published: \d+ in solepath markers, \d+ in solepath events, ", done.stdout)
    events = [json.loads(line) for line in (tmp_path / "out" / "events.jsonl").read_text().splitlines()]
    strikes = [event for event in events if event["event"] == "HeelStrike"]
    assert len(strikes) > 6 and all(-0.5 < event["t"] < 9.0 for event in strikes)


def test_a_stream_without_a_name_or_with_other_units_is_one_sentence() -> None:
    assert "lsl: names no stream" in run("live", "--left", "lsl:", expect=2).stderr
    assert "not ACC,GYRO" in run("live", "--left", "lsl:x", "--units", "g", expect=2).stderr
