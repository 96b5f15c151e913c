"""Floats are summed by `fsum` or in a loop: the rounding of `sum` differs between Python 3.11 and 3.12."""

from __future__ import annotations

import ast

import pytest
from here import ROOT

SRC = ROOT / "src" / "solepath"
CORE = ("types", "wire", "link", "foot", "body", "place", "session", "events", "saving", "calibration", "papers",
        "floorplan")  # fmt: skip
"""Folders of what runs for a sample, or makes a state."""
MARK = "# whole numbers"
"""Comment of a line that may use `sum` all the same."""
NOT_THE_SAME = {"sumprod", "mean", "stdev", "pstdev", "variance", "pvariance", "linear_regression", "correlation"}
"""Functions of math and statistics that other versions of Python lack or round otherwise."""


def is_count(argument: ast.expr) -> bool:
    """Return whether the sum counts or adds lengths, as its expression alone shows."""
    if isinstance(argument, ast.Call) and ast.unparse(argument).startswith("map(len, "):
        return True
    if not isinstance(argument, ast.ListComp | ast.GeneratorExp):
        return False
    item = argument.elt
    return (
        isinstance(item, ast.Compare | ast.BoolOp)
        or (isinstance(item, ast.UnaryOp) and isinstance(item.op, ast.Not))
        or (isinstance(item, ast.Constant) and type(item.value) is int)
        or (isinstance(item, ast.Call) and ast.unparse(item.func) == "len")
    )


def found_in(source: str) -> list[int]:
    """Return the lines in which floats may be summed in a way that is not the same everywhere."""
    lines = source.splitlines()
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.module in ("math", "statistics"):
            found += [node.lineno for alias in node.names if alias.name in NOT_THE_SAME]
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) in ("math", "statistics"):
            found += [node.lineno] if node.attr in NOT_THE_SAME else []
        is_sum = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "sum"
        if is_sum and not is_count(node.args[0]) and not lines[node.lineno - 1].endswith(MARK):
            found.append(node.lineno)
    return sorted(found)


@pytest.mark.parametrize("room", (*CORE, "fleet/step"))
def test_no_sum_of_floats_rounds_otherwise_in_another_python(room: str) -> None:
    found = {path.relative_to(SRC).as_posix(): found_in(path.read_text("utf-8")) for path in (SRC / room).rglob("*.py")}
    assert {path: lines for path, lines in found.items() if lines} == {}
