"""Exports of known devices, written by hand from their documents, are read as they are and by name."""

from __future__ import annotations

from math import hypot, radians
from pathlib import Path

import pytest
from commands import rows_in, run
from exported import LENGTH, G, strange

from solepath.recording import RecordingError, RecordingWarning, TableMapping, open_source, read_samples
from solepath.types import Foot, Sample, Site

FILES = Path(__file__).parent / "files"
METAWEAR = sorted(FILES.glob("MetaWear_*.csv"))
LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT


def near(sample: Sample, t: float, acc: tuple[float, ...], gyro: tuple[float, ...]) -> bool:
    """Return whether a sample has these values: s, g and deg/s."""
    assert sample.t == pytest.approx(t, abs=1e-9)
    assert sample.acc == pytest.approx([G * value for value in acc])
    assert sample.gyro == pytest.approx([radians(value) for value in gyro])
    return True


def test_a_movella_dot_has_microseconds_that_start_again_si_forces_and_degrees() -> None:
    with pytest.warns(RecordingWarning, match="was not synchronised, so the feet have separate clocks"):
        samples = list(read_samples(FILES / "dot.csv"))
    assert {sample.site for sample in samples} == {LEFT}, "by its tag"
    acc = (0.1 / G, -0.2 / G, 9.8 / G)
    assert near(samples[0], 4294.950629, acc, (0.5, -0.25, 90.0))
    assert near(samples[2], 4294.983963, acc, (0.5, -0.25, 180.0))


def test_a_movella_dot_without_what_the_sensors_measured_gets_a_line_on_the_modes_that_have_it() -> None:
    with pytest.raises(RecordingError) as caught:
        read_samples(FILES / "dot_free.csv")
    assert "without Acc_X, Acc_Y, Acc_Z; FreeAcc is without gravity" in str(caught.value)
    assert caught.value.repair.startswith('record with "Rate quantities"')


def test_metabase_has_a_file_for_each_sensor_and_one_clock_since_1970() -> None:
    source = open_source(METAWEAR)
    samples = [item for item in source if isinstance(item, Sample)]
    # the gyroscope is known from 5 to 25 ms, so there are two times of the accelerometer
    assert near(samples[0], 0.010, (0.01, -0.02, 1.0), (0.0, 0.0, 15.0))
    assert near(samples[1], 0.020, (0.01, -0.02, 1.0), (0.0, 0.0, 25.0))
    assert len(samples) == 2 and source.header["began"].startswith("2026-03-01T08:30:00")
    (first, *_) = read_samples(FILES / "metabase_ios.csv")
    assert first.acc == pytest.approx((0.01 * G, -0.02 * G, G)) and first.gyro is None


@pytest.mark.parametrize("name", ["Left_Linear Acceleration_100.000Hz.csv", "Left_Gravity_100.000Hz.csv"])
def test_what_the_fusion_of_a_metawear_computed_is_not_taken_for_its_accelerometer(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(METAWEAR[0].read_bytes())
    with pytest.raises(RecordingError, match="of the sensor fusion, not what the accelerometer measured"):
        read_samples(tmp_path / name)


def test_a_physilog_has_lines_of_groups_names_and_units() -> None:
    samples = list(read_samples(FILES / "physilog.csv"))
    assert len(samples) == 3 and near(samples[1], 0.01563, (-0.1, 0.5, 0.8), (0.5, -0.25, 90.0))


def test_opengo_has_both_insoles_in_a_file_and_rows_without_one_of_them() -> None:
    samples = list(read_samples(FILES / "opengo.txt"))
    assert [sample.site for sample in samples] == [RIGHT, LEFT, RIGHT, LEFT, RIGHT]
    assert near(samples[0], 0.0, (-0.1875, 0.046875, 0.96875), (-2.5, -3.5, 90.0))
    assert samples[0].pressure == (6.5, 5.75) and samples[1].pressure == (7.25, 5.25)


def test_an_ngimu_is_read_and_the_name_of_its_folder_gives_the_foot(tmp_path: Path) -> None:
    paths = []
    for name in ("NGIMU-Right - 0029BBBB", "NGIMU-Left - 0029AAAA"):
        paths.append(tmp_path / name / "sensors.csv")
        paths[-1].parent.mkdir()
        paths[-1].write_bytes((FILES / "NGIMU" / "sensors.csv").read_bytes())
    samples = list(read_samples(paths))
    assert [sample.site for sample in samples[:2]] == [LEFT, RIGHT] and len(samples) == 6
    assert near(samples[2], 0.020053, (-0.0046875, 0.015625, 1.03125), (-0.0125, 0.125, 90.0))


def test_a_file_that_lost_its_first_lines_is_read_by_the_name_of_its_format(tmp_path: Path) -> None:
    path = tmp_path / "right.csv"
    path.write_text("\n".join((FILES / "dot.csv").read_text().splitlines()[11:]) + "\n")
    with pytest.raises(RecordingError, match="is of no known format"):
        read_samples(path)
    samples = list(read_samples(path, mapping=TableMapping(format="movella-dot")))
    assert samples[2].t - samples[0].t == pytest.approx(0.033334) and samples[0].site is RIGHT


def test_tables_of_other_programs_that_look_alike_are_not_taken_for_a_known_format(tmp_path: Path) -> None:
    """MT Manager writes the names of a DOT in other units (rad/s, and ticks of 0.1 ms), between tabs."""
    path = tmp_path / "MT_left.txt"
    rows = "".join(f"{k}\t{100 * k}\t0.1\t0.2\t9.8\t0.01\t0.02\t0.03\n" for k in range(9))
    header = "PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n"
    path.write_text("// General information:\n//  Firmware Version: 4.4.0\n" + header + rows)
    with pytest.raises(RecordingError, match="is of no known format"):
        read_samples(path)


MAPPING = """
[columns]
t = "Zeit"
acc = ["Beschl X", "Beschl Y", "Beschl Z"]
gyro = ["Gyro X", "Gyro Y", "Gyro Z"]

[units]
t = "ms"
acc = "g"
gyro = "deg/s"
"""


def test_a_table_of_a_lab_goes_to_a_report_with_its_mapping(tmp_path: Path) -> None:
    (tmp_path / "lab.toml").write_text(MAPPING)
    files = [strange(tmp_path / "files", foot) for foot in Foot]
    out = tmp_path / "out"
    done = run("track", *files, "--mapping", tmp_path / "lab.toml", "--out", out, "--report", out / "walk.html")
    assert done.returncode == 0 and done.stderr == "" and (out / "walk.html").exists()
    last = {row["foot"]: row for row in rows_in(out / "strides.csv")}
    for foot in Foot:
        assert hypot(*(float(last[foot.value][axis]) for axis in ("x_m", "y_m"))) == pytest.approx(LENGTH, rel=0.03)
