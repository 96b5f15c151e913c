"""Every number of a calibration at both ends of what protocol/calibration.md allows, and other types."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import inf, nan, nextafter
from typing import Any

import attrs
import pytest
from made import Maker

from solepath import Calibration, Foot
from solepath.calibration.records import merged
from solepath.saving.codec import load
from solepath.types.checking import Fault, find_fault  # internal: a file or a session takes much longer

LIMITS = """
insoles.left.layout.length | 0.01 | 1
insoles.left.layout.cells.1.x | -1 | 1
insoles.left.layout.cells.1.y | -1 | 1
insoles.left.layout.cells.1.area | 0 | 1
insoles.left.layout.scale | 1e-9 | 1e6
insoles.left.layout.full_scale | 1e-6 | 1e9
insoles.left.newtons.coefficients.* | -1e12 | 1e12
insoles.left.newtons.threshold | 0 | 200
insoles.left.newtons.most | 5 | 1e5
insoles.left.noise.1 | -1e6 | 1e6
shoe.heel_radius | 0.001 | 1
shoe.height | 0 | 1
shoe.forefoot_radius.0 | -1 | 1
shoe.pivot_to_toe.5 | -100 | 100
drift.right.* | -1 | 1
toe_out.left | -1 | 1
headings.left.drift | -0.05 | 0.05
headings.left.turning | -0.1 | 0.1
headings.left.drift_sigma | 1e-6 | 0.05
headings.left.turning_sigma | 1e-6 | 0.2
sensors.left.acc.matrix.048 | 0.7 | 1.3
sensors.left.gyro.matrix.048 | 0.7 | 1.3
sensors.left.acc.matrix.123567 | -0.3 | 0.3
sensors.left.gyro.matrix.123567 | -0.3 | 0.3
sensors.left.acc.bias.* | -5 | 5
sensors.left.gyro.bias.* | -1 | 1
sensors.left.acc.matrix_sigma.* | 0 | 0.1
sensors.left.gyro.matrix_sigma.* | 0 | 0.1
sensors.left.acc.bias_sigma.* | 0 | 5
sensors.left.gyro.bias_sigma.* | 0 | 1
limbs.hip_width | 0.001 | 1.5
limbs.ankle_height | 0.001 | 1.5
weight | 50 | 5000
modes.left.LEFT_WIDE.* | -0.5 | 0.5
"""
FULL: dict[str, Any] = json.loads("""{
 "insoles": {"left": {
   "layout": {"id": 2, "foot": "left", "length": 0.26, "scale": 1.0, "full_scale": 4095.0,
              "cells": [{"x": 0.2, "y": 0.0, "area": 1e-4}, {"x": 0.1, "y": 0.0, "area": 1e-4}]},
   "newtons": {"coefficients": [0.0, 0.1, 0.0, 0.0], "threshold": 5.0, "most": 200.0},
   "noise": [1.5, 2.5]}},
 "shoe": {"heel_radius": 0.125, "height": 0.029, "forefoot_radius": [0.07, 0.0],
          "pivot_to_toe": [0.09, 0.0, 0.0, 0.0, 0.0, 0.0], "steepest": 0.1},
 "drift": {"right": [0.001, -0.002]}, "toe_out": {"left": 0.1},
 "headings": {"left": {"drift": 0.01, "turning": 0.01, "drift_sigma": 0.01, "turning_sigma": 0.01}},
 "sensors": {"left": {"acc": {"matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1], "bias": [0, 0, 0],
                              "matrix_sigma": [0, 0, 0, 0, 0, 0, 0, 0, 0], "bias_sigma": [0, 0, 0]},
                      "gyro": {"matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1], "bias": [0, 0, 0],
                               "matrix_sigma": [0, 0, 0, 0, 0, 0, 0, 0, 0], "bias_sigma": [0, 0, 0]}}},
 "limbs": {"hip_width": 0.3, "thigh": 0.4, "shank": 0.4, "foot": 0.2, "ankle_height": 0.1},
 "weight": 700.0,
 "modes": {"left": {"LEFT_WIDE": [0.01, -0.02]}}
}""")


def fault(path: list[str], value: float) -> Fault | None:
    """Return what is wrong with the calibration whose number at this path is `value`."""
    document = json.loads(json.dumps(FULL))
    inside = document
    for key in path[:-1]:
        inside = inside[int(key) if isinstance(inside, list) else key]
    inside[int(path[-1]) if isinstance(inside, list) else path[-1]] = value
    return find_fault(load(Calibration, document), Calibration)


@pytest.mark.parametrize("row", LIMITS.strip().splitlines())
def test_a_number_is_used_up_to_its_ends_and_not_beyond(row: str) -> None:
    path, least, most = row.split(" | ")
    *within, last = path.split(".")
    inside: Any = FULL
    for key in within:
        inside = inside[int(key) if isinstance(inside, list) else key]
    lasts = map(str, range(len(inside))) if last == "*" else last if isinstance(inside, list) else [last]
    for place in lasts:
        ends = (float(least), float(most))
        assert [fault([*within, place], end) for end in ends] == [None, None]
        for beyond in (nextafter(ends[0], -inf), nextafter(ends[1], inf), nan, -inf):
            reason = fault([*within, place], beyond)
            assert reason is not None and path.split(".")[0] in str(reason), reason


def others(value: Any) -> Iterator[Any]:
    """Yield the value with one thing in it replaced by what it cannot be."""
    if attrs.has(type(value)):
        for one in attrs.fields(type(value)):
            for other in ("x", 3 + 0j, *others(getattr(value, one.name))):
                yield attrs.evolve(value, **{one.name: other})
    elif isinstance(value, dict):
        yield from ({"left": item} for item in value.values())
        yield from ({key: other} for key, item in value.items() for other in ("x", *others(item)))
    elif isinstance(value, tuple) and value:
        yield from (list(value), None)
        yield from ((*value[:-1], other) for other in ("x", True, *others(value[-1])))


def test_what_is_of_another_type_is_a_fault_in_one_line() -> None:
    calibration = load(Calibration, FULL)
    assert find_fault(calibration, Calibration) is None is find_fault(Calibration(), Calibration)
    wrong = [*others(calibration)]
    assert len(wrong) > 150
    for one in wrong:
        reason = find_fault(one, Calibration)
        assert reason is not None and "\n" not in str(reason), one


@pytest.mark.parametrize("shape", range(4))
def test_what_is_newer_takes_the_place_of_what_is_older_and_all_else_stays(shape: int) -> None:
    older, newer = Maker(shape).of(Calibration), Maker(shape + 10, 1000).of(Calibration)
    both = merged(older, newer)
    for one in attrs.fields(Calibration):
        old, new, now = (getattr(each, one.name) for each in (older, newer, both))
        if one.name in ("headings", "drift"):  # what the errors of a sensor caused that is corrected otherwise now
            old = {foot: value for foot, value in old.items() if foot not in newer.sensors}
        if one.name == "insoles":
            assert list(now) == [foot for foot in Foot if foot in old or foot in new]
            for foot, insole in now.items():
                before, after = old.get(foot), new.get(foot)
                assert insole.layout == (getattr(after, "layout", None) or getattr(before, "layout", None))
                assert insole.newtons == (getattr(after, "newtons", None) or getattr(before, "newtons", None))
                kept = getattr(before, "noise", ()) if getattr(after, "newtons", None) is None else ()
                assert insole.noise == (getattr(after, "noise", ()) or kept), "noise is in the unit of the loads"
        elif isinstance(now, dict) and one.name != "modes":
            assert now == {**old, **new}, one.name
        else:
            assert now == (new or old), one.name
