"""Hostile tables: little memory and time, and one line, whatever they claim to hold."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from commands import run
from hostile import HOSTILE, ROWS, SHEET, workbook
from soak import longer

from solepath.recording import read_samples

MEMORY = 200_000
"""Largest size in memory of a command that reads such a file, kB."""
LOOPS = 60
"""Most time of the processor that it takes, in that of a loop of a million additions, some 25 ms."""
PROGRAM = """
import resource, sys
from time import process_time
from solepath.cli import main
resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
begun, total = process_time(), 0
for k in range(1_000_000):
    total += k
begun, loop = process_time(), process_time() - begun
status = main(["track", sys.argv[1]])
print(status, round((process_time() - begun) / loop))
print(*[line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")])
"""


def hostile(name: str, tmp_path: Path) -> Path:
    if name.endswith("parquet"):
        pytest.importorskip("pyarrow")
    path = HOSTILE[name](tmp_path / name)
    assert path.stat().st_size < 3_000_000
    return path


SLOW = {name for name in HOSTILE if name.endswith("parquet")} - {"columns.parquet"} | {"rows.xlsx", "walk.jsonl.xz"}


@pytest.mark.parametrize("name", [one for name in HOSTILE for one in (longer(name) if name in SLOW else [name])])
def test_a_hostile_file_takes_little_memory_and_time_and_gets_one_line(tmp_path: Path, name: str) -> None:
    command = [sys.executable, "-c", PROGRAM, str(hostile(name, tmp_path))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-300:]
    status, loops, memory = map(int, done.stdout.split())
    assert (status, done.stderr.count("\n")) == (2, 1), done.stderr[-300:]
    assert name in done.stderr
    assert memory < MEMORY
    assert loops < LOOPS


def test_a_dimension_that_is_claimed_and_a_cell_far_away_cost_nothing_of_a_good_table(tmp_path: Path) -> None:
    far = '<row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'
    path = workbook(tmp_path / "walk.xlsx", sheet=[ROWS, far])
    reports: list[str] = []
    assert len(list(read_samples(path, report=reports.append))) == 200
    assert len(reports) == 1 and "line 1048576: has 16384 columns instead of 4; this row is left out" in reports[0]


def test_a_workbook_without_its_sheet_is_named(tmp_path: Path) -> None:
    path = workbook(tmp_path / "walk.xlsx")
    path.write_bytes(path.read_bytes().replace(SHEET.encode(), SHEET.replace("1", "2").encode()))
    done = run("track", path)
    assert done.returncode == 2 and "walk.xlsx: " in done.stderr and done.stderr.count("\n") == 1
