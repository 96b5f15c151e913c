"""Events as plain data: `to_dict`, which is a line of events.jsonl."""

import json

from strides import stride

from solepath.events import (
    CellFault,
    CellsFailed,
    FeetSwapped,
    LayoutKnown,
    SampleGap,
    StrideFeatures,
    StrideFused,
    TouchedDown,
)
from solepath.types import Activity, Cell, Foot, Layout, Phase, Site, WalkingMode

STRIDE = stride(
    Foot.LEFT, 2.0, (1.25, 0.0, 0.0), known_at=2.0625, position=(1.25, 0.5, 0.0), degraded=True,
    features=StrideFeatures(0.125, 4.0, 1.0),
)  # fmt: skip


def test_events_are_strict_json_with_feet_and_modes_by_their_names():
    fused = StrideFused(
        t=2.0, known_at=2.0, foot=Foot.LEFT, number=4, stride_length=1.375, own_length=1.25, similarity=None,
        error_index=None, coefficient=1.0, chosen=Foot.RIGHT, distance=5.25, position=(5.0, 0.25, 0.0),
    )  # fmt: skip
    zero = (0.0, 0.0, 0.0)
    down = TouchedDown(
        t=1.0, known_at=1.0, foot=Foot.LEFT, position=zero, mode=WalkingMode.LEFT_TIGHT, compensation=zero
    )
    records = json.loads(json.dumps([fused.to_dict(), down.to_dict()], allow_nan=False))
    assert (records[0]["event"], records[0]["foot"], records[0]["chosen"]) == ("StrideFused", "left", "right")
    assert records[0]["similarity"] is None and records[0]["position"] == [5.0, 0.25, 0.0]
    assert (records[1]["event"], records[1]["mode"]) == ("TouchedDown", "LEFT_TIGHT")
    failed = CellsFailed(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, fault=CellFault.STUCK, cells=(3,))
    assert failed.to_dict() == {
        "event": "CellsFailed", "t": 1.0, "known_at": 1.0, "final": True, "foot": "left", "site": "left_foot",
        "fault": "stuck", "cells": [3],
    }  # fmt: skip
    swapped = FeetSwapped(t=1.0, known_at=1.0).to_dict()
    assert swapped == {"event": "FeetSwapped", "t": 1.0, "known_at": 1.0, "final": True}


def test_the_name_and_the_times_come_first_and_records_within_an_event_are_objects():
    record = STRIDE.to_dict()
    assert list(record)[:5] == ["event", "t", "known_at", "final", "foot"]
    assert record["event"] == "StrideTaken" and record["foot"] == "left" and record["position"] == [1.25, 0.5, 0.0]
    assert record["features"]["clearance"] == 0.125 and record["t_toe_off"] is None
    layout = Layout(2, Foot.LEFT, (Cell(0.0, 0.0), Cell(0.25, 0.0)), 0.25)
    known = LayoutKnown(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, layout=layout).to_dict()
    assert known["layout"]["cells"][1] == {"x": 0.25, "y": 0.0, "area": 1e-4}


def test_numbers_that_are_none_are_null():
    gap = SampleGap(t=0.0, known_at=float("inf"), site=Site.PELVIS, duration=float("nan"))
    assert gap.to_dict() == {
        "event": "SampleGap", "t": 0.0, "known_at": None, "final": True, "site": "pelvis", "duration": None
    }  # fmt: skip


def test_words_print_as_they_are_written():
    assert f"{Foot.LEFT} {Site.PELVIS} {Phase.SWING} {Activity.WALKING}" == "left pelvis SWING WALKING"
    assert str(Foot.RIGHT) == "right" and repr(Foot.RIGHT) == "<Foot.RIGHT: 'right'>"
