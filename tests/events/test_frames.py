"""`solepath.to_frame`: events, strides, gait cycles and samples as tables, with their units."""

from __future__ import annotations

import re
import sys
from math import isnan

import pytest
from strides import stride

from solepath import HeelStrike, Packet, StrideTaken, to_frame
from solepath.events import Flaw, StrideFeatures
from solepath.events.happening import BaseEvent
from solepath.types import Foot, Sample, Site
from solepath.types.attrs import frozen
from solepath.types.extras import install_hint

STRIDE = stride(
    Foot.LEFT, 2.0, (1.25, 0.0, 0.0), known_at=2.0625, position=(1.25, 0.5, 0.0), flaws=(Flaw.GAP,),
    features=StrideFeatures(0.125, 4.0, 1.0, cop=((0.25, 0.0), (0.5, 0.0))),
)  # fmt: skip
STRIKE = HeelStrike(t=1.75, known_at=1.8125, foot=Foot.RIGHT)
SAMPLE = Sample(t=0.5, site=Site.RIGHT_FOOT, acc=(0.0, 1.0, 9.75), pressure=(1.0, 2.0))

pandas = pytest.importorskip("pandas", reason="pandas is not installed")
polars = pytest.importorskip("polars", reason="polars is not installed")


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_a_frame_is_of_the_library_that_is_there(library: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, {"pandas": "polars", "polars": "pandas"}[library], None)
    frame = to_frame(event for event in (STRIKE, STRIDE))
    assert type(frame).__module__.startswith(library)
    assert frame["event"].to_list() == ["HeelStrike", "StrideTaken"] and frame["foot"].to_list() == ["right", "left"]
    assert [list(point) for point in [*frame["features_cop"]][1]] == [[0.25, 0.0], [0.5, 0.0]]
    only, empty = to_frame([STRIKE, STRIDE], StrideTaken), to_frame([], StrideTaken)
    assert str(only["number"].dtype) == {"pandas": "int64", "polars": "Int64"}[library]
    assert len(only) == 1 and len(to_frame([])) == len(empty) == 0 and list(only.columns) == list(empty.columns)


def test_samples_have_columns_of_their_own() -> None:
    frame = to_frame([SAMPLE, Sample(t=0.51, site=Site.PELVIS, gyro=(0.0, 0.5, 0.0), air_pressure=1e5)])
    assert list(frame.columns)[:2] == ["t", "known_at"] and "event" not in frame
    assert frame["site"].to_list() == ["right_foot", "pelvis"] and frame["foot"].to_list() == ["right", None]
    assert frame["acc_z"][0] == 9.75 and isnan(frame["acc_z"][1]) and list(frame["pressure"][0]) == [1.0, 2.0]
    units = frame.attrs["units"]
    assert [units[name] for name in ("acc_x", "gyro_y", "mag_z", "air_pressure")] == ["m/s^2", "rad/s", "T", "Pa"]
    assert len(to_frame(SAMPLE for _ in range(3))) == 3


@frozen(kw_only=True)
class Weighed(BaseEvent):
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


def test_what_is_no_event_and_no_library_is_rejected_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TypeError, match=r"^to_frame takes events and samples, not Packet$"):
        to_frame([Packet(0.0, Site.PELVIS, "receiver/tick", b"")])
    with pytest.raises(ValueError, match=r'^library is "pandas", "polars" or "arrow", not \'excel\'$'):
        to_frame([STRIKE], library="excel")
    for library in ("pandas", "polars"):
        monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match="^to_frame needs pandas or polars: " + re.escape(install_hint("frames"))):
        to_frame([STRIKE])
    with pytest.raises(ImportError, match=r"^to_frame needs polars: pip install polars$"):
        to_frame([STRIKE], library="polars")
