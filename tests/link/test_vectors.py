"""Reports of mistakes in a vector file, each in one sentence."""

from __future__ import annotations

import json
import re
from copy import deepcopy
from typing import Any

import pytest
from toys import NUMBERED

from solepath.testing.vectors import disagreements

VALID_HEX = "0006000000640141200000"
FILE: dict[str, Any] = json.loads("""{
 "schema": "solepath vectors 1", "channel": "toy/data", "header": "of the toy", "notes": {}, "count": 3,
 "vectors": [
  {"id": "fine", "result": "valid", "hex": "0006000000640141200000",
   "fields": {"number": 6, "ticks": 100, "count": 1, "up": [10.0]},
   "physical": {"tolerance": 1e-9, "sequence": 6, "samples": [{"acc": [0, 0, 10]}]}},
  {"id": "cut", "result": "invalid", "hex": "06000000640141200000", "reason": "truncated"},
  {"id": "no-number", "result": "invalid", "hex": "000600000064017fc00000", "reason": "not finite"}
 ]
}""")


def test_a_good_file_has_nothing_wrong_though_a_reading_may_have() -> None:
    assert disagreements(NUMBERED, FILE) == []


MISTAKES: dict[str, tuple[tuple[Any, ...], Any, str]] = {
    "another schema": (("schema",), "solepath vectors 2", "schema"),
    "another count": (("count",), 4, "3 vectors, not 4"),
    "the same id twice": (("vectors", 1, "id"), "fine", "fine: .*twice"),
    "no id": (("vectors", 1, "id"), None, "id"),
    "another result": (("vectors", 0, "result"), "good", "fine: .*result"),
    "no reason": (("vectors", 1, "reason"), None, "cut: .*reason"),
    "another reason": (("vectors", 1, "reason"), "malformed", "cut: truncated"),
    "no fields": (("vectors", 0, "fields"), None, "fine: .*fields"),
    "a field missing": (("vectors", 0, "fields", "up"), None, "fine: .*built"),
    "an unknown quantity": (("vectors", 0, "physical", "acceleration"), 9.8, "fine: .*'acceleration'"),
    "another value": (("vectors", 0, "physical", "sequence"), 7, "fine: sequence is 6"),
    "taken though it is fine": (("vectors", 1, "hex"), VALID_HEX, "cut: taken"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_reported_in_a_sentence(name: str) -> None:
    (*path, last), value, reported = MISTAKES[name]
    file = deepcopy(FILE)
    container: Any = file
    for step in path:
        container = container[step]
    if value is None:
        del container[last]
    else:
        container[last] = value
    reports = disagreements(NUMBERED, file)
    assert reports and any([re.search(reported, report) for report in reports]), reports
    assert disagreements(NUMBERED, FILE) == []


def test_a_file_without_vectors_is_reported() -> None:
    assert disagreements(NUMBERED, []) and disagreements(NUMBERED, {})  # type: ignore[arg-type]
