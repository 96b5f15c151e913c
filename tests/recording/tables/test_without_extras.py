"""What `pip install .` brings is enough to read packets and tables of text: no numpy, pandas or polars."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from recordings import PACKETS, recorded

FILES = Path(__file__).parent / "files"
PROGRAM = """
import sys
sys.modules |= dict.fromkeys(("numpy", "pandas", "polars"))  # an import of any of them fails
from solepath.recording import TableMapping, open_source
print(len(list(open_source(sys.argv[1], mapping=TableMapping.parse(*sys.argv[2:]) if sys.argv[2:] else None))))
"""


@pytest.mark.parametrize(
    ("name", "mapping", "number"),
    [
        ("walk.jsonl", (), len(PACKETS)),
        ("physilog.csv", (), 3),
        ("physilog.csv", ("t=Time,acc=Accel X,Accel Y,-Accel Z", "s,g"), 3),
    ],
)
def test_it_is_read(tmp_path: Path, name: str, mapping: tuple[str, ...], number: int) -> None:
    path = recorded(tmp_path / name, PACKETS) if name == "walk.jsonl" else FILES / name
    done = subprocess.run([sys.executable, "-c", PROGRAM, path, *mapping], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == (f"{number}\n", "")
