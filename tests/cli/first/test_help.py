"""Tests what a newcomer sees first: the first steps, the commands by their purpose, and the help of each command."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest
from commands import run

from solepath.cli.main import COMMANDS, parser

LEVELS = re.compile(r"### Exit status\n|## Exit status\n")


def parsers() -> dict[str, argparse.ArgumentParser]:
    """Return the parser of each command, and of each kind of `calibrate`, by its words."""
    top = parser()
    assert top.commands is not None
    found = dict(top.commands.choices)
    kinds = found["calibrate"].commands
    return found | {f"calibrate {name}": one for name, one in kinds.choices.items()}


WORDS = sorted(parsers())


def test_solepath_alone_shows_the_first_steps_and_every_command_once_by_its_purpose() -> None:
    done = run()
    lines = done.stdout.splitlines()
    assert (done.returncode, done.stderr) == (0, "")
    start = lines.index("first steps:")
    assert [line.split("  ")[1] for line in lines[start + 1 : start + 4]] == [
        "solepath demo", "solepath track walk.csv", "solepath live"
    ]  # fmt: skip
    assert sorted(COMMANDS) == [name for name in WORDS if " " not in name]
    for name in COMMANDS:
        assert sum(line.split()[:1] == [name] for line in lines) == 1
    assert run("--help").stdout == run("-h").stdout == run("help").stdout == done.stdout


@pytest.mark.parametrize("words", WORDS)
def test_a_help_is_narrow_grouped_and_ends_with_examples_that_can_be_parsed(
    words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    text = run(*words.split(), "--help").stdout
    assert run("help", *words.split()).stdout == text
    assert max(map(len, text.splitlines())) <= 100
    _, _, examples = text.partition("\nexample:\n")
    assert examples, "there is no example"
    named = []
    for line in examples.splitlines():
        (command,) = re.findall(r"solepath [^)\"|]*", line)
        arguments = shlex.split(command.split("   ")[0])[1:]
        if arguments[-1] != "--help":
            named.append(parser().parse_args(arguments).command)
    assert named[0] == words.split()[0]


def test_the_documents_have_every_command_and_every_exit_status() -> None:
    text = (Path(__file__).parents[3] / "docs" / "commands.md").read_text()
    for name in WORDS:
        assert f"`solepath {name.split()[0]}" in text
    table = LEVELS.split(text)[1].split("\n## ")[0]
    assert re.findall(r"^\| (\d+) \|", table, re.MULTILINE) == ["0", "1", "2", "130"]
