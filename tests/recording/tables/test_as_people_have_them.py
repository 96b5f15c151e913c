"""Tables as people have them: each works, or one sentence says what to do, and what it offers works."""

from __future__ import annotations

import bz2
import gzip
import lzma
import re
import shlex
import zipfile
from pathlib import Path

import numpy as np
import pytest
from commands import one_line, run
from hostile import workbook
from laid import COLUMNS, LENGTH, NAMES, UNTIMED, distance, table, walked
from soak import longer, soaked

from solepath.recording import RecordingError, TableMapping, open_source, read_mapping, read_samples
from solepath.types import Foot

UNITS = "g,deg/s"
NEAR = 0.03 * LENGTH


def offered(text: str) -> list[str]:
    """Return the options that a line offers."""
    return shlex.split(re.split(r"repair: (?:this may fit: )?", text)[1].split(" (there are")[0].splitlines()[0])


def works(path: Path, *options: object, foot: str = "left") -> None:
    done = run("track", path, *options)
    assert done.returncode == 0, done.stderr
    assert distance(done.stdout, foot) == pytest.approx(LENGTH, abs=NEAR)


@pytest.mark.parametrize(("acc", "gyro"), [(2048, 16.4), (16384, 131), (4096, 32.8), (1024, 14.2857), (8192, 65.5)])
def test_raw_counts_take_a_scale(tmp_path: Path, acc: float, gyro: float) -> None:
    rows = np.round(walked() * [1.0, *[acc] * 3, *[gyro] * 3] * [1e3, *[1.0] * 6]) * [1e-3, *[1.0] * 6]
    path = table(tmp_path / "left.csv", NAMES, rows)
    works(path, "--columns", COLUMNS, "--scale", f"acc={acc},gyro={gyro}")
    (tmp_path / "lab.toml").write_text(
        '[columns]\nt = "t"\nacc = ["ax", "ay", "az"]\ngyro = ["gx", "gy", "gz"]\n'
        f"[scale]\nacc = {acc}\ngyro = {gyro}\n"
    )
    assert read_mapping(tmp_path / "lab.toml").scale == {"acc": acc, "gyro": gyro}
    works(path, "--mapping", tmp_path / "lab.toml")


@pytest.mark.parametrize("options", [(), ("--columns", COLUMNS), ("--columns", COLUMNS, "--units", "s,g,deg/s")])
@pytest.mark.parametrize("acc", [2048, *longer(16384)])
def test_raw_counts_are_never_told_to_be_another_unit(tmp_path: Path, options: tuple[str, ...], acc: int) -> None:
    """The scale of the accelerometer is that of its rest; that of the gyroscope is in its data sheet."""
    path = table(
        tmp_path / "left.csv", NAMES, [[t, *map(round, rest)] for t, *rest in walked() * [1, *[acc] * 3, *[16.4] * 3]]
    )
    done = run("track", path, *options)
    assert done.returncode == 2 and f"--scale acc={acc},gyro=COUNTS" in done.stderr
    assert "mdeg/s" not in done.stderr and "mg" not in done.stderr


@pytest.mark.parametrize("unit", ["s", "ms"])
@pytest.mark.parametrize("size", [3, *soaked(2, 6)])
@pytest.mark.parametrize("given", ["", "s", "ms"])
def test_times_of_packets_are_repaired_by_the_rate_at_which_samples_come(
    tmp_path: Path, unit: str, size: int, given: str
) -> None:
    rows = walked().copy()
    rows[:, 0] = (
        np.ceil((np.arange(len(rows)) // size + 1) * size / 100.0 / 0.01) * 0.01 * (1e3 if unit == "ms" else 1.0)
    )
    path = table(tmp_path / "left.csv", NAMES, rows)
    options = ("--columns", COLUMNS, "--units", f"{given},{UNITS}" if given else UNITS)
    first = run("check", path, *options)
    assert first.returncode == 1 and f"samples come in bursts of about {size}" in first.stdout
    repair = offered(first.stdout)
    assert "--rate" in repair
    works(path, *repair, "--units", UNITS)


def test_the_rate_that_was_given_is_in_the_line_that_is_offered(tmp_path: Path) -> None:
    path = table(tmp_path / "left.csv", NAMES[1:], walked(rate=256.0)[:, 1:])
    done = run("track", path, "--rate", "256")
    assert done.returncode == 2 and "HZ" not in done.stderr
    repair = offered(done.stderr)
    assert repair == ["--columns", UNTIMED, "--units", UNITS, "--rate", "256"]
    works(path, *repair)
    assert "--rate HZ" in one_line(run("track", path))


def test_columns_without_names_are_offered_by_their_number(tmp_path: Path) -> None:
    six, seven = table(tmp_path / "left.csv", [], walked()[:, 1:]), table(tmp_path / "left7.csv", [], walked())
    assert offered(one_line(run("track", six, "--rate", "100"))) == [
        "--columns", "acc=1,2,3,gyro=4,5,6", "--units", UNITS, "--rate", "100"
    ]  # fmt: skip
    assert "--rate HZ" in one_line(run("track", six))
    works(six, *offered(one_line(run("track", six, "--rate", "100"))))
    works(seven, *offered(one_line(run("track", seven, "--foot", "left"))), "--foot", "left")


@pytest.mark.parametrize("unit", ["g", "m/s^2"])
@pytest.mark.parametrize("harder", [2.6, 3.4])
def test_gravity_is_that_of_the_rest_at_the_start_and_not_of_a_runner(tmp_path: Path, unit: str, harder: float) -> None:
    rows = walked() * [1.0, *[9.80665 if unit == "m/s^2" else 1.0] * 3, *[np.pi / 180.0] * 3]
    rows[200:, 1:4] *= harder
    names = ["t", *(f"{quantity}_{axis}" for quantity in ("acc", "gyro") for axis in "xyz")]
    path = table(tmp_path / "left.csv", names, rows)
    if unit == "m/s^2":
        assert len(list(read_samples(path))) == len(rows)
        return
    with pytest.raises(RecordingError, match=r"not 9.8: this looks like g; repair: --units g$"):
        read_samples(path)


def devices(path: Path, layout: str, names: tuple[str, ...] = ("id",)) -> Path:
    """Write both feet into one table, with the labels of the devices in front."""
    left, right = (walked(foot) for foot in Foot)
    count = min(len(left), len(right))
    labels = {1: ("3", "a")[: len(names)], 2: ("7", "a")[: len(names)]}
    one, other = ([[*labels[k], *row] for row in rows[:count]] for k, rows in ((1, left), (2, right)))
    if layout == "shifted":
        other = [[*row[: len(names)], row[len(names)] + 0.004, *row[len(names) + 1 :]] for row in other]
    rows = [*one, *other] if layout == "appended" else [row for pair in zip(one, other, strict=True) for row in pair]
    if layout == "half":
        rows = [row for number, row in enumerate(rows) if number % 4 != 3]
    return table(path, [*names, *NAMES], rows)


@pytest.mark.parametrize("layout", ["paired", "shifted", "appended", "half"])
@pytest.mark.parametrize("options", [("--columns", COLUMNS, "--units", UNITS), ()])
def test_rows_of_several_devices_are_a_fault_that_names_how_to_choose(
    tmp_path: Path, layout: str, options: tuple[str, ...]
) -> None:
    path = devices(tmp_path / "walk.csv", layout)
    given = options or offered(one_line(run("track", path)))
    done = run("track", path, *given)
    assert done.returncode == 2 and "devices" in done.stderr
    repair = offered(done.stderr)
    assert repair == ["--rows", "id=3"] and "(there are 7, too)" in done.stderr
    assert run("check", path, *given).returncode == 1
    works(path, *given, *repair, foot="right")
    works(path, *given, "--rows", "ID=7.0", "--foot", "left") if layout != "half" else None


def test_rows_are_chosen_by_several_columns_in_a_mapping_and_in_python(tmp_path: Path) -> None:
    path = devices(tmp_path / "walk.csv", "paired", ("canal", "place"))
    (tmp_path / "lab.toml").write_text(
        '[columns]\nt = "t"\nacc = ["ax", "ay", "az"]\ngyro = ["gx", "gy", "gz"]\n[units]\nacc = "g"\ngyro = "deg/s"\n'
        '[rows]\ncanal = 7\nplace = "a"\n'
    )
    works(path, "--mapping", tmp_path / "lab.toml", "--foot", "left")
    (tmp_path / "lab.toml").write_text((tmp_path / "lab.toml").read_text().partition("[rows]")[0])
    line = one_line(run("track", path, "--mapping", tmp_path / "lab.toml"))
    assert 'repair: in lab.toml: "canal" = "3" below [rows] (there are 7, too)' in line
    mapping = TableMapping.parse(COLUMNS, UNITS, rows=["canal=3", "place=a"])
    assert len(list(read_samples(path, mapping=mapping))) == len(walked())
    for rows, sentence in (
        ("canal=9", "has no row with canal = 9; there are 3; 7"),
        ("kanal=3", "has no column kanal to choose rows by (it names canal, place, t"),
        ("canal", "'canal' chooses no rows: write COLUMN=VALUE, as in device=3"),
    ):
        assert sentence in one_line(run("track", path, "--columns", COLUMNS, "--units", UNITS, "--rows", rows))


@pytest.mark.parametrize("name", ["left.csv.gz", "left.csv.bz2", "left.csv.xz", "left.zip", "walk.zip"])
def test_a_compressed_table_is_read_as_it_is(tmp_path: Path, name: str) -> None:
    import bz2
    import lzma

    plain = table(tmp_path / "left.csv", NAMES, walked())
    path = tmp_path / name
    if name.endswith(".zip"):
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(plain, "folder/data.csv" if name == "left.zip" else "left.csv")
    else:
        path.write_bytes({".gz": gzip, ".bz2": bz2, ".xz": lzma}[path.suffix].compress(plain.read_bytes()))
    works(path, "--columns", COLUMNS, "--units", UNITS)


def test_a_zip_of_several_tables_says_to_unpack_it(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "walk.zip", "w") as archive:
        archive.writestr("left.csv", "t")
        archive.writestr("right.csv", "t")
    line = one_line(run("track", tmp_path / "walk.zip"))
    assert "holds 2 recordings (left.csv, right.csv), not one; repair: unpack it" in line
    with zipfile.ZipFile(tmp_path / "none.zip", "w") as archive:
        archive.writestr("readme.txt.md", "t")
    assert "holds no recordings, not one" in one_line(run("track", tmp_path / "none.zip"))


def test_rows_of_an_archive_are_chosen_too(tmp_path: Path) -> None:
    rows = walked() * [1.0, *[9.80665] * 3, *[np.pi / 180.0] * 3]
    both = np.repeat(rows, 2, axis=0)
    device = np.tile([3, 7], len(rows))
    np.savez(tmp_path / "left.npz", t=both[:, 0], acc=both[:, 1:4], gyro=both[:, 4:], device=device)
    assert "rows of several devices" in one_line(run("track", tmp_path / "left.npz"))
    works(tmp_path / "left.npz", "--rows", "device=7")
    assert "has no row with device = 1; there are 3.0; 7.0" in one_line(
        run("track", tmp_path / "left.npz", "--rows", "device=1")
    )


@pytest.mark.parametrize("name", ["walk.mat", "walk.xls", "walk.ods", "walk.h5", "walk.mat.gz"])
def test_a_file_that_is_not_read_says_what_to_do(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"MATLAB 5.0 MAT-file" if not name.endswith("gz") else gzip.compress(b"MATLAB"))
    line = one_line(run("track", tmp_path / name))
    assert "is of a kind that is not read" in line
    assert ("writematrix" if "mat" in name else "save its table as .csv or .xlsx") in line


NAMES_OF_TWO = ["t", *(f"{q}_{axis}_{foot}" for foot in ("left", "right") for q in ("acc", "gyro") for axis in "xyz")]


@pytest.mark.parametrize("broken", ["left", *longer("right")])
@pytest.mark.parametrize(("quantity", "size"), [("gyro", 80.0), ("gyro", 3000.0), ("acc", 60.0), ("acc", 20_000.0)])
@pytest.mark.parametrize("in_two_files", [False, True])
def test_one_broken_sensor_costs_that_sensor(
    tmp_path: Path, broken: str, quantity: str, size: float, in_two_files: bool
) -> None:
    """Its values are noise, as those of the two corrupted gyroscopes of HuGaDB."""
    noise = np.random.default_rng(4).normal(size=(4000, 3)) * size
    feet = {}
    for foot in Foot:
        rows = walked(foot) * [1.0, *[9.80665] * 3, *[np.pi / 180.0] * 3]
        if foot.value == broken:
            columns = slice(1, 4) if quantity == "acc" else slice(4, 7)
            rows[:, columns] = noise[: len(rows)]
        feet[foot.value] = rows
    count = min(map(len, feet.values()))
    if in_two_files:
        names = [name.removesuffix("_left") for name in NAMES_OF_TWO[:7]]
        paths = [table(tmp_path / f"{foot}.csv", names, rows[:count]) for foot, rows in feet.items()]
    else:
        rows = np.column_stack([feet["left"][:count], feet["right"][:count, 1:]])
        paths = [table(tmp_path / "walk.csv", NAMES_OF_TWO, rows)]
    done = run("track", *paths)
    assert done.returncode == 0, done.stderr
    other = "right" if broken == "left" else "left"
    assert distance(done.stdout, other) == pytest.approx(LENGTH, abs=NEAR)
    sensor = "accelerometer" if quantity == "acc" else "gyroscope"
    assert f"{broken} foot: " in done.stderr and f"its {sensor} is broken, and left out" in done.stderr
    checked = run("check", *paths)
    must = checked.stdout.partition("needs fixing")[2].partition("worth knowing")[0]
    assert checked.returncode == 1 and f"its {sensor} is broken" in must


@pytest.mark.parametrize(
    ("speed", "rate"), [(1.3, 200.0), (1.3, 150.0), (1.3, 66.0), (0.7, 50.0), (1.6, 200.0), (1.6, 300.0)]
)
def test_a_rate_that_is_wrong_by_half_and_more_is_noticed(tmp_path: Path, speed: float, rate: float) -> None:
    path = table(tmp_path / "left.csv", NAMES[1:], walked(speed=speed)[:, 1:])
    options = ("--columns", UNTIMED, "--units", UNITS, "--rate", f"{rate:g}")
    done = run("check", path, *options)
    assert done.returncode == 1 and "the times of the samples are too" in done.stdout
    works(path, *options[:-1], "100")


def test_utf_16_without_its_mark_and_a_mapping_with_one_are_read(tmp_path: Path) -> None:
    path = tmp_path / "left.csv"
    plain = table(path, NAMES, walked()).read_text()
    (tmp_path / "lab.toml").write_bytes(b"\xef\xbb\xbf" + b'[units]\nacc = "g"\ngyro = "deg/s"\n')
    for encoding in ("utf-16-le", "utf-16-be", "utf-8-sig"):
        path.write_bytes(plain.encode(encoding))
        mapping = read_mapping(tmp_path / "lab.toml").replaced(TableMapping.parse(COLUMNS))
        assert len(list(open_source(path, mapping=mapping))) == len(walked())


@pytest.mark.parametrize("name", ["left.xlsx.gz", "left.xlsx.bz2", "left.xlsx.xz", "left.xlsx.zip"])
def test_a_workbook_may_be_compressed(tmp_path: Path, name: str) -> None:
    book = workbook(tmp_path / "left.xlsx").read_bytes()
    pack = {"gz": gzip.compress, "bz2": bz2.compress, "xz": lzma.compress}
    if name.endswith("zip"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("left.xlsx", book)
    else:
        (tmp_path / name).write_bytes(pack[name.rpartition(".")[2]](book))
    assert list(read_samples(tmp_path / name)) == list(read_samples(tmp_path / "left.xlsx"))
