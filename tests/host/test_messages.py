"""Messages that a host cannot understand, or that come when they make no sense (protocol/host.md)."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.session.json_host import HANDLERS, JsonHost

BAD: list[Any] = [
    None,
    [],
    {},
    {"type": "no such"},
    {"type": "add", "device": "", "site": None},
    {"type": "add", "device": "A", "site": "nose"},
    {"type": "add", "device": "A", "site": None, "address": 5},
    {"type": "add", "device": "A", "site": "pelvis", "profile": "toaster"},
    {"type": "connected", "device": "A", "t": 0.0, "characteristics": [["a", "b"]]},
    {"type": "connected", "device": "A", "t": 1e300, "characteristics": []},
    {"type": "done", "device": "A", "t": 0.0},
    {"type": "done", "device": "A", "t": 0.0, "value": "0g"},
    {"type": "rejected", "device": "A", "t": 0.0, "reason": ""},
    {"type": "values", "values": [[0.0, "A", "insole/frame"]]},
    {"type": "disconnected", "device": "A", "t": 0.0},
    {"type": "time", "t": None},
    {"type": "start", "state": "bm8gc3RhdGU="},
    {"type": "bind", "site": "left_foot", "address": 5},
]


@pytest.mark.parametrize("message", BAD, ids=lambda message: json.dumps(message)[:40])
def test_a_message_that_cannot_be_understood_is_an_error_and_changes_nothing(message: Any) -> None:
    host = JsonHost()
    before = host.host.session.pack()
    answers = json.loads(host.receive(json.dumps(message)))
    assert all(answer["type"] == "error" and answer["reason"] for answer in answers)
    assert answers or message == []
    assert host.host.session.pack() == before


def test_texts_that_are_no_json_are_an_error() -> None:
    for text in ("", "{", '{"type": "time", "t": NaN}', "\x00", "[" * 100_000):
        [answer] = json.loads(JsonHost().receive(text))
        assert answer["type"] == "error"


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.sampled_from(["A", "B", "", "00", "é"]),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=6,
)
KEYS = [
    "device",
    "t",
    "site",
    "profile",
    "name",
    "signal",
    "characteristics",
    "value",
    "reason",
    "values",
    "connection",
    "state",
    "address",
    "packets",
]


@settings(max_examples=40)
@given(
    st.lists(
        st.fixed_dictionaries({"type": st.sampled_from([*HANDLERS])}, optional={key: VALUES for key in KEYS}),
        max_size=12,
    )
)
def test_any_messages_give_messages(messages: list[dict[str, Any]]) -> None:
    host = JsonHost(packets=True)
    host.receive(json.dumps({"type": "add", "device": "A", "site": None}))
    for message in messages:
        for answer in json.loads(host.receive(json.dumps(message))):
            assert answer["type"] in ("error", "event", "packet", "filters", "saved", "disconnect")
