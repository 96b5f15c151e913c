"""All that is wrong with files is said at once, and what each line offers repairs it."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from commands import run
from exported import strange

from solepath.cli.common.tables import mapping_of  # what the options mean
from solepath.cli.main import parser
from solepath.recording import RecordingError, read_samples
from solepath.types import Foot

GOOD = ("--columns", "t=Zeit,acc=Beschl X,Beschl Y,Beschl Z,gyro=Gyro X,Gyro Y,Gyro Z", "--units", "ms,g,deg/s")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("strange")
    return [strange(folder, foot) for foot in Foot]


def offered(text: str) -> list[str]:
    """Return the options that the last line of a text offers."""
    line = text.strip().splitlines()[-1]
    return shlex.split(re.split(r"repair: (?:this may fit: )?", line)[1])


def changed(old: str, new: str) -> tuple[str, ...]:
    return tuple(text.replace(old, new) for text in GOOD)


FAULTS = {
    "time": (changed("Zeit", "Zeitt"), 1),
    "nothing": ((), 1),
    "all": (
        changed("Gyro Z", "Gyro zz")[:1] + (GOOD[1].replace("Zeit", "Zei").replace("Beschl", "Besch"),) + GOOD[2:],
        2,
    ),
    "units": (changed("ms,g,deg/s", "s,mg,rad/s"), 3),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_every_fault_of_every_file_is_named_and_its_line_repairs_it(files: list[Path], fault: str) -> None:
    options, count = FAULTS[fault]
    first = run("track", *files, *options)
    lines = first.stderr.splitlines()
    assert first.returncode == 2 and len(lines) == 2 * count and first.stdout == ""
    assert sum("left.csv" in line for line in lines) == sum("right.csv" in line for line in lines) == count
    assert all(re.search("repair: (this may fit: )?--", line) for line in lines)
    repair = offered(first.stderr)
    kept = options[2:] if "--columns" in repair else options[:2]
    repaired, good = (mapping_of(parser().parse_args(["track", *one])) for one in (("x", *kept, *repair), ("x", *GOOD)))
    assert repaired == good


def test_the_line_of_a_saved_mapping_is_named(files: list[Path], tmp_path: Path) -> None:
    path = tmp_path / "lab.toml"
    path.write_text(
        '[columns]\nt = "Zeit"\nacc = ["Beschl X", "Beschl Y", "Beschl Zz"]\ngyro = ["Gyro X", "Gyro Y", "Gyro Z"]\n'
        '[units]\nt = "ms"\nacc = "g"\ngyro = "deg/s"\n'
    )
    done = run("track", files[0], "--mapping", path)
    assert 'repair: in lab.toml: acc = ["Beschl X", "Beschl Y", "Beschl Z"]' in done.stderr
    path.write_text(path.read_text().replace("Zz", "Z").replace('"deg/s"', '"rad/s"'))
    assert 'repair: in lab.toml: gyro = "deg/s" below [units]' in run("track", files[0], "--mapping", path).stderr
    path.write_text(path.read_text().replace('"rad/s"', '"deg/s"'))
    assert run("track", files[0], "--mapping", path).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("--format", "fitbit"), "--format: there is no format 'fitbit'; there are: movella-dot, "),
        (("--foot", "left,right,left"), "that is 3 feet for 2 files"),
        (("--mapping", "none.toml"), "none.toml: there is no such file"),
    ],
)
def test_an_option_that_cannot_be_gets_one_line(files: list[Path], arguments: tuple[str, ...], line: str) -> None:
    done = run("track", *files, *arguments)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and line in done.stderr


GUESSES = {
    "t,AccX,AccY,AccZ,GyrX,GyrY,GyrZ": "t=t,acc=AccX,AccY,AccZ,gyro=GyrX,GyrY,GyrZ",
    "Timestamp,ax,ay,az,gx,gy,gz": "t=Timestamp,acc=ax,ay,az,gyro=gx,gy,gz",
    "time,a_x,a_y,a_z,w_x,w_y,w_z": "t=time,acc=a_x,a_y,a_z,gyro=w_x,w_y,w_z",
    "SampleTimeFine,FreeAcc_X,FreeAcc_Y,FreeAcc_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z":
        "t=SampleTimeFine,acc=Acc_X,Acc_Y,Acc_Z,gyro=Gyr_X,Gyr_Y,Gyr_Z",
    "elapsed,Accelerometer X,Accelerometer Y,Accelerometer Z,Gyroscope X,Gyroscope Y,Gyroscope Z":
        "t=elapsed,acc=Accelerometer X,Accelerometer Y,Accelerometer Z,gyro=Gyroscope X,Gyroscope Y,Gyroscope Z",
    "Time,L_ax,L_ay,L_az,L_gx,L_gy,L_gz,R_ax,R_ay,R_az,R_gx,R_gy,R_gz":
        "t=Time,acc_left=L_ax,L_ay,L_az,gyro_left=L_gx,L_gy,L_gz,acc_right=R_ax,R_ay,R_az,gyro_right=R_gx,R_gy,R_gz",
}  # fmt: skip


@pytest.mark.parametrize("header", GUESSES)
def test_usual_names_are_understood(tmp_path: Path, header: str) -> None:
    width = header.count(",") + 1
    rows = "".join(",".join([f"{10 * k}", *["0.577"] * (width - 1)]) + "\n" for k in range(40))
    (tmp_path / "walk_left.csv").write_text(f"{header}\n{rows}")
    with pytest.raises(RecordingError) as caught:
        read_samples(tmp_path / "walk_left.csv")
    options = shlex.split(caught.value.repair.partition("this may fit: ")[2])
    assert options == ["--columns", GUESSES[header], "--units", "ms,g,rad/s"]


@pytest.mark.parametrize(
    ("row", "rate", "units"),
    [
        ("{k},0,0,1,0,0,300", "--rate HZ", "g,deg/s"),
        ("{two},0,0,1,0,0,300", "", "ms,g,deg/s"),
        ("{us},0,0,1000,0,0,39", "", "us,mg,rad/s"),
        ("{s},0,0,5.5,0,0,41", "", "s,m/s^2,deg/s"),
        ("{s},0,0,5.3,0,0,2000000", "", "s,m/s^2,mdeg/s"),
        ("2026-03-01T09:30:{s},0,0,17.5,0,0,1", "", "datetime,m/s^2,rad/s"),
        ("{us}000,0,0,18,0,0,1", "", "ns,m/s^2,rad/s"),
    ],
)
def test_units_are_guessed_by_the_size_of_the_numbers(tmp_path: Path, row: str, rate: str, units: str) -> None:
    rows = [row.format(k=k, us=10_000 * k, two=2 * k, s=f"{10 + 0.01 * k:.2f}") for k in range(40)]
    (tmp_path / "walk_left.csv").write_text("\n".join(["Time,ax,ay,az,gx,gy,gz", *rows]) + "\n")
    with pytest.raises(RecordingError) as caught:
        read_samples(tmp_path / "walk_left.csv")
    columns = "acc=ax,ay,az,gyro=gx,gy,gz" if rate else "t=Time,acc=ax,ay,az,gyro=gx,gy,gz"
    assert caught.value.repair == " ".join(filter(None, [f"this may fit: --columns {columns} --units {units}", rate]))
