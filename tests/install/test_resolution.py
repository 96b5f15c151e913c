"""What `pip install solepath` brings can be installed on every platform that has a Python, from wheels alone.

pip itself resolves the base dependencies for the tags of each platform, among wheels that it fetched before."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from here import ROOT

PLATFORMS = {
    "Android": "android_24_arm64_v8a",
    "iOS": "ios_13_0_arm64_iphoneos",
    "Emscripten": "pyodide_2024_0_wasm32",
    "Windows": "win_amd64",
    "Windows on ARM": "win_arm64",
    "macOS": "macosx_11_0_arm64",
    "Linux aarch64": "manylinux_2_17_aarch64",
    "Linux armv7l": "linux_armv7l",
    "Linux with musl": "musllinux_1_2_x86_64",
}
"""Platform tag of each system (packaging.python.org, "Platform compatibility tags")."""
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
BASE: list[str] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
"""Requirements of solepath without extras."""
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check")


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with wheels of the base dependencies, and of numpy for this machine."""
    folder = tmp_path_factory.mktemp("wheels")
    done = subprocess.run([*PIP, "download", "-q", "-d", folder, *BASE, "numpy"], capture_output=True, text=True)
    if done.returncode != 0:
        pytest.skip(f"pip reaches no index: {done.stderr.splitlines()[-1:]}")
    return folder


RESOLVE = """
import json, sys
from contextlib import redirect_stdout
from io import StringIO
from pip._internal.cli.main import main

options, found = json.loads(sys.argv[1]), []
for platform, python, requirements in json.loads(sys.argv[2]):
    target = ["--platform", platform, "--python-version", python]
    with redirect_stdout(StringIO()) as report:
        status = main(["install", *options, *target, *requirements])
    names = sorted(one["metadata"]["name"] for one in json.loads(report.getvalue())["install"]) if status == 0 else None
    found.append(names)
print(json.dumps(found))
"""


def resolve(wheels: Path, targets: list[tuple[str, str, list[str]]]) -> list[list[str] | None]:
    """Return the packages that pip would install for each (platform, Python, requirements); None without wheels."""
    options = ["--dry-run", "--quiet", "--report", "-", "--no-index", "--find-links", str(wheels), "--target", "none"]
    options += ["--only-binary", ":all:", "--ignore-installed", "--disable-pip-version-check"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PIP_")}
    done = subprocess.run(
        [sys.executable, "-c", RESOLVE, json.dumps(options), json.dumps(targets)],
        capture_output=True,
        text=True,
        env=environment | {"PIP_CONFIG_FILE": os.devnull},
    )
    assert done.returncode == 0, done.stderr
    others = [line for line in done.stderr.splitlines() if "ERROR" in line and "o matching distribution" not in line]
    assert not [line for line in others if "Could not find a version" not in line], done.stderr
    found: list[list[str] | None] = json.loads(done.stdout)
    return found


@pytest.mark.long
def test_two_packages_come_with_solepath_on_every_platform(wheels: Path) -> None:
    targets = [(platform, python, BASE) for platform in PLATFORMS.values() for python in PYTHONS]
    found = resolve(wheels, targets)
    assert {(platform, python): names for (platform, python, _), names in zip(targets, found, strict=True)} == {
        (platform, python): ["attrs", "construct"] for platform, python, _ in targets
    }


def test_no_package_is_needed_on_some_platforms_only() -> None:
    """pip judges the markers of a requirement by the machine on which it runs, so the test above would not see it."""
    assert not [requirement for requirement in BASE if ";" in requirement]
