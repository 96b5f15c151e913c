"""Every event, with other values in all of its fields, as plain data and as a row of a table."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import inf
from typing import Any, get_args

import pytest
from attrs import evolve
from made import Maker

from solepath import Event, to_frame
from solepath.events import GaitCycleMeasured, SampleGap
from solepath.saving.codec import save
from solepath.types import Site

AXES = ("w", "x", "y", "z", "xx", "xy", "xz", "yy", "yz", "zz", "forward", "left")


def events(shape: int) -> list[Any]:
    """Return one event of each class."""
    return [Maker(shape, extreme=0.0).of(cls) for cls in get_args(Event)]


@pytest.mark.parametrize("shape", range(4))
def test_an_event_is_strict_json_with_its_name_its_times_and_its_foot_first(shape: int) -> None:
    for event in events(shape):
        plain = json.loads(json.dumps(event.to_dict(), allow_nan=False))
        saved: Any = save(event)
        foot = getattr(
            getattr(event, "foot", None) or getattr(getattr(event, "site", None), "foot", None), "value", None
        )
        first = {"event": type(event).__name__, "t": event.t, "known_at": event.known_at, "final": event.final}
        if foot is not None:
            first["foot"] = foot
        assert [*plain.items()][: len(first)] == [*first.items()]
        assert [*plain.items()][len(first) :] == [item for item in saved.items() if item[0] not in first]


def columns(record: dict[str, Any], row: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the columns of a table in which the plain data of an event are, a vector in those of its axes."""
    for name, value in record.items():
        if isinstance(value, list) and name == "north":
            yield from zip(["north", "north_sigma"], value, strict=True)
            continue
        name, axes = prefix + name, [column.removeprefix(f"{prefix}{name}_") for column in row]
        axes = [axis for axis in axes if axis in AXES]
        if isinstance(value, dict):
            yield from columns(value, row, f"{name}_")
        elif isinstance(value, list) and name not in row:
            yield from zip([f"{name}_{axis}" for axis in axes], value, strict=False)
        else:
            names = (name, f"{name}_name", "offset_sigma")
            yield next(one for one in names if value is None or row.get(one) == value), value


def properties_of(cls: type) -> set[str]:
    """Return the names of what an event derives from its fields."""
    return {name for base in cls.__mro__ for name, value in vars(base).items() if isinstance(value, property)}


@pytest.mark.parametrize("shape", range(4))
def test_every_number_of_every_event_is_in_its_row(shape: int) -> None:
    pytest.importorskip("polars", reason="polars is not installed")
    every = events(shape)
    for event, row in zip(every, to_frame(every, library="polars").to_dicts(), strict=True):
        present = {name: value for name, value in row.items() if value is not None}
        properties = [(name, getattr(event, name)) for name in present.keys() & properties_of(type(event))]
        derived = {name: getattr(value, "value", value) for name, value in properties}
        said = {name: value for name, value in columns(event.to_dict(), row) if value is not None}
        assert present == said | derived


def test_a_number_that_is_not_finite_is_null() -> None:
    gap = SampleGap(t=0.0, known_at=inf, site=Site.PELVIS, duration=-inf, count=0)
    assert gap.to_dict() == {
        "event": "SampleGap", "t": 0.0, "known_at": None, "final": True, "site": "pelvis", "duration": None,
        "count": 0, "gaps": 1, "longest": None
    }  # fmt: skip


def test_shares_of_a_gait_cycle_are_of_its_stride() -> None:
    for shape in range(12):
        cycle = Maker(shape, extreme=0.0).of(GaitCycleMeasured)
        first, last, single, stride = (
            cycle.initial_double_support, cycle.terminal_double_support, cycle.single_support, cycle.stride_time
        )  # fmt: skip
        assert (cycle.stance_share, cycle.swing_share) == (cycle.stance_time / stride, cycle.swing_time / stride)
        assert cycle.single_support_share == (None if single is None else single / stride)
        both = None if first is None or last is None else first + last
        assert cycle.double_support == both
        assert cycle.double_support_share == (None if both is None else both / stride)
        assert [evolve(cycle, stance_time=share * stride).running for share in (0.49, 0.5)] == [True, False]
