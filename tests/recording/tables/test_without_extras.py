"""What `pip install .` brings is enough to read packets, tables of text and a dataset: no numpy, pandas or polars."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from recordings import PACKETS, recorded
from tabled import saved, still

PROGRAM = """
import sys
sys.modules |= dict.fromkeys(("numpy", "pandas", "polars"))  # an import of any of them fails
from solepath.recording import TableMapping, open_source
given, columns, units = sys.argv[1:]
print(len(list(open_source(given, mapping=TableMapping.parse(columns, units) if columns else None))))
"""


def count(path: Path, columns: str = "", units: str = "") -> subprocess.CompletedProcess[str]:
    """Return what a program without these libraries prints of a file: the number of its packets or samples."""
    return subprocess.run([sys.executable, "-c", PROGRAM, path, columns, units], capture_output=True, text=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("plain")
    recorded(made / "walk.jsonl", PACKETS)
    saved(made / "left.csv", still())
    saved(made / "left.npz", still())
    rows = "".join(f"{10 * k};0;0;{'1' if k else '1,0'};0;0;90\n" for k in range(20))
    (made / "lab.csv").write_text("Zeit;AX;AY;AZ;GX;GY;GZ\n" + rows)
    channels = [f"{c}\t{kind}\tleft_foot\t{unit}" for kind, unit in (("ACCEL", "g"), ("GYRO", "rad/s")) for c in "xyz"]
    lines = ["component\ttype\ttracked_point\tunits", *channels, "n/a\tLATENCY\tn/a\ts"]
    (made / "sub-1_tracksys-a_channels.tsv").write_text("\n".join(lines) + "\n")
    values = [[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, k / 100.0] for k in range(20)]
    np.savetxt(made / "sub-1_tracksys-a_motion.tsv", values, delimiter="\t")
    return made


@pytest.mark.parametrize(
    ("name", "mapping", "number"),
    [
        ("walk.jsonl", (), len(PACKETS)),
        ("left.csv", (), 20),
        ("lab.csv", ("t=Zeit,acc=AX,AY,AZ,gyro=GX,-GY,GZ", "ms,g,deg/s"), 20),
        ("sub-1_tracksys-a_motion.tsv", (), 20),
    ],
)
def test_it_is_read(folder: Path, name: str, mapping: tuple[str, ...], number: int) -> None:
    done = count(folder / name, *mapping)
    assert (done.stdout, done.stderr) == (f"{number}\n", "")


def test_an_archive_needs_numpy(folder: Path) -> None:
    assert "numpy" in count(folder / "left.npz").stderr
