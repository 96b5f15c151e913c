"""Motion-BIDS, letter by letter: what is written and what is read of others; and the official validator accepts it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import walks
from commands import one_line, run
from recordings import recorded
from strides import stride

from solepath import ActivityChanged, HeelStrike, ToeOff
from solepath.emulate import Route
from solepath.recording import RecordingError, RecordingWarning, open_source

# contracts of the room, which `convert` calls; no shorter way in
from solepath.recording.bids.names import Entities
from solepath.recording.bids.writer import MotionWriter
from solepath.recording.posed import PosedSample, PoseState
from solepath.types import Activity, Foot, Phase, Sample, Site

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
ACC, GYRO = (0.5, -0.25, 9.75), (0.125, 0.0, -1.5)
FULL = Sample(
    2.02, LEFT, ACC, GYRO, (7.0, 8.0), quat=(0.5, 0.5, -0.5, 0.5), mag=(1e-5, 2e-5, -4e-5), air_pressure=101300.0,
    saturated=True,
)  # fmt: skip
STATE = PoseState((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (1.0, 0.0, 0.0, 0.0), Phase.SWING)
SAMPLES = [
    PosedSample(Sample(2.0, LEFT, ACC, GYRO), None),
    PosedSample(Sample(2.01, RIGHT, None, None, (7.0,)), None),
    PosedSample(FULL, STATE),
    PosedSample(Sample(2.04, LEFT, ACC, None), STATE),
]
EVENTS = [
    ToeOff(t=2.03, known_at=2.05, foot=Foot.RIGHT),
    HeelStrike(t=2.005, known_at=2.05, foot=Foot.LEFT),
    HeelStrike(t=2.01, known_at=2.05, foot=Foot.LEFT, final=False),
    ActivityChanged(t=2.0, known_at=2.05, activity=Activity.WALKING, probability=1.0),
    stride(Foot.LEFT, 3.04, (3.0, 4.0, 0.5), heading_change=-0.25),
]
START = {"began": "2026-11-21T09:30:00.25Z", "began_t": 0.5}
MOTION = [
    "0.000000000 0.5 -0.25 9.75 0.125 0.0 -1.5 n/a n/a n/a n/a n/a n/a n/a n/a n/a n/a 0.0" + " n/a" * 10,
    "0.020000000 0.5 -0.25 9.75 0.125 0.0 -1.5 1e-05 2e-05 -4e-05 0.5 0.5 -0.5 0.5 101300.0 7.0 8.0 1.0"
    " 1.0 2.0 3.0 4.0 5.0 6.0 1.0 0.0 0.0 0.0",
    "0.040000000 0.5 -0.25 9.75" + " n/a" * 13 + " 0.0 1.0 2.0 3.0 4.0 5.0 6.0 1.0 0.0 0.0 0.0",
]
CHANNELS = [
    "latency n/a LATENCY s n/a",
    *(f"acc_{c} {c} ACCEL m/s^2 sensor" for c in "xyz"),
    *(f"gyro_{c} {c} GYRO rad/s sensor" for c in "xyz"),
    *(f"mag_{c} {c} MAGN T sensor" for c in "xyz"),
    *(f"device_quat_{c} quat_{c} ORNT n/a device" for c in "wxyz"),
    "air_pressure n/a MISC Pa n/a",
    *(f"pressure_{k} n/a MISC N n/a" for k in range(2)),
    "saturated n/a MISC n/a n/a",
    *(f"position_{c} {c} POS m world" for c in "xyz"),
    *(f"velocity_{c} {c} VEL m/s world" for c in "xyz"),
    *(f"attitude_quat_{c} quat_{c} ORNT n/a world" for c in "wxyz"),
]


def dataset(root: Path, entities: Entities, replace: bool = False, samples: list[PosedSample] = SAMPLES) -> list[Path]:
    writer = MotionWriter(root, entities, START, replace=replace)
    writer.add(samples, EVENTS)
    return writer.write()


def rows(path: Path) -> list[list[str]]:
    return [line.split("\t") for line in path.read_text("utf-8").splitlines()]


def test_every_channel_of_a_sensor_is_written_under_its_name_unit_and_frame(tmp_path: Path) -> None:
    root = tmp_path / "study"
    files = dataset(root, Entities("01", "corridor", "a", 2))
    stem = "sub-01_ses-a_task-corridor"
    folder = root / "sub-01" / "ses-a" / "motion"
    ends = [f"_tracksys-{side}foot_run-2_{end}" for side in ("left", "right")
            for end in ("channels.json", "channels.tsv", "motion.json", "motion.tsv")]  # fmt: skip
    assert files == [folder / f"{stem}{end}" for end in sorted([*ends, "_run-2_events.json", "_run-2_events.tsv"])]
    left = folder / f"{stem}_tracksys-leftfoot_run-2_motion.tsv"
    assert rows(left) == [line.split(" ") for line in MOTION]
    names, *described = rows(left.with_name(left.name.replace("motion.tsv", "channels.tsv")))
    assert names == ["name", "component", "type", "tracked_point", "units", "reference_frame", "description"]
    assert [" ".join([*row[:3], *row[4:6]]) for row in described] == CHANNELS
    assert {row[3] for row in described} == {"left_foot"}
    (right,) = rows(left.with_name(left.name.replace("left", "right")))
    assert right == ["0.010000000", "7.0"]
    metadata = json.loads(left.with_suffix(".json").read_text())
    assert metadata["SamplingFrequency"] == 50.0 and metadata["SamplingFrequencyEffective"] == pytest.approx(50.0)
    assert (metadata["RecordingDuration"], metadata["StartTime"]) == (pytest.approx(0.04), 0.0)
    assert (metadata["MotionChannelCount"], metadata["ACCELChannelCount"], metadata["MISCChannelCount"]) == (28, 3, 4)
    other = json.loads((left.with_name(left.name.replace("left", "right"))).with_suffix(".json").read_text())
    assert other["StartTime"] == pytest.approx(0.01)
    assert (other["SamplingFrequency"], other["SamplingFrequencyEffective"]) == ("n/a", "n/a")
    assert rows(folder / f"{stem}_run-2_events.tsv")[1:] == [
        ["0.000000", "n/a", "walking", *["n/a"] * 5],
        ["0.005000", "0", "heel_strike", "left", *["n/a"] * 4],
        ["0.030000", "0", "toe_off", "right", *["n/a"] * 4],
        ["0.040000", "1.000000", "stride", "left", "5.000000", "-0.250000", "0.500000", "0"],
    ]


def test_a_dataset_lists_each_recording_and_person_once_and_keeps_what_others_wrote(tmp_path: Path) -> None:
    root = tmp_path / "study"
    first, second = Entities("01", run=1), Entities("01", run=2)
    scans = root / "sub-01" / "sub-01_scans.tsv"
    for entities in (first, second, Entities("02")):
        dataset(root, entities)
    scans.write_text(scans.read_text().replace("acq_time", "acq_time\toperator").replace("Z\n", "Z\tme\n"))
    (root / "participants.tsv").write_text("participant_id\tage\nsub-01\t44\nsub-02\t51\n")
    with pytest.raises(RecordingError, match="sub-01_task-walk_run-1_events.json: the dataset has this recording"):
        MotionWriter(root, first)
    dataset(root, first, replace=True, samples=SAMPLES[:1])
    dataset(root, Entities("03"))
    moment = "2026-11-21T09:30:01.750000Z"
    assert rows(scans) == [
        ["filename", "acq_time", "operator"],
        ["motion/sub-01_task-walk_tracksys-leftfoot_run-2_motion.tsv", moment, "me"],
        ["motion/sub-01_task-walk_tracksys-rightfoot_run-2_motion.tsv", moment, "me"],
        ["motion/sub-01_task-walk_tracksys-leftfoot_run-1_motion.tsv", moment, "n/a"],
    ]
    assert rows(root / "participants.tsv")[1:] == [["sub-01", "44"], ["sub-02", "51"], ["sub-03", "n/a"]]
    left = [path.name for path in scans.parent.glob("motion/*run-1*")]
    assert left and not [name for name in left if "right" in name], "a sensor that is no longer there"
    with pytest.raises(RecordingError, match="has no samples, so that there is nothing to write"):
        MotionWriter(root, Entities("04")).write()


def by_hand(root: Path) -> Path:
    """Write two tracking systems, the left one in mg, of which the right one starts 0.05 s later; return the file of
    the left one."""
    folder = root / "sub-7" / "motion"
    folder.mkdir(parents=True)
    (root / "dataset_description.json").write_text("{}")
    (root / "task-go_motion.json").write_text('{"SamplingFrequency": 50, "SamplingFrequencyEffective": 0}')
    (root / "task-other_motion.json").write_text('{"SamplingFrequency": 10}')
    (root / "sub-7" / "sub-7_task-go_tracksys-R_motion.json").write_text('{"SamplingFrequencyEffective": 25}')
    starts = "".join(f"motion/sub-7_task-go_tracksys-{side}_motion.tsv\t2026-03-01T09:30:{second}\n"
                     for side, second in (("R", "01.05"), ("L", "01")))  # fmt: skip
    (root / "sub-7" / "sub-7_scans.tsv").write_text("filename\tacq_time\n" + starts)
    axes = "component\ttype\ttracked_point\tunits\tname"
    for side, point, unit, force in (("L", "LeftFoot", "mg", 1000.0), ("R", "r-shoe", "m/s^2", 9.80665)):
        stem = f"sub-7_task-go_tracksys-{side}"
        channels = [
            f"{c}\t{kind}\t{point}\t{u}\t{kind}{c}" for kind, u in (("GYRO", "deg/s"), ("ACCEL", unit)) for c in "zxy"
        ]
        channels += [f"n/a\tMISC\t{point}\tN\tpressure_0", f"n/a\tMISC\t{point}\tN\ttotal"]
        channels += [f"n/a\t{'LATENCY' if side == 'L' else 'MISC'}\tn/a\ts\ttime"]
        (folder / f"{stem}_channels.tsv").write_text("\n".join([axes, *channels]) + "\n\n")
        lines = [f"3\t1\t2\t{force}\t0\t0\t{5 + k}\t99\t{0.01 * k}" for k in range(4)]
        lines[2] = lines[2].replace(f"{force}\t0\t0", "n/a\tn/a\tn/a").replace("3\t1\t2", "n/a\t1\t2")
        (folder / f"{stem}_motion.tsv").write_text("\n".join(lines) + "\n")
    return folder / "sub-7_task-go_tracksys-L_motion.tsv"


def test_files_of_another_program_give_the_samples_of_both_feet(tmp_path: Path) -> None:
    """Times are those of the latencies, or of the rate that the nearest metadata have; a row of n/a is no sample."""
    samples = list(open_source(by_hand(tmp_path), report=pytest.fail))
    assert [(s.site, round(s.t, 6), s.pressure) for s in samples] == [
        (LEFT, 0.0, (5.0,)), (LEFT, 0.01, (6.0,)), (LEFT, 0.03, (8.0,)),
        (RIGHT, 0.05, (5.0,)), (RIGHT, 0.09, (6.0,)), (RIGHT, 0.17, (8.0,)),
    ]  # fmt: skip
    for sample in samples:
        assert sample.acc == pytest.approx((0.0, 0.0, 9.80665))
        assert sample.gyro == pytest.approx((0.01745329, 0.03490659, 0.05235988), abs=1e-8)
    assert {s.site for s in open_source(tmp_path / "sub-7/motion/sub-7_task-go_tracksys-R_motion.tsv", Foot.RIGHT)} == {
        RIGHT
    }


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("1000.0\t0\t0\t6\t99", "inf\t0\t0\t6\t99", "line 2, acc_left: is inf, not a finite number"),
        ("6\t99\t0.01", "6\t99\t5", "line 2, t: time is out of order: 5 s after 0 s and before 0.03 s"),
    ],
)
def test_a_row_that_cannot_be_costs_itself_and_is_named(tmp_path: Path, old: str, new: str, fault: str) -> None:
    path, reports = by_hand(tmp_path), list[str]()
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    samples = list(open_source(path, report=reports.append))
    assert [round(s.t, 6) for s in samples if s.site is LEFT] == [0.0, 0.03]
    assert len([s for s in samples if s.site is RIGHT]) == 3
    assert len(reports) == 1 and fault in reports[0] and reports[0].endswith("this row is left out")


@pytest.mark.parametrize(
    ("changed", "old", "new", "complaint"),
    [
        ("channels", "z\tACCEL", "w\tACCEL", "L_motion.tsv: names no column acc_z_left .it names gyro_z_left, "),
        ("channels", "mg", "deg/s", r"acc is in deg/s, not in one of m/s\^2, g, mg"),
        ("channels", "type", "kind", "L_channels.tsv: describes no channels, each with a type"),
        ("channels", "LeftFoot", "r_toe", "tracked points are on the same foot: r_toe .right., r-shoe .right."),
        ("motion", "1000.0", "x", "L_motion.tsv: line 1: acc_z_left is \"x\", not a number; 3 of 4 rows"),
        ("motion", "\n", "\t1\n", "L_motion.tsv: has 10 columns, and 9 are described"),
    ],
)  # fmt: skip
def test_a_fault_of_a_file_is_named(tmp_path: Path, changed: str, old: str, new: str, complaint: str) -> None:
    path = by_hand(tmp_path)
    file = path.with_name(path.name.replace("motion", changed))
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    with pytest.raises(RecordingError, match=complaint):
        list(open_source(path))


def test_without_times_and_rates_it_says_what_there_is(tmp_path: Path) -> None:
    path = by_hand(tmp_path)
    channels = path.with_name(path.name.replace("motion", "channels"))
    channels.write_text(channels.read_text().replace("LATENCY", "MISC"))
    assert next(iter(open_source(path))).t == 0.0, "by the rate of the dataset"
    (tmp_path / "task-go_motion.json").unlink()
    with pytest.raises(RecordingError, match="has no LATENCY channel, and its metadata have no SamplingFrequency"):
        open_source(path)


def test_convert_writes_a_dataset_which_track_reads(tmp_path):
    packets = walks.insoles(Route().stand(1.0).walk(4.0).stop(1.0)).packets
    source = recorded(tmp_path / "walk.jsonl", packets, {"began": "2026-11-21T09:30:00Z"})
    root = tmp_path / "study"
    done = run("convert", source, root, "--subject", "01", "--task", "corridor")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"10 files written to {root / 'sub-01' / 'motion'}\n"
    again = one_line(run("convert", source, root, "--subject", "01", "--task", "corridor"))
    assert "the dataset has this recording already; --force replaces it" in again
    motion = next(root.glob("sub-01/motion/*leftfoot_motion.tsv"))
    tables = [run("track", path).stdout.splitlines()[2:6] for path in (motion, source)]
    assert tables[0] == tables[1] and tables[0][2].startswith("left")
    assert "no label of BIDS" in one_line(run("convert", source, root, "--subject", "0_1"))


def test_a_foot_whose_values_cannot_be_right_is_left_out_beside_one_that_is(tmp_path: Path) -> None:
    path = by_hand(tmp_path)
    path.write_text(path.read_text().replace("1000.0", "30.0"))
    with pytest.warns(RecordingWarning, match="left foot: .*its accelerometer is broken, and left out"):
        samples = [one for one in open_source(path) if isinstance(one, Sample)]
    assert {sample.site for sample in samples if sample.acc is not None} == {Site.RIGHT_FOOT}
