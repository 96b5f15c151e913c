"""`solepath.to_frame`: events, strides, gait cycles and samples as tables, with their units."""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from math import isnan
from typing import Any

import pytest
from here import ROOT
from strides import stride

import solepath
from solepath import GaitCycleMeasured, HeelStrike, Session, StrideTaken, to_frame
from solepath.emulate import Route, emulate
from solepath.events import Candidate, FlightClimbed, KeysChanged, Placed, SampleGap, StrideFeatures
from solepath.events.frames.columns import _columns_of, table_of
from solepath.events.frames.forms import ValueKind
from solepath.events.frames.units import UNITS
from solepath.events.happening import Happening
from solepath.types import Foot, Layout, Sample, Site
from solepath.types.attrs import fields, frozen
from solepath.types.extras import install_hint

STRIDE = stride(
    Foot.LEFT, 2.0, (1.25, 0.0, 0.0), known_at=2.0625, position=(1.25, 0.5, 0.0), degraded=True,
    features=StrideFeatures(0.125, 4.0, 1.0, cop=((0.25, 0.0), (0.5, 0.0))),
)  # fmt: skip
STRIKE = HeelStrike(t=1.75, known_at=1.8125, foot=Foot.RIGHT)
WALK = emulate(Route().stand(2).walk(8).stop(2), seed=1)
SAMPLE = Sample(t=0.5, site=Site.RIGHT_FOOT, acc=(0.0, 1.0, 9.75), pressure=(1.0, 2.0))

pandas = pytest.importorskip("pandas", reason="pandas is not installed")
polars = pytest.importorskip("polars", reason="polars is not installed")


def walked() -> list[Happening]:
    session = Session()
    return [*session.feed(WALK.packets), *session.finish()]


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_a_frame_has_a_row_an_event_and_a_column_a_number(library: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, {"pandas": "polars", "polars": "pandas"}[library], None)
    frame = to_frame(event for event in (STRIKE, STRIDE))
    assert type(frame).__module__.startswith(library)
    assert list(frame.columns)[:6] == ["event", "t", "known_at", "final", "foot", "inferred"]
    assert frame["event"].to_list() == ["HeelStrike", "StrideTaken"] and frame["foot"].to_list() == ["right", "left"]
    assert [*frame["position_y"]][1] == 0.5 and [*frame["features_clearance"]][1] == 0.125
    assert [*frame["covariance_xx"]][1] == STRIDE.covariance[0]
    assert [list(point) for point in [*frame["features_cop"]][1]] == [[0.25, 0.0], [0.5, 0.0]]
    assert len(to_frame([])) == 0


def test_every_number_of_a_walk_is_in_its_frame() -> None:
    """The same values as `to_dict`, which is the other way to plain data."""
    events = walked()
    rows = to_frame(events, library="polars").to_dicts()
    assert len(rows) == len(events) > 50

    def expected(record: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
        for name, value in record.items():
            if isinstance(value, dict):
                yield from expected(value, f"{prefix}{name}_")
            elif name in ("position", "displacement", "covariance"):
                axes = ("x", "y", "z") if len(value) == 3 else ("xx", "xy", "xz", "yy", "yz", "zz")
                yield from zip([f"{prefix}{name}_{axis}" for axis in axes], value, strict=True)
            else:
                yield prefix + name, value

    for event, row in zip(events, rows, strict=True):
        present = {name: value for name, value in row.items() if value is not None}
        assert present == {name: value for name, value in expected(event.to_dict()) if value is not None}


@pytest.mark.parametrize("cls", [StrideTaken, GaitCycleMeasured])
def test_a_frame_of_one_class_has_its_columns_without_a_row_too(cls: type[Happening]) -> None:
    events = walked()
    frame, empty = to_frame(events, cls), to_frame([], cls)
    assert len(frame) == len([event for event in events if isinstance(event, cls)]) > 8
    assert list(frame.columns) == list(empty.columns) and set(frame["event"]) == {cls.__name__}
    assert frame["number"].dtype == "int64" and frame["t_start"].dtype == empty["t_start"].dtype == "float64"


def test_samples_have_columns_of_their_own() -> None:
    frame = to_frame([SAMPLE, Sample(t=0.51, site=Site.PELVIS, gyro=(0.0, 0.5, 0.0), air_pressure=1e5)])
    assert list(frame.columns)[:2] == ["t", "known_at"] and "event" not in frame
    assert frame["site"].to_list() == ["right_foot", "pelvis"] and frame["foot"].to_list() == ["right", None]
    assert frame["acc_z"][0] == 9.75 and isnan(frame["acc_z"][1]) and list(frame["pressure"][0]) == [1.0, 2.0]
    units = frame.attrs["units"]
    assert [units[name] for name in ("acc_x", "gyro_y", "mag_z", "air_pressure")] == ["m/s^2", "rad/s", "T", "Pa"]
    assert len(to_frame(SAMPLE for _ in range(3))) == 3


def test_units_stay_with_a_part_of_a_frame() -> None:
    frame = to_frame(walked())
    steady = frame[frame.event == "GaitCycleMeasured"][["stride_time", "cadence"]]
    assert steady.attrs["units"]["cadence"] == "1/min" and steady.attrs["units"]["stride_time"] == "s"


@frozen(kw_only=True)
class Weighed(Happening):
    """An app's own event, whose `length` is a text and whose `weights` no table can have."""

    length: str
    weights: dict[str, float]
    height: float
    """Height, inches."""


def test_an_event_of_an_app_is_a_row_too_and_what_no_table_has_is_json() -> None:
    own = Weighed(t=1.0, known_at=1.0, length="long", weights={"a": 1.5}, height=70.0)
    frame = to_frame([STRIDE, own])
    assert frame["length"].to_list() == ["1.25", "long"] and frame["weights"].to_list() == [None, '{"a": 1.5}']
    assert "length" not in frame.attrs["units"] and frame.attrs["units"]["t"] == "s"


def test_an_event_of_an_app_has_no_unit_that_it_does_not_state() -> None:
    own = Weighed(t=1.0, known_at=1.0, length="long", weights={}, height=70.0)
    climbed = FlightClimbed(t=1.0, known_at=1.0, t_start=0.0, up=True, steps=9, height=1.5)
    for events in ([own], [own, climbed], [climbed, own]):
        assert "height" not in to_frame(events).attrs["units"], "inches and metres in one column have no unit"
    assert to_frame([climbed]).attrs["units"]["height"] == "m"


def test_what_is_no_event_and_no_library_is_rejected_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TypeError, match=r"^to_frame takes events and samples, not Packet$"):
        to_frame(WALK.packets)
    with pytest.raises(ValueError, match=r'^library is "pandas", "polars" or "arrow", not \'excel\'$'):
        to_frame([STRIKE], library="excel")
    for library in ("pandas", "polars"):
        monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match="^to_frame needs pandas or polars: " + re.escape(install_hint("frames"))):
        to_frame([STRIKE])
    with pytest.raises(ImportError, match=r"^to_frame needs polars: pip install polars$"):
        to_frame([STRIKE], library="polars")


def event_classes() -> list[Any]:
    """Return all classes that a row may be of."""
    named = [getattr(solepath, name) for name in solepath.__all__]
    return [Sample, *[one for one in named if inspect.isclass(one) and issubclass(one, Happening)]]


def test_a_column_has_one_kind_and_one_unit_whatever_the_event() -> None:
    forms, units = defaultdict(set), defaultdict(set)
    for cls in event_classes():
        for name, form, unit, _ in _columns_of(cls):
            forms[name].add(form)
            units[name].add(unit)
    assert {name: kinds for name, kinds in forms.items() if len(kinds) > 1} == {}
    assert {name: several for name, several in units.items() if len(several) > 1} == {}
    unknown = {name for name, kinds in forms.items() if {form.kind for form in kinds} == {ValueKind.FLOAT}} - {
        name for name, several in units.items() if None not in several
    }
    assert unknown == {"force", "features_contact_load", "layout_full_scale"}, "loads, in newtons or counts"
    assert UNITS.keys() <= {name.removesuffix(f"_{axis}") for name in forms for axis in ("", *"xyzw", "xx")}


def docstrings(cls: type) -> Iterator[tuple[str, str]]:
    """Yield column and docstring of each field of a class and of the records inside of it."""
    for one in cls.__mro__[:-1]:
        body = ast.parse(inspect.getsource(one)).body[0].body  # type: ignore[attr-defined]
        for field, after in zip(body, [*body[1:], None], strict=True):
            if isinstance(field, ast.AnnAssign) and isinstance(after, ast.Expr):
                yield ast.unparse(field.target), ast.literal_eval(after.value)


@pytest.mark.parametrize("cls", [*event_classes(), StrideFeatures, Layout], ids=lambda cls: cls.__name__)
def test_the_unit_of_a_column_is_that_of_the_fields_docstring(cls: Any) -> None:
    prefix = {StrideFeatures: "features_", Layout: "layout_"}.get(cls, "")
    renamed = {one[1]: name for one, name in solepath.events.frames.columns.RENAMED.items() if one[0] == cls.__name__}
    for name, text in docstrings(cls):
        unit = UNITS.get(prefix + renamed.get(name, name))
        words = " ".join(text.split())
        if unit == "1":
            assert re.search(r"0 to 1|share|no unit|unit quaternion", words), name
        elif unit is not None and words:
            assert re.search(rf"(?:, |in |force, ){re.escape(unit)}(?![\w/^])", words), (name, unit, words)


def test_missing_numbers_of_records_within_are_missing() -> None:
    placed = Placed(
        t=1.0, known_at=1.0, level="0", position=(0.0, 0.0, 0.0), room=None, door=None, spread=0.5,
        candidates=(Candidate("0", (0.0, 0.0, 0.0), None, 1.0, "stairs"),),
    )  # fmt: skip
    keys = KeysChanged(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, down=())
    gap = SampleGap(t=0.0, known_at=1.0, site=Site.PELVIS, duration=float("inf"))
    table = table_of([placed, keys, gap])
    values = {column.name: column.values for column in table.columns}
    assert values["level_name"] == ["0", None, None] and values["down"] == [None, [], None]
    assert values["duration"][2] == float("inf") and values["foot"] == [None, "left", None]
    assert list(values["candidates"][0][0]) == [one.name for one in fields(Candidate)]


def test_a_missing_extra_is_named_with_what_installs_it_from_a_clone_and_by_name() -> None:
    words = install_hint("arrays")
    assert "pip install '.[arrays]'" in words and "pip install 'solepath[arrays]'" in words
    literal = [path for path in (ROOT / "src").rglob("*.py") if "pip install 'solepath[" in path.read_text("utf-8")]
    assert [path.name for path in literal] == ["extras.py"], "all messages have this sentence"
