"""Tests that a shell completes commands, options, recipes and files of `solepath`."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from commands import run

from solepath.cli import completion
from solepath.recipes import NAMES

pytest.importorskip("argcomplete")


def completed(line: str, folder: Path) -> set[str]:
    """Return what bash would offer at the end of a line: the variables are those that its completion sets."""
    variables = {
        "_ARGCOMPLETE": "1", "_ARGCOMPLETE_SHELL": "bash", "_ARGCOMPLETE_SUPPRESS_SPACE": "1", "_ARGCOMPLETE_IFS": "\n",
        "COMP_LINE": line, "COMP_POINT": str(len(line)), "COMP_TYPE": "9",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(folder / "offers"),
    }  # fmt: skip
    subprocess.run([sys.executable, "-m", "solepath"], env=os.environ | variables, check=True)
    return {offer.strip() for offer in (folder / "offers").read_text().split("\n")}


@pytest.mark.parametrize(
    ("line", "offers"),
    [
        ("solepath tr", {"track"}),
        ("solepath track walk.jsonl --recipe k", {name for name in NAMES if name.startswith("k")}),
        ("solepath emulate --device cc", {"cc2650", "cc2541", "cc2541-20hz"}),
    ],
)
def test_the_tab_key_completes(line: str, offers: set[str], tmp_path: Path) -> None:
    assert completed(line, tmp_path) == offers


def test_the_tab_key_completes_files(tmp_path: Path) -> None:
    (tmp_path / "walk.jsonl").touch()
    assert completed(f"solepath track {tmp_path}/wa", tmp_path) == {f"{tmp_path}/walk.jsonl"}


@pytest.mark.parametrize("shell", completion.SHELLS)
def test_the_code_for_a_shell_names_the_program(shell: str) -> None:
    done = run("completion", shell)
    assert done.returncode == 0 and "solepath" in done.stdout and completion.COMPLETING in done.stdout
