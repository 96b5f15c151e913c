"""Motion-BIDS: the official validator accepts the dataset, and reading it back gives the samples and their events."""

import json
import subprocess
import sys
from math import degrees
from pathlib import Path

import pytest
import walks
from commands import one_line, run
from recordings import recorded

from solepath import Foot, HeelStrike, Packet, Sample, Session, Site, StrideTaken
from solepath.recording import RecordingError, open_source
from solepath.recording.bids.columns import read_table
from solepath.recording.bids.names import Entities
from solepath.recording.bids.reader import foot_of_point
from solepath.recording.bids.writer import MotionWriter
from solepath.recording.posed import PosedSession

FIRST = Entities("01")
START = {"began": "2026-11-21T09:30:00.25Z", "began_t": 0.0}


def dataset(root: Path, items=None, entities: Entities = FIRST, **options) -> list[Path]:
    """Write the items, by default a walk with insoles, into a dataset; return the files of the recording."""
    writer = MotionWriter(root, entities, START, **options)
    posed = PosedSession(Session(poses=True))
    for item in walks.insoles().packets if items is None else items:
        events = posed.session.feed(item)
        writer.add(posed.take(), events)
    events = posed.session.finish()
    writer.add(posed.take(), events)
    return writer.write()


def validate(root: Path) -> dict:
    """Return the report of the official validator."""
    pytest.importorskip("bids_validator_deno", reason="the extra bids is not installed")
    script = Path(sys.executable).with_name("bids-validator-deno")
    done = subprocess.run([script, root, "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def issues(report: dict, severity: str) -> list[tuple]:
    found = [issue for issue in report["issues"]["issues"] if issue["severity"] == severity]
    return [(issue["code"], issue.get("subCode"), issue.get("location")) for issue in found]


def motion_file(files: list[Path], foot: str = "left") -> Path:
    return next(path for path in files if path.name.endswith(f"tracksys-{foot}foot_motion.tsv"))


def test_the_official_validator_accepts_two_persons_and_two_visits_of_one(tmp_path):
    """What a program cannot know is missing, and only recommended: authors, institution and the like."""
    for subject, visit in (("01", "a"), ("01", "b"), ("02", "a")):
        dataset(tmp_path / "study", entities=Entities(subject, "walk", visit, 1))
    report = validate(tmp_path / "study")
    assert issues(report, "error") == []
    assert {code for code, _, _ in issues(report, "warning")} <= {
        "JSON_KEY_RECOMMENDED", "SIDECAR_KEY_RECOMMENDED", "NO_AUTHORS", "TOO_FEW_AUTHORS",
    }  # fmt: skip
    assert sorted(report["summary"]["subjects"]) == ["01", "02"]
    assert report["summary"]["tasks"] == ["walk"]


def test_reading_back_gives_the_samples(tmp_path):
    """Times differ by the start of the recording, from which latencies count."""
    posed = PosedSession(Session(poses=True))
    fed: list[Sample] = []
    for packet in walks.insoles().packets:
        posed.session.feed(packet)
        fed += [one.sample for one in posed.take()]
    posed.session.finish()
    fed += [one.sample for one in posed.take()]
    found = list(open_source(motion_file(dataset(tmp_path / "study"))))
    start = min(sample.t for sample in fed)
    expected = sorted(fed, key=lambda one: (one.t, one.site.value))
    found.sort(key=lambda one: (one.t, one.site.value))
    assert len(found) == len(expected)
    for back, sample in zip(found, expected, strict=True):
        assert isinstance(back, Sample)
        assert back.t == pytest.approx(sample.t - start, abs=1e-9)
        assert (back.site, back.acc, back.gyro, back.pressure) == (
            sample.site, sample.acc, sample.gyro, sample.pressure,
        )  # fmt: skip


def test_the_events_and_the_starts_are_those_of_the_session(tmp_path):
    session = Session()
    events = [*session.feed(walks.insoles().packets), *session.finish()]
    files = dataset(tmp_path / "study")
    rows = read_table(next(path for path in files if path.name.endswith("events.tsv")))
    strikes = [event for event in events if isinstance(event, HeelStrike) and event.final]
    found = [row for row in rows if row["trial_type"] == "heel_strike"]
    assert [row["foot"] for row in found] == [event.foot.value for event in sorted(strikes, key=lambda one: one.t)]
    strides = [event for event in events if isinstance(event, StrideTaken) and event.final]
    lengths = sorted(float(row["stride_length"]) for row in rows if row["trial_type"] == "stride")
    assert lengths == pytest.approx(sorted(event.length for event in strides), abs=1e-6)
    onsets = [float(row["onset"]) for row in rows]
    assert onsets == sorted(onsets)
    (scans,) = (tmp_path / "study").glob("sub-01/*_scans.tsv")
    moments = {row["acq_time"] for row in read_table(scans)}
    assert len(moments) == 1 and next(iter(moments)).startswith("2026-11-21T09:30:00.")


def foreign(root: Path, tracked: dict[str, str], acc: float = 1.0, gyro: float = 1.0, units=("m/s^2", "rad/s")) -> Path:
    """Write a dataset as another program would: one tracking system with several points, no latency channel."""
    folder = root / "sub-07" / "motion"
    folder.mkdir(parents=True)
    (root / "dataset_description.json").write_text('{"Name": "x", "BIDSVersion": "1.9.0"}')
    (root / "task-gait_motion.json").write_text('{"TaskName": "gait", "SamplingFrequency": 100}')
    feet = {Site.LEFT_FOOT: [], Site.RIGHT_FOOT: []}
    for sample in walks.samples():
        feet[sample.site].append(sample)
    header = ["name\tcomponent\ttype\ttracked_point\tunits"]
    for point in tracked:
        header += [f"{point}_A{c}\t{c}\tACCEL\t{point}\t{units[0]}" for c in "xyz"]
        header += [f"{point}_G{c}\t{c}\tGYRO\t{point}\t{units[1]}" for c in "xyz"]
    lines = []
    for left, right in zip(*feet.values(), strict=True):
        cells = []
        for foot in tracked.values():
            one = left if foot == "left" else right
            cells += [repr(value * acc) for value in one.acc] + [repr(value * gyro) for value in one.gyro]
        lines.append("\t".join(cells))
    stem = folder / "sub-07_task-gait_tracksys-imu"
    Path(f"{stem}_channels.tsv").write_text("\n".join(header) + "\n")
    Path(f"{stem}_motion.tsv").write_text("\n".join(lines) + "\n")
    return Path(f"{stem}_motion.tsv")


def test_a_dataset_of_another_program_is_read_in_its_units(tmp_path):
    points = {"LeftFoot": "left", "r_ankle": "right"}
    path = foreign(tmp_path, points, 1 / 9.80665, degrees(1.0), ("g", "deg/s"))
    found = list(open_source(path))
    expected = walks.samples()
    assert len(found) == len(expected)
    for foot in Foot:
        ours = next(one for one in found if isinstance(one, Sample) and one.site.foot is foot)
        theirs = next(one for one in expected if one.site.foot is foot)
        assert ours.acc == pytest.approx(theirs.acc) and ours.gyro == pytest.approx(theirs.gyro)
        assert ours.t == 0.0
    assert "strides" in run("track", path).stdout


def test_what_cannot_be_read_is_one_sentence(tmp_path):
    assert "there are: pelvis, sternum" in failure(foreign(tmp_path / "a", {"pelvis": "left", "sternum": "right"}))
    units = ("furlong/s^2", "rad/s")
    assert "furlong/s^2, not in one of m/s^2" in failure(foreign(tmp_path / "b", {"left_foot": "left"}, units=units))
    path = foreign(tmp_path / "c", {"left_foot": "left"})
    path.write_text(path.read_text() + "1\t2\n")
    assert "no table of numbers" in failure(path)
    path = foreign(tmp_path / "d", {"left_foot": "left", "left_heel": "left"})
    assert "several tracked points are on the left foot" in failure(path)


def failure(path: Path) -> str:
    with pytest.raises(RecordingError) as raised:
        list(open_source(path))
    return str(raised.value)


@pytest.mark.parametrize(
    ("point", "foot"),
    [("LeftFoot", Foot.LEFT), ("l_ankle", Foot.LEFT), ("R-shoe", Foot.RIGHT), ("right heel", Foot.RIGHT),
     ("RF", None), ("calcn_r", Foot.RIGHT), ("LeftWrist", None), ("foot", None), ("clear_foot", None)],
)  # fmt: skip
def test_the_foot_of_a_tracked_point(point, foot):
    assert foot_of_point(point) is foot


def recording(folder: Path, items: list[Packet]) -> Path:
    return recorded(folder / "walk.jsonl", items, {"began": "2026-11-21T09:30:00Z"})


def test_convert_writes_a_dataset_which_track_reads(tmp_path):
    source, root = recording(tmp_path, walks.insoles().packets), tmp_path / "study"
    done = run("convert", source, root, "--subject", "01", "--task", "corridor")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"10 files written to {root / 'sub-01' / 'motion'}\n"
    again = one_line(run("convert", source, root, "--subject", "01", "--task", "corridor"))
    assert "the dataset has this recording already; --force replaces it" in again
    assert run("convert", source, root, "--subject", "01", "--task", "corridor", "--force").returncode == 0
    motion = next(root.glob("sub-01/motion/*leftfoot_motion.tsv"))
    tables = [run("track", path).stdout.splitlines()[2:6] for path in (motion, source)]
    assert tables[0] == tables[1] and tables[0][2].startswith("left")
    assert "no label of BIDS" in one_line(run("convert", source, root, "--subject", "0_1"))
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "notes.txt").write_text("x")
    assert "no BIDS dataset" in one_line(run("convert", source, tmp_path / "other", "--subject", "01"))


def test_convert_writes_storage_files_of_opensim(tmp_path):
    source, out = recording(tmp_path, walks.insoles().packets), tmp_path / "walk.sto"
    done = run("convert", source, out)
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.endswith(f" rows written to {out}\n")
    assert "DataType=Quaternion" in out.read_text()
    assert "exists; --force replaces it" in one_line(run("convert", source, out))
    assert run("convert", source, out, "--positions", "--force").returncode == 0
    assert "DataType=Vec3" in out.read_text()


def test_damaged_files_of_a_dataset_are_named_in_one_line(tmp_path):
    path = motion_file(dataset(tmp_path / "study"))
    channels = path.with_name(path.name.replace("_motion.", "_channels."))
    rows, described = path.read_bytes(), channels.read_bytes()
    channels.write_bytes(bytes(range(128, 256)) * 20)
    assert "channels.tsv: describes no channels" in one_line(run("track", path))
    channels.write_bytes(described)
    path.write_bytes(b"")
    assert "holds no samples" in one_line(run("track", path))
    path.write_bytes(rows)
    assert run("track", path).stderr == ""


def test_all_files_of_a_recording_may_be_named_and_none_of_another(tmp_path):
    files = dataset(tmp_path / "study")
    both = [motion_file(files, "left"), motion_file(files, "right")]
    assert len(open_source(both).samples) == len(open_source(both[0]).samples)
    other = motion_file(dataset(tmp_path / "study", entities=Entities("02")))
    with pytest.raises(RecordingError, match="is no tracking system of the recording"):
        open_source([both[0], other])
