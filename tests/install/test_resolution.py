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


def resolve(wheels: Path, platform: str, python: str, *requirements: str) -> list[str] | None:
    """Return the packages that pip would install there, in order; None when it finds no wheels for them."""
    options = ["--no-index", "--find-links", wheels, "--only-binary", ":all:", "--ignore-installed", "--target", "none"]
    target = ["--platform", platform, "--python-version", python]
    command = [*PIP, "install", "--dry-run", "--quiet", "--report", "-", *options, *target, *requirements]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PIP_")}
    done = subprocess.run(command, capture_output=True, text=True, env=environment | {"PIP_CONFIG_FILE": os.devnull})
    if done.returncode != 0:
        assert "No matching distribution" in done.stderr, done.stderr
        return None
    return sorted(one["metadata"]["name"] for one in json.loads(done.stdout)["install"])


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("platform", PLATFORMS.values(), ids=PLATFORMS)
def test_two_packages_come_with_solepath_on_every_platform(wheels: Path, platform: str, python: str) -> None:
    assert resolve(wheels, platform, python, *BASE) == ["attrs", "construct"]


def test_a_package_without_a_wheel_for_a_phone_would_be_noticed(wheels: Path) -> None:
    assert resolve(wheels, PLATFORMS["Android"], "3.14", *BASE, "numpy") is None
