"""Rejection of records that do not fit a format, by ValueError when they are built."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import inf, nan
from typing import Any

import pytest
from attrs import evolve
from formats import FORMATS, VECTORS

from solepath.types import Cell, Foot
from solepath.wire import fragment, insole, insole_info  # internal: the builders, with which the emulator sends
from solepath.wire.error import WireError

MISFITS = (-(2**70), -1, 2**70, -1e300, nan, inf)


def changed(fields: Any) -> Iterator[Any]:
    """Yield the fields of a vector with each number replaced by one that hardly any format holds."""
    items = fields.items() if isinstance(fields, dict) else enumerate(fields) if isinstance(fields, list) else ()
    for key, value in items:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        for other in MISFITS if is_number else changed(value):
            copy = json.loads(json.dumps(fields))
            copy[key] = other
            yield copy


@pytest.mark.parametrize("name", FORMATS)
def test_a_number_that_does_not_fit_is_rejected_when_it_is_written(name: str) -> None:
    wire, rejected = FORMATS[name], 0
    vectors = json.loads((VECTORS / f"{name}.json").read_text("utf-8"))["vectors"]
    valid = [vector["fields"] for vector in vectors if vector["result"] == "valid"][:3]
    all_changed = [other for one in valid for other in changed(one)]
    for fields in all_changed:
        try:
            data = wire.build(wire.from_fields(fields))
        except ValueError as error:
            assert not isinstance(error, WireError)
            rejected += 1
        else:
            assert wire.build(wire.parse(data)) == data, fields
    assert rejected > 0 or not all_changed


SAMPLE = insole.InsoleSample((1, 2), (0, 0, 0, 0, 0, 0))
FRAME = insole.InsoleFrame(Foot.LEFT, 1, 2, 3, 4, (SAMPLE,))
INFO = insole_info.InsoleInfo(Foot.LEFT, 1, 2, 32768, 327, 0.5, 0.25, 0.125, 0.27, (Cell(0.1, 0.0),), "1")
WRONG: dict[str, tuple[Any, Any]] = {
    "no samples": (insole.build_frame, evolve(FRAME, samples=())),
    "129 cells": (insole.build_frame, evolve(FRAME, samples=(insole.InsoleSample((0,) * 129),))),
    "other cells": (insole.build_frame, evolve(FRAME, samples=(SAMPLE, evolve(SAMPLE, cells=(1,))))),
    "a quaternion of five": (insole.build_frame, evolve(FRAME, samples=(evolve(SAMPLE, quat=(0,) * 5),))),
    "over 512 bytes": (insole.build_frame, evolve(FRAME, samples=(SAMPLE,) * 40)),
    "a fragment over 512 bytes": (fragment.build_fragment, fragment.Fragment(0, False, 0, bytes(512))),
    "a name over 255 bytes": (insole_info.build_info, evolve(INFO, firmware="n" * 256)),
    "17 fragments": (lambda frame: fragment.split(frame, 20, 0), bytes(16 * 19 + 1)),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_record_of_another_form_is_rejected_when_it_is_written(case: str) -> None:
    build, record = WRONG[case]
    with pytest.raises(ValueError) as caught:
        build(record)
    assert not isinstance(caught.value, WireError)
