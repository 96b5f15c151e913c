"""Files of both feet and of several sensors: which foot a file is of, and how those of one foot are joined."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from solepath.recording import RecordingError, TableMapping, read_samples
from solepath.recording.mapping.words import foot_of_text
from solepath.recording.samples import load_samples
from solepath.types import Foot, Sample, Site


def write(path: Path, names: str, t: np.ndarray, *columns: np.ndarray | float) -> Path:
    rows = np.column_stack([t, *(np.broadcast_to(column, t.shape) for column in columns)])
    path.write_text("\n".join([names, *(",".join(f"{v:.6f}" for v in row) for row in rows)]) + "\n")
    return path


def acc_file(path: Path, t: np.ndarray) -> Path:
    return write(path, "t,acc_x,acc_y,acc_z", t, t, 0.0, 9.81)


def gyro_file(path: Path, t: np.ndarray) -> Path:
    return write(path, "t,gyro_x,gyro_y,gyro_z", t, 0.2 * t, 0.0, 0.0)


NAMED = {
    Foot.LEFT: ("left", "LF", "LeftFoot2", "walkLeft", "l_7", "S01-left.acc", "IMULeft")
    + ("proband01_links", "LinkerFuss", "p1 li", "01li", "pied_gauche", "pie izquierdo", "IZQ", "pe-esquerdo_3")
    + ("sinistra", "левая_нога", "Va\u0308nster", "左脚", "s1_左", "왼발", "re-test_left", "lewa"),
    Foot.RIGHT: ("walk_R", "S01-right-acc", "RightGyro", "RF", "right", "RECHTS", "proband01_rechts", "01_re")
    + ("Droite2", "paso_der", "pé_direito", "destro", "правая", "höger", "右足", "오른쪽", "Li_Wei_right", "IMU_DX"),
    None: ("leftover", "bright", "left_right", "control", "R2L", "Accelerometer", "", "Li_Wei", "re-test", "Der Gang")
    + ("linksrechts", "Linkspartei", "rechtsum", "links_rechts", "trial3D", "G1", "left_derecha"),
}


def test_a_name_gives_the_foot_if_a_word_of_it_does() -> None:
    assert {text: foot_of_text(text) for texts in NAMED.values() for text in texts} == {
        text: foot for foot, texts in NAMED.items() for text in texts
    }


def test_two_files_of_two_feet_are_one_recording(tmp_path: Path) -> None:
    t = np.arange(20) / 100.0
    files = [acc_file(tmp_path / name, t) for name in ("b_right.csv", "a_left.csv")]
    samples = list(read_samples(files))
    assert [sample.site for sample in samples[:4]] == [Site.LEFT_FOOT, Site.RIGHT_FOOT] * 2 and len(samples) == 40
    assert {sample.site for sample in read_samples(files, Foot.LEFT)} == {Site.LEFT_FOOT}


def test_files_whose_names_lack_the_foot_need_the_feet_in_their_order(tmp_path: Path) -> None:
    files = [acc_file(tmp_path / name, np.arange(20) / 100.0) for name in ("one.csv", "two.csv")]
    patterns = TableMapping(feet={"left": "*wo.csv", "right": "*ne.csv"})
    assert [table.path for table in load_samples(files, mapping=patterns).tables] == files[::-1], "the left one first"
    with pytest.raises(RecordingError) as caught:
        read_samples(files)
    assert [problem.what for problem in caught.value.problems] == ["nothing says of which foot it is"] * 2
    assert caught.value.repair == (
        "name the feet in the order of the files: --foot left,right, "
        "or in Python read_samples(files, [Foot.LEFT, Foot.RIGHT])"
    )
    assert len(load_samples(files, [Foot.RIGHT, Foot.LEFT]).tables) == 2
    with pytest.raises(ValueError, match="there are 1 feet for 2 files"):
        load_samples(files, [Foot.RIGHT])


def test_a_file_that_is_given_twice_is_an_error(tmp_path: Path) -> None:
    file = acc_file(tmp_path / "one.csv", np.arange(20) / 100.0)
    (tmp_path / "folder").mkdir()
    again = tmp_path / "folder" / ".." / "one.csv"
    for feet in (None, [Foot.LEFT, Foot.RIGHT]):
        with pytest.raises(RecordingError, match=r"one\.csv: is given twice$"):
            read_samples([file, again], feet)


def test_the_slower_sensor_is_interpolated_to_the_times_of_the_faster_one(tmp_path: Path) -> None:
    acc = acc_file(tmp_path / "left_acc.csv", np.arange(0.0, 2.0, 0.02))
    gyro = gyro_file(tmp_path / "left_gyro.csv", np.arange(0.503, 3.0, 0.01))
    for files in ([acc, gyro], [gyro, acc]):
        samples = list(read_samples(files))
        assert [s.t for s in samples] == pytest.approx(list(np.arange(0.503, 1.98, 0.01))), "what both cover"
        for sample in samples:
            assert sample.acc is not None and sample.gyro is not None
            assert sample.acc[0] == pytest.approx(sample.t) and sample.gyro[0] == pytest.approx(0.2 * sample.t)


def test_files_without_a_foot_that_hold_different_sensors_are_of_one_foot(tmp_path: Path) -> None:
    t = np.arange(50) / 100.0
    files = [acc_file(tmp_path / "Accelerometer.csv", t), gyro_file(tmp_path / "Gyroscope.csv", t)]
    assert {sample.site for sample in read_samples(files)} == {Site.RIGHT_FOOT}
    assert {sample.site for sample in read_samples(files, [Foot.LEFT, Foot.LEFT])} == {Site.LEFT_FOOT}


def test_what_cannot_be_joined_is_named_with_what_repairs_it(tmp_path: Path) -> None:
    t = np.arange(50) / 100.0
    acc, again = acc_file(tmp_path / "left_1.csv", t), acc_file(tmp_path / "left_2.csv", t)
    with pytest.raises(RecordingError, match=r"left_2.csv: holds acc of the left foot, as left_1.csv does; .*--foot"):
        read_samples([acc, again])
    later = gyro_file(tmp_path / "left_gyro.csv", t + 100.0)
    with pytest.raises(
        RecordingError, match=r"left_gyro.csv: t: holds no time that left_1.csv holds, too \(100 to 100.49"
    ):
        read_samples([acc, later])
    with pytest.raises(
        RecordingError, match=r"left_gyro.csv: line 1: names gyro but not acc; repair: give the file of the"
    ):
        read_samples(later)


def test_one_mapping_serves_the_files_of_two_sensors_with_the_same_names(tmp_path: Path) -> None:
    t, names = np.arange(50) / 100.0, "time,seconds_elapsed,z,y,x"
    files = [
        write(tmp_path / "Accelerometer.csv", names, 1e9 * t, t, 9.81, 0.0, 1.0),
        write(tmp_path / "Gyroscope.csv", names, 1e9 * t, t, 0.3, 0.2, 0.1),
    ]
    samples = list(read_samples(files, mapping=TableMapping.parse("t=seconds_elapsed,acc=x,y,z,gyro=x,y,z")))
    assert len(samples) == 50
    assert samples[3] == Sample(0.03, Site.RIGHT_FOOT, (1.0, 0.0, 9.81), (0.1, 0.2, 0.3))


def test_archives_and_tables_of_two_feet_may_be_mixed(tmp_path: Path) -> None:
    t = np.arange(20) / 100.0
    np.savez(tmp_path / "right.npz", zeit=1e3 * t, A=np.tile([0.0, 0.0, 1.0], (20, 1)), gx=t, gy=t, gz=-t)
    acc_file(tmp_path / "left.csv", t)
    mapping = TableMapping.parse("t=zeit,acc=A,gyro=gx,-gz,gy", "g,ms")
    right = list(read_samples(tmp_path / "right.npz", mapping=mapping))
    assert [sample.t for sample in right] == pytest.approx(t) and right[3].acc == pytest.approx((0.0, 0.0, 9.80665))
    assert right[5].gyro == pytest.approx((t[5], t[5], t[5])) and {sample.site for sample in right} == {Site.RIGHT_FOOT}
    with pytest.raises(
        RecordingError, match=r"names no column zeiten \(it names zeit, A_0, A_1, A_2, gx, gy, gz\); repair: --co"
    ):
        load_samples(tmp_path / "right.npz", mapping=TableMapping.parse("t=zeiten,acc=A", "g,ms"))
