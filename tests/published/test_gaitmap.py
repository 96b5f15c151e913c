"""docs/researcher.md quotes rows that the script for gaitmap prints; it makes an environment of its own for it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from here import TESTS
from quoted import below, nearly_the_same


@pytest.mark.long
def test_the_script_makes_its_environment_and_prints_the_table_of_the_page(tmp_path: Path) -> None:
    place = os.environ.get("SOLEPATH_GAITMAP", str(tmp_path / "gaitmap"))  # an environment that is there saves minutes
    words = [sys.executable, TESTS / "bench" / "lab" / "gaitmap_walks.py", "--environment", place]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    nearly_the_same(below("gaitmap"), done.stdout.splitlines()[2:8])
    assert done.stdout.count(": solepath ") == 3
