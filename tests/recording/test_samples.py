"""Reading of samples from .npz and .csv files, and one sentence about each thing that cannot be read."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve
from tabled import saved, still

from solepath.recording import RecordingError, RecordingWarning, read_samples
from solepath.recording.samples import load_samples
from solepath.types import Foot, Sample, Site


def read_until_error(path: Path, foot: Foot | None = None) -> tuple[list[Sample], str]:
    """Return the samples before the fault, and the sentence of the error."""
    samples: list[Sample] = []
    with pytest.raises(RecordingError) as caught:
        for sample in read_samples(path, foot):
            samples.append(sample)
    sentence = str(caught.value)
    assert sentence.startswith(str(path)) and sentence.isprintable() and len(sentence) < 400
    return samples, sentence


@pytest.mark.parametrize("name", ["one.npz", "one.csv"])
def test_one_foot_is_the_right_one_unless_named_otherwise(tmp_path, name):
    path = saved(tmp_path / name, still() | {"gt_pos": np.zeros((20, 3)), "activity": np.zeros(20)})
    expected = Sample(0.01, Site.RIGHT_FOOT, (0.25, -0.5, 9.75), (0.125, 0.0, -0.0625), (100.0, 200.0))
    samples = list(read_samples(path))
    assert len(samples) == len(load_samples(path)) == 20 and samples[1] == expected
    assert {sample.site for sample in read_samples(path, Foot.LEFT)} == {Site.LEFT_FOOT}


@pytest.mark.parametrize("name", ["two.npz", "two.csv"])
def test_both_feet_on_a_shared_clock_come_left_then_right_at_each_instant(tmp_path, name):
    one = still()
    columns = {"t": one["t"]} | {f"acc_{foot}": sign * one["acc"] for foot, sign in (("left", 1), ("right", -1))}
    path = saved(tmp_path / name, columns)
    left, right = Sample(0.0, Site.LEFT_FOOT, (0.25, -0.5, 9.75)), Sample(0.0, Site.RIGHT_FOOT, (-0.25, 0.5, -9.75))
    times = [k / 100 for k in range(20)]
    assert list(read_samples(path)) == [evolve(one, t=t, known_at=t) for t in times for one in (left, right)]
    assert {s.site for s in read_samples(path, Foot.LEFT)} == {Site.LEFT_FOOT}


def test_a_sheet_of_both_feet_may_have_other_columns_and_other_quantities_of_each(tmp_path):
    path = tmp_path / "two.csv"
    path.write_text(
        "\ufeffnote,t,acc_x_left,acc_y_left,acc_z_left,pressure_0_right,pressure_1_right\n"
        '"a, b",0.00,0,0,9.8,1,2\nx,0.01,0,0,9.8,3,4\n',
        encoding="utf-8",
    )
    left, right = list(read_samples(path))[:2]
    assert left == Sample(0.0, Site.LEFT_FOOT, (0.0, 0.0, 9.8))
    assert right == Sample(0.0, Site.RIGHT_FOOT, None, None, (1.0, 2.0))


@pytest.mark.soak
def test_every_recording_of_the_data_folder_is_read_to_its_end(data_dir):
    paths = sorted(data_dir.glob("*/*.npz"))
    assert paths
    for path in paths:
        with np.load(path) as archive:
            rows = sum(len(archive[k]) for k in archive.files if k in ("acc", "acc_left", "acc_right"))
            if not rows:
                rows = sum(len(archive[k]) for k in archive.files if k.startswith("pressure"))
        assert len(load_samples(path)) == rows


def test_an_accelerometer_stuck_at_the_end_of_its_range_costs_that_foot_and_not_the_recording(tmp_path):
    one, names = still(400), ("acc", "gyro")
    moving = one["acc"] + 0.01 * np.arange(400)[:, None]
    columns = {"t": one["t"]} | {f"{name}_{foot}": one[name] for name in names for foot in ("left", "right")}
    columns |= {"acc_left": moving, "acc_right": np.full((400, 3), -19.6)}
    assert len(load_samples(saved(tmp_path / "two.npz", columns))) == 800
    # without the other foot, nothing tells a broken sensor from counts
    alone = saved(tmp_path / "one.npz", one | {"acc": np.full((400, 3), -19.6)})
    assert "raw counts" in read_until_error(alone)[1]
    changing = saved(tmp_path / "counts.npz", columns | {"acc_right": 100.0 * moving})
    reports = []
    assert len(load_samples(changing, report=reports.append)) == 400
    assert "right foot: |acc| at rest is 1e+03 m/s^2" in reports[0] and "is broken, and left out" in reports[0]


def without(columns: dict[str, np.ndarray], *keys: str) -> dict[str, np.ndarray]:
    return {k: v for k, v in columns.items() if k not in keys}


def burst_times(size: int, within: float) -> dict[str, np.ndarray]:
    """Return 400 samples at 100 Hz, with times of their packets of `size` samples; those are `within` s apart."""
    number = np.arange(400)
    return still(400) | {"t": still(400)["t"][number // size * size] + within * (number % size)}


FAULTY = {
    "no t": (without(still(), "t"), "names no column t (it names acc_x, "),
    "nothing measured": (
        {"t": still()["t"], "mag": np.ones((20, 3))},
        "names no column acc_x or pressure_0 (it names t, mag)",
    ),
    "gyro alone": (without(still(), "acc"), "names gyro but not acc; repair: give the file of the accelerometer"),
    "both kinds of name": (still() | {"acc_left": still()["acc"]}, "has columns with and without a foot's name"),
    "acc of two axes": (still() | {"acc": np.ones((20, 2))}, "acc: holds float64 of the shape (20, 2), not columns of"),
    "four axes": (still() | {"acc": np.ones((20, 4))}, "acc: holds float64 of the shape (20, 4), not columns of"),
    "a cube": (still() | {"acc": np.ones((20, 3, 2))}, "acc: holds float64 of the shape (20, 3, 2), not columns of"),
    "one gyro row less": (still() | {"gyro": still(19)["gyro"]}, "gyro: has 19 rows but t has 20"),
    "words": (still() | {"acc": np.full((20, 3), "x")}, "acc: holds <U1 of the shape (20, 3), not columns of numbers"),
    "no rows": ({k: v[:0] for k, v in still().items()}, "bad.npz: holds no samples"),
    "first row not finite": (still() | {"acc": np.full((20, 3), np.nan)}, "acc, row 0: is nan, not a finite number"),
    "repeated": (still() | {"t": np.repeat(still()["t"][::2], 2)[: len(still()["t"])]}, "bursts of about 2, one"),
    "one time for a packet": (burst_times(10, 0.0), "bursts of about 10, one burst each 0.1 s, as with the time"),
    "packets by BLE": (burst_times(10, 1e-5), "give each sample its own time, about 0.01 s after the one before"),
    "huge": (still() | {"acc": still()["acc"] * 1e300}, "this looks like raw counts"),
    "gyro counts": (still() | {"gyro": np.full((20, 3), 9000.0)}, "gyro: |gyro| reaches 1.56e+04 rad/s"),
    "milliseconds": (still() | {"t": still()["t"] * 1000.0}, "between samples is 10 s: this looks like milliseconds"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTY)
def test_an_archive_with_a_fault_of_the_whole_is_rejected_in_one_sentence(tmp_path, fault):
    columns, complaint = FAULTY[fault]
    samples, sentence = read_until_error(saved(tmp_path / "bad.npz", columns))
    assert samples == [] and complaint in sentence


BOUNDARIES = [
    ("acc", 3.0, 2.99, "another unit, or gravity removed"),
    ("acc", 30.0, 30.01, "raw counts"),
    ("gyro", 40.0, 40.01, "deg/s; repair: --units deg/s"),
    ("t", 0.5, 0.51, "milliseconds or sample numbers"),
    ("t", 2e-4, 1.9e-4, "these are not seconds"),
]
"""Quantity; last value that may be right, next one that is not, and what it looks like."""


@pytest.mark.parametrize(("quantity", "right", "wrong", "complaint"), BOUNDARIES)
def test_numbers_are_rejected_from_a_boundary_on(tmp_path, quantity, right, wrong, complaint):
    def written(size: float) -> Path:
        column = size * np.arange(20) if quantity == "t" else np.tile([0.0, -size, 0.0], (20, 1))
        return saved(tmp_path / "walk.npz", still() | {quantity: column})

    assert len(list(read_samples(written(right)))) == 20
    assert complaint in read_until_error(written(wrong))[1]


@pytest.mark.parametrize(
    ("acc", "repair"),
    [(0.81, "g; repair: --units g"), (1.19, "g; repair: --units g"), (1190.0, "milli-g; repair: --units mg"),
     (1210.0, "raw counts"), (0.79, "another unit, or gravity removed"), (0.29, "no specific force at all")],
)  # fmt: skip
def test_what_specific_force_at_rest_looks_like(tmp_path, acc, repair):
    """At rest is the fifth of the samples with the lowest angular rate; the others are of a foot that swings."""
    moving = np.arange(40) >= 10
    columns = still(40) | {"acc": np.zeros((40, 3)), "gyro": np.where(moving, 5.0, 0.1)[:, None] * [0.0, 1.0, 0.0]}
    columns["acc"][:, 2] = np.where(moving, 2.0, 1.0) * acc
    assert f"looks like {repair}" in read_until_error(saved(tmp_path / "walk.npz", columns))[1]


def test_pickled_arrays_are_not_loaded(tmp_path):
    acc = np.array([[{"a": 1}] * 3] * 20, dtype=object)
    assert (
        "acc: cannot be read (Object arrays cannot be loaded"
        in read_until_error(saved(tmp_path / "bad.npz", still() | {"acc": acc}))[1]
    )
    path = tmp_path / "pickle.npz"
    path.write_bytes(pickle.dumps({"t": [0.0]}))
    assert read_until_error(path)[1].endswith("is not an .npz archive")


@pytest.mark.parametrize("share", [0.02, 0.3, 0.9, 0.999])
def test_an_archive_cut_off_is_rejected(tmp_path, share):
    path = saved(tmp_path / "bad.npz", still())
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    assert "is not a whole .npz archive" in read_until_error(path)[1]


@pytest.mark.parametrize("name", ["walk.npz", "walk.csv"])
def test_a_missing_or_empty_file_and_a_directory_are_named(tmp_path, name):
    path = tmp_path / name
    assert read_until_error(path)[1].endswith("no such file or directory")
    path.write_bytes(b"")
    assert read_until_error(path)[1].endswith("is empty")
    path.unlink()
    path.mkdir()
    assert read_until_error(path)[1].endswith("is a folder, not a recording")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("t,acc_x,acc_y,acc_z\n", "holds no samples"),
        ("0.0,1.0,2.0,9.8\n0.1,1,2,9.8\n", "(it holds numbers: is the line with the names missing?)"),
        ("acc_x,acc_y,acc_z\n0,0,9.8\n", "line 1: names no column t"),
        ("t,acc_x,acc_z\n0,0,9.8\n", "line 1: names no column acc_y"),
        ("t,acc_x,acc_y,acc_z,acc_x\n0,0,0,9.8,0\n", "line 1: names the column acc_x twice"),
        ("t,pressure_0,pressure_2\n0,0,0\n", "line 1: names no column pressure_1"),
        ("t,gyro_x,gyro_y,gyro_z,pressure_0\n0,0,0,0,0\n", "line 1: names gyro but not acc"),
        ("t,acc_x,acc_y,acc_z,pressure_0_left\n0,0,0,9.8,0\n", "is it of one foot or of two?"),
        ("t,acc_x,acc_y,acc_z\nzero,0,0,9.8\n", 'line 2: t is "zero", not a number'),
        ("\x1b[31m\x00\xff,\n1,2\n", "names no column acc_x"),
    ],
)
def test_a_sheet_with_a_fault_of_the_whole_is_rejected_in_one_sentence(tmp_path, text, complaint):
    path = tmp_path / "bad.csv"
    path.write_bytes(text.encode("latin-1"))
    samples, sentence = read_until_error(path)
    assert samples == [] and complaint in sentence


@pytest.mark.parametrize("name", ["cell.npz", "cell.csv"])
def test_a_pressure_cell_without_a_number_is_a_missing_cell_and_ends_no_file(tmp_path, name):
    columns = still()
    columns["pressure"][7, 1] = np.nan
    samples = list(load_samples(saved(tmp_path / name, columns)))
    assert len(samples) == 20 and str(samples[7].pressure) == "(100.0, nan)"


def test_a_sheet_cut_in_the_middle_of_a_line_keeps_every_line_before(tmp_path):
    path = saved(tmp_path / "cut.csv", still())
    path.write_bytes(path.read_bytes()[:-12])
    with pytest.warns(RecordingWarning, match="line 21: cut off in the middle; everything before it is used"):
        assert len(list(read_samples(path))) == 19
