"""What README.md quotes: blocks and tables below their marks, and how exactly they must hold."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def below(mark: str) -> list[str]:
    """The lines of the first block or table below the comment <!-- mark -->."""
    lines = README.split(f"<!-- {mark} -->\n", 1)[1].splitlines()
    if lines[0].startswith("```"):
        return lines[1 : lines.index("```", 1)]
    end = next(n for n, line in enumerate(lines) if not line.startswith("|"))
    return lines[:end]


def in_short(command: str) -> list[str]:
    """The rows of the short table whose figures that command gives."""
    return [line for line in below("figures")[2:] if line.split("|")[3].strip().startswith(f"`{command} ")]


def nearly_the_same(quoted: list[str], fresh: list[str]) -> None:
    """The same lines but for the last digits of their figures."""
    assert [NUMBER.sub("#", line) for line in quoted] == [NUMBER.sub("#", line) for line in fresh]
    for old, new in zip(quoted, fresh, strict=True):
        for a, b in zip(NUMBER.findall(old), NUMBER.findall(new), strict=True):
            # another machine's rounding may move the last digit by one
            last = 10.0 ** -len(a.partition(".")[2])
            assert float(a) == pytest.approx(float(b), abs=1.01 * last), f"quoted: {old}\nprinted: {new}"
