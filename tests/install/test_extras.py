"""All extras of pyproject.toml can be installed together, in an environment of the oldest Python that is supported."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from here import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = sorted(PROJECT["optional-dependencies"])
OLDEST = re.sub(r"[^0-9.]", "", PROJECT["requires-python"])


def oldest_python() -> str:
    """Return the program of the oldest Python; skip the test without it."""
    if f"{sys.version_info.major}.{sys.version_info.minor}" == OLDEST:
        return sys.executable
    found = shutil.which(f"python{OLDEST}")
    if found is None:
        pytest.skip(f"no Python {OLDEST} here")
    return found


@pytest.mark.long
def test_all_extras_can_be_installed_together(tmp_path: Path) -> None:
    """pip chooses a version of each package for all extras at once; nothing is installed."""
    subprocess.run([oldest_python(), "-m", "venv", tmp_path / "venv"], check=True)
    pip = [tmp_path / "venv" / ("Scripts" if sys.platform == "win32" else "bin") / "python", "-m", "pip"]
    report = tmp_path / "report.json"
    words = ["install", "--quiet", "--dry-run", "--report", report, f"{ROOT}[{','.join(EXTRAS)}]"]
    done = subprocess.run([*pip, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    chosen = [item["metadata"] for item in json.loads(report.read_text("utf-8"))["install"]]
    (own,) = [one for one in chosen if one["name"] == PROJECT["name"]]
    assert set(own["provides_extra"]) >= set(EXTRAS)
    names = [re.sub(r"[-_.]+", "-", one["name"]).lower() for one in chosen]
    assert len(names) == len(set(names)), "one version of each"
    required = " ".join(line for extra in EXTRAS for line in PROJECT["optional-dependencies"][extra])
    for name in ("bleak", "pandas", "pyspark", "quixstreams", "sphinx"):
        assert name in required and name in names
    print(f"{len(EXTRAS)} extras, {len(names)} packages for Python {OLDEST}: " + ", ".join(names))
